//! Boolean cases whose volume is known in closed form, measured through the whole program from their text: rays along z on a
//! jittered grid, the lengths of their spans summed. Names and numbers are those of the list of boolean cases.

mod csg_support;

use std::f64::consts::PI;
use std::fmt::Write;

use csg_support::draws::Draws;
use csg_support::scene::{shot, spans};
use glam::DVec3;
use pss::csg::Scratch;
use pss::geom::Ray;
use rayon::prelude::*;

/// Cells along each side of the grid, two rays in each.
const SIDE: u32 = 240;

/// What is no thicker than this share of the square is a film: of what is sharp along a line, as a lens is, two rays in a
/// million cross so little.
const FILM: f64 = 1e-7;

/// What rays along z tell of a solid within a square of x and y, which has to hold it.
struct Volume {
    volume: f64,
    /// Its standard error, by what the two rays of each cell differ.
    error: f64,
    /// Spans and gaps that are films.
    films: u32,
}

/// The volume of a scene's text over the square [-half, half]^2 of x and y.
fn volume(text: &str, half: f64) -> Volume {
    let shot = shot(&format!("draw {text}"));
    let (mut scratch, mut draws) = (Scratch::default(), Draws::new(1));
    let (mut sum, mut squares, mut films) = (0.0, 0.0, 0);
    let cell = 2.0 * half / f64::from(SIDE);
    for i in 0..SIDE * SIDE {
        let [a, b] = [(); 2].map(|()| {
            let [x, y] = [i % SIDE, i / SIDE].map(|k| (f64::from(k) + draws.unit()) * cell - half);
            let ray = Ray::new(DVec3::new(x, y, -2.0 * half), DVec3::Z);
            let spans = spans(&shot, &ray, &mut scratch);
            let ends: Vec<f64> = spans.iter().flat_map(|s| [s.interval().lo, s.interval().hi]).collect();
            films += ends.windows(2).filter(|w| w[1] - w[0] < FILM * half).count() as u32;
            spans.iter().map(|s| s.interval().length()).sum::<f64>()
        });
        sum += 0.5 * (a + b);
        squares += 0.25 * (a - b) * (a - b);
    }
    let area = cell * cell;
    Volume { volume: sum * area, error: squares.sqrt() * area, films }
}

/// Within five of its own standard errors, and a rounding where every ray of a cell tells the same. All that are wrong are
/// told.
fn check(cases: &[(&str, &str, f64, f64)]) {
    let wrong: Vec<String> = cases
        .par_iter()
        .filter_map(|(name, text, half, want)| {
            let Volume { volume: have, error, films } = volume(text, *half);
            let off = (have - want).abs();
            println!("{name}: {have} of {want}, off by {:.1} of {error:.1e}", off / error);
            let right = off <= 5.0 * error + 1e-11 * half.powi(3) && films == 0;
            (!right).then(|| format!("{name}: {have} +- {error}, not {want}; {films} films"))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn b13_cases_21_to_33_coincident_faces_leave_the_volume_exact() {
    let cube = "box([-1, -1, -1], [1, 1, 1])";
    let c = |x: f64| format!("box([{x}, {x}, 0], [{}, {}, 1])", x + 1.0, x + 1.0);
    let multi = format!("(({} - {}) - {})", c(0.0), c(0.3), c(-0.3));
    let through = format!("({cube} - cylinder(r: 0.5, from: [0, 0, -1], to: [0, 0, 1]))");
    let turned = format!("{through}.rotate(axis: [0, 0, 1], by: 30deg)");
    let boxed = format!("({cube} - box([-0.5, -0.5, -1], [0.5, 0.5, 1]))");
    let protruding = format!("({cube} - box([-0.5, -0.5, -1.0000003], [0.5, 0.5, 1.0000003]))");
    let ring = "(cylinder(r: 1, h: 2) - cylinder(r: 0.5, h: 2)).rotate(axis: [0, 0, 1], by: 185deg)";
    let slab = "box([0, 0, 0], [200, 200, 100])";
    let joined = format!("(({slab} | box([100, 0, 0], [400, 200, 100])) - {slab})");
    check(&[
        ("21 full-height cylinder", &through, 1.5, 8.0 - PI / 2.0),
        ("22 two caps flush", &boxed, 1.5, 6.0),
        ("23 three faces flush", "(box([0, 0, 0], [1, 1, 1]) - box([0.5, 0.5, 0.5], [1, 1, 1]))", 1.5, 0.875),
        ("25 abutting, joined", "(box([0, 0, 0], [1, 1, 1]) | box([-1, 0, 0], [0, 1, 1]))", 1.5, 2.0),
        ("25 abutting, cut", "(box([0, 0, 0], [1, 1, 1]) & box([-1, 0, 0], [0, 1, 1]))", 1.5, 0.0),
        (
            "26 stacked cutters",
            "(box([-1, -1, 0], [1, 1, 2]) - (box([-0.5, -0.5, 0], [0.5, 0.5, 1]) | box([-0.5, -0.5, 1], [0.5, 0.5, 2])))",
            1.5,
            6.0,
        ),
        ("27 (A|P)-A", &joined, 400.0, 4e6),
        ("28 protruding by 3e-7", &protruding, 1.5, 6.0),
        ("29 turned by 30 degrees", &turned, 1.5, 8.0 - PI / 2.0),
        ("31 caps shared, turned", ring, 1.5, 1.5 * PI),
        ("32, B5 multi-coplanar", &multi, 1.5, 0.18),
        ("33 opposite faces", "(box([0, 0, 0], [1, 1, 1]) ^ box([0, 0, 1], [1, 1, 1.5]))", 1.5, 1.5),
        ("B13 line contact", "(box([-1, -1, 0], [1, 1, 1]) - cylinder(r: 1, h: 1))", 1.5, 4.0 - PI),
    ]);
}

#[test]
fn cases_36_to_46_what_only_touches_adds_and_takes_nothing() {
    let torus = 2.0 * PI * PI * 0.0625;
    let ball = 4.0 / 3.0 * PI;
    let viviani = 8.0 * (2.0 * PI / 3.0 - 8.0 / 9.0);
    let post = "cylinder(r: 1, from: [1, 0, -3], to: [1, 0, 3])";
    let [and, minus, or] = ["&", "-", "|"].map(|op| format!("(sphere(r: 2) {op} {post})"));
    check(&[
        ("36 balls, joined", "(sphere(r: 1, at: [-1, 0, 0]) | sphere(r: 1, at: [1, 0, 0]))", 2.0, 2.0 * ball),
        ("36 balls, cut", "(sphere(r: 1, at: [-1, 0, 0]) & sphere(r: 1, at: [1, 0, 0]))", 2.0, 0.0),
        ("37 inner ball", "(sphere(r: 2) - sphere(r: 1, at: [1, 0, 0]))", 2.0, 28.0 * PI / 3.0),
        ("38 Viviani, cut", &and, 3.0, viviani),
        ("38 Viviani, taken away", &minus, 3.0, 8.0 * ball - viviani),
        ("38 Viviani, joined", &or, 3.0, 8.0 * ball + 6.0 * PI - viviani),
        (
            "39 outer equator",
            "(torus(major: 1, minor: 0.25) & cylinder(r: 1.25, from: [0, 0, -1], to: [0, 0, 1]))",
            1.5,
            torus,
        ),
        (
            "39 inner equator",
            "(torus(major: 1, minor: 0.25) - cylinder(r: 0.75, from: [0, 0, -1], to: [0, 0, 1]))",
            1.5,
            torus,
        ),
        ("40 edges touch", "(box([0, 0, 0], [1, 1, 1]) & box([-1, -1, 0], [0, 0, 1]))", 1.5, 0.0),
        ("40 corners touch", "(box([0, 0, 0], [1, 1, 1]) | box([-1, -1, -1], [0, 0, 0]))", 1.5, 2.0),
        ("46 on a plane", "(cylinder(r: 1, from: [-1, 0, 1], to: [1, 0, 1]) & half_space(z < 0))", 1.5, 0.0),
    ]);
}

/// A cube of edge 1 without the holes of `levels` levels.
fn sponge(levels: u32) -> String {
    let mut holes = Vec::new();
    for level in 1..=levels {
        let count = 3u32.pow(level - 1);
        let size = 1.0 / f64::from(3u32.pow(level));
        let at = |i: u32| (f64::from(3 * i + 1) * size, f64::from(3 * i + 2) * size);
        for i in 0..count * count {
            let ((a, b), (c, d)) = (at(i % count), at(i / count));
            holes.push(format!("box([{a:?}, {c:?}, -1], [{b:?}, {d:?}, 2])"));
            holes.push(format!("box([{a:?}, -1, {c:?}], [{b:?}, 2, {d:?}])"));
            holes.push(format!("box([-1, {a:?}, {c:?}], [2, {b:?}, {d:?}])"));
        }
    }
    format!("(difference(box([0, 0, 0], [1, 1, 1]), [{}]))", holes.join(", "))
}

#[test]
fn cases_47_to_58_known_volumes_and_nests() {
    let ball = 4.0 / 3.0 * PI;
    let [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|[x, y, z]| {
        format!(
            "cylinder(r: 1, from: [{}, {}, {}], to: [{}, {}, {}])",
            -2 * x,
            -2 * y,
            -2 * z,
            2 * x,
            2 * y,
            2 * z
        )
    });
    let shell = |i: u32| 1.0 - f64::from(i) / 64.0;
    let mut onion = format!("sphere(r: {:?})", shell(63));
    for i in (0..63).rev() {
        onion = format!("(sphere(r: {:?}) - {onion})", shell(i));
    }
    let onion_volume: f64 = (0..64).map(|i| if i % 2 == 0 { ball } else { -ball } * shell(i).powi(3)).sum();
    let squares = |half: f64| {
        let one = |i: u32| {
            format!(
                "box([-{half}, -{half}, 0], [{half}, {half}, 1]).rotate(axis: [0, 0, 1], by: {:?}deg)",
                5.625 * f64::from(i)
            )
        };
        format!("union([{}])", (0..16).map(one).collect::<Vec<_>>().join(", "))
    };
    // Between two neighbouring corners the outline is a / cos(45 degrees - phi), phi from a corner.
    let star = 64.0 * (1.0 - (PI / 4.0 - 5.625f64.to_radians() / 2.0).tan());
    let gear = format!("(difference({}, [{}]))", squares(1.0), squares(0.9));
    let (mut spiral, mut at, mut step, mut left) = (String::new(), [0i32, 0], [1i32, 0], 1);
    let mut run = 1;
    for _ in 0..120 {
        let [x, y] = at.map(|c| 0.1 * f64::from(c));
        write!(spiral, "box([{x:?}, {y:?}, 0], [{:?}, {:?}, 0.1]), ", x + 0.1, y + 0.1).unwrap();
        at = [at[0] + step[0], at[1] + step[1]];
        left -= 1;
        if left == 0 {
            step = [-step[1], step[0]];
            run += i32::from(step[1] == 0);
            left = run;
        }
    }
    // A ball less its six caps, less three bores: each alone, pairs counted twice, all three thrice.
    let bores = [&x, &y, &z].map(|c| c.replace("r: 1", "r: 0.5")).join(", ");
    let rounded = format!("(box(size: 2) & sphere(r: 1.25) & !union([{bores}]))");
    let caps = 6.0 * PI * 0.25f64.powi(2) * (3.0 * 1.25 - 0.25) / 3.0;
    let bores = 6.0 * PI * 0.25 - 16.0 * 0.125 + 8.0 * (2.0 - 2f64.sqrt()) * 0.125;
    check(&[
        ("47 lens", "(sphere(r: 1) & sphere(r: 1, at: [1, 0, 0]))", 1.5, 5.0 * PI / 12.0),
        ("48 two cylinders", &format!("({x} & {z})"), 1.5, 16.0 / 3.0),
        ("48 three cylinders", &format!("({x} & {y} & {z})"), 1.5, 8.0 * (2.0 - 2f64.sqrt())),
        (
            "49 napkin ring",
            "(sphere(r: 1) - cylinder(r: 0.8, from: [0, 0, -2], to: [0, 0, 2]))",
            1.5,
            PI * 1.2f64.powi(3) / 6.0,
        ),
        ("51 onion of 64 shells", &onion, 1.5, onion_volume),
        ("52 Menger sponge", &sponge(3), 1.5, (20.0f64 / 27.0).powi(3)),
        ("54 vug", "(box([-1, -1, -1], [1, 1, 1]) - sphere(r: 0.5))", 1.5, 8.0 - ball / 8.0),
        (
            "55 window frame",
            "difference(box([-1, -1, 0], [1, 1, 0.5]), [box([-0.8, -0.8, -1], [-0.1, 0.8, 1]), box([0.1, -0.8, -1], [0.8, 0.8, 1])])",
            1.5,
            0.5 * (4.0 - 2.0 * 0.7 * 1.6),
        ),
        ("56 gear without a smaller one", &gear, 1.5, star * (1.0 - 0.81)),
        ("57 spiral of touching cubes", &format!("union([{}])", spiral.trim_end_matches(", ")), 1.5, 0.12),
        ("58 rounded cube, bored", &rounded, 1.5, ball * 1.25f64.powi(3) - caps - bores),
    ]);
}

/// Boxes of 1, 2 and 4: every expression has the volume that the bits of its operands have.
#[test]
fn case_50_boxes_of_powers_of_two_do_the_arithmetic_of_bits() {
    let boxes = [
        (1, "box([0, 0, 0], [1, 1, 1])"),
        (2, "box([-2, 0, 0], [0, 1, 1])"),
        (4, "box([-2, -2, 0], [2, 0, 0.5])"),
    ];
    let mut draws = Draws::new(50);
    for _ in 0..40 {
        let (mut bits, mut text) =
            (0u32, String::from("box([0, 0, 0], [1, 1, 1]) - box([0, 0, 0], [1, 1, 1])"));
        for _ in 0..6 {
            let (bit, solid) = draws.pick(&boxes);
            let op = draws.pick(&["|", "&", "-", "^"]);
            text = format!("({text}) {op} {solid}");
            bits = match op {
                "|" => bits | bit,
                "&" => bits & bit,
                "-" => bits & !bit,
                _ => bits ^ bit,
            };
        }
        check(&[(&text, &format!("({text})"), 2.5, f64::from(bits))]);
    }
}

#[test]
fn cases_61_to_70_maps_and_structure() {
    let half = "(sphere(r: 1) - half_space(z < 0))";
    let bitten = "(box([0, 0, 0], [1, 1, 1]) - sphere(r: 0.5))";
    let bite = 1.0 - PI / 48.0;
    let near: Vec<String> = (0..10)
        .map(|i| format!("sphere(r: 1, at: [{:e}, 0, 0])", f64::from(i) * f64::EPSILON / 10.0))
        .collect();
    check(&[
        ("61 mirrored", &format!("{bitten}.scale([-1, 1, 1])"), 1.5, bite),
        ("62 scaled apart", &format!("{half}.scale([0.5, 1, 1.2])"), 1.5, 2.0 / 3.0 * PI * 0.6),
        (
            "62 sheared",
            &format!("{half}.matrix([[1, 0.5, 0.2, 0], [0, 1, 0, 0], [0, 0, 0.8, 0]])"),
            2.0,
            2.0 / 3.0 * PI * 0.8,
        ),
        ("66 near-coincident copies", &format!("union([{}])", near.join(", ")), 1.5, 4.0 / 3.0 * PI),
        ("67 no cutters", "difference(sphere(r: 1), [])", 1.5, 4.0 / 3.0 * PI),
        ("67 one child", "union([sphere(r: 1)])", 1.5, 4.0 / 3.0 * PI),
        ("67 empty first child", "((sphere(r: 1) - sphere(r: 1)) - box([0, 0, 0], [1, 1, 1]))", 1.5, 0.0),
        ("68 cutter outside", "(sphere(r: 1) - box([5, 5, 5], [6, 6, 6]))", 1.5, 4.0 / 3.0 * PI),
        ("69 base inside the cutter", "(sphere(r: 1) - box([-2, -2, -2], [2, 2, 2]))", 1.5, 0.0),
        ("70 finite part of a half-space", "(half_space(z < 0) & box([-1, -1, -1], [1, 1, 1]))", 1.5, 4.0),
    ]);
}

/// Volume and area of solids with faces along the axes and edges at multiples of 0.1 within [-1, 2]^3, and the most spans on
/// one ray: rays along each axis through the middles of a grid that the edges run along count both exactly.
fn measures(text: &str, per_tenth: u32) -> (f64, f64, usize) {
    let shot = shot(&format!("draw {text}"));
    let (mut scratch, mut volume, mut ends, mut most) = (Scratch::default(), 0.0, 0, 0);
    let side = 30 * per_tenth;
    let cell = 3.0 / f64::from(side);
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|k| DVec3::AXES[k]);
        for i in 0..side * side {
            let [x, y] = [i % side, i / side].map(|k| (f64::from(k) + 0.5) * cell - 1.0);
            let ray = Ray::new(x * u + y * v - 3.0 * DVec3::AXES[axis], DVec3::AXES[axis]);
            let spans = spans(&shot, &ray, &mut scratch);
            volume += spans.iter().map(|s| s.interval().length()).sum::<f64>();
            ends += 2 * spans.len();
            most = most.max(spans.len());
        }
    }
    (volume * cell * cell / 3.0, ends as f64 * cell * cell, most)
}

/// The areas too, and, over a million rays, no wall inside a union: what volumes cannot tell.
#[test]
fn b3_b4_b5_areas_are_exact_and_no_wall_is_inside() {
    let cubes =
        |at: &str| format!("(box([0, 0, 0], [1, 1, 1]) | box(size: 1).move({at}).move([0.5, 0.5, 0.5]))");
    let corners = "(box([0, 0, 0], [1, 1, 1]) - box([0.3, 0.3, 0], [1.3, 1.3, 1]) - box([-0.3, -0.3, 0], [0.7, 0.7, 1]))";
    let solids = [
        ("B3, a face", "(box([0, 0, 0], [1, 1, 1]) | box([1, 0, 0], [2, 1, 1]))", 20, 2.0, 10.0),
        ("B4, an edge", &cubes("[1, 1, 0]"), 3, 2.0, 12.0),
        ("B4, a corner", &cubes("[1, 1, 1]"), 3, 2.0, 12.0),
        ("B5", corners, 3, 0.18, 2.76),
    ];
    for (name, text, per_tenth, volume, area) in solids {
        let have = measures(text, per_tenth);
        assert!((have.0 - volume).abs() < 1e-9 && (have.1 - area).abs() < 1e-9, "{name}: {have:?}");
        assert_eq!(have.2, 1, "{name}: spans on a ray");
    }
}
