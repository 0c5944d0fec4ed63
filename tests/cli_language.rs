//! `pss fmt`, `dump`, `test` and `explain`, `print` and `expect` at the command line.

mod cli_common;

use cli_common::{Folder, Ran};

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).unwrap()
}

fn out(ran: &Ran) -> String {
    String::from_utf8(ran.stdout.clone()).unwrap()
}

const MESSY: &str = "// a scene\n\n\n\nlet   r=3 // mm\nfn ring( n ,  at=[0,0,0] )=union(for i in 0 .. n{\nsphere( r:r,at:at+[3*i , -1 ,0] )})\nlet f = fn (x)=>x%2\n draw ring ( 5 )-box( [0,0,-1],\n\n\n [ 1,1,1 ] ) /* cut */\nexpect volume(sphere(r:r))~=113 within 0.5 %\n let s = [-1, - 2, 3 - -4][ 0 ]  camera( eye:[9,9,9] )\nlet g = if s<0 and not(s==3){1}else{ !true }\n\n\n";

#[test]
fn fmt_puts_scenes_into_the_house_style_once() {
    let folder = Folder::new();
    folder.write("a.pss", MESSY);
    assert_eq!(folder.run(&["fmt", "--check", "a.pss"]).code, 1);
    assert_eq!(text(&folder, "a.pss"), MESSY);
    assert_eq!(folder.run(&["fmt", "a.pss"]).code, 0);
    let neat = text(&folder, "a.pss");
    let want = "// a scene\n\nlet r = 3 // mm\nfn ring(n, at = [0, 0, 0]) = union(for i in 0..n {\n    sphere(r: r, at: at + [3 * i, -1, 0]) })\nlet f = fn(x) => x % 2\ndraw ring(5) - box([0, 0, -1],\n\n    [1, 1, 1]) /* cut */\nexpect volume(sphere(r: r)) ~= 113 within 0.5%\nlet s = [-1, -2, 3 - -4][0]\ncamera(eye: [9, 9, 9])\nlet g = if s < 0 and not (s == 3) { 1 } else { !true }\n";
    assert_eq!(neat, want, "{neat}");
    let again = folder.run(&["fmt", "--check", "a.pss"]);
    assert_eq!((again.code, again.stderr.as_str()), (0, ""));
    folder.write("b.pss", "draw sphere(r: ");
    assert_eq!(folder.run(&["fmt", "b.pss"]).code, 65);
    assert_eq!(text(&folder, "b.pss"), "draw sphere(r: ");
    assert_eq!(folder.run(&["fmt", "gone.pss"]).code, 66);
}

/// The scenes of the project are in the house style, and what is formatted says the same.
#[test]
fn every_scene_of_the_project_formats_to_itself() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Folder::new();
    let folders = ["scenes", "scenes/cookbook", "scenes/cookbook/parts"]
        .map(|f| std::fs::read_dir(root.join(f)).unwrap());
    for entry in folders.into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "pss") {
            let ran = folder.run(&["fmt", "--check", path.to_str().unwrap()]);
            assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{}", path.display());
        }
    }
}

#[test]
fn dump_is_json_that_reads_back() {
    let folder = Folder::new();
    folder.write("a.pss", "param n: int = 3 in 1..9\nfn f(x) = x * 2\ndraw union(for i in 0..n { sphere(r: f(1), at: [i, 0, 0]) })\nrender(samples: 2)\n");
    let ran = folder.run(&["dump", "a.pss", "--json", "-D", "n=2"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let dump = &ran.json_lines()[0];
    assert_eq!(dump["version"], 1);
    assert!(dump["files"][0].as_str().is_some_and(|name| name.ends_with(".pss")), "{}", dump["files"]);
    let items: Vec<pss::lang::ast::Item> = serde_json::from_value(dump["items"].clone()).unwrap();
    assert_eq!(serde_json::to_value(&items).unwrap(), dump["items"]);
    let scene: pss::scene::Scene = serde_json::from_value(dump["scene"].clone()).unwrap();
    assert_eq!(serde_json::to_value(&scene).unwrap(), dump["scene"]);
    let pss::scene::ShapeKind::Boolean { operands, .. } = &scene.draws[0].shape.0.kind else { panic!() };
    assert_eq!((items.len(), operands.len()), (4, 2));
}

/// Every scene of the project comes back from its JSON as it was, as items and as what they come to.
#[test]
fn every_scene_of_the_project_round_trips_through_json() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let (folder, mut scenes) = (Folder::new(), 0);
    for entry in ["scenes", "scenes/cookbook"].iter().flat_map(|f| std::fs::read_dir(root.join(f)).unwrap()) {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "pss") {
            continue;
        }
        scenes += 1;
        let ran = folder.run(&["dump", "--json", path.to_str().unwrap()]);
        assert_eq!(ran.code, 0, "{}: {}", path.display(), ran.stderr);
        #[derive(serde::Serialize, serde::Deserialize)]
        struct Dump {
            version: u32,
            files: Vec<String>,
            items: Vec<pss::lang::ast::Item>,
            scene: pss::scene::Scene,
        }
        let dump: Dump = serde_json::from_slice(&ran.stdout).unwrap();
        let again = format!("{}\n", serde_json::to_string(&dump).unwrap());
        assert!(again.as_bytes() == ran.stdout, "{}", path.display());
        assert!(!dump.scene.draws.is_empty(), "{}", path.display());
    }
    assert!(30 <= scenes, "{scenes}");
}

#[test]
fn expectations_are_evaluated_by_check_and_test_and_not_by_render() {
    let folder = Folder::new();
    folder.write("good.pss", "draw sphere(r: 1)\nexpect volume(sphere(r: 1)) ~= 4.18879 within 0.1%\nrender(size: [8, 8], samples: 1)\n");
    folder.write(
        "bad.pss",
        "draw sphere(r: 1)\nexpect empty(sphere(r: 1))\nrender(size: [8, 8], samples: 1)\n",
    );
    assert_eq!(folder.run(&["check", "good.pss"]).code, 0);
    let ran = folder.run(&["check", "bad.pss"]);
    assert!(ran.code == 1 && ran.stderr.contains("E0801"), "{}", ran.stderr);
    assert_eq!(folder.run(&["render", "bad.pss", "--quiet"]).code, 0);
    let ran = folder.run(&["test", ".", "--junit", "report.xml"]);
    assert!(ran.code == 1 && ran.stderr.contains("2 scenes, 1 failed"), "{}", ran.stderr);
    let report = text(&folder, "report.xml");
    assert!(
        report.contains("tests=\"2\" failures=\"1\"") && report.contains("<failure message=\"error[E0801]"),
        "{report}"
    );
    assert_eq!(folder.run(&["test", "good.pss"]).code, 0);
    assert_eq!(folder.run(&["test", "nowhere"]).code, 66);
}

#[test]
fn print_goes_to_standard_error() {
    let folder = Folder::new();
    folder.write("a.pss", "draw sphere(r: 1)\nprint [1, 2]\nprint bounds(sphere(r: 1)).size\n");
    let ran = folder.run(&["probe", "a.pss", "--ray", "-5,0,0 1,0,0", "--json"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, "[1, 2]\n[2, 2, 2]\n"));
}

#[test]
fn explain_prints_words_and_codes() {
    let folder = Folder::new();
    let page = folder.run(&["explain", "box"]);
    assert!(page.code == 0 && out(&page).contains("round"), "{}", out(&page));
    let page = folder.run(&["explain", "e0301"]);
    assert!(out(&page).contains("draw box(size: 1) - half_space(z < 0)"), "{}", out(&page));
    let ran = folder.run(&["explain", "bix"]);
    assert!(ran.code == 2 && ran.stderr.contains("did you mean `box`?"), "{}", ran.stderr);
    assert!(out(&folder.run(&["explain"])).lines().count() > 100);
}

#[test]
fn check_fix_mends_the_file_and_json_tells_the_edit() {
    let folder = Folder::new();
    folder.write("a.pss", "// kept\ndraw spere(r: 1) + box(size: 1)\n");
    let ran = folder.run(&["check", "--format", "json", "a.pss"]);
    let told: serde_json::Value = serde_json::from_str(ran.stderr.lines().next().unwrap()).unwrap();
    let edit = serde_json::json!({
        "file": "a.pss", "line": 2, "column": 6, "end_line": 2, "end_column": 11, "text": "sphere"
    });
    assert_eq!((ran.code, &told["fix"]), (65, &edit));
    let ran = folder.run(&["check", "--fix", "a.pss"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stderr.contains("2 edits made"), "{}", ran.stderr);
    assert_eq!(text(&folder, "a.pss"), "// kept\ndraw sphere(r: 1) | box(size: 1)\n");
    // Nothing to mend, and what cannot be.
    assert_eq!(folder.run(&["check", "--fix", "a.pss"]).code, 0);
    folder.write("b.pss", "draw sphere()\n");
    assert_eq!(folder.run(&["check", "--fix", "b.pss"]).code, 65);
    assert_eq!(text(&folder, "b.pss"), "draw sphere()\n");
    assert_eq!(folder.run(&["check", "--fix", "-"]).code, 2);
}

/// `make` reads the rule: all that the picture is made from, and nothing else.
#[test]
fn deps_names_all_that_a_picture_is_made_from() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("my scans")).unwrap();
    folder.write("my scans/b.ply", cli_common::ply_with_normals(&cli_common::sphere(300, 1.0)));
    folder.write("parts.pss", "fn peg(r) = sphere(r: r)\n");
    folder.write(
        "a.pss",
        "import \"parts.pss\"\nlet unused = points(\"gone.ply\")\ndraw peg(1) | points(\"my scans/b.ply\")\n",
    );
    let args = ["render", "a.pss", "--size", "8x8", "-o", "a.png", "-o", "a.exr", "--deps", "a.d"];
    let ran = folder.run(&args);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let rule = text(&folder, "a.d");
    let (first, rest) = rule.split_once("\n\n").unwrap();
    let (targets, needs) = first.split_once(": ").unwrap();
    assert_eq!(targets, "a.png a.exr");
    let mut needs: Vec<&str> = needs.split(" \\\n  ").collect();
    needs.sort_unstable();
    assert_eq!(needs, ["a.pss", "my\\ scans/b.ply", "parts.pss"]);
    assert_eq!(rest.matches(":\n").count(), 3);
    for wrong in [vec!["-o", "-"], vec!["-o", "a.d.png", "--stats-json", "a.d"]] {
        let ran = folder.run(&[&["render", "a.pss", "--deps", "a.d"][..], &wrong].concat());
        assert_eq!(ran.code, 2, "{}", ran.stderr);
    }
    assert_eq!(folder.run(&["render", "a.pss", "--deps", "parts.pss"]).code, 73);
}
