//! The program's exit codes and streams, where nothing has to be traced for them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn pss(dir: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pss")).args(args).current_dir(dir).output().unwrap()
}

fn code(dir: &Path, args: &[&str]) -> i32 {
    let output = pss(dir, args);
    let code = output.status.code().unwrap();
    let said = !output.stderr.is_empty();
    assert!(code == 0 || said, "{args:?} fails without a word");
    assert!(code == 0 || output.stdout.is_empty(), "{args:?} fails and still fills standard output");
    code
}

fn folder_with_scene() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.pss"), "draw sphere(r: 1)\n").unwrap();
    dir
}

#[test]
fn wrong_arguments_exit_with_2() {
    let dir = folder_with_scene();
    let cases: &[&[&str]] = &[
        &[],
        &["paint", "a.pss"],
        &["render"],
        &["render", "a.pss", "--sise", "8x8"],
        &["render", "a.pss", "--size", "8"],
        &["render", "a.pss", "--size", "0x8"],
        &["render", "a.pss", "--size", "8x99999999999"],
        &["render", "a.pss", "--spp", "0"],
        &["render", "a.pss", "--crop", "1,2,3"],
        &["render", "a.pss", "--crop", "4,4,4,8"],
        &["render", "a.pss", "-o", "a.jpg"],
        &["render", "a.pss", "-o", "a"],
        &["render", "a.pss", "-D", "bore"],
        &["render", "a.pss", "-t", "many"],
        &["render", "a.pss", "-o", "a.png", "--stats-json", "a.png"],
        &["probe", "a.pss"],
        &["probe", "a.pss", "--pixel", "1"],
        &["probe", "a.pss", "--ray", "0,0,0 0,0,0"],
        &["probe", "a.pss", "--ray", "0,0,0 1,0"],
        &["probe", "a.pss", "--ray", "0,0,0 inf,0,0"],
        &["probe", "a.pss", "--pixel", "1,1", "--ray", "0,0,0 1,0,0"],
    ];
    for args in cases {
        assert_eq!(code(dir.path(), args), 2, "{args:?}");
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "nothing is written");
}

#[test]
fn missing_inputs_exit_with_66() {
    let dir = folder_with_scene();
    fs::create_dir(dir.path().join("folder.pss")).unwrap();
    let cases: &[&[&str]] = &[
        &["render", "b.pss"],
        &["render", "folder.pss"],
        &["render", "nowhere/b.pss", "-o", "b.png"],
        &["probe", "b.pss", "--pixel", "1,1"],
        &["probe", "a.pss", "--rays", "rays.csv"],
    ];
    for args in cases {
        assert_eq!(code(dir.path(), args), 66, "{args:?}");
    }
}

#[test]
fn outputs_that_cannot_be_made_exit_with_73_and_harm_nothing() {
    let dir = folder_with_scene();
    let scene = "draw sphere(r: 1)\n";
    fs::write(dir.path().join("scene.png"), scene).unwrap();
    fs::create_dir(dir.path().join("folder.png")).unwrap();
    let cases: &[&[&str]] = &[
        &["render", "scene.png"],
        &["render", "scene.png", "-o", "./scene.png"],
        &["render", "a.pss", "--stats-json", "a.pss"],
        &["render", "a.pss", "-o", "folder.png"],
        &["render", "a.pss", "-o", "nowhere/a.png"],
        &["render", "a.pss", "-o", "a.pss/b.exr"],
    ];
    for args in cases {
        assert_eq!(code(dir.path(), args), 73, "{args:?}");
    }
    assert_eq!(fs::read_to_string(dir.path().join("scene.png")).unwrap(), scene);
    assert_eq!(fs::read_to_string(dir.path().join("a.pss")).unwrap(), scene);
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3, "nothing is written");
}

#[test]
fn a_pixel_outside_the_picture_exits_with_2() {
    let dir = folder_with_scene();
    assert_eq!(code(dir.path(), &["probe", "a.pss", "--pixel", "8,0", "--size", "8x8"]), 2);
}

#[test]
fn texts_that_are_none_exit_with_65() {
    let dir = folder_with_scene();
    fs::write(dir.path().join("latin.pss"), b"// caf\xe9\n").unwrap();
    assert_eq!(code(dir.path(), &["render", "latin.pss"]), 65);
    fs::write(dir.path().join("rays.csv"), "0,0,-5, 0,0,1\n\n0,0,-5, 0,x,1\n").unwrap();
    let rays = pss(dir.path(), &["probe", "a.pss", "--rays", "rays.csv"]);
    assert_eq!(rays.status.code(), Some(65));
}

#[test]
fn help_and_version_go_to_standard_output() {
    let dir = folder_with_scene();
    for args in [&["--help"][..], &["render", "--help"], &["probe", "--help"], &["--version"]] {
        let output = pss(dir.path(), args);
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert!(!output.stdout.is_empty() && output.stderr.is_empty(), "{args:?}");
    }
}

#[test]
fn usage_errors_are_json_where_json_is_asked_for() {
    let dir = folder_with_scene();
    let output = pss(dir.path(), &["render", "a.pss", "--format", "json", "--size", "8"]);
    assert_eq!(output.status.code(), Some(2));
    let stderr = String::from_utf8(output.stderr).unwrap();
    let lines: Vec<&str> = stderr.lines().collect();
    assert_eq!(lines.len(), 1, "{stderr}");
    assert!(serde_json::from_str::<serde_json::Value>(lines[0]).is_ok(), "{stderr}");
}
