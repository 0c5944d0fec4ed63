//! `pss probe --json`: a line for each ray, its fields and their values.

mod cli_common;

use cli_common::Folder;
use serde_json::{Value, json};

/// The answer to one ray.
fn probe(scene: &str, ray: &str) -> Value {
    let folder = Folder::new();
    folder.write("a.pss", scene);
    let ran = folder.run(&["probe", "a.pss", "--ray", ray, "--json"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let mut lines = ran.json_lines();
    assert_eq!(lines.len(), 1);
    lines.remove(0)
}

fn near(value: &Value, wanted: &[f64], within: f64) {
    let numbers = value.as_array().cloned().unwrap_or_else(|| vec![value.clone()]);
    assert_eq!(numbers.len(), wanted.len(), "{value}");
    for (have, want) in numbers.iter().zip(wanted) {
        assert!((have.as_f64().unwrap() - want).abs() <= within, "{value} is not {wanted:?}");
    }
}

#[test]
fn a_box_has_one_span_with_every_field() {
    let answer = probe("let block = box([0, 0, 0], [1, 2, 3])\ndraw block", "-4,1,1 2,0,0");
    let end = |t: f64, x: f64, nx: f64| {
        json!({ "t": t, "err": 0.0, "point": [x, 1.0, 1.0], "normal": [nx, 0.0, 0.0],
                "leaf": "block", "flipped": false, "cap": false })
    };
    let mut answer = answer;
    // How sure the end is depends on rounding alone.
    for end in ["enter", "exit"] {
        let err = answer["spans"][0][end]["err"].take();
        assert!((1e-16..1e-13).contains(&err.as_f64().unwrap()), "{err}");
        answer["spans"][0][end]["err"] = json!(0.0);
    }
    let spans = [json!({ "enter": end(2.0, 0.0, -1.0), "exit": end(2.5, 1.0, 1.0) })];
    assert_eq!(answer, json!({ "ray": 0, "spans": spans }));
}

#[test]
fn spans_are_those_of_what_is_drawn() {
    let scene = "let block = box([-2, -1, -1], [2, 1, 1])\nlet ball = sphere(r: 1)\ndraw block - ball\n";
    let answer = probe(scene, "-5,0,0 1,0,0");
    let spans = answer["spans"].as_array().unwrap();
    assert_eq!(spans.len(), 2);
    near(&spans[0]["exit"]["t"], &[4.0], 1e-14);
    assert_eq!(spans[0]["exit"]["leaf"], "ball");
    assert_eq!(spans[0]["exit"]["flipped"], true, "the inside of the ball bounds what is left");
    near(&spans[0]["exit"]["normal"], &[1.0, 0.0, 0.0], 1e-14);
    assert_eq!(probe(scene, "-5,0,4 1,0,0"), json!({ "ray": 0, "spans": [] }));
}

#[test]
fn ends_that_are_not_there_are_null() {
    let inside = probe("draw sphere(r: 2)", "0,0,0 0,0,4");
    assert_eq!(inside["spans"][0]["enter"], Value::Null);
    near(&inside["spans"][0]["exit"]["t"], &[0.5], 1e-14);
    let endless = probe("draw half_space(z < 1)", "0,0,5 0,0,-2");
    near(&endless["spans"][0]["enter"]["t"], &[2.0], 1e-14);
    assert_eq!(endless["spans"][0]["exit"], Value::Null);
}

#[test]
fn a_scan_is_where_its_samples_are() {
    let scene = "let scan = points(sphere(r: 1), samples: 3000, seed: 2)\ndraw scan.move([0, 0, 3])";
    let answer = probe(scene, "0,0,9 0,0,-1");
    let spans = answer["spans"].as_array().unwrap();
    assert_eq!(spans.len(), 1, "{answer}");
    for (end, t, nz) in [("enter", 5.0, 1.0), ("exit", 7.0, -1.0)] {
        let end = &spans[0][end];
        near(&end["t"], &[t], 1e-3);
        near(&end["normal"], &[0.0, 0.0, nz], 0.02);
        assert!(end["err"].as_f64().unwrap() < 1e-7, "{end}");
        assert_eq!(
            (&end["leaf"], &end["cap"], &end["flipped"]),
            (&json!("scan"), &json!(false), &json!(false))
        );
    }
}

#[test]
fn a_capped_hole_says_so() {
    let folder = Folder::new();
    folder.write("a.ply", cli_common::ply_with_normals(&cli_common::sphere(2000, 0.8)));
    folder.write("a.pss", "draw points(\"a.ply\").close(max_hole: 2)");
    let ran = folder.run(&["probe", "a.pss", "--ray", "0,0,9 0,0,-1", "--json"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let answer = &ran.json_lines()[0];
    assert_eq!(answer["spans"][0]["enter"]["cap"], true, "{answer}");
    assert_eq!(answer["spans"][0]["exit"]["cap"], false, "{answer}");
}

#[test]
fn sheets_are_listed_apart() {
    let answer =
        probe("let ground = plane(z: -1)\ndraw ground\ndraw sphere(r: 1, at: [9, 0, 0])", "0,0,1 0,0,-1");
    assert_eq!(answer["spans"], json!([]));
    let sheets = answer["sheets"].as_array().unwrap();
    assert_eq!(sheets.len(), 1);
    near(&sheets[0]["t"], &[2.0], 1e-14);
    near(&sheets[0]["point"], &[0.0, 0.0, -1.0], 1e-14);
    assert_eq!(sheets[0]["leaf"], "ground");
}

#[test]
fn a_file_of_rays_is_answered_line_by_line() {
    let folder = Folder::new();
    folder
        .write("a.pss", "draw sphere(r: 1)")
        .write("rays.csv", "0,0,9,0,0,-1\n9,9,9,0,0,1\n\n0,0,0,1,0,0\n");
    let one = folder.run(&["probe", "a.pss", "--rays", "rays.csv", "--json", "-t", "1"]);
    let two = folder.run(&["probe", "a.pss", "--rays", "rays.csv", "--json", "-t", "2"]);
    assert_eq!(one.stdout, two.stdout);
    let lines = one.json_lines();
    let rays: Vec<_> =
        lines.iter().map(|l| (l["ray"].as_u64().unwrap(), l["spans"].as_array().unwrap().len())).collect();
    assert_eq!(rays, [(0, 1), (1, 0), (2, 1)]);
}

#[test]
fn a_pixel_is_probed_through_its_centre() {
    let folder = Folder::new();
    let scene = "draw sphere(r: 1)\ncamera(eye: [0, -5, 0], look_at: [0, 0, 0], fov: 40deg)\n";
    folder.write("a.pss", scene);
    let ran = folder.run(&["probe", "a.pss", "--pixel", "4,4", "--size", "9x9", "--json"]);
    let answer = &ran.json_lines()[0];
    near(&answer["spans"][0]["enter"]["point"], &[0.0, -1.0, 0.0], 1e-12);
    let table = folder.run(&["probe", "a.pss", "--pixel", "4,4", "--size", "9x9"]);
    let text = String::from_utf8(table.stdout).unwrap();
    assert!(text.starts_with("ray 0\n  enter t ") && text.contains("exit"), "{text}");
}

/// From five sizes away it is a ball like any other; from 5, 1e30 sizes away, both ends are one and the same `t`, and so
/// there is no span.
#[test]
fn p15_a_cloud_of_1e_minus_30_has_its_spans() {
    let folder = Folder::new();
    let tiny: Vec<glam::DVec3> = cli_common::sphere(4000, 1.0).iter().map(|p| 1e-30 * *p).collect();
    folder.write("a.ply", cli_common::ply(&tiny)).write("a.pss", "draw points(\"a.ply\")\n");
    folder.write("rays.csv", "0,0,-5e-30,0,0,1e-30\n0,0,-5e-30,0,0,1\n0,0,-5,0,0,1\n");
    let ran = folder.run(&["probe", "a.pss", "--rays", "rays.csv", "--json"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let lines = ran.json_lines();
    for (line, unit) in lines.iter().zip([1.0, 1e-30]) {
        let span = &line["spans"][0];
        near(&span["enter"]["t"], &[4.0 * unit], 1e-4 * unit);
        near(&span["exit"]["t"], &[6.0 * unit], 1e-4 * unit);
    }
    assert_eq!(lines[2]["spans"], json!([]));
}

/// From far away and at a graze roundings are what is left; a ball of radius 2 about z = 3 is known exactly.
#[test]
fn the_bound_of_error_holds_for_closed_forms_from_far_away_and_at_a_graze() {
    let scene = "draw sphere(r: 2, at: [0, 0, 3])";
    for (far, beside) in [(7.0, 0.3), (1e4, 1.0), (1e7, 1.9), (1e7, 1.9999999), (1e3, 1.999999999999)] {
        let answer = probe(scene, &format!("-{far},{beside},3 0.5,0,0"));
        let half = (4.0f64 - beside * beside).sqrt();
        for (end, exact) in [("enter", 2.0 * (far - half)), ("exit", 2.0 * (far + half))] {
            let end = &answer["spans"][0][end];
            let (t, err) = (end["t"].as_f64().unwrap(), end["err"].as_f64().unwrap());
            assert!((t - exact).abs() <= err && err < 1e-6 * far, "{t} {exact} {err} at {far} {beside}");
        }
    }
}
