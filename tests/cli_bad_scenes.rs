//! Scenes that are wrong: the code, the place, the exit code, and nothing written.

mod cli_common;

use cli_common::Folder;

/// Runs a scene that must fail and gives what was said.
fn refused(text: &str, exit: i32) -> String {
    let folder = Folder::new();
    folder.write("a.pss", text);
    let ran = folder.run(&["render", "a.pss", "-o", "a.png", "--size", "8x8", "--spp", "1"]);
    assert_eq!(ran.code, exit, "{text}\n{}", ran.stderr);
    assert!(ran.stdout.is_empty(), "{text}");
    assert_eq!(folder.files(), ["a.pss"], "nothing is written: {text}");
    ran.stderr
}

#[test]
fn a_wrong_scene_is_told_with_its_code_and_its_place() {
    // The text, the code, line and column of the place.
    let cases = [
        ("draw sphere(r: 1", "E01", "1:12"),
        ("draw sphere(r: 1))", "E01", "1:18"),
        ("let a = \"open\ndraw sphere(r: 1)", "E01", "1:9"),
        ("draw spere(r: 1)", "E04", "1:6"),
        ("draw sphere(radius: 1)", "E04", "1:13"),
        ("draw sphere(r: \"a\")", "E05", "1:16"),
        ("draw sphere(r: -1)", "E05", "1:16"),
        ("let a = 1\nlet a = 2\ndraw sphere(r: a)", "E04", "2:5"),
        ("draw sphere(r: 1) + sphere(r: 2)", "E02", "1:19"),
        ("let a = sphere(r: 1)\ndraw a - a | a", "E02", "2:12"),
        ("draw sphere(r: 1) - plane(z: 0)", "E0301", "1:21"),
        ("draw sphere(r: 1)\ncamera(eye: [0, 0, 0], look_at: [0, 0, 0], fov: 30deg)", "E0407", "2:"),
        ("render(size: [0, 8])\ndraw sphere(r: 1)", "E0407", "1:14"),
        ("draw sphere(r: 1).rotate_x(90)", "E05", "1:28"),
        ("draw points(sphere(r: 1))", "E0404", "1:6"),
        ("draw points(half_space(z < 0), samples: 100)", "E0306", "1:13"),
        ("draw box([0, 0, 0], [1, 1, 1]).close(max_hole: 1)", "E0304", "1:"),
    ];
    for (text, code, place) in cases {
        let said = refused(text, 65);
        assert!(said.starts_with(&format!("error[{code}")), "{text}: wants {code}\n{said}");
        assert!(said.contains(&format!("a.pss:{place}")), "{text}: wants {place}\n{said}");
    }
}

#[test]
fn an_error_as_json_is_one_line_with_every_field() {
    let folder = Folder::new();
    folder.write("a.pss", "draw sphere(r: 1)\n  - plane(z: 0)\n");
    let ran = folder.run(&["render", "a.pss", "--format", "json"]);
    assert_eq!(ran.code, 65);
    let lines: Vec<serde_json::Value> =
        ran.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 1, "{}", ran.stderr);
    let error = &lines[0];
    let fields =
        ["severity", "code", "message", "file", "line", "column", "end_line", "end_column", "help", "notes"];
    for field in fields {
        assert!(error.get(field).is_some(), "no {field}: {error}");
    }
    assert_eq!(
        (&error["severity"], &error["code"], &error["file"]),
        (&"error".into(), &"E0301".into(), &"a.pss".into())
    );
    assert_eq!((&error["line"], &error["column"]), (&2.into(), &5.into()));
    assert_eq!((&error["end_line"], &error["end_column"]), (&2.into(), &16.into()));
}

#[test]
fn wrong_choices_on_the_command_line_exit_with_2() {
    let folder = Folder::new();
    let scene = "param bore: length = 4 in 1..8\nparam n: int = 2\n\
                 camera front(eye: [0, -9, 0], look_at: [0, 0, 0])\ndraw sphere(r: bore * n)\n";
    folder.write("a.pss", scene);
    let cases: [&[&str]; 6] = [
        &["--camera", "back"],
        &["-D", "bora=4"],
        &["-D", "bore=wide"],
        &["-D", "bore=9"],
        &["-D", "n=1.5"],
        &["--crop", "0,0,9,8"],
    ];
    for more in cases {
        let ran = folder.run(&[&["render", "a.pss", "-o", "a.png", "--size", "8x8"], more].concat());
        assert_eq!(ran.code, 2, "{more:?}\n{}", ran.stderr);
        assert!(ran.stderr.starts_with("error["), "{more:?}\n{}", ran.stderr);
    }
    assert_eq!(folder.files(), ["a.pss"]);
    let right =
        ["render", "a.pss", "-o", "a.png", "--size", "8x8", "--camera", "front", "-D", "bore=8", "-D", "n=1"];
    assert_eq!(folder.run(&right).code, 0);
}

#[test]
fn a_scene_reads_nothing_outside_its_folder() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    folder.write("cloud.ply", cli_common::ply(&cli_common::sphere(200, 1.0)));
    for path in ["../cloud.ply", "../nowhere.ply", "/etc/passwd"] {
        folder.write("sub/a.pss", format!("draw points(\"{path}\")"));
        let ran = folder.run(&["render", "sub/a.pss", "-o", "a.png", "--size", "8x8"]);
        assert_eq!(ran.code, 77, "{path}\n{}", ran.stderr);
        assert!(ran.stderr.contains("sub/a.pss:1:13"), "{}", ran.stderr);
    }
    folder.write("sub/a.pss", "draw points(\"../cloud.ply\")");
    let ran = folder.run(&["render", "sub/a.pss", "-o", "a.png", "--size", "8x8", "--allow-read", "."]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
}

/// The stack that reads the deepest scene is 256 MiB, of which only what is used is touched.
#[cfg(target_os = "linux")]
#[test]
fn where_there_is_no_memory_to_read_a_scene_that_is_said() {
    let folder = Folder::new();
    folder.write("a.pss", "draw sphere(r: 1)");
    let args = ["render", "a.pss", "-o", "a.png", "--size", "8x8", "--threads", "1"];
    let ran = folder.run_within(256 << 20, &args);
    assert_eq!(ran.code, 71, "{}", ran.stderr);
    assert!(ran.stderr.starts_with("error[E0704]") && ran.stderr.contains("256 MiB"), "{}", ran.stderr);
    assert_eq!(folder.files(), ["a.pss"]);
    assert_eq!(folder.run_within(1 << 30, &args).code, 0);
}
