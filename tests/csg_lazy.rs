//! Laziness changes nothing but the work: leaves that answer in pieces, and leaves that need not be asked.

mod csg_support;

use std::sync::Arc;

use csg_support::draws::Draws;
use csg_support::forest;
use csg_support::line::{self, Line, axis};
use csg_support::oracle::{Oracle, clipped, ends};
use pss::csg::{Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Interval, Placement};

fn placed(line: Line, rank: usize) -> (Leaf, Arc<Line>) {
    let line = Arc::new(line);
    let mut leaf = Leaf::new(line.clone(), Placement::IDENTITY);
    leaf.rank = rank as u64;
    (leaf, line)
}

/// Leaves that answer piece by piece, costly or not, give the same spans, firsts and owners as whole answers.
#[test]
fn answers_in_pieces_change_no_bit() {
    let mut scratch = Scratch::default();
    let mut draws = Draws::new(7);
    for trial in 0..10_000 {
        let count = 1 + draws.below(6);
        let lines: Vec<Line> = (0..count).map(|_| line::random(&mut draws, trial % 3 == 0)).collect();
        let lazy = lines.iter().map(|l| Line {
            ends: l.ends.clone(),
            inside: l.inside,
            piece: [None, Some(1.0), Some(2.5), Some(7.0), Some(1000.0)][draws.below(5)],
            costly: draws.chance(0.5),
            ..Line::default()
        });
        let lazy: Vec<Leaf> =
            lazy.collect::<Vec<_>>().into_iter().enumerate().map(|(i, l)| line::leaf(l, i as u64)).collect();
        let whole: Vec<Leaf> = lines.into_iter().enumerate().map(|(i, l)| line::leaf(l, i as u64)).collect();
        let expr = forest::expr(&mut draws, count, 4);
        let want = Oracle::new(&whole, &expr, &axis()).spans();
        let told = format!("{:?}", whole.iter().map(|l| &l.solid).collect::<Vec<_>>());
        let [whole, lazy] = [whole, lazy].map(|leaves| Object::new(leaves, &expr));
        let mut ts = [draws.below(65) as f64 + 0.25, draws.below(65) as f64 + 0.75];
        ts.sort_by(f64::total_cmp);
        for range in [Interval::ALL, Interval::new(ts[0], f64::INFINITY), Interval::new(ts[0], ts[1])] {
            let [mut a, mut b] = [Spans::new(), Spans::new()];
            whole.spans(&axis(), range, &mut scratch, &mut a);
            lazy.spans(&axis(), range, &mut scratch, &mut b);
            let want = clipped(&want, range);
            assert_eq!(ends(&a), want, "whole {range:?} {expr:?} {told}");
            assert_eq!(ends(&b), want, "pieces {range:?} {expr:?} {told}");
            assert_eq!(whole.first(&axis(), range, &mut scratch), lazy.first(&axis(), range, &mut scratch));
            assert_eq!(whole.any(&axis(), range, &mut scratch), lazy.any(&axis(), range, &mut scratch));
        }
    }
}

/// A leaf that is used a thousand times is asked once a ray, and an exclusion of it an even number of times is nothing.
#[test]
fn a_leaf_used_a_thousand_times_is_asked_once() {
    let mut scratch = Scratch::default();
    let (leaf, line) = placed(Line::new(&[1.0, 3.0]), 4);
    let all: Vec<Expr> = (0..1000).map(Expr::Leaf).collect();
    let one = ends(&{
        let mut spans = Spans::new();
        let object = Object::new(vec![leaf.clone()], &Expr::Leaf(0));
        object.spans(&axis(), Interval::ALL, &mut scratch, &mut spans);
        spans
    });
    for (expr, want) in [
        (Expr::Or(all.clone()), &one[..]),
        (Expr::And(all.clone()), &one[..]),
        (Expr::Xor(all[..999].to_vec()), &one[..]),
        (Expr::Xor(all.clone()), &[][..]),
    ] {
        let object = Object::new(vec![leaf.clone(); 1000], &expr);
        let (before, mut spans) = (line.asked(), Spans::new());
        object.spans(&axis(), Interval::ALL, &mut scratch, &mut spans);
        assert_eq!(ends(&spans), want);
        assert_eq!(line.asked() - before, 1);
    }
}

/// A cutter outside the base's extent along the ray is never asked; one inside it is.
#[test]
fn a_cutter_is_asked_only_where_the_base_lives() {
    let mut scratch = Scratch::default();
    for (cut, wanted) in [([20.0, 30.0], false), ([5.0, 30.0], true), ([1.0, 1.5], false)] {
        let (base, _) = placed(Line::new(&[2.0, 10.0]), 0);
        let (cutter, asked) = placed(Line { costly: true, ..Line::new(&cut) }, 1);
        let expr = Expr::And(vec![Expr::Leaf(0), Expr::Not(Box::new(Expr::Leaf(1)))]);
        let object = Object::new(vec![base, cutter], &expr);
        let mut out = Spans::new();
        object.spans(&axis(), Interval::ALL, &mut scratch, &mut out);
        assert_eq!(0 < asked.asked(), wanted, "{cut:?}");
    }
}

/// Asked for the first surface, the sweep leaves what lies behind it alone.
#[test]
fn what_lies_behind_the_first_surface_is_never_asked() {
    let mut scratch = Scratch::default();
    let (front, _) = placed(Line::new(&[2.0, 10.0]), 0);
    let (behind, asked) = placed(Line { costly: true, ..Line::new(&[20.0, 30.0]) }, 1);
    let object = Object::new(vec![front, behind], &Expr::Or(vec![Expr::Leaf(0), Expr::Leaf(1)]));
    let first = object.first(&axis(), Interval::AHEAD, &mut scratch).unwrap();
    assert_eq!((first.0.t, first.1), (2.0, true));
    assert!(object.any(&axis(), Interval::AHEAD, &mut scratch));
    assert_eq!(asked.asked(), 0);
}

/// A chain of ten thousand operators, nested to the right, is built, asked and dropped.
#[test]
fn a_chain_of_ten_thousand_operators_is_no_trouble() {
    let leaves: Vec<Leaf> =
        (0..10_000).map(|i| line::leaf(Line::new(&[i as f64, i as f64 + 1.0]), i)).collect();
    let mut expr = Expr::Leaf(0);
    for i in 1..10_000u32 {
        let other = Expr::Leaf(i);
        expr = if i % 2 == 0 { Expr::Or(vec![other, expr]) } else { Expr::Xor(vec![expr, other]) };
    }
    let object = Object::new(leaves, &expr);
    let mut out = Spans::new();
    object.spans(&axis(), Interval::ALL, &mut Scratch::default(), &mut out);
    assert_eq!(out.len(), 1);
    assert_eq!(out[0].interval(), Interval::new(0.0, 10_000.0));
}

/// A leaf that is nothing has an empty box, which no ray meets, whatever its direction.
#[test]
fn a_leaf_that_is_nothing_is_never_asked() {
    let (nothing, asked) = placed(Line::new(&[]), 0);
    let object = Object::new(vec![nothing], &Expr::Leaf(0));
    let ray = pss::geom::Ray::new(glam::DVec3::ZERO, glam::DVec3::ONE);
    assert!(!object.any(&ray, Interval::ALL, &mut Scratch::default()));
    assert_eq!(asked.asked(), 0);
}
