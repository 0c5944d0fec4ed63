//! Objects against the evaluator that takes no short cut, on random trees over random leaves: the same spans, to the
//! bit, the same owners; laziness, ranges, order and brackets change nothing.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::forest;
use csg_support::oracle::{End, Oracle, clipped, ends};
use glam::{DAffine3, DQuat};
use pss::csg::{Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Interval, Placement, Ray};

const TREES: u64 = 400;
const RAYS: usize = 200;

/// `PSS_LONG=1` sends 2,600 rays at each of the 400 trees: more than a million.
fn rays() -> usize {
    if std::env::var_os("PSS_LONG").is_some() { 2600 } else { RAYS }
}

fn spans(object: &Object, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Vec<[End; 2]> {
    let mut out = Spans::new();
    object.spans(ray, range, scratch, &mut out);
    ends(&out)
}

/// Random leaves, an expression, and the coordinates in play.
fn tree(draws: &mut Draws) -> (Vec<Leaf>, Expr, Vec<f64>) {
    let mut earlier = Vec::new();
    let count = 1 + draws.below(8);
    let leaves = (0..count).map(|i| forest::leaf(draws, &mut earlier, i as u64)).collect();
    let depth = 1 + draws.below(6);
    (leaves, forest::expr(draws, count, depth), earlier)
}

/// Runs a check on every ray of every tree; the check gives its complaint.
fn on_all(trees: u64, mut check: impl FnMut(&mut Draws, &Case) -> Result<(), String>) {
    let mut wrong = Vec::new();
    for seed in 0..trees {
        let mut draws = Draws::new(seed);
        let (leaves, expr, mut earlier) = tree(&mut draws);
        let object = Object::new(leaves.clone(), &expr);
        for i in 0..rays() {
            let ray = forest::ray(&mut draws, &mut earlier);
            let case = Case { object: &object, leaves: &leaves, expr: &expr, ray };
            if let Err(message) = check(&mut draws, &case) {
                let raw = Oracle::new(&leaves, &expr, &ray).told();
                wrong.push(format!("tree {seed} ray {i}: {message}\n{raw}\n{ray:?}\n{expr:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[0]);
}

struct Case<'a> {
    object: &'a Object,
    leaves: &'a [Leaf],
    expr: &'a Expr,
    ray: Ray,
}

fn same<T: PartialEq + std::fmt::Debug>(what: &str, have: T, want: T) -> Result<(), String> {
    if have == want { Ok(()) } else { Err(format!("{what}\n have {have:?}\n want {want:?}")) }
}

/// FEATURES 88 and B18: lazy equals brute force, shape, owner and side; and so does culling equal asking everything.
#[test]
fn b18_law_88_spans_are_those_of_brute_force() {
    let mut scratch = Scratch::default();
    on_all(TREES, |_, case| {
        let want = Oracle::new(case.leaves, case.expr, &case.ray).spans();
        same("spans", spans(case.object, &case.ray, Interval::ALL, &mut scratch), want)
    });
}

/// FEATURES 89 and 91: `first` is the first end of the list, `any` whether there is one, a range clips.
#[test]
fn law_89_91_ranges_clip_the_list_and_first_is_its_first_end() {
    let mut scratch = Scratch::default();
    on_all(TREES, |draws, case| {
        let oracle = Oracle::new(case.leaves, case.expr, &case.ray);
        let all = oracle.spans();
        let known: Vec<f64> = all.iter().flatten().flatten().map(|e| e.0).collect();
        let mut ends: [f64; 2] = std::array::from_fn(|_| {
            let near = if known.is_empty() { 0.0 } else { draws.pick(&known) };
            near + draws.between(-1.0, 1.0)
        });
        ends.sort_by(f64::total_cmp);
        let ranges = [Interval::ALL, Interval::new(ends[0], f64::INFINITY), Interval::new(ends[0], ends[1])];
        for range in ranges {
            if [range.lo, range.hi].into_iter().any(|t| t.is_finite() && oracle.near_a_change(t)) {
                continue;
            }
            let want = clipped(&all, range);
            same("clip", spans(case.object, &case.ray, range, &mut scratch), want.clone())?;
            same("any", case.object.any(&case.ray, range, &mut scratch), !want.is_empty())?;
            let first = case.object.first(&case.ray, range, &mut scratch);
            // The short way and the long one agree in all: place, owner, normal, and what fills.
            let mut list = Spans::new();
            case.object.spans(&case.ray, range, &mut scratch, &mut list);
            let end = list.first().and_then(|s| s.enter.map(|b| (b, true)).or(s.exit.map(|b| (b, false))));
            same("first boundary", first, end)?;
            let first = first.map(|(b, entering)| ((b.t, b.leaf, b.flipped), entering));
            let entering = want.iter().flat_map(|s| [s[0].map(|e| (e, true)), s[1].map(|e| (e, false))]);
            same("first", first, entering.flatten().next())?;
        }
        Ok(())
    });
}

/// A range that ends at a boundary of the list: the low end is before the range, the high end in it.
#[test]
fn law_91_a_range_that_ends_at_a_boundary_keeps_what_lies_beyond() {
    let mut scratch = Scratch::default();
    on_all(TREES, |draws, case| {
        let all = Oracle::new(case.leaves, case.expr, &case.ray).spans();
        let known: Vec<f64> = all.iter().flatten().flatten().map(|e| e.0).collect();
        if known.is_empty() {
            return Ok(());
        }
        let at = draws.pick(&known);
        let thick = |s: &[End; 2]| matches!(s, [Some(a), Some(b)] if b.0 - a.0 > 1e-6);
        if !all.iter().all(thick) {
            return Ok(());
        }
        let after = spans(case.object, &case.ray, Interval::new(at, f64::INFINITY), &mut scratch);
        let before = spans(case.object, &case.ray, Interval::new(f64::NEG_INFINITY, at), &mut scratch);
        let ends = |list: &[[End; 2]]| list.iter().flatten().flatten().map(|e| e.0).collect::<Vec<f64>>();
        same("after", ends(&after), known.iter().copied().filter(|t| at < *t).collect())?;
        same("before", ends(&before), known.iter().copied().filter(|t| *t <= at).collect())
    });
}

/// FEATURES 90. Where each leaf answers the reversed ray exactly, so does the object.
#[test]
fn law_90_a_reversed_ray_gives_the_reversed_list() {
    let (mut scratch, mut compared) = (Scratch::default(), 0);
    on_all(TREES / 2, |_, case| {
        let back = Ray::new(case.ray.origin, -case.ray.dir);
        let forth = Oracle::new(case.leaves, case.expr, &case.ray);
        if !forth.mirrors(&Oracle::new(case.leaves, case.expr, &back)) {
            return Ok(());
        }
        compared += 1;
        let want: Vec<[End; 2]> =
            forth.spans().iter().rev().map(|[a, b]| [*b, *a].map(|e| e.map(|e| (-e.0, e.1, e.2)))).collect();
        same("reversed", spans(case.object, &back, Interval::ALL, &mut scratch), want)
    });
    assert!(TREES / 2 * rays() as u64 / 2 < compared, "only {compared} could be compared");
}

/// FEATURES 20 and 53: order and brackets of operands change no bit and no owner.
#[test]
fn case_20_53_law_85_order_and_brackets_of_operands_change_nothing() {
    let mut scratch = Scratch::default();
    for seed in 0..TREES / 2 {
        let mut draws = Draws::new(seed);
        let (leaves, expr, mut earlier) = tree(&mut draws);
        let shuffled = forest::permuted(&mut draws, &expr);
        let regrouped = forest::bracketed(&mut draws, &shuffled);
        // The leaves themselves in another order, their ranks kept.
        let order: Vec<u32> = {
            let mut order: Vec<u32> = (0..leaves.len() as u32).collect();
            draws.shuffle(&mut order);
            order
        };
        let moved: Vec<Leaf> = order.iter().map(|i| leaves[*i as usize].clone()).collect();
        let renamed = renamed(&expr, &order);
        let plain = Object::new(leaves.clone(), &expr);
        let others = [shuffled, regrouped].map(|e| Object::new(leaves.clone(), &e));
        let moved = Object::new(moved, &renamed);
        for _ in 0..RAYS {
            let ray = forest::ray(&mut draws, &mut earlier);
            let want = spans(&plain, &ray, Interval::ALL, &mut scratch);
            for other in &others {
                assert_eq!(spans(other, &ray, Interval::ALL, &mut scratch), want, "{seed} {ray:?} {expr:?}");
            }
            let mut have = spans(&moved, &ray, Interval::ALL, &mut scratch);
            have.iter_mut().flatten().flatten().for_each(|e| e.1 = order[e.1 as usize]);
            assert_eq!(have, want, "{seed} {ray:?} {expr:?}");
        }
    }
}

fn renamed(expr: &Expr, order: &[u32]) -> Expr {
    let all = |list: &[Expr]| list.iter().map(|e| renamed(e, order)).collect();
    match expr {
        Expr::Leaf(i) => Expr::Leaf(order.iter().position(|o| o == i).unwrap() as u32),
        Expr::Not(inner) => Expr::Not(Box::new(renamed(inner, order))),
        Expr::Shared(inner) => Expr::Shared(renamed(inner, order).into()),
        Expr::Or(list) => Expr::Or(all(list)),
        Expr::And(list) => Expr::And(all(list)),
        Expr::Xor(list) => Expr::Xor(all(list)),
    }
}

/// FEATURES 82-86: laws of sets, on random sub-expressions; the shape is the same to the bit.
#[test]
fn law_82_to_86_the_laws_of_sets_hold_to_the_bit() {
    let mut scratch = Scratch::default();
    for seed in 0..TREES / 4 {
        let mut draws = Draws::new(seed ^ 0x1a35);
        let mut earlier = Vec::new();
        let count = 2 + draws.below(5);
        let leaves: Vec<Leaf> =
            (0..count).map(|i| forest::leaf(&mut draws, &mut earlier, i as u64)).collect();
        let [a, b, c] = std::array::from_fn(|_| forest::expr(&mut draws, count, 3));
        let laws = laws(&a, &b, &c);
        let objects = laws.map(|(name, l, r)| (name, [l, r].map(|e| Object::new(leaves.clone(), &e))));
        for _ in 0..RAYS / 4 {
            let ray = forest::ray(&mut draws, &mut earlier);
            for (name, sides) in &objects {
                let [l, r] = sides.each_ref().map(|o| {
                    let ends = spans(o, &ray, Interval::ALL, &mut scratch);
                    ends.iter().map(|s| s.map(|e| e.map(|e| e.0))).collect::<Vec<_>>()
                });
                assert_eq!(l, r, "{name} {seed} {ray:?} {a:?} {b:?} {c:?}");
            }
        }
    }
}

/// FEATURES 87: an object moved and turned has the spans of the object at rest for the ray moved back, to rounding.
#[test]
fn law_87_moving_an_object_moves_its_spans() {
    let (mut scratch, mut compared) = (Scratch::default(), 0);
    for seed in 0..TREES / 4 {
        let mut draws = Draws::new(seed ^ 0x87);
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
        for _ in 0..RAYS / 4 {
            // Not along anything, so that no ray runs in a face.
            let from = draws.vector(&mut earlier);
            let ray = Ray::new(from + draws.direction(), draws.direction());
            let ends = |object: &Object, ray: &Ray, scratch: &mut Scratch| -> Vec<[Option<f64>; 2]> {
                spans(object, ray, Interval::ALL, scratch).iter().map(|s| s.map(|e| e.map(|e| e.0))).collect()
            };
            let want = ends(&plain, &ray, &mut scratch);
            let have = ends(&moved, &ray.transformed(&map), &mut scratch);
            let t =
                |list: &[[Option<f64>; 2]]| list.iter().flatten().flatten().copied().collect::<Vec<f64>>();
            let (have, want) = (t(&have), t(&want));
            // What is about as thin as the clean-up's own thickness may be there or not.
            if want.windows(2).any(|w| w[1] - w[0] < 1e-6) || have.windows(2).any(|w| w[1] - w[0] < 1e-6) {
                continue;
            }
            compared += 1;
            assert_eq!(have.len(), want.len(), "{seed} {ray:?} {have:?} {want:?}");
            for (a, b) in have.iter().zip(&want) {
                assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{seed} {ray:?} {have:?} {want:?}");
            }
        }
    }
    assert!(4000 < compared, "only {compared} rays could be compared");
}

/// FEATURES 92: on every ray the lengths of A and B together are those of A | B and A & B together.
#[test]
fn law_92_lengths_of_union_and_intersection_are_those_of_both() {
    let mut scratch = Scratch::default();
    for seed in 0..TREES / 4 {
        let mut draws = Draws::new(seed ^ 0x92);
        let (leaves, a, mut earlier) = tree(&mut draws);
        let b = forest::expr(&mut draws, leaves.len(), 3);
        let both = || vec![a.clone(), b.clone()];
        let objects = [a.clone(), b.clone(), Expr::Or(both()), Expr::And(both())];
        let objects = objects.map(|e| Object::new(leaves.clone(), &e));
        for _ in 0..RAYS / 4 {
            let ray = forest::ray(&mut draws, &mut earlier);
            let range = Interval::new(-8.0, 8.0);
            let [a, b, or, and] = objects.each_ref().map(|object| {
                let mut out = Spans::new();
                object.spans(&ray, range, &mut scratch, &mut out);
                out.iter().map(|s| s.interval().intersect(range).length()).sum::<f64>()
            });
            assert!((a + b - or - and).abs() < 1e-9, "{seed} {ray:?}: {a} + {b}, {or} + {and}");
        }
    }
}

type Law = (&'static str, Expr, Expr);

fn laws(a: &Expr, b: &Expr, c: &Expr) -> [Law; 12] {
    let or = |a: &Expr, b: &Expr| Expr::Or(vec![a.clone(), b.clone()]);
    let and = |a: &Expr, b: &Expr| Expr::And(vec![a.clone(), b.clone()]);
    let xor = |a: &Expr, b: &Expr| Expr::Xor(vec![a.clone(), b.clone()]);
    let not = |a: &Expr| Expr::Not(Box::new(a.clone()));
    let minus = |a: &Expr, b: &Expr| Expr::And(vec![a.clone(), Expr::Not(Box::new(b.clone()))]);
    [
        ("De Morgan |", not(&or(a, b)), and(&not(a), &not(b))),
        ("De Morgan &", not(&and(a, b)), or(&not(a), &not(b))),
        ("A-(B|C)", minus(a, &or(b, c)), minus(&minus(a, b), c)),
        ("A-(B&C)", minus(a, &and(b, c)), or(&minus(a, b), &minus(a, c))),
        ("A-(B-C)", minus(a, &minus(b, c)), or(&minus(a, b), &and(a, c))),
        ("(A-B)|(A&B)", or(&minus(a, b), &and(a, b)), a.clone()),
        ("(A-B)|B", or(&minus(a, b), b), or(a, b)),
        ("absorption", or(a, &and(a, b)), a.clone()),
        ("xor", xor(a, b), minus(&or(a, b), &and(a, b))),
        ("(A^B)^C", xor(&xor(a, b), c), xor(a, &xor(b, c))),
        ("idempotence", or(a, a), and(a, a)),
        ("A^A", xor(a, a), minus(a, a)),
    ]
}
