//! Clouds that are wrong or unfit for what the scene asks: the code, the place in the scene, and nothing written.

mod cli_common;

use cli_common::{Folder, ply, ply_of, sphere};
use glam::DVec3;

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

/// Renders `draw points("a.ply")` of a cloud that must be refused and gives what was said.
fn refused(what: &str, cloud: &[u8]) -> String {
    let folder = Folder::new();
    folder.write("a.pss", "// a cloud\ndraw points(\"a.ply\")\n").write("a.ply", cloud);
    let ran = folder.run(&["render", "a.pss", "-o", "a.png", "--size", "8x8", "--spp", "1"]);
    assert_eq!(ran.code, 65, "{what}\n{}", ran.stderr);
    assert!(ran.stderr.starts_with("error[E0605]"), "{what}\n{}", ran.stderr);
    assert!(ran.stderr.contains("a.pss:2:13"), "{what}\n{}", ran.stderr);
    assert_eq!(folder.files(), ["a.ply", "a.pss"], "nothing is written: {what}");
    ran.stderr
}

fn rows(points: &[DVec3]) -> impl Iterator<Item = String> {
    points.iter().map(|p| format!("{} {} {}", p.x, p.y, p.z))
}

#[test]
fn a_file_that_is_no_whole_cloud_is_refused() {
    let points = sphere(100, 1.0);
    let whole = ply(&points);
    let header = whole.find("end_header\n").unwrap() + "end_header\n".len();
    let binary = |count: &str, bytes: &[u8]| {
        let head = ply_of(count, XYZ, std::iter::empty()).replace("ascii", "binary_little_endian");
        [head.as_bytes(), bytes].concat()
    };
    let missing_z = ply_of(1, "property float x\nproperty float y\n", ["1 2".to_owned()].into_iter());
    let cases: [(&str, Vec<u8>, &str); 11] = [
        ("nothing", vec![], "no points"),
        ("one byte", vec![b'p'], "not a PLY"),
        ("a header alone", whole.as_bytes()[..header].to_vec(), ""),
        ("truncated text", whole.as_bytes()[..whole.len() / 2].to_vec(), ""),
        ("truncated bytes", binary("100", &[0; 1000]), ""),
        ("no points", ply_of(0, XYZ, std::iter::empty()).into_bytes(), "no points"),
        ("a count beyond the file", binary("1099511627776", &[0; 12]), ""),
        ("a negative count", binary("-3", &[0; 36]), "line 3"),
        ("no z", missing_z.into_bytes(), "z"),
        ("another format", b"solid a\nfacet normal 0 0 1\n".to_vec(), "STL"),
        ("a word for a number", whole.replacen("0.99", "zero", 1).into_bytes(), "line 8"),
    ];
    for (what, cloud, word) in cases {
        let said = refused(what, &cloud);
        assert!(said.contains(word), "{what}: wants `{word}`\n{said}");
    }
}

#[test]
fn points_without_a_surface_are_refused() {
    let same = vec![DVec3::new(1.0, 2.0, 3.0); 200];
    let line: Vec<DVec3> = (0..200).map(|i| DVec3::new(f64::from(i), 0.0, 1.0)).collect();
    let nan = ply_of(50, XYZ, (0..50).map(|_| "nan nan nan".to_owned()));
    let vast: Vec<DVec3> = sphere(200, 1.0).iter().map(|p| 1e30 * *p).collect();
    for (what, cloud) in [
        ("all points equal", ply(&same)),
        ("all on a line", ply(&line)),
        ("no number at all", nan),
        ("two points", ply(&line[..2])),
        ("beyond all bounds", ply(&vast)),
    ] {
        refused(what, cloud.as_bytes());
    }
}

#[test]
fn a_few_points_that_are_none_are_dropped() {
    let mut points = sphere(1000, 1.0);
    points.extend([DVec3::NAN, DVec3::INFINITY]);
    let folder = Folder::new();
    folder.write("a.pss", "draw points(\"a.ply\") & half_space(z < 0)");
    folder.write("a.ply", ply_of(points.len(), XYZ, rows(&points)));
    let ran = folder.run(&["render", "a.pss", "--size", "8x8", "--spp", "1"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
}

#[test]
fn a_missing_cloud_exits_with_66() {
    let folder = Folder::new();
    folder.write("a.pss", "draw points(\"nowhere.ply\")");
    let ran = folder.run(&["render", "a.pss"]);
    assert_eq!(ran.code, 66, "{}", ran.stderr);
    assert!(ran.stderr.starts_with("error[E0601]") && ran.stderr.contains("a.pss:1:13"), "{}", ran.stderr);
    assert_eq!(folder.files(), ["a.pss"]);
    // What nothing draws is not opened.
    folder.write("a.pss", "let a = points(\"nowhere.ply\")\ndraw sphere(r: 1)");
    assert_eq!(folder.run(&["render", "a.pss", "--size", "8x8"]).code, 0);
}

#[test]
fn an_open_scan_is_no_operand_until_it_is_closed() {
    let folder = Folder::new();
    folder.write("a.ply", ply(&sphere(2000, 0.7)));
    let render = |text: &str| {
        folder.write("a.pss", text);
        folder.run(&["render", "a.pss", "-o", "a.png", "--size", "16x16", "--spp", "1"])
    };
    let ran = render("let scan = points(\"a.ply\")\ndraw box([0, 0, 0], [2, 2, 2]) - scan\n");
    assert_eq!(ran.code, 65, "{}", ran.stderr);
    assert!(ran.stderr.starts_with("error[E0301]") && ran.stderr.contains("a.pss:2:34"), "{}", ran.stderr);
    let share = ran.stderr.split("a Sheet: ").nth(1).and_then(|s| s.split(" %").next());
    let share: f64 = share.unwrap().parse().unwrap();
    // A chord of the ball meets what is left of the cap once with 2 x 0.15 x 0.85; a third of all chords meet the ball.
    assert!((3.0..9.0).contains(&share), "{share} % of chords are odd");
    assert!(ran.stderr.contains("help: close it, `scan.close(max_hole:"), "{}", ran.stderr);
    let ran = render("draw points(\"a.ply\").close(max_hole: 0.5) & half_space(x < 0)");
    assert_eq!(ran.code, 65, "{}", ran.stderr);
    assert!(ran.stderr.starts_with("error[E0303]") && ran.stderr.contains("a.pss:1:6"), "{}", ran.stderr);
    let width = ran.stderr.split("a hole ").nth(1).and_then(|s| s.split(" wide").next());
    let width: f64 = width.unwrap().parse().unwrap();
    // The rim lies at z = 0.7.
    assert!((1.3..1.6).contains(&width), "the hole is {width} wide");
    assert_eq!(folder.files(), ["a.ply", "a.pss"]);
    let ran = render("draw points(\"a.ply\").close(max_hole: 1.6) & half_space(x < 0)");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    // Drawn as it is, an open scan is a sheet and needs no closing.
    assert_eq!(render("draw points(\"a.ply\")").code, 0);
}
