//! A closer look at what the first lines did not see, before anything is said of it: shapes may be small in their boxes, and
//! what two of them leave of each other smaller still.

use std::collections::BTreeSet;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::endless;
use super::extents::Extents;
use super::flush;
use super::lines::{WORK, is_edge, through};
use super::logic::Logic;
use super::seen::Seen;
use super::summit;
use crate::csg::{Expr, Leaf, Object, Scratch, Spans};
use crate::geom::{Aabb, Interval, Ray};
use crate::prepare::{Outline, Piece};
use crate::source::Span;

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
const FEWEST: usize = 24;
/// Leaves of a base whose corners are looked at, and how close: each time half as far from them.
const CORNERED: usize = 4;
const INSETS: i32 = 16;

/// The part of the first lines' work that may be spent on it is one in so many.
pub(super) const SHARE: u64 = 4;

/// Along the axes but for a little: in a plane of symmetry edges are met, where faces seem to coincide.
const ABOUT: [[f64; 3]; 3] = [[1.0, 0.123, 0.077], [0.077, 1.0, 0.123], [0.123, 0.077, 1.0]];

/// Leaves that no line has been inside of, and that none is inside of when they are looked at alone.
pub(super) fn nothing(object: &Object, seen: &Seen) -> Vec<u32> {
    let is_nothing = |leaf: &Leaf, i: u32, scratch: &mut Scratch| {
        let finite = leaf.bounds.is_finite() && !leaf.bounds.is_empty();
        !seen.crossed.contains(&i) && finite && !is_met(leaf, scratch)
    };
    those(object.leaves(), is_nothing)
}

/// Sheets that no line through their boxes meets.
pub(super) fn nothing_open(sheets: &[Leaf]) -> Vec<u32> {
    let is_nothing = |leaf: &Leaf, _: u32, scratch: &mut Scratch| {
        leaf.bounds.is_empty() || leaf.bounds.is_finite() && !is_crossed(leaf, scratch)
    };
    those(sheets, is_nothing)
}

/// Which leaves a test picks.
fn those(leaves: &[Leaf], test: impl Fn(&Leaf, u32, &mut Scratch) -> bool + Sync) -> Vec<u32> {
    let picked = |scratch: &mut Scratch, (leaf, i): (&Leaf, usize)| {
        let i = i as u32;
        test(leaf, i, scratch).then_some(i)
    };
    let leaves = leaves.par_iter().enumerate().map(|(i, leaf)| (leaf, i));
    leaves.map_init(Scratch::default, picked).flatten().collect()
}

/// Whether some line through the box of a leaf alone passes a test.
fn any_line(leaf: &Leaf, test: impl FnMut(Ray) -> bool) -> bool {
    let lines = (0..ALONE).map(|number| through(&leaf.bounds, leaf.bounds.diagonal(), number));
    lines.filter(Ray::is_valid).any(test)
}

fn is_crossed(sheet: &Leaf, scratch: &mut Scratch) -> bool {
    let mut found = Vec::new();
    any_line(sheet, |ray| {
        let met = sheet.met(&ray);
        if !met.is_empty() {
            sheet.crossings(&sheet.place.ray_to_local(&ray), met, &mut scratch.solid, &mut found);
        }
        !found.is_empty()
    })
}

fn is_met(leaf: &Leaf, scratch: &mut Scratch) -> bool {
    let alone = Object::new(vec![leaf.clone()], &Expr::Leaf(0));
    let mut spans = Spans::new();
    any_line(leaf, |ray| {
        alone.spans(&ray, Interval::ALL, scratch, &mut spans);
        !spans.is_empty()
    })
}

/// What is looked at closer, and the lines that do.
#[derive(Debug, Default)]
pub(super) struct Closer {
    pub rays: Vec<Ray>,
    /// Operands of cuts, and what is where operands meet, that are looked at, or need not be, as their boxes do not meet: only
    /// of these it is told that they seem to do nothing.
    pub pieces: BTreeSet<Span>,
    /// Solids drawn, and shapes that cutters are unions of.
    pub parts: BTreeSet<u32>,
    pub leaves: BTreeSet<u32>,
}

/// Two sides between which lines are sent, the box they can meet in, and what is known then.
struct Pair {
    sides: [Range<u32>; 2],
    region: Aabb,
    pieces: Vec<Span>,
    part: Option<u32>,
    leaf: Option<u32>,
}

impl Pair {
    fn new(sides: [Range<u32>; 2], region: Aabb) -> Pair {
        Pair { sides, region, pieces: Vec::new(), part: None, leaf: None }
    }
}

/// Lines at what seems to be nothing, to cut nothing, or to keep clear of something else: between the middles of the shapes that
/// may meet, where they meet first and leave each other last, about the middle of where they can, at the summits of shapes there
/// ([`summit`]), close to the corners of what seems to be cut away whole, and across faces that may coincide ([`flush`]).
/// `extents` are boxes around the nodes of the expression.
pub(super) fn closer(
    object: &Object,
    outline: &Outline,
    (logic, extents): (&Logic, &Extents),
    seen: &Seen,
) -> Closer {
    let leaves = object.leaves();
    let own = |range: &Range<u32>| &leaves[range.start as usize..range.end as usize];
    let mut closer = Closer::default();
    let mut most = (WORK / SHARE / logic.len().max(1) as u64) as usize;
    for base in eaten(outline, seen) {
        let rays: Vec<Ray> = own(&base).iter().take(CORNERED).flat_map(corners).collect();
        if rays.len() <= most / 2 {
            most -= rays.len();
            closer.rays.extend(rays);
        }
    }
    let flush = flush::lines(object, most / 4);
    most -= flush.len();
    closer.rays.extend(flush);
    let (mut pairs, mut places) = (pairs(outline, logic, extents, seen), 0);
    // Sides that cannot meet cost nothing.
    pairs.retain(|pair| {
        let is_kept = pair.region.is_empty()
            || places < PLACES.min(most / FEWEST)
                && (pair.region.is_finite() || endless::can_tell(pair.sides.each_ref().map(own)));
        places += usize::from(is_kept && !pair.region.is_empty());
        is_kept
    });
    let each = most / places.clamp(1, PLACES);
    let looks = |Pair { sides, region, .. }: &Pair| look(sides.each_ref().map(own), region, each);
    closer.rays.par_extend(pairs.par_iter().flat_map_iter(looks));
    for Pair { pieces, part, leaf, .. } in pairs {
        closer.pieces.extend(pieces);
        closer.parts.extend(part);
        closer.leaves.extend(leaf);
    }
    closer.rays.retain(Ray::is_valid);
    closer
}

/// So many lines at where two sides may meet, at most.
fn look(sides: [&[Leaf]; 2], region: &Aabb, most: usize) -> Vec<Ray> {
    if region.is_empty() {
        return Vec::new();
    }
    if !region.is_finite() {
        let mut lines = endless::lines(sides, region);
        lines.truncate(most);
        return lines;
    }
    // The first of both where there are few.
    let (mut between, mut summits) =
        (between(sides, region).into_iter(), summit::lines(sides, region).into_iter());
    let mut turns = (0..most).map(|i| match i % 2 {
        0 => between.next().or_else(|| summits.next()),
        _ => summits.next().or_else(|| between.next()),
    });
    std::iter::from_fn(|| turns.next().flatten()).collect()
}

/// The leaves of bases of which nothing was seen to be left.
fn eaten<'a>(outline: &'a Outline, seen: &'a Seen) -> impl Iterator<Item = Range<u32>> {
    let bases = outline.cuts.iter().filter_map(|cut| cut.base.as_ref());
    bases.filter(|base| !seen.left.contains(&base.at)).map(|base| base.leaves.clone())
}

/// Between what lines are sent.
fn pairs(outline: &Outline, logic: &Logic, extents: &Extents, seen: &Seen) -> Vec<Pair> {
    let of = |node: Option<u32>| extents.of(node);
    let mut pairs = Vec::new();
    for (cut, nodes) in outline.cuts.iter().zip(&logic.cuts) {
        let idle = |piece: &Piece| {
            let base = cut.base.as_ref().is_some_and(|base| !seen.left.contains(&base.at));
            base || !seen.cutting.contains(&piece.at)
        };
        let base = cut.base.as_ref().map(|base| base.leaves.clone()).unwrap_or_default();
        let around = if cut.base.is_some() { of(nodes.base) } else { Aabb::ALL };
        let cutters = cut.cutters.iter().zip(&nodes.cutters).filter(|(piece, _)| idle(piece));
        pairs.extend(cutters.map(|(piece, node)| Pair {
            pieces: cut.base.iter().map(|base| base.at).chain([piece.at]).collect(),
            ..Pair::new([base.clone(), piece.leaves.clone()], around.intersection(of(*node)))
        }));
        let shapes = nodes.shapes.iter().map(|(node, _)| (*node, logic.leaf(*node)));
        pairs.extend(shapes.filter(|(_, leaf)| !seen.biting.contains(leaf)).map(|(node, leaf)| Pair {
            leaf: Some(leaf),
            ..Pair::new([base.clone(), leaf..leaf + 1], around.intersection(of(Some(node))))
        }));
    }
    let meetings = outline.meetings.iter().zip(&logic.meetings);
    let unmet = meetings.filter(|(meeting, node)| node.is_some() && !seen.meetings.contains(&meeting.at));
    pairs.extend(unmet.map(|(m, node)| Pair { pieces: vec![m.at], ..Pair::new(m.sides.clone(), of(*node)) }));
    let region = |i: u32| of(logic.parts.get(i as usize).copied());
    let empty = outline.parts.iter().zip(0..).filter(|(_, i)| !seen.parts.contains(i));
    pairs.extend(empty.map(|(part, i)| {
        let sides = [part.leaves.clone(), part.leaves.clone()];
        Pair { part: Some(i), ..Pair::new(sides, region(i)) }
    }));
    for (a, i) in outline.parts.iter().zip(0..).take(PAIRS) {
        for (b, j) in outline.parts.iter().zip(0..).skip(i as usize + 1).take(PAIRS) {
            let region = region(i).intersection(region(j));
            if region.is_empty() || seen.overlaps.contains_key(&(i, j)) {
                continue;
            }
            pairs.push(Pair::new([a.leaves.clone(), b.leaves.clone()], region));
        }
    }
    pairs
}

/// Lines across a solid just inside the corners, edges and faces of its own box: what is left of it may be no more than those.
fn corners(leaf: &Leaf) -> Vec<Ray> {
    let own = leaf.solid.bounds();
    if !own.is_finite() || own.is_empty() {
        return Vec::new();
    }
    let (middle, half) = (own.center(), 0.5 * own.size());
    let side = |i: u32| f64::from(i % 3) - 1.0;
    let toward = (0..27).map(|i| DVec3::new(side(i), side(i / 3), side(i / 9))).filter(|s| *s != DVec3::ZERO);
    let mut rays = Vec::new();
    for s in toward {
        let (u, v) = s.normalize().any_orthonormal_pair();
        for depth in (1..=INSETS).map(|k| 0.5f64.powi(k)) {
            let at = middle + (1.0 - depth) * s * half;
            // A little askew, so that no line runs in a face.
            for dir in [u + 0.013 * v, v - 0.017 * u] {
                let local = Ray::new(at, half.max_element() * dir);
                rays.push(local.transformed(&leaf.place.world_from_local));
            }
        }
    }
    rays
}

/// Lines between shapes of two sides, and about where they can meet.
fn between([a, b]: [&[Leaf]; 2], region: &Aabb) -> Vec<Ray> {
    if is_edge(region) {
        return Vec::new();
    }
    let boxes = |side: &[Leaf]| -> Vec<Aabb> {
        side.iter().map(|leaf| leaf.bounds).filter(|b| b.is_finite() && !b.is_empty()).collect()
    };
    let (a, b) = (boxes(a), boxes(b));
    let length = a.iter().chain(&b).fold(*region, |sum, b| sum.union(*b)).diagonal();
    let each = a.iter().flat_map(|a| b.iter().map(move |b| (a.center(), b.center())));
    let joins = each.filter(|(a, b)| a != b).take(PAIRS);
    let mut joins = joins.map(|(a, b)| Ray::new(a, length * (b - a).normalize_or_zero()));
    let mut rays: Vec<Ray> = joins.next().into_iter().collect();
    rays.extend(ABOUT.map(|dir| Ray::new(region.center(), length * DVec3::from_array(dir).normalize())));
    rays.extend(joins);
    rays.extend((0..MEETING).map(|number| through(region, length, number)));
    rays
}
