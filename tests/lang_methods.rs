//! What the methods that place and copy shapes mean: the resolved scene, and what lines meet of it.

mod csg_support;
mod lang_support;

use std::sync::Arc;

use csg_support::scene::{shot, spans};
use glam::{DAffine3, DMat3, DVec3};
use lang_support::scene;
use pss::csg::Scratch;
use pss::geom::Ray;
use pss::num::hash::Stream;
use pss::scene::{BooleanOp, Operand, Shape, ShapeKind};

fn drawn(text: &str) -> Shape {
    scene(text).draws[0].shape.clone()
}

fn map(shape: &Shape) -> (DAffine3, &Shape) {
    match &shape.0.kind {
        ShapeKind::Transform { world_from_local, child } => (*world_from_local, child),
        other => panic!("not a transform: {other:?}"),
    }
}

fn operands(shape: &Shape) -> &[Operand] {
    match &shape.0.kind {
        ShapeKind::Boolean { op: BooleanOp::Union, operands } => operands,
        other => panic!("not a union: {other:?}"),
    }
}

/// Whether two scenes are inside at the same places of random lines.
fn same(a: &str, b: &str) {
    let (a, b) = (shot(a), shot(b));
    let mut scratch = Scratch::default();
    let mut met = 0;
    for i in 0..1500 {
        let ray = Ray::chord(&mut Stream::new(i), DVec3::ZERO, 6.0);
        let (u, v) = (spans(&a, &ray, &mut scratch), spans(&b, &ray, &mut scratch));
        assert_eq!(u.len(), v.len(), "ray {i}: {u:?} {v:?}");
        for (x, y) in u.iter().zip(&v) {
            let (x, y) = (x.interval(), y.interval());
            assert!((x.lo - y.lo).abs() < 1e-9 && (x.hi - y.hi).abs() < 1e-9, "ray {i}: {x:?} {y:?}");
        }
        met += u.len();
    }
    assert!(20 < met, "the lines meet too little to tell: {met}");
}

#[test]
fn a_mirror_turns_one_axis_and_leaves_its_plane() {
    for axis in ["\"x\"", "[1, 0, 0]", "[-7, 0, 0]"] {
        let shape = drawn(&format!("draw sphere(r: 1).mirror({axis})"));
        assert_eq!(map(&shape).0, DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
    }
    let shape = drawn("draw sphere(r: 1).mirror([1, 1, 0], about: [2, 0, 5])");
    let (map, _) = map(&shape);
    for point in [DVec3::new(2.0, 0.0, 5.0), DVec3::new(1.0, 1.0, 0.0)] {
        assert!((map.transform_point3(point) - point).length() < 1e-15, "the plane stays");
    }
    let image = map.transform_point3(DVec3::new(3.0, 1.0, 7.0));
    assert!((image - DVec3::new(1.0, -1.0, 7.0)).length() < 1e-14, "{image}");
}

#[test]
fn d6_mirrors_keep_normals_outward_and_twice_is_once() {
    let body = "(box([0, 0, 0], [1, 2, 3]) - sphere(r: 1, at: [1, 2, 3]))";
    same(&format!("draw {body}.mirror(\"z\").mirror(\"z\")"), &format!("draw {body}"));
    same(
        &format!("draw {body}.mirror(\"x\").mirror(\"y\").mirror(\"z\")"),
        "draw box([0, 0, 0], [-1, -2, -3]) - sphere(r: 1, at: [-1, -2, -3])",
    );
    let made = shot(&format!("draw {body}.mirror([1, 2, -1])"));
    let mut scratch = Scratch::default();
    for i in 0..200 {
        let ray = Ray::chord(&mut Stream::new(i), DVec3::ZERO, 6.0);
        for span in spans(&made, &ray, &mut scratch) {
            let (enter, exit) = (span.enter.unwrap(), span.exit.unwrap());
            assert!(enter.normal.dot(ray.dir) < 0.0 && 0.0 < exit.normal.dot(ray.dir));
        }
    }
}

#[test]
fn a_matrix_takes_points_as_columns() {
    let shape = drawn("draw sphere(r: 1).matrix([[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 2, 7]])");
    let image = map(&shape).0.transform_point3(DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(image, DVec3::new(3.0, 7.0, 13.0));
    same(
        "draw box(size: [1, 2, 3]).matrix([[0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0.5]])",
        "draw box(size: [1, 2, 3]).rotate_z(90deg).move([1, 0, 0.5])",
    );
}

#[test]
fn copies_share_the_shape_they_are_made_of() {
    let texts = [
        ("array([[0, 0, 0], [3, 0, 0], [0, 4, 0]])", 3),
        ("around(5, about: [2, 0, 0])", 5),
        ("instance([[1, 0, 0], [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 9]]])", 2),
        ("array([])", 0),
    ];
    for (method, count) in texts {
        let shape = drawn(&format!("let s = sphere(r: 1) | box(size: 1)\ndraw s.{method}"));
        let list = operands(&shape);
        assert_eq!(list.len(), count, "{method}");
        let first = list.first().map(|o| map(&o.shape).1);
        assert!(list.iter().all(|o| Arc::ptr_eq(&map(&o.shape).1.0, &first.unwrap().0)), "{method}");
    }
}

#[test]
fn an_array_moves_and_around_turns() {
    let shape = drawn("draw sphere(r: 1).array([[3, 0, 1]])");
    assert_eq!(map(&operands(&shape)[0].shape).0, DAffine3::from_translation(DVec3::new(3.0, 0.0, 1.0)));
    let shape = drawn("draw sphere(r: 1).around(4)");
    let turns: Vec<DMat3> = operands(&shape).iter().map(|o| map(&o.shape).0.matrix3).collect();
    assert_eq!(turns[0], DMat3::IDENTITY);
    assert_eq!(turns[1] * DVec3::X, DVec3::Y);
    assert_eq!(turns[2] * DVec3::X, -DVec3::X);
    same(
        "draw cylinder(r: 0.5, h: 2).move([2, 0, 0]).around(3, about: [0.5, 0, 0])",
        "let c = cylinder(r: 0.5, h: 2).move([2, 0, 0])
draw c | c.rotate_z(120deg, about: [0.5, 0, 0]) | c.rotate_z(240deg, about: [0.5, 0, 0])",
    );
}

#[test]
fn copies_of_sheets_are_sheets() {
    let made = shot("draw plane(z: 0).array([[0, 0, 1], [0, 0, 2]])");
    let mut hits = Vec::new();
    let ray = Ray::new(DVec3::ZERO, DVec3::new(0.1, 0.2, 1.0));
    made.world.sheets(&ray, pss::geom::Interval::AHEAD, &mut Scratch::default(), &mut hits);
    assert_eq!(hits.iter().map(|h| h.boundary.t).collect::<Vec<_>>(), [1.0, 2.0]);
}

/// The material of the first face that a ray from above meets.
fn seen(text: &str, x: f64) -> u32 {
    let made = shot(text);
    let ray = Ray::new(DVec3::new(x, 0.1, 10.0), -DVec3::Z);
    let hit = made.world.first(&ray, pss::geom::Interval::AHEAD, &mut Scratch::default()).unwrap();
    made.world.surface(&ray, &hit).material
}

#[test]
fn a_cut_dresses_cutters_that_wear_nothing() {
    let head = "material a(color: #f00)\nmaterial b(color: #0f0)\nmaterial c(color: #00f)\n";
    let see = |draw: &str, x: f64| seen(&format!("{head}draw {draw}"), x);
    let (base, dent, other) =
        ("box(size: 4).with(a)", "sphere(r: 1, at: [1, 0, 2])", "sphere(r: 1, at: [-1, 0, 2])");
    // Materials are numbered as they are defined.
    assert_eq!(see(&format!("({base} - {dent}).cut(b)"), 1.0), 1);
    assert_eq!(see(&format!("({base} - {dent}).cut(b)"), -1.0), 0);
    assert_eq!(see(&format!("{base} - {dent}"), 1.0), 0);
    assert_eq!(see(&format!("difference({base}, [{dent}.with(c), {other}]).cut(b)"), 1.0), 2);
    assert_eq!(see(&format!("difference({base}, [{dent}.with(c), {other}]).cut(b)"), -1.0), 1);
    // The inner `.cut` is nearer; complements are cutters too; what cuts a cutter wears it as well.
    assert_eq!(see(&format!("({base} - {dent}).cut(c).cut(b)"), 1.0), 2);
    assert_eq!(see(&format!("({base} & !{dent}).cut(c)"), 1.0), 2);
    assert_eq!(see(&format!("({base} - ({dent} - box(size: 0.8, at: [1, 0, 1.4]))).cut(c)"), 1.0), 2);
}

#[test]
fn doubling_a_shape_forty_times_is_refused_by_its_count() {
    let mut text = String::from("let s0 = sphere(r: 1)\n");
    for i in 0..40 {
        text += &format!("let s{} = s{i}.array([[0, 0, 0], [{}, 0, 0]])\n", i + 1, 1u64 << i);
    }
    let errors = csg_support::scene::errors(&format!("{text}draw s40\n"));
    assert_eq!(errors[0].code, "E0703");
    assert_eq!(errors[0].message, "this comes to more than 4294967295 solids: 1099511627776");
}

#[test]
fn a_formula_in_the_language_is_what_it_says() {
    let twins = [
        ("implicit(x**2 + y**2 + z**2 <= r**2, inside: box(size: 3))", "sphere(r: 1.25)"),
        ("implicit(length([x, y, z] - [1, 0, 0]) < 1, inside: box(size: 5))", "sphere(r: 1, at: [1, 0, 0])"),
        ("implicit(max(abs(x) - 1, abs(y) - 1, ) <= 0, inside: box(size: [9, 9, 2]))", "box(size: 2)"),
        ("implicit(0 >= x, inside: sphere(r: 2))", "sphere(r: 2) & half_space(x < 0)"),
        ("implicit(atan2(y, x) <= 0deg, inside: sphere(r: 2))", "sphere(r: 2) & half_space(y < 0)"),
        (
            "implicit(cos(x * 1rad) >= cos(1rad), inside: sphere(r: 3))",
            "sphere(r: 3) & half_space(x < 1) & half_space(x > -1)",
        ),
    ];
    for (formula, twin) in twins {
        same(&format!("let r = 1.25\ndraw {formula}"), &format!("draw {twin}"));
    }
}

/// Below an offset every solid is moved on its own, so they are written out; instances are not.
#[test]
fn a_million_solids_may_stand_in_many_places_but_not_be_written_out() {
    let row = |n: usize, step: usize| {
        let places: Vec<String> = (0..n).map(|i| format!("[{}, 0, 0]", i * step)).collect();
        format!("[{}]", places.join(", "))
    };
    let lets = format!(
        "let a = sphere(r: 1).array({})
         let b = a.array({})
         let c = b.array({})\n",
        row(100, 3),
        row(100, 1000),
        row(1000, 1_000_000),
    );
    let errors = csg_support::scene::errors(&format!("{lets}draw c.offset(0.1)\n"));
    assert_eq!(errors[0].code, "E0703");
    assert_eq!(errors[0].message, "this comes to more than 1000000 solids of their own: 10000000");
    let shot = shot(&format!("{lets}draw c\n"));
    let ray = Ray::new(DVec3::new(999_099_297.0, 5.0, 0.0), -DVec3::Y);
    let spans = spans(&shot, &ray, &mut Scratch::default());
    let ends: Vec<_> =
        spans.iter().flat_map(|s| [s.enter, s.exit]).flatten().map(|b| (b.t, b.leaf)).collect();
    assert_eq!(ends, [(4.0, 9_999_999), (6.0, 9_999_999)]);
}
