//! `pss render`, end to end: names, sizes and bytes of what it writes, and what it says.

mod cli_common;

use std::process::{Command, Stdio};

use cli_common::{Folder, png_size};
use pss::output::read_exr;

const BALL: &str = "draw sphere(r: 1)\nlight(direction: [-1, 2, -3], softness: 5deg)\n\
                    render(size: [24, 16], samples: 2, aov: [\"depth\", \"normal\"])\n";

/// A scan, cut, in soft light: everything that is random or built lazily.
const SCAN: &str = "draw points(sphere(r: 1), samples: 1500, noise: 0.003, seed: 4) - box([0, -2, 0], [2, 0, 2])\n\
                    draw plane(z: -1)\nlight(direction: [-1, 2, -3], softness: 9deg)\nlight(color: #88aaff)\n\
                    render(size: [40, 30], samples: 3, aov: [\"depth\", \"normal\", \"albedo\"])\n";

fn folder(scene: &str) -> Folder {
    let folder = Folder::new();
    folder.write("a.pss", scene);
    folder
}

#[test]
fn without_a_name_the_picture_is_called_as_the_scene() {
    let folder = folder(BALL);
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    folder.write("sub/b.pss", BALL);
    let ran = folder.run(&["render", "sub/b.pss"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, "wrote b.png\n"));
    assert_eq!(folder.files(), ["a.pss", "b.png", "sub"]);
    assert_eq!(png_size(&folder.read("b.png")), [24, 16]);
    let quiet = folder.run(&["render", "a.pss", "--quiet"]);
    assert!(quiet.code == 0 && quiet.stderr.is_empty() && quiet.stdout.is_empty());
}

#[test]
fn one_run_writes_several_files_and_standard_output() {
    let folder = folder(BALL);
    let args =
        ["render", "a.pss", "-o", "a.png", "-o", "b.exr", "-o", "c.png", "-o", "-", "--stats-json", "s.json"];
    let ran = folder.run(&args);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(folder.files(), ["a.png", "a.pss", "b.exr", "c.png", "s.json"]);
    assert_eq!(ran.stdout, folder.read("a.png"));
    assert_eq!(folder.read("c.png"), folder.read("a.png"));
    let film = read_exr(&folder.path().join("b.exr")).unwrap();
    assert_eq!((film.size, film.layers.len()), ([24, 16], 2));
}

#[test]
fn a_part_is_the_same_pixels_of_the_whole() {
    let folder = folder(BALL);
    let whole = folder.run(&["render", "a.pss", "-o", "a.exr"]);
    let part = folder.run(&["render", "a.pss", "-o", "b.exr", "-o", "b.png", "--crop", "5,3,17,12"]);
    assert_eq!((whole.code, part.code), (0, 0));
    assert_eq!(png_size(&folder.read("b.png")), [12, 9]);
    let read = |name: &str| read_exr(&folder.path().join(name)).unwrap();
    let (whole, part) = (read("a.exr"), read("b.exr"));
    assert_eq!(part.size, [12, 9]);
    for (x, y) in (0..12).flat_map(|x| (0..9).map(move |y| (x, y))) {
        assert_eq!(part.pixel(x, y), whole.pixel(x + 5, y + 3), "{x}, {y}");
    }
    let sized = folder.run(&["render", "a.pss", "-o", "c.png", "--size", "10x7", "--spp", "1"]);
    assert_eq!(sized.code, 0);
    assert_eq!(png_size(&folder.read("c.png")), [10, 7]);
}

#[test]
fn threads_and_runs_change_no_byte() {
    let folder = folder(SCAN);
    for (name, threads) in [("a", "1"), ("b", "2"), ("c", "2")] {
        let (png, exr) = (format!("{name}.png"), format!("{name}.exr"));
        let ran = folder.run(&["render", "a.pss", "-o", &png, "-o", &exr, "-t", threads]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert_eq!(folder.read(&png), folder.read("a.png"), "{png} with {threads} threads");
        assert_eq!(folder.read(&exr), folder.read("a.exr"), "{exr} with {threads} threads");
    }
    let other = folder.run(&["render", "a.pss", "-o", "d.png", "--seed", "1"]);
    assert_eq!(other.code, 0);
    assert_ne!(folder.read("d.png"), folder.read("a.png"), "another seed, other noise");
}

#[test]
fn statistics_have_every_field() {
    let folder = folder(SCAN);
    assert_eq!(folder.run(&["render", "a.pss", "--quiet", "--stats-json", "s.json", "-t", "2"]).code, 0);
    let stats: serde_json::Value = serde_json::from_slice(&folder.read("s.json")).unwrap();
    let number = |place: &str| {
        let value = stats.pointer(place).unwrap_or_else(|| panic!("no {place}: {stats:#}"));
        value.as_f64().unwrap_or_else(|| panic!("{place} is no number: {stats:#}"))
    };
    for name in ["wall_s", "cpu_s", "threads", "peak_bytes"] {
        assert!(0.0 < number(&format!("/{name}")), "{name}");
    }
    let groups: [(&str, &[&str]); 4] = [
        ("stages", &["parse", "load", "prepare", "render", "write"]),
        ("rays", &["camera", "shadow", "bounce"]),
        (
            "pss",
            &["projections", "patch_hits", "crossings", "certificate_failures", "parity_repairs", "caps"],
        ),
        ("csg", &["leaf_queries", "leaves_skipped", "ties"]),
    ];
    for (group, names) in groups {
        names.iter().for_each(|name| assert!(0.0 <= number(&format!("/{group}/{name}"))));
    }
    assert_eq!(number("/threads"), 2.0);
    // A ray a sample, and one through the centre of each pixel where a layer is written.
    assert_eq!(number("/rays/camera"), f64::from(40 * 30 * 3));
    assert!(
        0.0 < number("/rays/shadow") && 0.0 < number("/pss/projections") && 0.0 < number("/pss/crossings")
    );
    // What is cut has to have an inside: whether it does was measured.
    assert_eq!(stats.pointer("/scans/0/solidity/body"), Some(&serde_json::json!("Solid")));
    assert!(100.0 <= number("/scans/0/solidity/chords") && number("/scans/0/solidity/odd_chords") <= 1.0);
}

#[test]
fn an_input_is_never_overwritten() {
    let folder = folder("draw points(\"scan.png\")\n");
    let cloud = cli_common::ply_with_normals(&cli_common::sphere(300, 1.0));
    folder.write("scan.png", &cloud);
    let ran = folder.run(&["render", "a.pss", "-o", "scan.png"]);
    assert_eq!(ran.code, 73, "{}", ran.stderr);
    assert_eq!(folder.read("scan.png"), cloud.as_bytes());
    assert_eq!(folder.files(), ["a.pss", "scan.png"]);
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let folder = folder(BALL);
    let scene = std::fs::File::open(folder.path().join("a.pss")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pss"));
    let output = command.args(["render", "-"]).current_dir(folder.path()).stdin(scene).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(folder.files(), ["a.pss", "scene.png"]);
}

#[test]
fn a_reader_that_has_gone_is_no_error() {
    let folder = folder(BALL);
    folder.write("rays.csv", "0,0,9,0,0,-1\n".repeat(20_000));
    for args in [&["probe", "a.pss", "--rays", "rays.csv", "--json"][..], &["render", "a.pss", "-o", "-"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pss"));
        command.args(args).current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args:?}");
    }
}
