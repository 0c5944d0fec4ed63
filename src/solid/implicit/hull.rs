//! A box around all points of a box, or of its image, at which a formula holds: certain, and tight where intervals tell it.
//!
//! From each side of the image's box a slab is sought that is proved to hold no point: its inner face goes inward by
//! bisection. A slab is empty where every part of it is: where the interval of the formula's values over a part does not reach
//! zero, each step's narrowed by its mean value form f(m) + D (X - m) where that is continuous, or where the part lies out of
//! the box (branch and bound: Moore, Kearfott and Cloud 2009, chapters 5 and 10). Parts are halved across the side over which
//! the values differ most (the smear rule: Kearfott 1996), as a ridge is not cut along, those with the lowest value in the
//! middle first: so a point at which the formula holds, and the slab is known not to be empty, is met soon. Everything is done
//! in the frame of the image, whose sides are the box's. Where lines of closed forms would be exact, such as the top of a ball,
//! the bound is to [`FINEST`]; where intervals tell less it stays as far out as it is proved, never inside.
//!
//! Degenerate: a formula that holds nowhere has the empty box, if that is proved; one that holds up to a side keeps that side.
//! Oracle: balls and ellipsoids far from the middle of their box (`tests/measure_boxes.rs`).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DAffine3, DVec3};

use super::tape::{self, Room};
use crate::geom::Aabb;
use crate::num::enclosure::Enclosure;
use crate::scene::Formula;

/// Slabs thinner than this share of the box are not sought.
const FINEST: f64 = 1.0 / (1u64 << 44) as f64;
/// Parts that are looked at to prove one slab empty, and for one side.
const PARTS: u32 = 1 << 10;
const PARTS_OF_SIDE: u32 = 1 << 13;

/// The box around the image of the points of a box at which a formula holds.
pub(super) fn hull(formula: &Formula, within: &Aabb, to_from: &DAffine3) -> Aabb {
    let around = within.transformed(to_from);
    let from_to = to_from.inverse();
    if !from_to.is_finite() || !around.is_finite() || around.is_empty() {
        return around;
    }
    let mut search = Search { formula, within, from_to, room: Room::default(), means: Vec::new() };
    let mut found = around;
    for axis in 0..3 {
        for far in [false, true] {
            let Some(side) = search.side(&found, axis, far) else { return Aabb::EMPTY };
            if far { found.max[axis] = side } else { found.min[axis] = side }
        }
    }
    found
}

struct Search<'a> {
    formula: &'a Formula,
    within: &'a Aabb,
    from_to: DAffine3,
    room: Room,
    /// What each step's values lie in beside what its operands say.
    means: Vec<Enclosure>,
}

/// A part of a slab, with the value in its middle.
struct Part(Aabb, f64);

impl PartialEq for Part {
    fn eq(&self, other: &Part) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Part) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// The lowest value is the greatest; corners make the order one of all parts.
    fn cmp(&self, other: &Part) -> Ordering {
        let corner = |part: &Part| part.0.min.to_array();
        let corners = corner(self).into_iter().zip(corner(other)).map(|(a, b)| a.total_cmp(&b));
        other.1.total_cmp(&self.1).then(corners.fold(Ordering::Equal, Ordering::then))
    }
}

impl Search<'_> {
    /// Where a side can stand; `None` where nothing is left in the box.
    fn side(&mut self, around: &Aabb, axis: usize, far: bool) -> Option<f64> {
        let (outer, inner) = if far { (around.max, around.min) } else { (around.min, around.max) };
        let (mut proved, mut open) = (outer[axis], inner[axis]);
        let mut left = PARTS_OF_SIDE;
        let slab = |from: f64, to: f64| {
            let mut slab = *around;
            (slab.min[axis], slab.max[axis]) = (from.min(to), from.max(to));
            slab
        };
        if self.is_empty(&slab(proved, open), &mut left) {
            return None;
        }
        let finest = FINEST * around.size()[axis];
        while finest < (proved - open).abs() && 0 < left {
            let middle = 0.5 * (proved + open);
            // What lies beyond `proved` is empty already.
            if self.is_empty(&slab(middle, proved), &mut left) {
                proved = middle;
            } else {
                open = middle;
            }
        }
        Some(proved)
    }

    /// Whether a slab is proved to hold no point; `left` counts down the parts looked at.
    fn is_empty(&mut self, slab: &Aabb, left: &mut u32) -> bool {
        let last = left.saturating_sub(PARTS);
        let mut parts = BinaryHeap::from([Part(*slab, 0.0)]);
        while let Some(Part(part, _)) = parts.pop() {
            if *left <= last {
                return false;
            }
            *left -= 1;
            let Some(along) = self.left(&part) else { continue };
            let middle = part.center();
            if !(part.min[along] < middle[along] && middle[along] < part.max[along]) {
                return false;
            }
            let (mut low, mut high) = (part, part);
            (low.max[along], high.min[along]) = (middle[along], middle[along]);
            for half in [low, high] {
                let value = self.value(half.center());
                if value.is_some_and(|value| self.holds(value)) {
                    return false;
                }
                parts.push(Part(half, value.unwrap_or(f64::INFINITY)));
            }
        }
        true
    }

    fn holds(&self, value: f64) -> bool {
        if self.formula.closed { value <= 0.0 } else { value < 0.0 }
    }

    /// The value at a point of the box, where it has one.
    fn value(&mut self, at: DVec3) -> Option<f64> {
        let own = self.from_to.transform_point3(at);
        if !self.within.contains(own) {
            return None;
        }
        let value = tape::value(&self.formula.steps, own, &mut self.room);
        value.is_finite().then_some(value)
    }

    /// The coordinates of a part in the formula's own frame.
    fn own(&self, part: [Enclosure; 3]) -> [Enclosure; 3] {
        let rows = self.from_to.matrix3.transpose();
        let row = [rows.x_axis, rows.y_axis, rows.z_axis];
        std::array::from_fn(|i| {
            let term = |j: usize| part[j].times(Enclosure::point(row[i][j]));
            let moved = self.from_to.translation[i];
            // An axis that is not turned keeps its corners as they are.
            let terms = (0..3).filter(|j| row[i][*j] != 0.0).map(term).reduce(|a, b| a + b);
            let sum = terms.unwrap_or(Enclosure::point(0.0));
            if moved == 0.0 { sum } else { sum + Enclosure::point(moved) }
        })
    }

    /// Across which side a part is halved; `None` where no point of it is in the box and lets the formula hold.
    fn left(&mut self, part: &Aabb) -> Option<usize> {
        let sides = |p: &Aabb| std::array::from_fn(|i| Enclosure::new(p.min[i], p.max[i]));
        let steps = &self.formula.steps;
        let outer: [Enclosure; 3] = sides(part);
        let mut own = self.own(outer);
        for (axis, side) in own.iter_mut().enumerate() {
            *side = side.intersect(Enclosure::new(self.within.min[axis], self.within.max[axis]));
            if side.is_empty() {
                return None;
            }
        }
        let values = tape::enclose(steps, &own, &mut self.room);
        if self.is_above(values) {
            return None;
        }
        let spread = self.narrow(part, outer);
        let own = self.own(outer);
        let values = tape::enclose_within(steps, &own, &self.means, &mut self.room);
        (!self.is_above(values)).then(|| largest(spread))
    }

    /// The mean value form of every step over a part, to [`Search::means`], and by how much the formula's differs over each side.
    fn narrow(&mut self, part: &Aabb, sides: [Enclosure; 3]) -> DVec3 {
        let steps = &self.formula.steps;
        let (middle, own) = (part.center().to_array().map(Enclosure::point), self.own(sides));
        let own_middle = self.own(middle);
        tape::enclose(steps, &own_middle, &mut self.room);
        self.means.clone_from(&self.room.enclosures);
        let (size, mut spread) = (part.size(), part.size());
        for axis in 0..3 {
            let rates = self.from_to.matrix3.col(axis);
            let slope = tape::slope(steps, &own, rates, &mut self.room);
            let away = sides[axis] - middle[axis];
            for (mean, slope) in self.means.iter_mut().zip(&self.room.slopes) {
                let smooth = !slope.value.breaks.any() && !slope.rate.breaks.any();
                *mean = if smooth {
                    *mean + slope.rate.times(away)
                } else {
                    Enclosure::new(f64::NEG_INFINITY, f64::INFINITY)
                };
            }
            let steepest = slope.rate.lo.abs().max(slope.rate.hi.abs());
            spread[axis] = size[axis] * if steepest.is_finite() { steepest } else { 1.0 };
        }
        spread
    }

    /// Whether the formula holds for none of these values.
    fn is_above(&self, values: Enclosure) -> bool {
        values.is_empty() || 0.0 < values.lo || (values.lo == 0.0 && !self.formula.closed)
    }
}

fn largest(of: DVec3) -> usize {
    let larger = usize::from(of.x < of.y);
    if of[larger] < of.z { 2 } else { larger }
}
