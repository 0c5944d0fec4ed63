//! `pss cloud info` and `pss cloud convert`.

mod cli_common;

use cli_common::{Folder, ply, ply_of, ply_with_normals, sphere};
use glam::DVec3;
use pss::cloud::ply::read;
use pss::num::hash::Stream;

#[test]
fn info_says_what_a_sphere_is_like() {
    let folder = Folder::new();
    folder.write("ball.ply", ply_with_normals(&sphere(4000, 1.0)));
    let ran = folder.run(&["cloud", "info", "ball.ply"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let text = String::from_utf8(ran.stdout).unwrap();
    for words in [
        "4000 in the file, 4000 samples",
        "diagonal 3.46",
        "normals        file",
        "holes          none",
        "a Solid: 0 of 10000",
    ] {
        assert!(text.contains(words), "{words}:\n{}", text);
    }
    let ran = folder.run(&["cloud", "info", "--json", "ball.ply", "ball.ply"]);
    let lines = ran.json_lines();
    assert_eq!(lines.len(), 2);
    let spacing = lines[0]["spacing"]["median"].as_f64().unwrap();
    // The root of a sample's share of 4 pi.
    assert!((spacing / (4.0 * std::f64::consts::PI / 4000.0).sqrt() - 1.0).abs() < 0.1, "{spacing}");
    assert_eq!((&lines[1]["version"], &lines[1]["inside"]["body"]), (&1.into(), &"Solid".into()));
}

#[test]
fn info_calls_an_open_cloud_a_sheet_and_shows_its_hole() {
    let folder = Folder::new();
    folder.write("bowl.ply", ply(&sphere(4000, 0.3)));
    let line = &folder.run(&["cloud", "info", "--json", "bowl.ply"]).json_lines()[0];
    assert_eq!((&line["inside"]["body"], &line["normals"]), (&"Sheet".into(), &"estimated".into()));
    let widest = line["holes"]["widest"].as_f64().unwrap();
    assert!((widest - 1.9).abs() < 0.1, "{widest}");
}

#[test]
fn what_is_no_cloud_is_refused_with_its_exit_code() {
    let folder = Folder::new();
    folder.write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    assert_eq!(folder.run(&["cloud", "info", "bad.ply"]).code, 65);
    assert_eq!(folder.run(&["cloud", "info", "none.ply"]).code, 66);
    assert_eq!(folder.run(&["cloud", "info"]).code, 2);
}

#[test]
fn convert_keeps_every_bit_and_never_writes_over_its_input() {
    let folder = Folder::new();
    folder.write("a.ply", ply_with_normals(&sphere(500, 1.0)));
    let first = read(&folder.read("a.ply")).unwrap();
    for flags in [&["--ascii"][..], &[]] {
        let ran = folder.run(&[&["cloud", "convert", "a.ply", "b.ply"], flags].concat());
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let second = read(&folder.read("b.ply")).unwrap();
        assert_eq!(first.points, second.points);
        let apart = |(a, b): (&DVec3, &DVec3)| (*a - *b).length();
        let normals = |c: &pss::cloud::Cloud| c.normals.clone().unwrap();
        assert!(normals(&first).iter().zip(&normals(&second)).map(apart).all(|d| d < 1e-6));
    }
    assert_eq!(folder.run(&["cloud", "convert", "a.ply", "a.ply"]).code, 73);
    assert_eq!(folder.run(&["cloud", "convert", "a.ply", "b.obj"]).code, 2);
    assert_eq!(folder.run(&["cloud", "convert", "none.ply", "c.ply"]).code, 66);
    assert_eq!(folder.files(), ["a.ply", "b.ply"]);
}

#[test]
fn convert_adds_normals_and_drops_strays() {
    let folder = Folder::new();
    let mut points = sphere(2000, 1.0);
    points.push(DVec3::splat(5.0));
    folder.write("a.ply", ply(&points));
    assert_eq!(folder.run(&["cloud", "convert", "--normals", "--clean", "a.ply", "b.ply"]).code, 0);
    let cloud = read(&folder.read("b.ply")).unwrap();
    assert_eq!(cloud.points.len(), 2000);
    let normals = cloud.normals.unwrap();
    assert!(cloud.points.iter().zip(&normals).all(|(p, n)| 0.99 < n.dot(*p)));
}

/// What `cloud info` prints of a cloud.
fn info(cloud: impl AsRef<[u8]>) -> String {
    let folder = Folder::new();
    folder.write("a.ply", cloud);
    let ran = folder.run(&["cloud", "info", "a.ply"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    String::from_utf8(ran.stdout).unwrap()
}

#[test]
fn normals_that_are_all_zero_are_said_to_be_estimated() {
    let columns = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    let rows = sphere(1000, 1.0).into_iter().map(|p| format!("{} {} {} 0 0 0", p.x, p.y, p.z));
    let text = info(ply_of(1000, &columns, rows));
    assert!(text.contains("normals        estimated"), "{text}");
}

#[test]
fn rows_that_are_no_points_are_rows_of_the_file_too() {
    let mut points = sphere(1000, 1.0);
    points[7] = DVec3::NAN;
    points[70] = DVec3::INFINITY;
    let text = info(ply(&points));
    assert!(text.contains("1000 in the file, 998 samples"), "{text}");
}

#[test]
fn lengths_of_a_tiny_cloud_have_digits() {
    let tiny: Vec<DVec3> = sphere(1000, 1.0).iter().map(|p| 1e-30 * *p).collect();
    let text = info(ply(&tiny));
    let extent = text.lines().find(|l| l.contains("extent")).unwrap();
    assert!(extent.contains("diagonal 3.46") && extent.contains("e-30"), "{extent}");
}

/// Strays once tied themselves to the surface in their midst and gave it weights as wide as the ball.
#[test]
fn a_dirty_cloud_of_ten_thousand_points_is_surveyed_in_ten_seconds() {
    let mut clouds: Vec<(Vec<DVec3>, bool)> = Vec::new();
    for (seed, count) in [(0, 10), (1, 100), (2, 500), (3, 100)] {
        let mut stream = Stream::new(seed);
        let strays = (0..count).map(|_| stream.direction() * (0.5 + stream.unit()));
        let points: Vec<DVec3> = sphere(10_000, 1.0).into_iter().chain(strays).collect();
        clouds.push((points, true));
    }
    // A thin sheet through the ball.
    let row = |i: i32| f64::from(i) * 0.3 - 1.35;
    let sheet = (0..100).map(|k| DVec3::new(row(k % 10), row(k / 10), 0.1));
    clouds.push((sphere(10_000, 1.0).into_iter().chain(sheet).collect(), false));
    for (points, solid) in clouds {
        // Once this did not end.
        let text = info(ply(&points));
        assert!(!solid || text.contains("a Solid: 0 of 10000"), "{text}");
    }
}
