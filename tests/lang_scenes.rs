//! What good scenes mean: the resolved [`pss::scene::Scene`].

mod lang_support;

use std::sync::Arc;

use glam::{DMat3, DVec3};
use lang_support::{read_with, scene};
use pss::scene::{BooleanOp, Call, FitTo, Operand, Shape, ShapeKind, Value};

const BUNNY: &str = r##"
// A scan, cut open.
units(mm)
param bore: length = 4 in 1..8 "radius of the drain"

material clay(kind: "matte", color: #b8683c)
material core(kind: "matte", color: #f2e3c6)

let shown = difference(bunny, [wedge, drain])
let bunny = points("bunny.ply").rotate_x(90deg).fit([0, 0, 0], height: 100).close(max_hole: 30).with(clay)
let wedge = box([0, -80, -5], [80, 0, 120]).with(core)
let drain = cylinder(r: bore, from: [0, 0, -5], to: [0, 0, 20])

draw shown
draw plane(z: 0).with(matte(#d8d8d8))

camera(eye: [140, -220, 120], look_at: [0, 0, 48], fov: 28deg)
light sun(direction: [-1, 2, -3], intensity: 3, softness: 2deg)
light sky(color: #dfe8ff, intensity: 0.6)
render(size: [640, 480], samples: 64)
"##;

/// The shape drawn by a scene with one `draw`.
fn drawn(text: &str) -> Shape {
    scene(text).draws[0].shape.clone()
}

fn leaf(shape: &Shape) -> (&Call, &str) {
    match &shape.0.kind {
        ShapeKind::Leaf { call, name } => (call, name),
        ShapeKind::Boolean { .. } => panic!("not a leaf: {shape:?}"),
        other => leaf(other.children().next().expect("a child")),
    }
}

fn boolean(shape: &Shape) -> (BooleanOp, &[Operand]) {
    match &shape.0.kind {
        ShapeKind::Boolean { op, operands } => (*op, operands),
        other => panic!("not a Boolean: {other:?}"),
    }
}

fn linear(shape: &Shape) -> DMat3 {
    match &shape.0.kind {
        ShapeKind::Transform { world_from_local, .. } => world_from_local.matrix3,
        other => panic!("not a transform: {other:?}"),
    }
}

/// The number that `expr` comes to.
fn number(expr: &str) -> f64 {
    let shape = drawn(&format!("draw plane(z: {expr})"));
    leaf(&shape).0.number("z").unwrap_or(f64::NAN)
}

#[test]
fn a_whole_scene_is_resolved() {
    let scene = scene(BUNNY);
    assert_eq!(
        (scene.draws.len(), scene.cameras.len(), scene.lights.len(), scene.materials.len()),
        (2, 1, 2, 3)
    );
    let (op, operands) = boolean(&scene.draws[0].shape);
    assert_eq!((op, operands.len()), (BooleanOp::Difference, 3));
    assert_eq!(leaf(&operands[0].shape).1, "bunny");
    let (drain, name) = leaf(&operands[2].shape);
    assert_eq!((name, drain.number("r")), ("drain", Some(4.0)));
    assert_eq!(leaf(&scene.draws[1].shape).1, "plane");
    assert_eq!(scene.lights[0].name.as_deref(), Some("sun"));
    assert_eq!(scene.cameras[0].call.angle("fov"), Some(28f64.to_radians()));
    let render = scene.render.expect("a render item");
    assert_eq!((render.vec2("size"), render.number("samples")), (Some([640.0, 480.0]), Some(64.0)));
}

#[test]
fn methods_nest_from_left_to_right() {
    let shape =
        drawn("draw points(\"a.ply\").fit([1, 2, 3], size: 4).close(max_hole: 1cm).with(matte(#fff))");
    let ShapeKind::With { child, .. } = &shape.0.kind else { panic!("{shape:?}") };
    let ShapeKind::Close { max_hole, child } = &child.0.kind else { panic!("{child:?}") };
    assert_eq!(*max_hole, Some(10.0));
    let ShapeKind::Fit { at, to, .. } = &child.0.kind else { panic!("{child:?}") };
    assert_eq!((*at, *to), (DVec3::new(1.0, 2.0, 3.0), FitTo::Size(4.0)));
}

#[test]
fn a_named_solid_used_twice_is_one_node() {
    let shape = drawn("let a = sphere(r: 1)\nlet b = a\ndraw a & b.move([1, 0, 0])");
    let (_, operands) = boolean(&shape);
    let ShapeKind::Transform { child, .. } = &operands[1].shape.0.kind else { panic!("{shape:?}") };
    assert!(Arc::ptr_eq(&operands[0].shape.0, &child.0));
}

#[test]
fn chains_are_flat_and_operands_know_their_places() {
    let text = "let a = sphere(r: 1)\nlet b = sphere(r: 2)\ndraw a | b | a | !b";
    let shape = drawn(text);
    let (op, operands) = boolean(&shape);
    assert_eq!((op, operands.len()), (BooleanOp::Union, 4));
    let at = operands[1].at;
    assert_eq!(&text[at.start as usize..at.end as usize], "b");
    assert_eq!(boolean(&operands[3].shape).0, BooleanOp::Complement);
    assert_eq!(&text[operands[3].at.start as usize..operands[3].at.end as usize], "!b");
}

#[test]
fn lists_are_flattened_and_an_empty_union_is_nothing() {
    let shape = drawn("let s = [sphere(r: 1), [sphere(r: 2), []], sphere(r: 3)]\ndraw union([s, s])");
    assert_eq!(boolean(&shape).1.len(), 6);
    let shape = drawn("draw union([])");
    assert!(boolean(&shape).1.is_empty());
    assert_eq!(scene("draw [sphere(r: 1), [sphere(r: 2)]]").draws.len(), 2);
}

#[test]
fn lengths_are_read_in_scene_units() {
    assert_eq!(number("1cm"), 10.0);
    assert_eq!(number("5in"), 127.0);
    let shape = drawn("draw sphere(r: 3mm)\nunits(m)");
    assert_eq!(leaf(&shape).0.number("r"), Some(0.003));
}

#[test]
fn a_unit_touches_its_number_and_a_keyword_does_not() {
    let (outcome, _) = read_with("param a = 5 in 1..8\nparam b = 5in in 1..200\n", &[]);
    assert!(outcome.is_ok());
}

#[test]
fn arithmetic_follows_precedence() {
    assert_eq!(number("2 + 3 * 4 - 10 / 4"), 11.5);
    assert_eq!(number("-2 ** 2"), -4.0);
    assert_eq!(number("2 ** 3 ** 2"), 512.0);
    assert_eq!(number("2 ** -1"), 0.5);
    assert_eq!(number("10 - 3 - 2 + 1"), 6.0);
    assert_eq!(number("-7 % 3"), 2.0);
    assert_eq!(number("dot([1, 2, 3], 2 * [1, 1, 1]) + length([3, 4])"), 17.0);
    assert_eq!(number("cross([1, 0, 0], [0, 1, 0])[2] + max([1, 5], 3)[1]"), 6.0);
    assert_eq!(number("mix(1, 3, 0.5) + clamp(9, 0, 4) + round(2.5)"), 9.0);
}

#[test]
fn angles_are_a_type_and_quarter_turns_are_exact() {
    assert_eq!(number("sin(180deg) + cos(0.25turn)"), 0.0);
    assert_eq!(number("(90deg + 2 * 45deg) / 60deg"), 3.0);
    assert_eq!(number("atan2(1, 0) / 1deg"), 90.0);
    let turned = linear(&drawn("draw sphere(r: 1).rotate_x(90deg)"));
    assert_eq!(turned * DVec3::Y, DVec3::Z);
    let turned = linear(&drawn("draw sphere(r: 1).rotate_y(-270deg)"));
    assert_eq!(turned * DVec3::Z, DVec3::X);
    let turned = linear(&drawn("draw sphere(r: 1).rotate(axis: [0, 0, 2], by: 90deg)"));
    assert_eq!(turned, DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z));
}

#[test]
fn about_keeps_its_point() {
    let shape = drawn("draw sphere(r: 1).rotate_z(30deg, about: [1, 2, 3])");
    let ShapeKind::Transform { world_from_local, .. } = &shape.0.kind else { panic!("{shape:?}") };
    let point = DVec3::new(1.0, 2.0, 3.0);
    assert!(world_from_local.transform_point3(point).distance(point) < 1e-15);
}

#[test]
fn half_spaces_are_linear_forms() {
    let plane = |condition: &str| {
        let shape = drawn(&format!("draw half_space({condition})"));
        match leaf(&shape).0.get("inside") {
            Some(Value::HalfSpace { normal, offset }) => (normal.to_array(), *offset),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(plane("z < 60"), ([0.0, 0.0, 1.0], 60.0));
    assert_eq!(plane("x + 2*y <= 3"), ([1.0, 2.0, 0.0], 3.0));
    assert_eq!(plane("1cm < -(z - x) / 2"), ([-0.5, 0.0, 0.5], -10.0));
    assert_eq!(plane("inside: (sqrt(4) * y >= 2 ** 2)"), ([0.0, -2.0, 0.0], -4.0));
}

#[test]
fn a_coordinate_hides_a_name_of_the_file() {
    scene("let x = half_space(x < 3)\ndraw x");
    scene("let a = half_space(x < 3).move([x, 0, 0])\nlet x = 3\ndraw a");
}

#[test]
fn files_know_the_folder_they_start_from() {
    let path = |text: &str, defines: &[(&str, &str)]| {
        let (outcome, _) = read_with(text, defines);
        let scene = outcome.expect("a good scene").0;
        match leaf(&scene.draws[0].shape).0.get("source") {
            Some(Value::Path { text, base, from_command_line }) => {
                (text.clone(), base.display().to_string(), *from_command_line)
            }
            other => panic!("{other:?}"),
        }
    };
    let text = "param file = \"a.ply\"\ndraw points(file)";
    assert_eq!(path(text, &[]), ("a.ply".into(), "/scenes".into(), false));
    assert_eq!(path(text, &[("file", "b \"c\".ply")]), ("b \"c\".ply".into(), String::new(), true));
}

#[test]
fn a_solid_can_stand_for_a_file() {
    let shape = drawn("draw points(sphere(r: 1))");
    assert!(matches!(leaf(&shape).0.get("source"), Some(Value::Shape(_))));
}

#[test]
fn defines_are_read_by_type() {
    let text = "param r: length = 4 in 1..80\nparam turn = 30deg\nparam c = #fff\nparam v = [1, 2, 3]\n\
                param deep = false\nlight(color: c, direction: v, falloff: deep)\ndraw sphere(r: r).rotate_z(turn)";
    let defines = [("r", "2cm"), ("turn", "90deg"), ("c", "#000"), ("v", "[0, -1, 2.5]"), ("deep", "true")];
    let (outcome, _) = read_with(text, &defines);
    let scene = outcome.expect("a good scene").0;
    assert_eq!(leaf(&scene.draws[0].shape).0.number("r"), Some(20.0));
    assert_eq!(linear(&scene.draws[0].shape) * DVec3::X, DVec3::Y);
    let light = &scene.lights[0].call;
    assert_eq!(light.color("color"), Some([0.0; 3]));
    assert_eq!(light.vec3("direction"), Some(DVec3::new(0.0, -1.0, 2.5)));
    assert_eq!(light.flag("falloff"), Some(true));
}

#[test]
fn a_wrong_define_is_a_fault_of_usage() {
    let text = "param r: length = 4 in 1..8\ndraw sphere(r: r)";
    for define in [("r", "9"), ("s", "1"), ("r", "x"), ("r", "#fff"), ("r", ""), ("r", "2 * 3"), ("", "")] {
        let (outcome, _) = read_with(text, &[define]);
        let errors = outcome.expect_err("a wrong define");
        assert!(errors.iter().all(|e| e.fault.exit_code() == 2 && e.help.is_some()), "{define:?} {errors:?}");
    }
}

#[test]
fn colours_are_decoded_to_linear_light() {
    let scene = scene("material a(color: #bc0000)\nmaterial b(kind: \"metal\", color: rgb(0.5, 0, 0))");
    let a = scene.materials[0].color("color").expect("a colour");
    assert!((a[0] - 0.502_886).abs() < 1e-5, "{a:?}");
    assert_eq!(
        (scene.materials[1].word.as_str(), scene.materials[1].color("color")),
        ("metal", Some([0.5, 0.0, 0.0]))
    );
}

#[test]
fn only_and_skip_choose_what_is_drawn() {
    assert_eq!(scene("draw sphere(r: 1)\n@skip draw sphere(r: 2)").draws.len(), 1);
    let scene = scene("draw sphere(r: 1)\n@only draw sphere(r: 2)");
    assert_eq!(scene.draws.len(), 1);
    assert_eq!(leaf(&scene.draws[0].shape).0.number("r"), Some(2.0));
}

#[test]
fn comments_line_ends_and_a_byte_order_mark_are_no_matter() {
    scene(
        "\u{feff}/* a\r\n comment */ let a = sphere( // here\r\n  r: 1,\r\n)\r\n  .move([1, 0, 0]) /* and */ .scale(2)\r\n\r\ndraw a",
    );
    scene("let inside = 1 let notch = 2\nlet a = inside\n  + notch draw sphere(r: a)");
    scene("");
}
