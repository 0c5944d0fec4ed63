//! Part B of the numerical stress list in 64 rotations and at four distances from the origin, each case by its number: on
//! every ray what the scene at rest has there, whose truth other tests tell (`csg_rays`, `csg_contacts`, `csg_volumes`,
//! `stress_b`). A film, a crack or a lost wall is another number of spans.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::frames::{OFFSETS, TURNS, frame, through};
use csg_support::scene::{ends, shot};
use glam::DVec3;
use pss::csg::Scratch;
use pss::geom::Ray;
use pss::shot::Shot;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

type Ends = Vec<[f64; 2]>;

/// The scenes of the list, by their numbers.
fn scenes() -> Vec<(String, String)> {
    let cube = "box([-1, -1, -1], [1, 1, 1])";
    let peg = "cylinder(r: 0.5, from: [0, 0, -1], to: [0, 0, 1])";
    let small = "box([-1, -1, -1], [0, 0, 0])";
    let gear: Vec<String> =
        (0..16).map(|i| format!("box(size: 1).rotate_z({}deg)", 5.625 * f64::from(i))).collect();
    let mut nested = cube.to_owned();
    for i in 0..50 {
        nested = format!("({nested} {} {peg})", ["-", "|"][i % 2]);
    }
    let corners =
        "box([0, 0, 0], [1, 1, 1]) - box([0.3, 0.3, 0], [1.3, 1.3, 1]) - box([-0.3, -0.3, 0], [0.7, 0.7, 1])";
    let mut all: Vec<(String, String)> = [
        ("B1", format!("{cube} - {peg}")),
        ("B2", format!("{cube} - cylinder(r: 0.5, from: [0, 0, 0], to: [0, 0, 1])")),
        ("B3", "box([0, 0, 0], [1, 1, 1]) | box([1, 0, 0], [2, 1, 1])".to_owned()),
        ("B4, an edge", format!("{small} | {small}.move([1, 1, 0])")),
        ("B4, a corner", format!("{small} | {small}.move([1, 1, 1])")),
        ("B5", corners.to_owned()),
        ("B7", "sphere(r: 2) ^ sphere(r: 1).scale(2)".to_owned()),
        ("B7, joined", "sphere(r: 2) | sphere(r: 1).scale(2)".to_owned()),
        ("B8", "half_space(z < 0) & half_space(z > 0)".to_owned()),
        ("B8, boxes", format!("{small} & {small}.move([1, 0, 0])")),
        ("B10", "sphere(r: 1) - sphere(r: 0.999)".to_owned()),
        ("B10, thin", "sphere(r: 1) - sphere(r: 0.99999)".to_owned()),
        ("B11", "half_space(z < 0) | box([-1, -1, 0], [1, 1, 1])".to_owned()),
        ("B11, cut", "half_space(z < 0) - box([-1, -1, 0], [1, 1, 1])".to_owned()),
        ("B12", format!("({cube} - {peg}) | {peg}")),
        ("B13", "box([-1, -1, 0], [1, 1, 1]) - cylinder(r: 1, h: 1)".to_owned()),
        ("B14, 0.1", format!("{cube} ^ {cube}.rotate(axis: [0, 0, 1], by: 0.1rad)")),
        ("B14, 0.001", format!("{cube} ^ {cube}.rotate(axis: [0, 0, 1], by: 0.001rad)")),
        ("B15", format!("union([{}])", gear.join(", "))),
        ("B16", "box([0, -1, -1], [1, 1, 1]) | box([-1, -1, -1], [0, 1, 1])".to_owned()),
        ("B17", nested),
    ]
    .map(|(name, text)| (name.to_owned(), text))
    .into();
    // B6: faces shared by all three.
    let [x, y, z] = [
        "box([0, 0, 0], [1, 1, 1])",
        "box([0.25, -0.5, 0], [1, 0.75, 0.5])",
        "box([0.25, 0, -0.5], [0.75, 1, 0.5])",
    ];
    for (one, two) in
        ["|", "&", "-", "^"].into_iter().flat_map(|one| ["|", "&", "-", "^"].map(|two| (one, two)))
    {
        all.push((format!("B6, {one} {two}, left"), format!("({x} {one} {y}) {two} {z}")));
        all.push((format!("B6, {one} {two}, right"), format!("{x} {one} ({y} {two} {z})")));
    }
    all
}

/// Rays that are tried at rest, and how many of them in each frame.
const KNOWN: usize = 400;
const EACH: usize = 16;

/// Two points of a ray, what it meets at rest, and how far a shift moves that.
type Known = ([DVec3; 2], Ends, f64);

/// Rays at rest whose answers a shift by `by` changes a little, but not in number. `in_face` has some of them run in the
/// plane of x = 0: a face that two boxes share is inside their union. (Inside the intersection of two a ray can be there,
/// where turns bring one face a rounding beyond the other: such a film has no thickness that a ray in it could tell.)
fn known(at_rest: &Shot, by: f64, in_face: bool) -> Vec<Known> {
    let (mut draws, mut scratch) = (Draws::new(3), Scratch::default());
    let mut rays = Vec::new();
    for i in 0..KNOWN {
        let mut from = 3.0 * draws.direction();
        let mut to = 1.2 * draws.unit() * draws.direction() + if i % 2 == 0 { 0.25 } else { 0.0 };
        if in_face && i % 4 == 0 {
            (from.x, to.x) = (0.0, 0.0);
        }
        let of =
            |shift: DVec3, scratch: &mut Scratch| ends(at_rest, &Ray::new(from + shift, to - from), scratch);
        let want = of(DVec3::ZERO, &mut scratch);
        let shifted: Vec<Ends> =
            DVec3::AXES.iter().flat_map(|a| [by * *a, -by * *a]).map(|s| of(s, &mut scratch)).collect();
        if shifted.iter().any(|s| s.len() != want.len()) {
            continue;
        }
        let off = |s: &Ends| {
            let pairs = s.iter().flatten().zip(want.iter().flatten());
            pairs.map(|(a, b)| if a == b { 0.0 } else { (a - b).abs() }).fold(0.0, f64::max)
        };
        let most = shifted.iter().map(off).fold(0.0, f64::max);
        if 1e3 * by < most {
            continue;
        }
        rays.push(([from, to], want, 2.0 * most + by));
    }
    rays
}

#[test]
fn b1_to_b17_every_case_is_the_same_in_every_frame() {
    let compared = AtomicUsize::new(0);
    let wrong: Vec<String> = scenes()
        .par_iter()
        .flat_map_iter(|(name, text)| {
            let at_rest = shot(&format!("draw {text}"));
            let mut scratch = Scratch::default();
            let mut wrong = Vec::new();
            for offset in OFFSETS {
                // What rounding makes of places so far away, and of turns.
                let known = known(&at_rest, 64.0 * f64::EPSILON * (4.0 + offset), name == "B16");
                assert!(KNOWN / 2 < known.len(), "{name}: {} rays tell at {offset}", known.len());
                for turn in 0..TURNS {
                    let (place, map) = frame(turn, offset);
                    let moved = shot(&format!("draw ({text}){place}"));
                    let some = known.iter().cycle().skip(turn as usize * EACH).take(EACH);
                    for ([from, to], want, error) in some {
                        compared.fetch_add(1, Ordering::Relaxed);
                        let have = ends(&moved, &through(&map, *from, *to), &mut scratch);
                        let near = |(a, b): (&f64, &f64)| a == b || (a - b).abs() <= *error;
                        let pairs = have.iter().flatten().zip(want.iter().flatten());
                        if have.len() != want.len() || !pairs.into_iter().all(near) {
                            wrong.push(format!("{name} at {offset}, turn {turn}: {have:?}, not {want:?} +- {error:e} from {from} to {to}"));
                        }
                    }
                }
            }
            wrong
        })
        .collect();
    assert!(wrong.is_empty(), "{} wrong of {compared:?}, the first:\n{}", wrong.len(), wrong[0]);
}

/// B9: a slab of thickness 10^-j is there where that is more than the clean-up's thickness for the lengths in play, in
/// every frame, on all rays or on none.
#[test]
fn b9_a_slab_is_there_on_all_rays_or_on_none() {
    let cases: Vec<(u64, f64)> = (0..TURNS).flat_map(|turn| OFFSETS.map(|offset| (turn, offset))).collect();
    cases.into_par_iter().for_each(|(turn, offset)| {
        let (place, map) = frame(turn, offset);
        let (mut scratch, mut draws) = (Scratch::default(), Draws::new(turn + 9));
        for j in 0..=17 {
            let width = 10f64.powi(-j);
            let slab = shot(&format!("draw box([-1, -1, 0], [1, 1, {width:e}]){place}"));
            // 16 eps of the largest length, which is that of the ray's beginning, or of the slab's place.
            let tau = |from: DVec3| 16.0 * f64::EPSILON * map.transform_point3(from).length().max(1.0);
            for _ in 0..12 {
                let [x, y] = [(); 2].map(|()| draws.between(-0.9, 0.9));
                let from = DVec3::new(x, y, 2.0);
                let count =
                    ends(&slab, &through(&map, from, DVec3::new(0.9 * y, 0.9 * x, -2.0)), &mut scratch).len();
                if 3.0 * tau(from) < width {
                    assert_eq!(count, 1, "10^-{j} in {place}");
                } else if width < 0.2 * tau(from) {
                    assert_eq!(count, 0, "10^-{j} in {place}");
                }
            }
        }
    });
}

/// B7: a ball less the same ball by another route shows nothing in a hundred views: of 64 pixels a side, of 1,024 with
/// `PSS_LONG=1`.
#[test]
fn b7_a_hundred_views_of_a_ball_less_itself_show_nothing() {
    let side = if std::env::var_os("PSS_LONG").is_some() { 1024 } else { 64 };
    let nothing = ["a - b", "b - a", "a ^ b"]
        .map(|e| shot(&format!("let a = sphere(r: 2)\nlet b = sphere(r: 1).scale(2)\ndraw {e}")));
    let lit: usize = (0..100u64)
        .into_par_iter()
        .map(|view| {
            let (mut draws, mut scratch, mut lit) = (Draws::new(view + 7), Scratch::default(), 0);
            let eye = draws.between(2.5, 9.0) * draws.direction();
            let (u, v) = eye.normalize().any_orthonormal_pair();
            for i in 0..side * side {
                let [x, y] = [i % side, i / side].map(|k| (f64::from(k) + 0.5) / f64::from(side) * 5.0 - 2.5);
                let ray = Ray::new(eye, x * u + y * v - eye);
                lit += nothing.iter().filter(|s| !ends(s, &ray, &mut scratch).is_empty()).count();
            }
            lit
        })
        .sum();
    assert_eq!(lit, 0);
}
