//! The interval algebra without geometry: leaves that are sets of integer intervals of a line, every operator against
//! membership of unit cells, exactly. Case names are those of the stress plan, section A.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::line::{self, Line, axis};
use pss::csg::{Expr, Leaf, Object, Scratch, Span, Spans};
use pss::geom::{Aabb, Interval};
use rayon::prelude::*;
use std::sync::Arc;

/// Trials of each law: a hundred thousand, a million with `PSS_LONG=1`, by batches that each have their own seed.
fn each_trial(seed: u64, trial: impl Fn(u64, &mut Draws, &mut Scratch) + Sync) {
    const BATCH: u64 = 1000;
    let batches = if std::env::var_os("PSS_LONG").is_some() { 1000 } else { 100 };
    (0..batches).into_par_iter().for_each(|batch| {
        let (mut draws, mut scratch) = (Draws::new(seed << 32 | batch), Scratch::default());
        (0..BATCH).for_each(|i| trial(batch * BATCH + i, &mut draws, &mut scratch));
    });
}

/// Spans as pairs of numbers.
type List = Vec<(f64, f64)>;

fn list(object: &Object, scratch: &mut Scratch) -> List {
    let mut out = Spans::new();
    object.spans(&axis(), Interval::ALL, scratch, &mut out);
    out.iter().map(|s: &Span| (s.interval().lo, s.interval().hi)).collect()
}

fn leaves(lines: Vec<Line>) -> Vec<Leaf> {
    lines.into_iter().enumerate().map(|(i, l)| line::leaf(l, i as u64)).collect()
}

fn inside(line: &Line, x: f64) -> bool {
    (line.ends.iter().filter(|e| **e < x).count() % 2 == 1) != line.inside
}

/// The spans of a predicate, by its value in every unit cell and beyond.
fn cells(holds: impl Fn(f64) -> bool) -> List {
    let mut spans: List = Vec::new();
    for cell in -1..=64 {
        let lo = if cell == -1 { f64::NEG_INFINITY } else { f64::from(cell) };
        let hi = if cell == 64 { f64::INFINITY } else { f64::from(cell + 1) };
        if holds(f64::from(cell) + 0.5) {
            match spans.last_mut() {
                Some(last) if last.1 == lo => last.1 = hi,
                _ => spans.push((lo, hi)),
            }
        }
    }
    spans
}

fn leaf(i: u32) -> Expr {
    Expr::Leaf(i)
}

fn not(e: Expr) -> Expr {
    Expr::Not(Box::new(e))
}

/// An operator of two operands, and what it makes of two truths.
type Op = (fn(Vec<Expr>) -> Expr, fn(bool, bool) -> bool);

const OPS: [Op; 4] = [
    (Expr::Or, |a, b| a | b),
    (Expr::And, |a, b| a & b),
    (Expr::Xor, |a, b| a ^ b),
    (
        |mut l| {
            let b = not(l.pop().unwrap());
            Expr::And(vec![l.pop().unwrap(), b])
        },
        |a, b| a & !b,
    ),
];

/// A1, A2, A6, A12: one set with itself, and complements; unbounded sets are among them.
#[test]
fn a1_a2_a6_a12_a_set_with_itself() {
    each_trial(1, |_, draws, scratch| {
        let a = line::random(draws, true);
        let want = cells(|x| inside(&a, x));
        let leaves = leaves(vec![a]);
        let mut of = |expr: Expr| list(&Object::new(leaves.clone(), &expr), scratch);
        let none = List::new();
        assert_eq!(of(Expr::And(vec![leaf(0), not(leaf(0))])), none, "A - A");
        assert_eq!(of(Expr::Or(vec![leaf(0), leaf(0)])), want, "A | A");
        assert_eq!(of(Expr::And(vec![leaf(0), leaf(0)])), want, "A & A");
        assert_eq!(of(not(not(leaf(0)))), want, "!!A");
        let copies = 1 + draws.below(6);
        let xor = of(Expr::Xor(vec![leaf(0); copies]));
        assert_eq!(xor, if copies % 2 == 1 { want } else { none }, "{copies} copies in ^");
    });
}

/// A3, A5, A11 and all else that a truth table says: two to four sets in every operator and nested pairs of them.
#[test]
fn a3_a5_all_pairs_of_operators_are_their_truth_tables() {
    each_trial(2, |trial, draws, scratch| {
        let lines: Vec<Line> = (0..3).map(|_| line::random(draws, trial % 2 == 0)).collect();
        let (outer, inner) = (OPS[draws.below(4)], OPS[draws.below(4)]);
        let left = draws.chance(0.5);
        let want = cells(|x| {
            let [a, b, c] = [0, 1, 2].map(|i: usize| inside(&lines[i], x));
            if left { outer.1(inner.1(a, b), c) } else { outer.1(a, inner.1(b, c)) }
        });
        let expr = if left {
            outer.0(vec![inner.0(vec![leaf(0), leaf(1)]), leaf(2)])
        } else {
            outer.0(vec![leaf(0), inner.0(vec![leaf(1), leaf(2)])])
        };
        let leaves = leaves(lines);
        assert_eq!(list(&Object::new(leaves, &expr), scratch), want, "{expr:?}");
    });
}

/// A3, A5 and A6: the laws themselves, both sides by the evaluator.
#[test]
fn a3_a5_a6_laws_of_two_and_three_sets() {
    let (a, b, c) = (|| leaf(0), || leaf(1), || leaf(2));
    let or = |x, y| Expr::Or(vec![x, y]);
    let and = |x, y| Expr::And(vec![x, y]);
    let minus = |x, y| Expr::And(vec![x, not(y)]);
    let xor = |x, y| Expr::Xor(vec![x, y]);
    let all = || leaf(3);
    let laws = [
        ("A3 |", minus(all(), or(a(), b())), and(minus(all(), a()), minus(all(), b()))),
        ("A3 &", minus(all(), and(a(), b())), or(minus(all(), a()), minus(all(), b()))),
        ("A5 A-(B|C)", minus(a(), or(b(), c())), minus(minus(a(), b()), c())),
        ("A5 A-(B&C)", minus(a(), and(b(), c())), or(minus(a(), b()), minus(a(), c()))),
        ("A5 A-(B-C)", minus(a(), minus(b(), c())), or(minus(a(), b()), and(a(), c()))),
        ("A5 (A-B)|(A&B)", or(minus(a(), b()), and(a(), b())), a()),
        ("A5 (A-B)|B", or(minus(a(), b()), b()), or(a(), b())),
        ("A5 A|(A&B)", or(a(), and(a(), b())), a()),
        ("A6 (A|B)-(A&B)", xor(a(), b()), minus(or(a(), b()), and(a(), b()))),
        ("A6 (A-B)|(B-A)", xor(a(), b()), or(minus(a(), b()), minus(b(), a()))),
    ];
    each_trial(5, |trial, draws, scratch| {
        let mut lines: Vec<Line> = (0..3).map(|_| line::random(draws, false)).collect();
        lines.push(Line::new(&[0.0, 64.0]));
        let (name, left, right) = &laws[trial as usize % laws.len()];
        let leaves = leaves(lines);
        let [left, right] = [left, right].map(|e| list(&Object::new(leaves.clone(), e), scratch));
        assert_eq!(left, right, "{name} {leaves:?}");
    });
}

/// A4: three to thirty-two operands, any order, any brackets.
#[test]
fn a4_many_operands_in_any_brackets() {
    each_trial(3, |trial, draws, scratch| {
        let count = 3 + draws.below(30);
        let lines: Vec<Line> = (0..count).map(|_| line::random(draws, false)).collect();
        let node: fn(Vec<Expr>) -> Expr = [Expr::Or, Expr::And, Expr::Xor][(trial % 3) as usize];
        let want = cells(|x| {
            let in_it = lines.iter().filter(|l| inside(l, x)).count();
            [0 < in_it, in_it == count, in_it % 2 == 1][(trial % 3) as usize]
        });
        let mut parts: Vec<Expr> = (0..count as u32).map(leaf).collect();
        draws.shuffle(&mut parts);
        while 1 < parts.len() {
            let at = draws.below(parts.len() - 1);
            let pair = parts.drain(at..at + 2).collect();
            parts.insert(at, node(pair));
        }
        let object = Object::new(leaves(lines), &parts[0]);
        assert_eq!(list(&object, scratch), want);
    });
}

/// Operands that a ray meets again and again: a torus twice, a gear thirty-two times, two gears tooth in gap; every
/// operator, both orders, every place of one along the other.
#[test]
fn case_18_operands_of_many_intervals() {
    let mut scratch = Scratch::default();
    let gear = |first: u32, teeth: u32| -> Vec<f64> { (first..first + 2 * teeth).map(f64::from).collect() };
    let tori =
        (0..48).flat_map(|at| (1..8).map(move |tube| [0, tube, 15 - tube, 15].map(|x| f64::from(at + x))));
    let mut pairs: Vec<[Vec<f64>; 2]> = tori.map(|torus| [torus.to_vec(), gear(0, 32)]).collect();
    pairs.extend((0..32).map(|shift| [gear(0, 32), gear(shift, 16)]));
    let mut longest = 0;
    for pair in pairs.iter().flat_map(|[a, b]| [[a, b], [b, a]]) {
        for (expr, truth) in OPS {
            let [a, b] = pair.map(|ends| Line::new(ends));
            let want = cells(|x| truth(inside(&a, x), inside(&b, x)));
            let object = Object::new(leaves(vec![a, b]), &expr(vec![leaf(0), leaf(1)]));
            longest = longest.max(want.len());
            assert_eq!(list(&object, &mut scratch), want, "{pair:?} {:?}", expr(vec![leaf(0), leaf(1)]));
        }
    }
    assert_eq!(longest, 32);
}

/// A7 and A8: the matrix of positions by operators, both orders; what touches leaves neither film nor wall.
#[test]
fn a7_a8_cases_1_to_11_the_matrix_of_positions() {
    let mut scratch = Scratch::default();
    let pairs: [(&[f64], &[f64]); 11] = [
        (&[1.0, 3.0], &[5.0, 7.0]),
        (&[1.0, 3.0], &[3.0, 5.0]),
        (&[1.0, 4.0], &[3.0, 5.0]),
        (&[1.0, 7.0], &[3.0, 5.0]),
        (&[3.0, 5.0], &[1.0, 7.0]),
        (&[1.0, 3.0], &[1.0, 3.0]),
        (&[1.0, 3.0], &[1.0, 5.0]),
        (&[1.0, 5.0], &[3.0, 5.0]),
        (&[1.0, 5.0], &[]),
        (&[1.0, 5.0], &[3.0, 3.0]),
        (&[3.0, 3.0], &[]),
    ];
    for (a, b) in pairs {
        for (a, b) in [(a, b), (b, a)] {
            let [la, lb] = [a, b].map(Line::new);
            let truth = |op: fn(bool, bool) -> bool| cells(|x| op(inside(&la, x), inside(&lb, x)));
            let want = [truth(|a, b| a | b), truth(|a, b| a & b), truth(|a, b| a & !b), truth(|a, b| a ^ b)];
            let both = || vec![leaf(0), leaf(1)];
            let minus = Expr::And(vec![leaf(0), not(leaf(1))]);
            let exprs = [Expr::Or(both()), Expr::And(both()), minus, Expr::Xor(both())];
            for (expr, want) in exprs.iter().zip(want) {
                let object = Object::new(leaves(vec![Line::new(a), Line::new(b)]), expr);
                assert_eq!(list(&object, &mut scratch), want, "{a:?} {b:?} {expr:?}");
            }
        }
    }
}

/// A9 and A14: what is thinner than tau goes, what is thicker stays, in both orders.
#[test]
fn a9_a14_slits_and_films_up_to_tau_vanish() {
    let mut scratch = Scratch::default();
    for j in -8..=8 {
        // All lengths in play are at most 4, so tau is 16 eps 4 for leaves that reach to 4.
        let tau = 64.0 * f64::EPSILON;
        let width = tau * 2f64.powi(j);
        let [a, b] = [[1.0, 3.0], [3.0 + width, 4.0]];
        let slit = if j <= 0 { vec![(1.0, 4.0)] } else { vec![(1.0, 3.0), (3.0 + width, 4.0)] };
        let film = [1.0, 3.0 + width];
        let film_left: List = if j <= 0 { vec![] } else { vec![(3.0, 3.0 + width)] };
        let reach = [2.0, 4.0];
        for order in [[0u32, 1], [1, 0]] {
            let both = order.map(leaf).to_vec();
            let object = Object::new(leaves(vec![Line::new(&a), Line::new(&b)]), &Expr::Or(both));
            let have = list(&object, &mut scratch);
            assert_eq!(have.len(), slit.len(), "j {j} {have:?}");
            let minus = Expr::And(vec![leaf(0), not(leaf(1)), Expr::Or(vec![leaf(2), leaf(0)])]);
            let lines = vec![Line::new(&film), Line::new(&[1.0, 3.0]), Line::new(&reach)];
            let have = list(&Object::new(leaves(lines), &minus), &mut scratch);
            // The film's own leaf reaches only to 3 + width: tau is three quarters.
            let kept = 0.75 * tau < width;
            assert_eq!(have, if kept { vec![(3.0, 3.0 + width)] } else { film_left.clone() }, "j {j}");
        }
    }
}

/// A10: a chain of a thousand slits of 0.9 tau is one span, whose two ends are those of the chain: the largest length in play
/// is about the same for all of them, as they are much wider than they are far away.
#[test]
fn a10_case_17_a_chain_of_slits_is_one_span() {
    let mut scratch = Scratch::default();
    let slit = 0.9 * 16.0 * f64::EPSILON * 4096.0;
    let mut lines: Vec<Line> =
        (0..1000).map(|i| Line::new(&[f64::from(i), f64::from(i + 1) - slit])).collect();
    lines.iter_mut().for_each(|line| line.wide = 4096.0);
    let expr = Expr::Or((0..1000).map(leaf).collect());
    let object = Object::new(leaves(lines), &expr);
    assert_eq!(list(&object, &mut scratch), [(0.0, 1000.0 - slit)]);
}

/// A13: a leaf whose box is too small, or which answers no numbers, inverts nothing and hangs nothing.
#[test]
fn a13_case_19_a_leaf_that_lies_cannot_invert_what_follows() {
    #[derive(Debug)]
    struct Liar(Line, Aabb);
    impl pss::solid::Solid for Liar {
        fn bounds(&self) -> Aabb {
            self.1
        }
        fn crossings(
            &self,
            ray: &pss::geom::Ray,
            range: Interval,
            scratch: &mut pss::solid::Scratch,
            out: &mut Vec<pss::solid::Crossing>,
        ) -> pss::solid::Answer {
            self.0.crossings(ray, range, scratch, out)
        }
        fn normal(
            &self,
            ray: &pss::geom::Ray,
            c: &pss::solid::Crossing,
            scratch: &mut pss::solid::Scratch,
        ) -> glam::DVec3 {
            self.0.normal(ray, c, scratch)
        }
    }
    let mut scratch = Scratch::default();
    for (lo, hi) in [(1.5, 2.5), (1.5, 9.0), (0.0, 2.5)] {
        let small = Aabb { min: glam::dvec3(lo, -1.0, -1.0), max: glam::dvec3(hi, 1.0, 1.0) };
        let liar = Liar(Line::new(&[1.0, 3.0]), small);
        let place = pss::geom::Placement::IDENTITY;
        let mut all = vec![Leaf::new(Arc::new(liar), place), line::leaf(Line::new(&[5.0, 6.0]), 1)];
        all[0].rank = 0;
        let have = list(&Object::new(all, &Expr::Or(vec![leaf(0), leaf(1)])), &mut scratch);
        assert_eq!(have.len(), 2, "{have:?}");
        assert_eq!((have[0].1, have[1]), (3.0, (5.0, 6.0)), "{have:?}");
    }
    // No numbers, ends in the wrong order, ends at infinity: no answer at all. The neighbour stays whole, and it is told.
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for (told, ends) in
        [[nan, nan], [1.0, nan], [nan, 3.0], [3.0, 1.0], [-inf, inf], [1.0, inf]].iter().enumerate()
    {
        let place = pss::geom::Placement::IDENTITY;
        let all = vec![Leaf::new(Arc::new(Raw(ends.to_vec())), place), line::leaf(Line::new(&[5.0, 6.0]), 1)];
        let object = Object::new(all, &Expr::Or(vec![leaf(0), leaf(1)]));
        assert_eq!(list(&object, &mut scratch), vec![(5.0, 6.0)], "{ends:?}");
        assert!((told as u64) < scratch.solid.counts.bad_leaves, "{ends:?}");
    }
    assert!(6 <= scratch.solid.counts.bad_leaves);
    // Either zero is the same end.
    let zeros = [Line::new(&[-1.0, -0.0]), Line::new(&[0.0, 1.0])];
    let object = Object::new(leaves(zeros.into()), &Expr::Or(vec![leaf(0), leaf(1)]));
    assert_eq!(list(&object, &mut scratch), vec![(-1.0, 1.0)]);
}

/// Tells these ends, whatever they are.
#[derive(Debug)]
struct Raw(Vec<f64>);

impl pss::solid::Solid for Raw {
    fn bounds(&self) -> Aabb {
        Aabb { min: glam::DVec3::NEG_ONE, max: glam::DVec3::splat(9.0) }
    }

    fn crossings(
        &self,
        _: &pss::geom::Ray,
        _: Interval,
        _: &mut pss::solid::Scratch,
        out: &mut Vec<pss::solid::Crossing>,
    ) -> pss::solid::Answer {
        let crossing = |(i, t): (usize, &f64)| pss::solid::Crossing::exact(*t, i % 2 == 0, 0);
        out.extend(self.0.iter().enumerate().map(crossing));
        pss::solid::Answer::whole_line(false)
    }

    fn normal(
        &self,
        _: &pss::geom::Ray,
        _: &pss::solid::Crossing,
        _: &mut pss::solid::Scratch,
    ) -> glam::DVec3 {
        glam::DVec3::X
    }
}

/// A11: m(A) + m(B) = m(A | B) + m(A & B), and m(A ^ B) = m(A) + m(B) - 2 m(A & B), exactly.
#[test]
fn a11_measures_add_up() {
    each_trial(11, |_, draws, scratch| {
        let leaves = leaves(vec![line::random(draws, false), line::random(draws, false)]);
        let both = || vec![leaf(0), leaf(1)];
        let mut measure = |expr: Expr| {
            let spans = list(&Object::new(leaves.clone(), &expr), scratch);
            spans.iter().map(|s| s.1 - s.0).sum::<f64>()
        };
        let (a, b) = (measure(leaf(0)), measure(leaf(1)));
        let (or, and, xor) =
            (measure(Expr::Or(both())), measure(Expr::And(both())), measure(Expr::Xor(both())));
        assert_eq!(a + b, or + and);
        assert_eq!(xor, a + b - 2.0 * and);
    });
}

/// A15: who is written first owns a shared front, a cutter its cut, whatever the order of operands; the cut's normal points
/// into the cutter.
#[test]
fn a15_owners_are_the_first_written_under_any_order() {
    let mut scratch = Scratch::default();
    for turned in [false, true] {
        let order = |a: u32, b: u32| if turned { vec![leaf(b), leaf(a)] } else { vec![leaf(a), leaf(b)] };
        let lines = || leaves(vec![Line::new(&[1.0, 3.0]), Line::new(&[1.0, 5.0])]);
        let first = |leaves: Vec<Leaf>, expr: Expr, scratch: &mut Scratch| {
            Object::new(leaves, &expr).first(&axis(), Interval::ALL, scratch).unwrap().0
        };
        let shared = first(lines(), Expr::Or(order(0, 1)), &mut scratch);
        assert_eq!((shared.t, shared.leaf), (1.0, 0));
        let mut swapped = lines();
        (swapped[0].rank, swapped[1].rank) = (1, 0);
        assert_eq!(first(swapped, Expr::Or(order(0, 1)), &mut scratch).leaf, 1);
        let mut parts = vec![leaf(1), not(leaf(0))];
        if turned {
            parts.reverse();
        }
        let cut = first(lines(), Expr::And(parts), &mut scratch);
        assert_eq!((cut.t, cut.leaf, cut.flipped, cut.normal), (3.0, 0, true, -glam::DVec3::X));
    }
}
