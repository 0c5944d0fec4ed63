//! Objects against the evaluator that takes no short cut, on random trees over random leaves: the same spans, to the
//! bit, the same owners; laziness, ranges, order and brackets change nothing.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::forest;
use csg_support::oracle::{End, Oracle, clipped, ends};
use pss::csg::{Boundary, Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Interval, Ray};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

const TREES: u64 = 400;

/// Rays at each tree: a million in all.
const RAYS: usize = 2600;

fn spans(object: &Object, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Vec<[End; 2]> {
    let mut out = Spans::new();
    object.spans(ray, range, scratch, &mut out);
    ends(&out)
}

/// Random leaves, an expression, and the coordinates in play.
fn tree(draws: &mut Draws) -> (Vec<Leaf>, Expr, Vec<f64>) {
    let mut earlier = Vec::new();
    let count = 1 + draws.below(8);
    let mut leaves: Vec<Leaf> = (0..count).map(|i| forest::leaf(draws, &mut earlier, i as u64)).collect();
    for i in 1..count {
        // The same solid written twice.
        if draws.chance(0.15) {
            leaves[i] = Leaf { rank: i as u64, ..leaves[draws.below(i)].clone() };
        }
    }
    let depth = 1 + draws.below(6);
    (leaves, forest::expr(draws, count, depth), earlier)
}

/// Runs a check on every ray of every tree; the check gives its complaint.
fn on_all(
    trees: u64,
    rays: usize,
    check: impl Fn(&mut Draws, &Case, &mut Scratch) -> Result<(), String> + Sync,
) {
    let on_one = |seed: u64| {
        let (mut draws, mut scratch, mut wrong) = (Draws::new(seed), Scratch::default(), Vec::new());
        let (leaves, expr, mut earlier) = tree(&mut draws);
        let object = Object::new(leaves.clone(), &expr);
        let exact = leaves.iter().all(|leaf| leaf.solid.shift_bound() == 0.0);
        let apart = exact.then(|| Object::new(leaves.iter().map(forest::slow).collect(), &expr));
        let apart = apart.as_ref();
        for i in 0..rays {
            let ray = forest::ray(&mut draws, &mut earlier);
            let case = Case { object: &object, apart, leaves: &leaves, expr: &expr, ray };
            if let Err(message) = check(&mut draws, &case, &mut scratch) {
                let raw = Oracle::new(&leaves, &expr, &ray).told();
                wrong.push(format!("tree {seed} ray {i}: {message}\n{raw}\n{ray:?}\n{expr:?}"));
            }
        }
        wrong
    };
    let wrong: Vec<String> = (0..trees).into_par_iter().flat_map_iter(on_one).collect();
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[0]);
}

struct Case<'a> {
    object: &'a Object,
    /// The same of leaves that are not known to be alike, nor of closed form; where none of them moves its boundary.
    apart: Option<&'a Object>,
    leaves: &'a [Leaf],
    expr: &'a Expr,
    ray: Ray,
}

fn same<T: PartialEq + std::fmt::Debug>(what: &str, have: T, want: T) -> Result<(), String> {
    if have == want { Ok(()) } else { Err(format!("{what}\n have {have:?}\n want {want:?}")) }
}

/// A boundary as it shows: of two leaves alike either may stand for what fills.
fn shown(found: Option<(Boundary, bool)>, leaves: &[Leaf]) -> Option<(Boundary, Option<u32>, bool)> {
    let (boundary, entering) = found?;
    let fills = boundary.filler.and_then(|leaf| leaves[leaf as usize].material);
    Some((Boundary { filler: None, ..boundary }, fills, entering))
}

/// FEATURES 88 and B18: lazy equals brute force, shape, owner and side; and so does culling equal asking everything.
#[test]
fn b18_law_88_spans_are_those_of_brute_force() {
    on_all(TREES, RAYS, |_, case, scratch| {
        let want = Oracle::new(case.leaves, case.expr, &case.ray).spans();
        same("spans", spans(case.object, &case.ray, Interval::ALL, scratch), want)
    });
}

/// FEATURES 89 and 91: `first` is the first end of the list, `any` whether there is one, a range clips.
#[test]
fn law_89_91_ranges_clip_the_list_and_first_is_its_first_end() {
    on_all(TREES, RAYS, |draws, case, scratch| {
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
            same("clip", spans(case.object, &case.ray, range, scratch), want.clone())?;
            // What a scan does not resolve where a range begins does not count there.
            if case.leaves.iter().all(|leaf| leaf.solid.grain() == 0.0) {
                same("any", case.object.any(&case.ray, range, scratch), !want.is_empty())?;
            }
            let first = case.object.first(&case.ray, range, scratch);
            // The short way and the long one agree in all: place, owner, normal, and what fills.
            let mut list = Spans::new();
            case.object.spans(&case.ray, range, scratch, &mut list);
            let end = list.first().and_then(|s| s.enter.map(|b| (b, true)).or(s.exit.map(|b| (b, false))));
            same("first boundary", first, end)?;
            if let Some(apart) = case.apart {
                let other = apart.first(&case.ray, range, scratch);
                same("first boundary, none merged", shown(first, case.leaves), shown(other, case.leaves))?;
            }
            let first = first.map(|(b, entering)| ((b.t, b.leaf, b.flipped), entering));
            let entering = want.iter().flat_map(|s| [s[0].map(|e| (e, true)), s[1].map(|e| (e, false))]);
            same("first", first, entering.flatten().next())?;
        }
        Ok(())
    });
}

/// Intersections of many convex leaves, some of them shared by two, have a way of their own: spans, ranges, first and any.
#[test]
fn law_88_89_91_intersections_of_many_are_those_of_brute_force() {
    let met = AtomicU64::new(0);
    let wrong: Vec<String> = (0..TREES)
        .into_par_iter()
        .filter_map(|seed| {
            let (mut draws, mut scratch) = (Draws::new(seed ^ 0xc0), Scratch::default());
            let mut earlier = Vec::new();
            let count = 7 + draws.below(30);
            let mut leaves: Vec<Leaf> =
                (0..count).map(|i| forest::plain_leaf(&mut draws, &mut earlier, i as u64)).collect();
            if draws.chance(0.3) {
                leaves[0] = Leaf { rank: 0, ..leaves[count - 1].clone() };
            }
            let expr = Expr::And((0..count as u32).map(Expr::Leaf).collect());
            let object = Object::new(leaves.clone(), &expr);
            // The same the long way, which tells normals and fillers too.
            let long = Object::new(leaves.iter().map(forest::slow).collect(), &expr);
            for _ in 0..RAYS / 2 {
                let ray = forest::ray(&mut draws, &mut earlier);
                let all = Oracle::new(&leaves, &expr, &ray).spans();
                let mut at = || ray_place(&mut draws, &all);
                let (a, b) = (at(), at());
                for range in [Interval::ALL, Interval::AHEAD, Interval::new(a.min(b), a.max(b))] {
                    let oracle = Oracle::new(&leaves, &expr, &ray);
                    if [range.lo, range.hi].into_iter().any(|t| t.is_finite() && oracle.near_a_change(t)) {
                        continue;
                    }
                    let want = clipped(&all, range);
                    met.fetch_add(want.len() as u64, Ordering::Relaxed);
                    let ends = want.iter().flat_map(|s| [s[0].map(|e| (e, true)), s[1].map(|e| (e, false))]);
                    let first = object.first(&ray, range, &mut scratch);
                    let other = shown(long.first(&ray, range, &mut scratch), &leaves);
                    let told = same("boundary", shown(first, &leaves), other);
                    let first = first.map(|(b, entering)| ((b.t, b.leaf, b.flipped), entering));
                    let found = told
                        .and(same("spans", spans(&object, &ray, range, &mut scratch), want.clone()))
                        .and(same("first", first, ends.flatten().next()))
                        .and(same("any", object.any(&ray, range, &mut scratch), !want.is_empty()));
                    if let Err(message) = found {
                        return Some(format!("tree {seed}: {message}\n{range:?} {ray:?}"));
                    }
                }
            }
            None
        })
        .collect();
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[0]);
    assert!(100_000 < met.into_inner(), "too few were met");
}

/// Long rows of shapes, many of them flush or grazed: what a ray has left behind is dropped on the way, and what still has a
/// say is not.
#[test]
fn law_88_rows_of_hundreds_are_those_of_brute_force() {
    let met = AtomicU64::new(0);
    (0..24u64).into_par_iter().for_each(|seed| {
        let (mut draws, mut scratch) = (Draws::new(seed ^ 0x50), Scratch::default());
        let count = 120 + draws.below(120);
        let leaves: Vec<Leaf> = (0..count).map(|i| forest::in_a_row(&mut draws, i as u64)).collect();
        let part = |draws: &mut Draws, p: f64| -> Vec<Expr> {
            (0..count as u32).filter(|_| draws.chance(p)).map(Expr::Leaf).collect()
        };
        let cut = Expr::Not(Box::new(Expr::Or(part(&mut draws, 0.4))));
        let expr = match seed % 3 {
            0 => Expr::Or(part(&mut draws, 0.9)),
            1 => Expr::And(vec![Expr::Or(part(&mut draws, 0.9)), cut]),
            _ => Expr::Xor(part(&mut draws, 0.9)),
        };
        let object = Object::new(leaves.clone(), &expr);
        for _ in 0..30 {
            let offset = |draws: &mut Draws| draws.pick(&[0.0, 0.1, 0.25, 0.5 - 1e-9, 0.5]);
            let (y, z) = (offset(&mut draws), offset(&mut draws) * 0.9);
            let slant = draws.pick(&[0.0, 0.0, 1e-3]);
            let ray = Ray::new(glam::dvec3(-2.0, y, z), glam::dvec3(1.0, -slant, slant));
            let want = Oracle::new(&leaves, &expr, &ray).spans();
            met.fetch_add(want.len() as u64, Ordering::Relaxed);
            assert_eq!(spans(&object, &ray, Interval::ALL, &mut scratch), want, "{seed} {ray:?}");
        }
    });
    assert!(8_000 < met.into_inner(), "too few were met");
}

/// A place near an end, or anywhere.
fn ray_place(draws: &mut Draws, all: &[[End; 2]]) -> f64 {
    let known: Vec<f64> = all.iter().flatten().flatten().map(|e| e.0).collect();
    let near = if known.is_empty() { 0.0 } else { draws.pick(&known) };
    near + draws.between(-1.0, 1.0)
}

/// A range that ends at a boundary of the list: the low end is before the range, the high end in it.
#[test]
fn law_91_a_range_that_ends_at_a_boundary_keeps_what_lies_beyond() {
    on_all(TREES, RAYS, |draws, case, scratch| {
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
        let after = spans(case.object, &case.ray, Interval::new(at, f64::INFINITY), scratch);
        let before = spans(case.object, &case.ray, Interval::new(f64::NEG_INFINITY, at), scratch);
        let ends = |list: &[[End; 2]]| list.iter().flatten().flatten().map(|e| e.0).collect::<Vec<f64>>();
        same("after", ends(&after), known.iter().copied().filter(|t| at < *t).collect())?;
        same("before", ends(&before), known.iter().copied().filter(|t| *t <= at).collect())
    });
}

/// FEATURES 90. Where each leaf answers the reversed ray exactly, so does the object.
#[test]
fn law_90_a_reversed_ray_gives_the_reversed_list() {
    let compared = AtomicU64::new(0);
    on_all(TREES / 2, RAYS, |_, case, scratch| {
        let back = Ray::new(case.ray.origin, -case.ray.dir);
        let forth = Oracle::new(case.leaves, case.expr, &case.ray);
        if !forth.mirrors(&Oracle::new(case.leaves, case.expr, &back)) {
            return Ok(());
        }
        compared.fetch_add(1, Ordering::Relaxed);
        let want: Vec<[End; 2]> =
            forth.spans().iter().rev().map(|[a, b]| [*b, *a].map(|e| e.map(|e| (-e.0, e.1, e.2)))).collect();
        same("reversed", spans(case.object, &back, Interval::ALL, scratch), want)
    });
    let compared = compared.into_inner();
    assert!(TREES / 2 * RAYS as u64 / 2 < compared, "only {compared} could be compared");
}

/// FEATURES 20 and 53: order and brackets of operands change no bit and no owner.
#[test]
fn case_20_53_law_85_order_and_brackets_of_operands_change_nothing() {
    (0..TREES).into_par_iter().for_each(|seed| {
        let (mut draws, mut scratch) = (Draws::new(seed), Scratch::default());
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
    });
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
