//! `pss check` as it is called.

mod cli_common;

use cli_common::Folder;

#[test]
fn a_good_scene_is_fine_and_a_doubtful_one_too() {
    let folder = Folder::new();
    folder
        .write("good.pss", "draw sphere(r: 1)\n")
        .write("doubtful.pss", "draw box(size: 1) - sphere(r: 2)\n");
    let ran = folder.run(&["check", "good.pss", "doubtful.pss"]);
    assert_eq!((ran.code, ran.stdout.len()), (0, 0));
    assert!(ran.stderr.contains("good.pss: nothing to complain of\n"), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("warning[W0124]") && ran.stderr.contains("doubtful.pss: 1 warning\n"),
        "{}",
        ran.stderr
    );
    assert_eq!(folder.files(), ["doubtful.pss", "good.pss"]);
}

#[test]
fn every_scene_is_checked_and_the_first_failure_gives_the_code() {
    let folder = Folder::new();
    folder.write("a.pss", "draw points(\"missing.ply\")\n").write("b.pss", "draw ball(r: 1)\n");
    folder.write("c.pss", "draw sphere(r: 1)\n");
    let ran = folder.run(&["check", "a.pss", "b.pss", "c.pss"]);
    assert_eq!(ran.code, 66);
    for told in ["E0601", "E0401", "c.pss: nothing to complain of"] {
        assert!(ran.stderr.contains(told), "{told}\n{}", ran.stderr);
    }
    assert_eq!(folder.run(&["check", "b.pss", "a.pss"]).code, 65);
    assert_eq!(folder.run(&["check", "nowhere.pss"]).code, 66);
    assert_eq!(folder.run(&["check"]).code, 2);
}

#[test]
fn messages_can_be_json_and_parameters_are_set() {
    let folder = Folder::new();
    folder.write("a.pss", "param r: length = 1\ndraw box(size: 1) - sphere(r: r)\n");
    let ran = folder.run(&["check", "a.pss", "--format", "json", "-D", "r=2", "-t", "1"]);
    let lines: Vec<serde_json::Value> =
        ran.stderr.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let codes: Vec<&str> = lines.iter().map(|l| l["code"].as_str().unwrap()).collect();
    assert_eq!((ran.code, codes), (0, vec!["W0124"]));
    let ran = folder.run(&["check", "a.pss", "--format", "json", "-D", "r=0.6"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(folder.run(&["check", "a.pss", "-D", "q=1"]).code, 2);
}

#[test]
fn open_scans_are_refused_where_an_inside_is_wanted() {
    let folder = Folder::new();
    folder.write("open.ply", cli_common::ply(&cli_common::sphere(3000, 0.3)));
    folder.write("a.pss", "draw box(size: 3) - points(\"open.ply\")\n");
    let ran = folder.run(&["check", "a.pss"]);
    assert!(ran.code == 65 && ran.stderr.contains("E0301"), "{}", ran.stderr);
}

#[test]
fn every_scene_of_the_project_checks_clean() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Folder::new();
    let mut checked = 0;
    for scenes in ["scenes", "scenes/cookbook"] {
        for entry in std::fs::read_dir(root.join(scenes)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "pss") {
                continue;
            }
            let ran = folder.run(&["check", path.to_str().unwrap()]);
            assert_eq!(ran.code, 0, "{}", ran.stderr);
            assert!(ran.stderr.contains(": nothing to complain of"), "{}", ran.stderr);
            checked += 1;
        }
    }
    assert!(20 <= checked, "{checked} scenes");
}
