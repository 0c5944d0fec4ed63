//! A closer look at what the first lines did not see, before anything is said of it: shapes may be small in their boxes, and
//! what two of them leave of each other smaller still.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::evidence::Seen;
use super::lines::{WORK, through};
use crate::csg::{Expr, Leaf, Object, Scratch, Spans};
use crate::geom::{Aabb, Interval, Ray};
use crate::prepare::{Outline, Piece};

/// Lines through the box of a shape alone: one that fills a thousandth of its box as a line sees it is missed once in seven
/// times, one that fills a hundredth never.
const ALONE: u64 = 2000;
/// Lines between the middles of two shapes that are tried for one pair of operands, and pairs of solids drawn.
const PAIRS: usize = 64;
/// Random lines through where two operands can meet.
const MEETING: u64 = 300;
/// What is looked at closer, at most: a text with more such places has told enough.
const PLACES: usize = 200;
/// Lines for each of these at least: else there are fewer places.
const FEWEST: usize = 8;

/// The part of the first lines' work that may be spent on it is one in so many.
const SHARE: u64 = 4;

/// Along the axes but for a little: in a plane of symmetry edges are met, where faces seem to coincide.
const ABOUT: [[f64; 3]; 3] = [[1.0, 0.123, 0.077], [0.077, 1.0, 0.123], [0.123, 0.077, 1.0]];

/// Leaves that no line has been inside of, and that none is inside of when they are looked at alone.
pub(super) fn nothing(object: &Object, seen: &Seen) -> Vec<u32> {
    let is_nothing = |scratch: &mut Scratch, (leaf, i): (&Leaf, u32)| {
        let finite = leaf.bounds.is_finite() && !leaf.bounds.is_empty();
        (!seen.crossed.contains(&i) && finite && !is_met(leaf, scratch)).then_some(i)
    };
    let leaves = object.leaves().par_iter().enumerate().map(|(i, leaf)| (leaf, i as u32));
    leaves.map_init(Scratch::default, is_nothing).flatten().collect()
}

/// Sheets that no line through their boxes meets.
pub(super) fn nothing_open(sheets: &[Leaf]) -> Vec<u32> {
    let is_nothing = |scratch: &mut Scratch, (leaf, i): (&Leaf, u32)| {
        let nothing = leaf.bounds.is_empty() || leaf.bounds.is_finite() && !is_crossed(leaf, scratch);
        nothing.then_some(i)
    };
    let sheets = sheets.par_iter().enumerate().map(|(i, leaf)| (leaf, i as u32));
    sheets.map_init(Scratch::default, is_nothing).flatten().collect()
}

fn is_crossed(sheet: &Leaf, scratch: &mut Scratch) -> bool {
    let mut found = Vec::new();
    (0..ALONE).any(|number| {
        let ray = through(&sheet.bounds, sheet.bounds.diagonal(), number);
        let met = if ray.is_valid() { sheet.met(&ray) } else { Interval::EMPTY };
        if !met.is_empty() {
            let local = sheet.place.ray_to_local(&ray);
            sheet.crossings(&local, met, &mut scratch.solid, &mut found);
        }
        !found.is_empty()
    })
}

fn is_met(leaf: &Leaf, scratch: &mut Scratch) -> bool {
    let alone = Object::new(vec![leaf.clone()], &Expr::Leaf(0));
    let mut spans = Spans::new();
    (0..ALONE).any(|number| {
        let ray = through(&leaf.bounds, leaf.bounds.diagonal(), number);
        if ray.is_valid() {
            alone.spans(&ray, Interval::ALL, scratch, &mut spans);
        }
        !spans.is_empty()
    })
}

/// Lines at what seems to be nothing, to cut nothing, or to keep clear of something else: between the middles of the shapes that
/// may meet, where they meet first and leave each other last, and about the middle of where their boxes do. `nodes` is the size
/// of the object's expression.
pub(super) fn lines(object: &Object, outline: &Outline, nodes: usize, seen: &Seen) -> Vec<Ray> {
    let leaves = object.leaves();
    let boxes = |range: &Range<u32>| -> Vec<Aabb> {
        let own = leaves[range.start as usize..range.end as usize].iter().map(|leaf| leaf.bounds);
        own.filter(|b| b.is_finite() && !b.is_empty()).collect()
    };
    let mut pairs: Vec<[Range<u32>; 2]> = Vec::new();
    for cut in &outline.cuts {
        let idle = |piece: &&Piece| {
            let base = cut.base.as_ref().is_some_and(|base| !seen.left.contains(&base.at));
            base || !seen.cutting.contains(&piece.at)
        };
        let base = cut.base.as_ref().map(|base| base.leaves.clone()).unwrap_or_default();
        pairs.extend(cut.cutters.iter().filter(idle).map(|piece| [base.clone(), piece.leaves.clone()]));
    }
    let empty = outline.parts.iter().zip(0..).filter(|(_, i)| !seen.parts.contains(i));
    pairs.extend(empty.map(|(part, _)| [part.leaves.clone(), part.leaves.clone()]));
    for (a, i) in outline.parts.iter().zip(0..).take(PAIRS) {
        let apart = |b: &crate::prepare::Part| a.bounds.intersection(b.bounds).is_empty();
        let others = outline.parts.iter().zip(0..).skip(i as usize + 1).take(PAIRS);
        let others = others.filter(|(b, j)| !apart(b) && !seen.overlaps.contains_key(&(i, *j)));
        pairs.extend(others.map(|(b, _)| [a.leaves.clone(), b.leaves.clone()]));
    }
    let most = (WORK / SHARE / nodes.max(1) as u64) as usize;
    pairs.truncate(PLACES.min(most / FEWEST));
    let each = most / pairs.len().max(1);
    let rays = pairs.iter().flat_map(|[a, b]| between(&boxes(a), &boxes(b)).into_iter().take(each));
    rays.filter(Ray::is_valid).collect()
}

/// Lines between boxes of two sides.
fn between(a: &[Aabb], b: &[Aabb]) -> Vec<Ray> {
    let union = |boxes: &[Aabb]| boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let meeting = union(a).intersection(union(b));
    let length = union(a).union(union(b)).diagonal();
    if meeting.is_empty() || !length.is_finite() {
        return Vec::new();
    }
    let each = a.iter().flat_map(|a| b.iter().map(move |b| (a.center(), b.center())));
    let joins = each.filter(|(a, b)| a != b).take(PAIRS);
    let mut joins = joins.map(|(a, b)| Ray::new(a, length * (b - a).normalize_or_zero()));
    let mut rays: Vec<Ray> = joins.next().into_iter().collect();
    rays.extend(ABOUT.map(|dir| Ray::new(meeting.center(), length * DVec3::from_array(dir).normalize())));
    rays.extend(joins);
    rays.extend((0..MEETING).map(|number| through(&meeting, length, number)));
    rays
}
