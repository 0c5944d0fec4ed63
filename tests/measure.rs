//! What a scene asks of its shapes: closed forms within the bars, and expectations that hold or are told.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use pss::diag::Diagnostic;
use pss::lang::{Read, Reading};
use pss::measure::Measuring;
use pss::prepare::{self, Imports, Options};
use pss::source::SourceMap;

/// Reads a scene that is in a folder, its expectations evaluated.
fn read_in(folder: &Path, text: &str) -> Result<Read, String> {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", Some(folder.join("scene.pss")), text);
    let options = Options { scene_dir: folder.to_owned(), ..Options::default() };
    let (catalog, measuring) = (prepare::catalog(), Measuring::new(&options));
    let imports = Imports {
        scene_dir: folder,
        allow_read: &[] as &[PathBuf],
        limit: 1 << 20,
        inputs: Default::default(),
    };
    let reading = Reading {
        catalog: &catalog,
        defines: &[],
        files: Some(&imports),
        geometry: Some(&measuring),
        expects: true,
        memory: pss::lang::MEMORY,
    };
    let told = |all: &[Diagnostic], sources: &SourceMap| pss::report::text(all, sources, false);
    match pss::lang::read_with(&mut sources, file, &reading) {
        Ok(read) if read.unmet.is_empty() => Ok(read),
        Ok(read) => Err(told(&read.unmet, &sources)),
        Err(errors) => Err(told(&errors, &sources)),
    }
}

fn read(text: &str) -> Result<Read, String> {
    read_in(Path::new("/nowhere"), text)
}

/// What a scene prints.
fn prints(text: &str) -> Vec<String> {
    read(text).unwrap().scene.prints
}

fn number(expr: &str) -> f64 {
    prints(&format!("print {expr}"))[0].parse().unwrap()
}

#[test]
fn volumes_and_areas_are_those_of_closed_forms() {
    for (shape, volume, area) in [
        ("box([1, 2, 3], [2, 4, 7])", 8.0, 28.0),
        ("sphere(r: 2, at: [100, 0, 0])", 32.0 * PI / 3.0, 16.0 * PI),
        ("torus(major: 3, minor: 1).rotate_x(37deg)", 6.0 * PI * PI, 12.0 * PI * PI),
        ("cylinder(r: 1, h: 5)", 5.0 * PI, 12.0 * PI),
        (
            "cylinder(r: 1, from: [-2, 0, 0], to: [2, 0, 0]) & cylinder(r: 1, from: [0, -2, 0], to: [0, 2, 0])",
            16.0 / 3.0,
            16.0,
        ),
        ("sphere(r: 1) - sphere(r: 1)", 0.0, 0.0),
        ("box(size: 2) - half_space(z < 0)", 4.0, 16.0),
    ] {
        let (v, a) = (number(&format!("volume({shape})")), number(&format!("area({shape})")));
        assert!((v - volume).abs() <= 2e-4 * volume, "{shape}: {v} {volume}");
        assert!((a - area).abs() <= 5e-3 * area, "{shape}: {a} {area}");
    }
    let disc = number("area(plane(z: 0).clip(sphere(r: 1)))");
    assert!((disc - PI).abs() < 0.02, "{disc}");
}

/// What a scene says that does not hold, or cannot be told.
fn told(text: &str) -> String {
    read(text).unwrap_err()
}

#[test]
fn verdicts_are_refined_until_they_are_decided() {
    for text in [
        "expect volume(sphere(r: 1)) < 4.1888",
        "expect volume(sphere(r: 1)) ~= 4.18879 within 0.001%",
        "expect volume(sphere(r: 1)) is 4 * pi / 3",
        "expect volume(sphere(r: 1)) == 4 * pi / 3",
        "expect volume(sphere(r: 1)) <= 4 * pi / 3",
        "expect volume(sphere(r: 1)) ~= 4 * pi / 3",
        "expect not (volume(sphere(r: 1)) > 4.1888)",
        "let v = volume(sphere(r: 1))\nexpect [v, 0, 0] is [4 * pi / 3, 0, 0]\nexpect 2 * [v, 0] / 3 + [1, 1] is [8 * pi / 9 + 1, 1]",
        "let v = volume(sphere(r: 1))\nexpect sqrt(v) is sqrt(4 * pi / 3)\nexpect v ** 2 is (4 * pi / 3) ** 2\nexpect -v is -4 * pi / 3",
        "let v = volume(sphere(r: 1))\nexpect v - v is 0\nexpect v / v is 1\nexpect max(v, 4.1887) > 4.1887\nexpect sum([v, v]) is 8 * pi / 3",
        "expect volume(box(size: 2)) is 8\nexpect volume(box(size: 2)) <= 8\nexpect not (volume(box(size: 2)) < 8)",
        "expect volume(box(size: [200, 100, 3]) - cylinder(r: 0.5, h: 9).move([0, 0, -5])) < 59999",
        "expect volume(tube([[0, 0, 0], [10, 10, 10]], r: 0.01)) ~= 0.0054456 within 1%",
        "expect centroid(sphere(r: 1, at: [1, 2, 3])) ~= [1, 2, 3] within 0.001%\nexpect centroid(sphere(r: 1)) ~= [0, 0, 0] within 1e-5",
        "expect area(torus(major: 3, minor: 1)) ~= 4 * pi ** 2 * 3",
        "expect volume(capsule(r: 1.893, from: [0, 0, 0], to: [4.354, 0, 0])) ~= pi * 1.893**2 * 4.354 + 4/3 * pi * 1.893**3",
        "expect area(cone(r1: 2, r2: 1, h: 3).rotate_x(0.3rad).scale(2)) ~= 4 * pi * (5 + 3 * sqrt(10))",
        "expect volume(sphere(r: [1, 2, 3]).scale([1, 1, 0.5]).rotate_x(50deg)) is 4 * pi",
        "expect area(torus(major: 3, minor: 1) & box(size: 9)) ~= 4 * pi ** 2 * 3 within 0.005%",
        "expect volume(sphere(r: 1) | sphere(r: 1, at: [1, 0, 0])) ~= 9 * pi / 4 within 0.001%",
        "expect bounds(sphere(r: 1) - box([0, -5, -5], [5, 5, 5])).max.x ~= 0 within 1e-8",
        "expect bounds(implicit(x**2 + y**2 + z**2 <= 1, inside: box(size: 3))).size ~= [2, 2, 2] within 1e-5%",
        "expect bounds(implicit(x**2 + y**2 + z**2 <= 1, inside: box(size: 100))).max.x ~= 1 within 1e-5%",
        "expect volume(sphere(r: 1)) == 4 * pi / 3 or volume(sphere(r: 1)) > 4.18879020478639",
    ] {
        assert!(read(text).is_ok(), "{text}\n{}", told(text));
    }
    for (text, said) in [
        ("expect volume(sphere(r: 1)) > 4.1888", "is not met"),
        ("expect volume(sphere(r: 1)) is 4.189", "is not met"),
        ("expect volume(box(size: 2)) < 8", "is not met"),
        ("expect volume(sphere(r: 1)) is 4.18881", "is not met"),
        ("expect volume(sphere(r: 1)) is 4.1888", "is not met"),
        ("expect volume(sphere(r: 1)) ~= 4.1888", "is not met"),
        ("expect volume(sphere(r: 1)) == 4.18880", "is not met"),
        // Closer than any number of lines tells.
        (
            "expect volume(sphere(r: 1) & box(size: 9)) < 4.18879020478639",
            "cannot be decided: the left side is 4.1887",
        ),
        ("expect volume(sphere(r: 1) & box(size: 9)) ~= 4.18879020478639 within 1e-12", "cannot be decided"),
        ("expect volume(sphere(r: 1) & box(size: 9)) is 4 * pi / 3", "cannot be decided"),
        ("expect volume(sphere(r: 1) & box(size: 9)) ~= 4 * pi / 3", "`~= ... within 0.00"),
        ("expect volume(sphere(r: 1e-6)) is 0", "the left side is 4.18879020478639e-18 ("),
    ] {
        assert!(told(text).contains(said), "{text}\n{}", told(text));
    }
}

#[test]
fn comparisons_that_stay_open_are_warned_of_where_nothing_is_expected() {
    let lens = "let v = volume(sphere(r: 1) & sphere(r: 1, at: [1, 0, 0]))\n";
    // What both hold are two caps, 5 pi / 12.
    for (text, count) in [
        ("print v == 5 * pi / 12", 1),
        ("print v < 5 * pi / 12 + 1e-9", 1),
        ("print v < 5 * pi / 12 + 0.001", 0),
        ("print volume(sphere(r: 1)) == 4 / 3 * pi", 0),
    ] {
        let read = read(&format!("{lens}{text}")).unwrap();
        assert_eq!(read.warnings.iter().filter(|w| w.code == "W0128").count(), count, "{text}");
    }
}

#[test]
fn middles_bounds_insides_and_rays_are_those_of_closed_forms() {
    let half = prints("let c = centroid(sphere(r: 2) & half_space(z > 0))\nprint c.x\nprint c.y\nprint c.z");
    for (x, want) in half.iter().zip([0.0, 0.0, 0.75]) {
        assert!((x.parse::<f64>().unwrap() - want).abs() < 1e-3, "{half:?}");
    }
    assert_eq!(
        prints(
            "let b = bounds(box([1, 2, 3], [2, 4, 7]))\nprint b.min\nprint b.size\nprint b.center\nprint b.max.z"
        ),
        ["[1, 2, 3]", "[1, 2, 4]", "[1.5, 3, 5]", "7"]
    );
    let shell = "let s = sphere(r: 2) - sphere(r: 1)\n";
    assert_eq!(
        prints(&format!("{shell}print [inside(s, [0, 0, 1.5]), inside(s, [0, 0, 0]), inside(s, [3, 0, 0])]")),
        ["[true, false, false]"]
    );
    assert_eq!(
        prints(&format!(
            "{shell}let hits = raycast(s, from: [-4, 0, 0], dir: [2, 0, 0])\nprint for h in hits {{ h.t }}\nprint hits[1].normal\nprint hits[1].entering"
        )),
        ["[1, 1.5, 2.5, 3]", "[1, 0, 0]", "false"]
    );
}

#[test]
fn a_scene_is_built_by_what_it_measures() {
    let made = read("let a = box(size: [2, 3, 4])\ndraw a | sphere(r: 1).move([0, 0, bounds(a).max.z + 1])\nexpect bounds(a | sphere(r: 1)).max ~= [1, 1.5, 2]").unwrap();
    assert_eq!(made.scene.draws.len(), 1);
}

#[test]
fn expectations_that_hold_are_silent_and_others_are_told() {
    for text in [
        "expect 1 < 2",
        "expect not empty(sphere(r: 1))",
        "expect empty(sphere(r: 1) & sphere(r: 1, at: [2.5, 0, 0]))",
        "expect solid(sphere(r: 1))",
        "expect solid(plane(z: 0)) is false",
        "expect volume(sphere(r: 1)) ~= 4.18879 within 0.01%",
        "expect volume(box(size: 2)) is 8 within 1e-9",
        "expect [1, 2] ~= [1, 2.05] within 0.1",
        "expect 90deg is 0.25turn",
        "expect inside(sphere(r: 1), [0, 0, 0])",
        "let a = box(size: 2)\nlet b = sphere(r: 1.2)\nexpect a - b is a & !b\nexpect (a | b) == (b | a)\nexpect a != b",
        "let s = sphere(r: 1)\nexpect s ^ s is union([])",
    ] {
        assert!(read(text).is_ok(), "{text}\n{}", read(text).unwrap_err());
    }
    for (text, told) in [
        ("expect 1 > 2", "the left side is 1, the right 2"),
        ("expect volume(box(size: 2)) ~= 9 within 1%", "11.111 %, where 1.000 % are allowed"),
        ("expect empty(box(size: 2))", "does not hold"),
        ("expect sphere(r: 1) is sphere(r: 1.001)", "an expectation is not met"),
        ("expect 3", "`expect` wants a condition, found a number"),
        ("expect 1 ~= \"a\"", "cannot be compared"),
        ("print volume(half_space(z < 0))", "no finite volume"),
        ("print volume(plane(z: 0))", "has no inside"),
        ("print bounds(union([]))", "has no bounds"),
    ] {
        let said = read(text).unwrap_err();
        assert!(said.contains(told), "{text}\n{said}");
    }
}

#[test]
fn files_are_imported_once_into_scopes_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    std::fs::create_dir(folder.path().join("lib")).unwrap();
    write(
        "lib/parts.pss",
        "import \"sizes.pss\"\nfn peg(h) = cylinder(r: width / 2, h: h)\nlet inner = 3\ndraw sphere(r: 99)\ncamera(eye: [1, 1, 1])\n",
    );
    write("lib/sizes.pss", "let width = 4\nprint \"once\"\n");
    let here = folder.path();
    let read = read_in(here, "import \"lib/parts.pss\" as parts\nimport \"lib/sizes.pss\"\nlet inner = 7\nprint [parts.inner, inner, width]\ndraw parts.peg(h: 5)\nexpect bounds(parts.peg(5)).size ~= [4, 4, 5]\n").unwrap();
    assert_eq!(read.scene.prints, ["once", "[3, 7, 4]"]);
    assert_eq!((read.scene.draws.len(), read.scene.cameras.len()), (1, 0));
    write("a.pss", "import \"b.pss\"\nlet x = 1\n");
    write("b.pss", "import \"a.pss\"\nlet y = 2\n");
    for (text, told) in [
        ("import \"a.pss\"\n", "E0609"),
        ("import \"gone.pss\"\n", "E0601"),
        ("import \"../up.pss\"\n", "E0603"),
        ("import \"lib/sizes.pss\"\nlet width = 3\n", "E0402"),
        ("import \"lib/parts.pss\" as p\nprint p.pegg\n", "did you mean `.peg`?"),
        ("import \"lib/parts.pss\" as p\nunits(cm)\nimport \"units.pss\"\n", "E0513"),
    ] {
        write("units.pss", "units(mm)\n");
        let said = read_in(here, text).unwrap_err();
        assert!(said.contains(told), "{text}\n{said}");
    }
}
