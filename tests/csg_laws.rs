//! The laws of sets on random trees over random leaves: two expressions that say the same give the same spans to the bit,
//! a hundred thousand rays each. Numbers are those of the list of laws.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::forest;
use csg_support::scene::{shot, spans as drawn};
use glam::{DAffine3, DQuat};
use pss::csg::{Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Interval, Placement, Ray};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

const TREES: u64 = 200;
const RAYS: usize = 500;

/// Spans of the line as places, and what is told of them.
fn places(object: &Object, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Vec<[Option<f64>; 2]> {
    let mut out = Spans::new();
    object.spans(ray, range, scratch, &mut out);
    out.iter().map(|s| [s.enter, s.exit].map(|end| end.map(|b| b.t))).collect()
}

/// Random leaves, an expression, and the coordinates in play.
fn tree(draws: &mut Draws) -> (Vec<Leaf>, Expr, Vec<f64>) {
    let mut earlier = Vec::new();
    let count = 1 + draws.below(8);
    let leaves = (0..count).map(|i| forest::leaf(draws, &mut earlier, i as u64)).collect();
    let depth = 1 + draws.below(6);
    (leaves, forest::expr(draws, count, depth), earlier)
}

type Law = (&'static str, Expr, Expr);

fn laws(a: &Expr, b: &Expr, c: &Expr) -> Vec<Law> {
    let or = |a: &Expr, b: &Expr| Expr::Or(vec![a.clone(), b.clone()]);
    let and = |a: &Expr, b: &Expr| Expr::And(vec![a.clone(), b.clone()]);
    let xor = |a: &Expr, b: &Expr| Expr::Xor(vec![a.clone(), b.clone()]);
    let not = |a: &Expr| Expr::Not(Box::new(a.clone()));
    let minus = |a: &Expr, b: &Expr| and(a, &not(b));
    let none = Expr::Or(Vec::new());
    vec![
        ("82 De Morgan |", not(&or(a, b)), and(&not(a), &not(b))),
        ("82 De Morgan &", not(&and(a, b)), or(&not(a), &not(b))),
        ("84 xor", xor(a, b), minus(&or(a, b), &and(a, b))),
        ("84 xor, apart", xor(a, b), or(&minus(a, b), &minus(b, a))),
        ("85 | commutes", or(a, b), or(b, a)),
        ("85 & commutes", and(a, b), and(b, a)),
        ("85 ^ commutes", xor(a, b), xor(b, a)),
        ("85 | associates", or(&or(a, b), c), or(a, &or(b, c))),
        ("85 & associates", and(&and(a, b), c), and(a, &and(b, c))),
        ("85 ^ associates", xor(&xor(a, b), c), xor(a, &xor(b, c))),
        ("85 & distributes over |", and(a, &or(b, c)), or(&and(a, b), &and(a, c))),
        ("85 | distributes over &", or(a, &and(b, c)), and(&or(a, b), &or(a, c))),
        ("85 & distributes over ^", and(a, &xor(b, c)), xor(&and(a, b), &and(a, c))),
        ("85 | absorbs &", or(a, &and(a, b)), a.clone()),
        ("85 & absorbs |", and(a, &or(a, b)), a.clone()),
        ("85 A | A", or(a, a), a.clone()),
        ("85 A & A", and(a, a), a.clone()),
        ("86 !!A", not(&not(a)), a.clone()),
        ("A5 A-(B|C)", minus(a, &or(b, c)), minus(&minus(a, b), c)),
        ("A5 A-(B&C)", minus(a, &and(b, c)), or(&minus(a, b), &minus(a, c))),
        ("A5 A-(B-C)", minus(a, &minus(b, c)), or(&minus(a, b), &and(a, c))),
        ("A5 (A-B)|(A&B)", or(&minus(a, b), &and(a, b)), a.clone()),
        ("A5 (A-B)|B", or(&minus(a, b), b), or(a, b)),
        ("A1 A-A", minus(a, a), none.clone()),
        ("A2 A^A", xor(a, a), none),
    ]
}

#[test]
fn law_82_84_to_86_the_laws_of_sets_hold_to_the_bit() {
    let met = AtomicU64::new(0);
    (0..TREES).into_par_iter().for_each(|seed| {
        let (mut draws, mut scratch) = (Draws::new(seed ^ 0x1a35), Scratch::default());
        let mut earlier = Vec::new();
        let count = 2 + draws.below(5);
        let leaves: Vec<Leaf> =
            (0..count).map(|i| forest::leaf(&mut draws, &mut earlier, i as u64)).collect();
        let [a, b, c] = std::array::from_fn(|_| forest::expr(&mut draws, count, 3));
        let sides = |(name, l, r): Law| (name, [l, r].map(|e| Object::new(leaves.clone(), &e)));
        let objects: Vec<_> = laws(&a, &b, &c).into_iter().map(sides).collect();
        for _ in 0..RAYS {
            let ray = forest::ray(&mut draws, &mut earlier);
            for (name, sides) in &objects {
                let [l, r] = sides.each_ref().map(|o| places(o, &ray, Interval::ALL, &mut scratch));
                met.fetch_add(u64::from(!l.is_empty()), Ordering::Relaxed);
                assert_eq!(l, r, "{name} {seed} {ray:?} {a:?} {b:?} {c:?}");
            }
        }
    });
    assert!(TREES * RAYS as u64 * 5 < met.into_inner(), "too few rays met anything");
}

/// A random solid as a text.
fn text(draws: &mut Draws, depth: usize) -> String {
    if depth == 0 || draws.chance(0.2) {
        let mut small = || draws.below(5) as f64 * 0.5 - 1.0;
        let [x, y, z] = [small(), small(), small()];
        return match draws.below(5) {
            0 => format!("sphere(r: {}, at: [{x}, {y}, {z}])", draws.pick(&[0.5, 1.0, 1.5])),
            1 => format!("cylinder(r: 0.5, from: [{x}, {y}, {z}], to: [{x}, {y}, {}])", z + 1.0),
            2 => format!("half_space(z < {z})"),
            3 => format!("torus(major: 1, minor: 0.25).move([{x}, {y}, {z}])"),
            _ => format!("box([{x}, {y}, {z}], [{}, {}, {}])", x + 1.0, y + 1.5, z + 1.0),
        };
    }
    let [a, b] = [text(draws, depth - 1), text(draws, depth - 1)];
    match draws.below(5) {
        0 => format!("!({a})"),
        1 => format!("({a} - {b}).rotate_z({}deg)", draws.pick(&[30, 90])),
        n => format!("({a} {} {b})", ["|", "&", "^"][n - 2]),
    }
}

/// In the language `a - b` is `a & !b`, to the bit and with the same owners.
#[test]
fn law_83_a_difference_is_the_intersection_with_the_complement() {
    let met = AtomicU64::new(0);
    (0..TREES).into_par_iter().for_each(|seed| {
        let (mut draws, mut scratch) = (Draws::new(seed ^ 0x83), Scratch::default());
        let (a, b) = (text(&mut draws, 3), text(&mut draws, 3));
        let setting = format!("let a = {a}\nlet b = {b}\n");
        let sides = ["a - b", "a & !b"].map(|e| shot(&format!("{setting}draw {e}")));
        let mut earlier = Vec::new();
        for _ in 0..RAYS {
            let ray = forest::ray(&mut draws, &mut earlier);
            let [l, r] = sides.each_ref().map(|shot| {
                let list = drawn(shot, &ray, &mut scratch);
                let end = |b: pss::csg::Boundary| (b.t, b.leaf, b.flipped, b.normal.to_array());
                list.iter().map(|s| [s.enter.map(end), s.exit.map(end)]).collect::<Vec<_>>()
            });
            met.fetch_add(u64::from(!l.is_empty()), Ordering::Relaxed);
            assert_eq!(l, r, "{seed} {ray:?}\n{setting}");
        }
    });
    assert!(TREES * RAYS as u64 / 5 < met.into_inner(), "too few rays met anything");
}

/// An object moved and turned has the spans of the object at rest for the ray moved back, to rounding.
#[test]
fn law_87_moving_an_object_moves_its_spans() {
    let compared = AtomicU64::new(0);
    (0..TREES).into_par_iter().for_each(|seed| {
        let (mut draws, mut scratch) = (Draws::new(seed ^ 0x87), Scratch::default());
        let (leaves, expr, mut earlier) = tree(&mut draws);
        let map = DAffine3::from_rotation_translation(
            DQuat::from_axis_angle(draws.direction(), draws.between(0.0, 3.0)),
            3.0 * draws.direction(),
        );
        let moved = leaves.iter().map(|leaf| {
            let place = Placement::new(map * leaf.place.world_from_local).unwrap();
            Leaf { solid: leaf.solid.clone(), rank: leaf.rank, ..Leaf::new(leaf.solid.clone(), place) }
        });
        let (moved, plain) = (Object::new(moved.collect(), &expr), Object::new(leaves, &expr));
        for _ in 0..RAYS {
            // Not along anything, so that no ray runs in a face.
            let from = draws.vector(&mut earlier);
            let ray = Ray::new(from + draws.direction(), draws.direction());
            let t = |list: Vec<[Option<f64>; 2]>| list.into_iter().flatten().flatten().collect::<Vec<f64>>();
            let want = t(places(&plain, &ray, Interval::ALL, &mut scratch));
            let have = t(places(&moved, &ray.transformed(&map), Interval::ALL, &mut scratch));
            // What is about as thin as the clean-up's own thickness may be there or not.
            if [&want, &have].into_iter().any(|ends| ends.windows(2).any(|w| w[1] - w[0] < 1e-6)) {
                continue;
            }
            compared.fetch_add(1, Ordering::Relaxed);
            assert_eq!(have.len(), want.len(), "{seed} {ray:?} {have:?} {want:?}");
            for (a, b) in have.iter().zip(&want) {
                assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{seed} {ray:?} {have:?} {want:?}");
            }
        }
    });
    let compared = compared.into_inner();
    assert!(TREES * RAYS as u64 * 3 / 4 < compared, "only {compared} rays could be compared");
}

/// On every ray the lengths of A and B together are those of A | B and A & B together.
#[test]
fn law_92_lengths_of_union_and_intersection_are_those_of_both() {
    let met = AtomicU64::new(0);
    (0..TREES).into_par_iter().for_each(|seed| {
        let (mut draws, mut scratch) = (Draws::new(seed ^ 0x92), Scratch::default());
        let (leaves, a, mut earlier) = tree(&mut draws);
        let b = forest::expr(&mut draws, leaves.len(), 3);
        let both = || vec![a.clone(), b.clone()];
        let objects = [a.clone(), b.clone(), Expr::Or(both()), Expr::And(both())];
        let objects = objects.map(|e| Object::new(leaves.clone(), &e));
        for _ in 0..RAYS {
            let ray = forest::ray(&mut draws, &mut earlier);
            let range = Interval::new(-8.0, 8.0);
            let [a, b, or, and] = objects.each_ref().map(|object| {
                let mut out = Spans::new();
                object.spans(&ray, range, &mut scratch, &mut out);
                out.iter().map(|s| s.interval().intersect(range).length()).sum::<f64>()
            });
            met.fetch_add(u64::from(0.0 < and && and < or), Ordering::Relaxed);
            assert!((a + b - or - and).abs() < 1e-9, "{seed} {ray:?}: {a} + {b}, {or} + {and}");
        }
    });
    assert!(TREES * RAYS as u64 / 50 < met.into_inner(), "too few rays met both");
}
