//! Clouds that can be drawn but may disappoint: each is warned of, with its place in the scene and a way out, and the
//! picture is made all the same.

mod cli_common;

use cli_common::{Folder, Ran, ply, ply_of, ply_with_normals, sphere};
use glam::DVec3;
use pss::num::hash::Stream;

/// Renders `draw points("a.ply")`.
fn rendered(cloud: impl AsRef<[u8]>, flags: &[&str]) -> Ran {
    let folder = Folder::new();
    folder.write("a.pss", "// a cloud\ndraw points(\"a.ply\")\n").write("a.ply", cloud);
    let ran =
        folder.run(&[&["render", "a.pss", "-o", "a.png", "--size", "8x8", "--spp", "1"], flags].concat());
    assert!(ran.code != 0 || folder.files().contains(&"a.png".to_owned()));
    ran
}

/// What is said of a scene.
fn said_of(scene: &str, cloud: impl AsRef<[u8]>) -> String {
    let folder = Folder::new();
    folder.write("a.pss", scene).write("a.ply", cloud);
    folder.run(&["render", "a.pss", "-o", "a.png", "--size", "8x8", "--spp", "1"]).stderr
}

/// What is warned of when a cloud is drawn.
fn warned(cloud: impl AsRef<[u8]>) -> String {
    let ran = rendered(&cloud, &[]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(rendered(&cloud, &["--quiet"]).stderr.is_empty());
    ran.stderr
}

fn says(said: &str, words: &[&str]) {
    words.iter().for_each(|word| assert!(said.contains(word), "wants `{word}`:\n{said}"));
}

fn shaken(points: &[DVec3], by: f64) -> Vec<DVec3> {
    let mut stream = Stream::new(3);
    points.iter().map(|p| *p + by * DVec3::new(stream.normal(), stream.normal(), stream.normal())).collect()
}

#[test]
fn a_good_cloud_is_drawn_without_a_word() {
    let said = warned(ply_with_normals(&sphere(4000, 1.0)));
    assert_eq!(said, "");
}

#[test]
fn f8_p10_points_that_are_not_finite_are_counted_aloud() {
    let rows = sphere(4000, 1.0).into_iter().enumerate().map(|(i, p)| match i {
        7 | 9 => "nan 0 0".to_owned(),
        _ => format!("{} {} {}", p.x, p.y, p.z),
    });
    let said = warned(ply_of(4000, "property float x\nproperty float y\nproperty float z\n", rows));
    says(
        &said,
        &[
            "warning[W0102]",
            "a.pss:2:13",
            "2 points with coordinates that are not finite",
            "first is point 7",
        ],
    );
}

#[test]
fn p5_data_behind_the_last_point_are_told_with_their_byte() {
    let mut text = ply(&sphere(4000, 1.0));
    let at = text.len();
    text.push_str("1 2 3\n");
    says(&warned(text), &["warning[W0102]", &format!("from byte {at}")]);
}

#[test]
fn p2_a_cut_file_is_drawn_where_the_user_is_lenient() {
    let text = ply(&sphere(4000, 1.0));
    let cut = &text[..text.len() * 9 / 10];
    let count = cut.lines().count() - 8;
    assert_eq!(rendered(cut, &[]).code, 65);
    let ran = rendered(cut, &["--lenient"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    says(&ran.stderr, &["W0102", &format!("truncated: expected 4000 points, got {count}: these were kept")]);

    let folder = Folder::new();
    folder.write("a.ply", cut);
    assert_eq!(folder.run(&["cloud", "convert", "a.ply", "b.ply"]).code, 65);
    let ran = folder.run(&["cloud", "convert", "--lenient", "a.ply", "b.ply"]);
    says(&ran.stderr, &["warning[W0102]", "these were kept"]);
    let ran = folder.run(&["cloud", "info", "b.ply"]);
    says(&String::from_utf8(ran.stdout).unwrap(), &[&format!("{count} in the file")]);
}

#[test]
fn f14_noise_above_a_third_of_the_width_is_warned_of() {
    // 10,000 points, 0.035 apart; a width is some 1.9 of that.
    let points = shaken(&sphere(10_000, 1.0), 0.05);
    says(&warned(ply(&points)), &["warning[W0104]", "smoothing"]);
}

#[test]
fn f17_walls_thinner_than_the_weights_tell_apart_are_warned_of() {
    let shells = |gap: f64| {
        let outer = sphere(8000, 1.0);
        let row = |p: DVec3, n: DVec3| format!("{} {} {} {} {} {}", p.x, p.y, p.z, n.x, n.y, n.z);
        let rows: Vec<String> =
            outer.iter().flat_map(|p| [row(*p, *p), row((1.0 - gap) * *p, -*p)]).collect();
        let columns =
            ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
        ply_of(16_000, &columns, rows.into_iter())
    };
    // Samples are 0.04 apart, widths twice that: walls of 0.75, 2 and 5 widths.
    says(&warned(shells(0.06)), &["warning[W0105]", "walls thinner"]);
    assert_eq!(warned(shells(0.16)), "");
    let mixed = "draw points(\"a.ply\", facing: \"any\")\n";
    says(&said_of(mixed, shells(0.16)), &["warning[W0105]", "walls thinner"]);
    assert_eq!(said_of(mixed, shells(0.4)), "");
}

#[test]
fn f18_normals_that_disagree_are_warned_of() {
    let mut stream = Stream::new(5);
    let rows: Vec<String> = sphere(4000, 1.0)
        .iter()
        .map(|p| {
            let n = if stream.unit() < 0.45 { -*p } else { *p };
            format!("{} {} {} {} {} {}", p.x, p.y, p.z, n.x, n.y, n.z)
        })
        .collect();
    let columns = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    says(&warned(ply_of(4000, &columns, rows.into_iter())), &["normals"]);
}

#[test]
fn f22_single_precision_too_far_from_the_origin_is_warned_of() {
    let far: Vec<DVec3> =
        sphere(4000, 1.0).iter().map(|p| (*p + DVec3::X * 1e6).as_vec3().as_dvec3()).collect();
    says(&warned(ply(&far)), &["warning[W0103]", "float32", "nearer to the origin"]);
}

#[test]
fn statistics_hold_what_was_done_to_each_scan() {
    let folder = Folder::new();
    let mut points = sphere(4000, 1.0);
    points.push(DVec3::splat(5.0));
    points.push(points[0]);
    folder.write("a.pss", "let scan = points(\"a.ply\")\ndraw scan\n").write("a.ply", ply(&points));
    let ran =
        folder.run(&["render", "a.pss", "-o", "a.png", "--size", "8x8", "--stats", "--stats-json", "s.json"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    says(&ran.stderr, &["4000 samples", "1 stray points", "pss.projections"]);
    let stats: serde_json::Value = serde_json::from_slice(&folder.read("s.json")).unwrap();
    assert_eq!(stats["scans"][0]["samples"], 4000);
    assert!(stats["scans"][0]["notes"].to_string().contains("stray"), "{stats}");
}

#[test]
fn weights_that_hold_hundreds_of_samples_are_warned_of_and_those_that_hold_thousands_refused() {
    let cloud = || ply_with_normals(&sphere(10_000, 1.0));
    says(
        &said_of("draw points(\"a.ply\", smoothing: 6)\n", cloud()),
        &["warning[W0107]", "samples, where 12 are usual"],
    );
    assert_eq!(said_of("draw points(\"a.ply\", smoothing: 3)\n", cloud()), "");
    for (argument, words) in [
        ("h: 1", ["holds some 2", "0.0349 apart"]),
        ("h: 5", ["more than the whole cloud", "0.0349 apart"]),
        ("smoothing: 20", ["where 12 are usual", "0.0349 apart"]),
        ("h: 0", ["`h` must be above zero", "write a number above zero"]),
    ] {
        let folder = Folder::new();
        folder.write("a.pss", format!("draw points(\"a.ply\", {argument})\n")).write("a.ply", cloud());
        let ran = folder.run(&["render", "a.pss", "-o", "a.png", "--size", "8x8", "--spp", "1"]);
        assert_eq!(ran.code, 65, "{argument}: {}", ran.stderr);
        says(&ran.stderr, &["a.pss:1:", words[0], words[1]]);
        assert!(!ran.stderr.contains("warning"), "{}", ran.stderr);
    }
}
