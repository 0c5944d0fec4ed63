//! Boolean cases told by their spans on single rays, through the whole program from their text. Names and numbers are those
//! of the list of boolean cases and of the numerical stress cases, sections B and E.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::scene::{shot, spans};
use glam::{DVec3, dvec3};
use pss::csg::{Scratch, Spans};
use pss::geom::{Interval, Ray};
use pss::shot::Shot;

type Ends = Vec<(f64, f64)>;

fn ends(list: &Spans) -> Ends {
    list.iter().map(|s| (s.interval().lo, s.interval().hi)).collect()
}

fn ahead(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Ends {
    let mut out = Spans::new();
    shot.world.spans(ray, Interval::AHEAD, scratch, &mut out);
    out.iter().map(|s| (s.enter.map_or(0.0, |b| b.t), s.interval().hi)).collect()
}

fn is_near(have: &[(f64, f64)], want: &[(f64, f64)], error: f64) -> bool {
    let near = |a: f64, b: f64| a == b || (a - b).abs() <= error;
    have.len() == want.len() && have.iter().zip(want).all(|(a, b)| near(a.0, b.0) && near(a.1, b.1))
}

/// A name, a shape, an origin, a direction, and the spans.
type Case<'a> = (&'a str, &'a str, [f64; 3], [f64; 3], &'a [(f64, f64)]);

/// Spans on whole lines.
fn check(cases: &[Case]) {
    let mut scratch = Scratch::default();
    for (name, text, origin, dir, want) in cases {
        let shot = shot(&format!("draw {text}"));
        let have = ends(&spans(&shot, &Ray::new((*origin).into(), (*dir).into()), &mut scratch));
        assert!(is_near(&have, want, 1e-12), "{name}: {have:?}, not {want:?}");
    }
}

const INF: f64 = f64::INFINITY;

#[test]
fn cases_12_to_16_where_the_ray_begins() {
    let mut scratch = Scratch::default();
    let ball = shot("draw sphere(r: 1)");
    let along = |x: f64| Ray::new(dvec3(x, 0.0, 0.0), DVec3::X);
    let mut of = |ray: Ray| ahead(&ball, &ray, &mut scratch);
    assert_eq!(of(along(3.0)), [], "12: behind the origin");
    assert_eq!(of(along(0.0)), [(0.0, 1.0)], "13: the origin inside");
    assert_eq!(of(along(1.0)), [], "14: on the surface, outward");
    assert_eq!(of(along(-1.0)), [(0.0, 2.0)], "14: on the surface, inward");
    check(&[
        ("15 half-space", "half_space(z < 0)", [0.0, 0.0, 3.0], [0.0, 0.0, 1.0], &[(-INF, -3.0)]),
        ("15 slab", "(half_space(z < 1) - half_space(z < 0))", [0.0; 3], [0.0, 0.0, 1.0], &[(0.0, 1.0)]),
        (
            "16 an ulp apart",
            "(box([0, 0, 0], [1, 1, 1]) | box([0, 0, 1.0000000000000002], [1, 1, 2]))",
            [0.5, 0.5, -1.0],
            [0.0, 0.0, 1.0],
            &[(1.0, 3.0)],
        ),
        (
            "18 many intervals",
            "(torus(major: 1, minor: 0.25) - sphere(r: 1))",
            [0.0; 3],
            [1.0, 0.0, 0.0],
            &[(-1.25, -1.0), (1.0, 1.25)],
        ),
    ]);
}

#[test]
fn cases_28_and_42_to_44_grazing_rays() {
    let unit = "box([0, 0, 0], [1, 1, 1])";
    let cut = "(box([-1, -1, -1], [1, 1, 1]) - box([-0.5, -0.5, -1.0000003], [0.5, 0.5, 1.0000003]))";
    check(&[
        ("28 through the cutter", cut, [0.1, 0.2, -5.0], [0.0, 0.0, 1.0], &[]),
        ("42 grazing a ball", "sphere(r: 1)", [-3.0, 1.0, 0.0], [1.0, 0.0, 0.0], &[]),
        ("43 in the low face", unit, [-1.0, 0.5, 0.0], [1.0, 0.0, 0.0], &[(1.0, 2.0)]),
        ("43 in the high face", unit, [-1.0, 0.5, 1.0], [1.0, 0.0, 0.0], &[]),
        ("43 along the low edge", unit, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], &[(1.0, 2.0)]),
        ("43 along the high edge", unit, [-1.0, 1.0, 1.0], [1.0, 0.0, 0.0], &[]),
        ("43 through two corners", unit, [-1.0, -1.0, -1.0], [1.0, 1.0, 1.0], &[(1.0, 2.0)]),
        ("44 horn torus", "torus(major: 1, minor: 1)", [0.0; 3], [1.0, 0.0, 0.0], &[(-2.0, 2.0)]),
        ("44 spindle torus", "torus(major: 0.5, minor: 1)", [0.0; 3], [1.0, 0.0, 0.0], &[(-1.5, 1.5)]),
    ]);
}

#[test]
fn b8_b9_b10_thin_and_opposed() {
    let mut scratch = Scratch::default();
    let mut on = |text: &str, origin: DVec3, dir: DVec3| {
        ends(&spans(&shot(&format!("draw {text}")), &Ray::new(origin, dir), &mut scratch))
    };
    let (from, up) = (dvec3(0.3, 0.2, -2.0), DVec3::Z);
    assert_eq!(on("(half_space(z < 0) & half_space(z > 0))", from, up), []);
    assert_eq!(on("(half_space(z < 0) & half_space(z > 0))", dvec3(0.3, 0.2, 0.0), DVec3::X), []);
    assert_eq!(on("(half_space(z < 0) | half_space(z > 0))", from, up), [(-INF, INF)]);
    assert_eq!(on("(half_space(z < 0) | half_space(z > 0))", dvec3(0.3, 0.2, 0.0), DVec3::X), [(-INF, INF)]);
    // B9: a slab of size one is there where it is thicker than the clean-up's thickness for what is in play, on all rays.
    for j in 0..=17 {
        let width = 10f64.powi(-j);
        let text = format!("box([-1, -1, 0], [1, 1, {width:e}])");
        let mut draws = Draws::new(9);
        let counts: Vec<usize> = (0..40)
            .map(|_| on(&text, dvec3(draws.between(-0.9, 0.9), draws.between(-0.9, 0.9), -1.5), up).len())
            .collect();
        assert!(counts.iter().all(|c| *c == counts[0]), "10^-{j}: {counts:?}");
        if j <= 13 {
            assert_eq!(counts[0], 1, "10^-{j}");
        }
        if 15 < j {
            assert_eq!(counts[0], 0, "10^-{j}");
        }
    }
    // B10: a shell has two walls of its thickness, and a chord of the closed form.
    for j in 3..=13 {
        let w = 10f64.powi(-j);
        let text = format!("(sphere(r: 1) - sphere(r: {:?}))", 1.0 - w);
        let w = 1.0 - (1.0 - w);
        let walls = on(&text, dvec3(0.0, 0.0, -2.0), up);
        assert!(is_near(&walls, &[(1.0, 1.0 + w), (3.0 - w, 3.0)], 1e-14), "{j}: {walls:?}");
        let chord = on(&text, dvec3(1.0 - w, 0.0, -2.0), up);
        let half = (2.0 * w - w * w).sqrt();
        assert!(is_near(&chord, &[(2.0 - half, 2.0 + half)], 1e-14 / half), "{j}: {chord:?} {half}");
    }
}

#[test]
fn b11_b12_b15_joints_leave_neither_film_nor_crack() {
    let mut scratch = Scratch::default();
    let mut draws = Draws::new(4);
    let mut rays = |count: usize| -> Vec<Ray> {
        (0..count)
            .map(|_| {
                let [a, b] = [draws.direction(), draws.direction()];
                Ray::new(3.0 * a, 0.9 * b * draws.unit() - 3.0 * a)
            })
            .collect()
    };
    let floor = shot("draw (half_space(z < 0) | box([-1, -1, 0], [1, 1, 1]))");
    let bare = shot("draw (half_space(z < 0) - box([-1, -1, 0], [1, 1, 1]))");
    let plain = shot("draw half_space(z < 0)");
    let fit = shot(
        "draw ((box([-1, -1, -1], [1, 1, 1]) - cylinder(r: 0.5, from: [0, 0, -1], to: [0, 0, 1])) | cylinder(r: 0.5, from: [0, 0, -1], to: [0, 0, 1]))",
    );
    let block = shot("draw box([-1, -1, -1], [1, 1, 1])");
    for ray in rays(1_000_000) {
        let mut of = |shot: &Shot| ends(&spans(shot, &ray, &mut scratch));
        let (floor, bare, plain, fit, block) = (of(&floor), of(&bare), of(&plain), of(&fit), of(&block));
        assert!(floor.len() <= 2, "B11: {floor:?} {ray:?}");
        assert!(is_near(&bare, &plain, 1e-12), "B11: {bare:?} {plain:?} {ray:?}");
        assert!(is_near(&fit, &block, 1e-12), "B12: {fit:?} {block:?} {ray:?}");
    }
    // B15: sixteen cubes turned about z share both faces.
    let one = |i: u32| {
        format!(
            "box([-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]).rotate(axis: [0, 0, 1], by: {}deg)",
            5.625 * f64::from(i)
        )
    };
    let gear = shot(&format!("draw union([{}])", (0..16).map(one).collect::<Vec<_>>().join(", ")));
    for _ in 0..2000 {
        let (r, a) = (draws.between(0.0, 0.49), draws.between(0.0, 6.3));
        let list =
            ends(&spans(&gear, &Ray::new(dvec3(r * a.cos(), r * a.sin(), -2.0), DVec3::Z), &mut scratch));
        assert_eq!(list, [(1.5, 2.5)], "B15");
    }
}

/// B16, C17 and the rule of rays in faces: of two solids that share a face exactly one has a ray that runs in it, whatever
/// mirrors and turns brought them there.
#[test]
fn b16_c17_a_ray_in_a_shared_face_meets_the_union_once() {
    let mut scratch = Scratch::default();
    let (unit, left) = ("box([0, 0, 0], [1, 1, 1])", "box([-1, 0, 0], [0, 1, 1])");
    let others = [
        ("as it is", left.to_owned()),
        ("mirrored", format!("{unit}.scale([-1, 1, 1])")),
        ("mirrored twice", format!("{unit}.scale([-1, -1, 1]).move([0, 1, 0])")),
        ("turned", format!("{unit}.rotate(axis: [0, 0, 1], by: 90deg)")),
        ("turned back", format!("{unit}.rotate(axis: [0, 0, 1], by: 180deg).move([0, 1, 0])")),
        ("rounded", "box([-1, 0, 0], [0, 1, 1], round: 0.01).scale([1, 1, 1])".to_owned()),
    ];
    for (name, other) in &others {
        let union = shot(&format!("draw ({unit} | {other})"));
        let both = shot(&format!("draw ({unit} & {other})"));
        let of = |shot: &Shot, ray: &Ray, scratch: &mut Scratch| ends(&spans(shot, ray, scratch));
        for i in 1..20 {
            let ray = Ray::new(dvec3(0.0, -1.0, 0.05 * f64::from(i)), DVec3::Y);
            let list = of(&union, &ray, &mut scratch);
            let whole = is_near(&list, &[(1.0, 2.0)], 1e-9) || is_near(&list, &[(1.01, 1.99)], 1e-2);
            assert!(whole, "{name}: {list:?}");
            assert_eq!(of(&both, &ray, &mut scratch), [], "{name}");
        }
    }
    // C17: two cylinders end to end, the caps named from either side; a cone on a cylinder.
    for upper in [
        "cylinder(r: 1, from: [0, 0, 0], to: [0, 0, 1])",
        "cylinder(r: 1, from: [0, 0, 1], to: [0, 0, 0])",
        "cone(r1: 1, r2: 0.2, from: [0, 0, 0], to: [0, 0, 1])",
        "cylinder(r: 1, h: 1).scale([1, 1, -1]).rotate(axis: [1, 0, 0], by: 180deg)",
    ] {
        for lower in [
            "cylinder(r: 1, from: [0, 0, -1], to: [0, 0, 0])",
            "cylinder(r: 1, from: [0, 0, 0], to: [0, 0, -1])",
        ] {
            let union = shot(&format!("draw ({lower} | {upper})"));
            let list = ends(&spans(&union, &Ray::new(dvec3(-2.0, 0.5, 0.0), DVec3::X), &mut scratch));
            let half = 0.75f64.sqrt();
            assert!(is_near(&list, &[(2.0 - half, 2.0 + half)], 1e-9), "{lower} | {upper}: {list:?}");
        }
    }
}

/// B17: ((A - B) | B) - B and so on fifty times is A - B or A | B; no slivers gather.
#[test]
fn b17_fifty_flush_operations_are_the_last_two() {
    let mut scratch = Scratch::default();
    let (a, b) = (
        "box([-1, -1, -1], [1, 1, 1])",
        "cylinder(r: 0.5, from: [0, 0, -1], to: [0, 0, 1]).rotate(axis: [0, 0, 1], by: 30deg)",
    );
    let mut text = a.to_owned();
    for i in 0..50 {
        text = format!("({text} {} {b})", ["-", "|"][i % 2]);
        if i < 48 {
            continue;
        }
        let nested = shot(&format!("draw {text}"));
        let short = shot(&format!("draw ({a} {} {b})", ["-", "|"][i % 2]));
        let mut draws = Draws::new(17);
        for _ in 0..5000 {
            let from = 3.0 * draws.direction();
            let ray = Ray::new(from, 0.9 * draws.direction() - from);
            let [nested, short] = [&nested, &short].map(|s| ends(&spans(s, &ray, &mut scratch)));
            assert_eq!(nested, short, "{ray:?}");
        }
    }
}

/// Case 65: cutters one by one and cutters joined before are the same to the bit.
#[test]
fn case_65_a_plate_of_a_thousand_cutters_equals_one_of_their_union() {
    let holes: Vec<String> = (0..1024)
        .map(|i| format!("cylinder(r: 0.4, from: [{}, {}, -1], to: [{0}, {1}, 2])", i % 32, i / 32))
        .collect();
    let (plate, holes) = ("box([-1, -1, 0], [32, 32, 1])", holes.join(", "));
    let one = shot(&format!("draw difference({plate}, [{holes}])"));
    let two = shot(&format!("draw {plate} - union([{holes}])"));
    let (mut scratch, mut draws) = (Scratch::default(), Draws::new(65));
    let mut crossed = 0;
    for _ in 0..3000 {
        let mut at = |z: f64| dvec3(draws.between(-2.0, 33.0), draws.between(-2.0, 33.0), z);
        let (from, to) = (at(4.0), at(-4.0));
        let ray = Ray::new(from, to - from);
        let [one, two] = [&one, &two].map(|s| ends(&spans(s, &ray, &mut scratch)));
        assert_eq!(one, two, "{ray:?}");
        crossed += one.len();
    }
    assert!(1000 < crossed);
}

/// Case 71: a camera in a solid, in a cutter, and exactly on a face.
#[test]
fn case_71_where_the_eye_stands() {
    let mut scratch = Scratch::default();
    let hollow = shot("draw (box([-2, -2, -2], [2, 2, 2]) - sphere(r: 1))");
    let mut of = |x: f64| ahead(&hollow, &Ray::new(dvec3(x, 0.0, 0.0), DVec3::X), &mut scratch);
    assert_eq!(of(-1.5), [(0.0, 0.5), (2.5, 3.5)], "in the solid");
    assert_eq!(of(0.0), [(1.0, 2.0)], "in the cutter");
    assert_eq!(of(-2.0), [(0.0, 1.0), (3.0, 4.0)], "on the face, inward");
    assert_eq!(of(2.0), [], "on the face, outward");
    assert_eq!(of(1.0), [(0.0, 1.0)], "on the cut");
}
