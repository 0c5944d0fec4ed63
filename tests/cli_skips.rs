//! What a scene does not need is not done: line by line of the design's list, by the counts of `--stats-json`.

mod cli_common;

use cli_common::{Folder, ply, ply_with_normals, sphere};
use serde_json::Value;

/// The counts of a render of this scene.
fn stats(folder: &Folder, scene: &str) -> Value {
    folder.write("scene.pss", scene);
    let ran = folder.run(&["render", "scene.pss", "-o", "out.png", "--quiet", "--stats-json", "stats.json"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    serde_json::from_slice(&folder.read("stats.json")).unwrap()
}

fn number(stats: &Value, path: &str) -> u64 {
    stats.pointer(path).and_then(Value::as_u64).unwrap_or_else(|| panic!("no {path} in {stats}"))
}

const VIEW: &str = "camera(eye: [3, -4, 2], look_at: [0, 0, 0], fov: 40deg)\n";

fn clouds() -> Folder {
    let folder = Folder::new();
    let points = sphere(3000, 2.0);
    folder.write("bare.ply", ply(&points)).write("with.ply", ply_with_normals(&points));
    folder
}

#[test]
fn a_file_that_nothing_drawn_uses_is_not_opened() {
    let folder = clouds();
    let scene =
        format!("let unused = points(\"no such file.ply\")\ndraw sphere(r: 1)\n{VIEW}render(size: [16, 16])");
    assert_eq!(number(&stats(&folder, &scene), "/files"), 0);
    let scene = format!("draw points(\"with.ply\")\n{VIEW}render(size: [16, 16], samples: 1)");
    assert_eq!(number(&stats(&folder, &scene), "/files"), 1);
}

#[test]
fn normals_are_estimated_only_where_the_file_has_none() {
    let folder = clouds();
    for (file, estimated) in [("with.ply", 0), ("bare.ply", 3000)] {
        let scene = format!("draw points(\"{file}\")\n{VIEW}render(size: [16, 16], samples: 1)");
        assert_eq!(number(&stats(&folder, &scene), "/scans/0/normals_estimated"), estimated, "{file}");
    }
}

#[test]
fn solidity_is_measured_only_of_operands() {
    let folder = clouds();
    let alone = format!("draw points(\"with.ply\")\n{VIEW}render(size: [16, 16], samples: 1)");
    assert!(stats(&folder, &alone).pointer("/scans/0/solidity").unwrap().is_null());
    let operand =
        format!("draw points(\"with.ply\") & half_space(z < 0.5)\n{VIEW}render(size: [16, 16], samples: 1)");
    assert_eq!(number(&stats(&folder, &operand), "/scans/0/solidity/chords"), 10_000);
}

#[test]
fn guides_and_patches_are_made_only_where_rays_come_and_patches_only_where_many_do() {
    let folder = clouds();
    let scene = |size: u32, look_at: &str| {
        format!(
            "draw points(\"with.ply\", tolerance: 1e-6)\n\
             camera(eye: [3, -4, 2], look_at: {look_at}, fov: 40deg)\n\
             render(size: [{size}, {size}], samples: 1, integrator: \"depth\")"
        )
    };
    // Past the scan: nothing is made.
    let past = stats(&folder, &scene(400, "[9, -4, 2]"));
    assert_eq!(["guides", "patches", "projections"].map(|n| number(&past, &format!("/pss/{n}"))), [0; 3]);
    // Few rays: guides alone, and fewer of them than cells of eight samples in sight.
    let few = stats(&folder, &scene(20, "[0, 0, 0]"));
    assert_eq!(["patches", "patch_hits"].map(|n| number(&few, &format!("/pss/{n}"))), [0; 2]);
    assert!((1..375).contains(&number(&few, "/pss/guides")), "{few}");
    // Many: patches, which answer most crossings.
    let many = stats(&folder, &scene(400, "[0, 0, 0]"));
    assert!(0 < number(&many, "/pss/patches"));
    assert!(number(&many, "/pss/crossings") < 2 * number(&many, "/pss/patch_hits"), "{many}");
}

#[test]
fn layers_are_kept_only_where_a_file_holds_them() {
    let folder = Folder::new();
    let kept = |aov: &str, out: &str| {
        folder
            .write("scene.pss", format!("draw sphere(r: 1)\n{VIEW}render(size: [16, 16], samples: 1{aov})"));
        let ran = folder.run(&["render", "scene.pss", "-o", out, "--quiet", "--stats-json", "stats.json"]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        number(&serde_json::from_slice(&folder.read("stats.json")).unwrap(), "/layers")
    };
    let asked = ", aov: [\"depth\", \"normal\"]";
    assert_eq!(kept("", "out.exr"), 0, "none asked for");
    assert_eq!(kept(asked, "out.png"), 0, "the file holds colour alone");
    assert_eq!(kept(asked, "out.exr"), 2);
}

#[test]
fn the_time_of_reading_files_is_told_apart() {
    let folder = clouds();
    let seconds = |scene: &str| {
        let stats = stats(&folder, &format!("{scene}\n{VIEW}render(size: [16, 16], samples: 1)"));
        stats.pointer("/stages/load").and_then(Value::as_f64).unwrap()
    };
    assert_eq!(seconds("draw sphere(r: 1)"), 0.0);
    assert!(0.0 < seconds("draw points(\"with.ply\")"));
}

#[test]
fn shadow_rays_go_only_towards_lights_that_can_contribute() {
    let folder = clouds();
    let scene = |light: &str, integrator: &str| {
        format!(
            "draw sphere(r: 1)\n{VIEW}{light}\nrender(size: [32, 32], samples: 1, integrator: \"{integrator}\")"
        )
    };
    let sun = "light(direction: [-1, 1, -1])";
    let lit = number(&stats(&folder, &scene(sun, "direct")), "/rays/shadow");
    assert!(0 < lit);
    // From behind the sphere: no face in sight is turned to it.
    let behind = "light(direction: [3, -4, 2])";
    assert!(number(&stats(&folder, &scene(behind, "direct")), "/rays/shadow") < lit);
    assert_eq!(number(&stats(&folder, &scene(sun, "normals")), "/rays/shadow"), 0);
    assert_eq!(
        number(
            &stats(&folder, &scene("light(direction: [-1, 1, -1], intensity: 0)", "direct")),
            "/rays/shadow"
        ),
        0
    );
}

#[test]
fn cutters_are_not_asked_where_the_base_does_not_live_and_no_scan_behind_what_hides_it() {
    let folder = clouds();
    let wall = "draw box([-2, -2, -2], [2, 2, 2])\n";
    let hidden = format!(
        "{wall}draw points(\"with.ply\")\n{VIEW}render(size: [24, 24], samples: 1, integrator: \"depth\")"
    );
    assert_eq!(number(&stats(&folder, &hidden), "/pss/projections"), 0);
    let cutter = format!(
        "draw box([4, 4, 4], [5, 5, 5]) - points(\"with.ply\")\n{VIEW}render(size: [24, 24], samples: 1, integrator: \"depth\")"
    );
    assert_eq!(number(&stats(&folder, &cutter), "/pss/crossings"), 0, "crossings of rays of the picture");
}
