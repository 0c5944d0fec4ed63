//! Boxes around what is left of shapes that are cut: how far out along an axis lines are still inside.
//!
//! The end of a solid along an axis is the largest `t` at which a line along it leaves, over the plane across it. Lines go
//! through the cells of [`super::cells`], so that each leaf is looked at in its own box, and from the farthest ends found a simplex
//! climbs (Nelder and Mead 1965): it stretches along ridges, where what only divides stops short of the corner, and needs no
//! slopes, which a corner has not. It begins anew where it stopped, turned, until that gains nothing. A box found so is not one
//! around the solid but one that it reaches: the bar says what may be missing, and holds where no peak is missed that is narrower
//! than the first lines are apart in the box of its leaf. Where the box around it is proved to be tight the true side lies between
//! that and the one reached, and the bar is what these are apart.
//!
//! Sheets are met, not passed through: their ends are the crossings. One that lies along an axis is met by no line along it, and
//! keeps the side of its box there.

use glam::DVec2;
use rayon::prelude::*;

use super::cells::{Planes, Rect};
use super::integrals::line;
use crate::csg::{Scratch, Spans};
use crate::geom::{Aabb, Interval, tolerance};
use crate::num::hash::{Stream, mix};
use crate::shot::World;

/// Places in a rectangle at which lines are cast.
const LINES: usize = 4;
/// From so many rectangles with the farthest ends a simplex climbs.
const CLIMBERS: usize = 8;
/// Steps of one climb, and climbs, at most; with so many in a row that gain nothing there are no more.
const STEPS: usize = 150;
const CLIMBS: usize = 24;
const IDLE: usize = 2;

/// The box that a world reaches within one that holds it, and a bar for its sides; `None` where no line meets it. `is_tight` says
/// that its own sides are meant to be those of the box around it, which is certain.
pub fn reached(world: &World, around: &Aabb, is_tight: bool) -> Option<(Aabb, f64)> {
    let grain = tolerance::cleanup(around.farthest());
    let (mut found, mut bar, mut is_met) = (*around, 0.0f64, false);
    let sheets = world.open().iter().map(|sheet| sheet.bounds.intersection(*around));
    let boxes: Vec<Aabb> = world.solids().reaches().iter().copied().chain(sheets).collect();
    for axis in 0..3 {
        let (_, cells) = Planes::new(around, &boxes, &[axis], grain);
        let first = look(world, around, cells);
        for (side, sign) in [(&mut found.min, -1.0), (&mut found.max, 1.0)] {
            let Some((end, err)) = (Search { world, around, axis, sign, grain }).farthest(&first) else {
                continue;
            };
            is_met = true;
            let missing = (side[axis] - end).abs();
            if is_tight {
                bar = bar.max(missing);
            } else if err + grain < missing {
                // What is all but reached is.
                side[axis] = end;
                bar = bar.max(err + grain);
            }
        }
    }
    is_met.then_some((found, bar))
}

/// Where the lines through a rectangle are inside first and last; empty where none is.
type Ends = (Rect, Interval);

/// Where a line along an axis is inside first and last; empty where it is not.
fn ends(world: &World, around: &Aabb, axis: usize, place: DVec2, lent: &mut (Scratch, Spans)) -> Interval {
    let (scratch, spans) = lent;
    let ray = line(around, axis, place.to_array());
    spans.clear();
    world.spans(&ray, Interval::ALL, scratch, spans);
    let mut found = match (spans.first(), spans.last()) {
        (Some(first), Some(last)) => Interval::new(first.interval().lo, last.interval().hi),
        _ => Interval::EMPTY,
    };
    if !world.open().is_empty() {
        let mut hits = Vec::new();
        world.sheets(&ray, Interval::ALL, scratch, &mut hits);
        for hit in hits {
            found = Interval::new(found.lo.min(hit.boundary.t), found.hi.max(hit.boundary.t));
        }
    }
    if found.is_empty() { found } else { Interval::new(ray.at(found.lo)[axis], ray.at(found.hi)[axis]) }
}

fn look(world: &World, around: &Aabb, rects: Vec<Rect>) -> Vec<Ends> {
    let rects = rects.into_par_iter().enumerate().with_min_len(4);
    let one = |lent: &mut (Scratch, Spans), (i, rect): (usize, Rect)| {
        let mut stream = Stream::new(mix(i as u64));
        let mut sum = Interval::EMPTY;
        for _ in 0..LINES {
            let place = rect.min + DVec2::new(stream.unit(), stream.unit()) * rect.size();
            let found = ends(world, around, rect.axis, place, lent);
            sum = Interval::new(sum.lo.min(found.lo), sum.hi.max(found.hi));
        }
        (rect, sum)
    };
    rects.map_init(Default::default, one).collect()
}

/// For the end along an axis, toward lower values where `sign` is -1.
struct Search<'a> {
    world: &'a World,
    around: &'a Aabb,
    axis: usize,
    sign: f64,
    /// A simplex smaller than that climbs no more.
    grain: f64,
}

/// A place of the plane, and how far the solid reaches there.
type Corner = (DVec2, f64);

impl Search<'_> {
    fn reach(&self, found: Interval) -> f64 {
        if self.sign < 0.0 { -found.lo } else { found.hi }
    }

    /// How far the solid reaches, and how much farther it may; `None` where no line is inside.
    fn farthest(&self, first: &[Ends]) -> Option<(f64, f64)> {
        let mut starts: Vec<&Ends> = first.iter().filter(|ends| !ends.1.is_empty()).collect();
        starts.sort_by(|a, b| self.reach(b.1).total_cmp(&self.reach(a.1)));
        starts.truncate(CLIMBERS);
        let climbed =
            starts.par_iter().map_init(Default::default, |lent, ends| self.climb_from(&ends.0, lent));
        let found: Vec<(f64, f64)> = climbed.collect();
        let (end, gain) = found.into_iter().reduce(|a, b| if a.0 < b.0 { b } else { a })?;
        let end = end.max(self.reach(starts[0].1));
        // Climbs that begin anew gain ever less; four times the last gains is more than what is left.
        Some((self.sign * end, 4.0 * gain + tolerance::reached(self.around.size()[self.axis])))
    }

    /// The farthest end that climbs from a rectangle come to, and what the last of them gained.
    fn climb_from(&self, rect: &Rect, lent: &mut (Scratch, Spans)) -> (f64, f64) {
        let least = tolerance::reached(self.around.size()[self.axis]);
        let mut stream = Stream::new(mix(self.axis as u64));
        let mut best = (0.5 * (rect.min + rect.max), f64::NEG_INFINITY);
        let (mut gains, mut idle) = (Vec::new(), 0);
        while idle < IDLE && gains.len() < CLIMBS {
            let size = 0.5 * rect.size() * 0.5f64.powi(gains.len() as i32 / 2);
            let turn = DVec2::from_angle(std::f64::consts::TAU * stream.unit());
            let corners = [DVec2::X, DVec2::Y].map(|side| best.0 + turn.rotate(side) * size);
            let found = self.climb([best.0, corners[0], corners[1]], lent);
            let gain = found.1 - best.1;
            idle = if gain <= least { idle + 1 } else { 0 };
            // Where nothing was inside yet there is no gain to speak of.
            gains.push(if gain.is_finite() { gain.max(0.0) } else { 0.0 });
            best = if best.1 < found.1 { found } else { best };
        }
        (best.1, gains.iter().rev().take(IDLE).fold(0.0, |a: f64, b| a.max(*b)))
    }

    /// Nelder and Mead's simplex, with their coefficients.
    fn climb(&self, places: [DVec2; 3], lent: &mut (Scratch, Spans)) -> Corner {
        let mut at = |place: DVec2| -> Corner {
            let found = ends(self.world, self.around, self.axis, place, lent);
            (place, if found.is_empty() { f64::NEG_INFINITY } else { self.reach(found) })
        };
        let mut all = places.map(&mut at);
        for _ in 0..STEPS {
            all.sort_by(|a, b| b.1.total_cmp(&a.1));
            let [best, second, worst] = all;
            if (best.0 - worst.0).length().max((best.0 - second.0).length()) <= self.grain {
                break;
            }
            let middle = 0.5 * (best.0 + second.0);
            let away = middle - worst.0;
            let reflected = at(middle + away);
            if best.1 < reflected.1 {
                let expanded = at(middle + 2.0 * away);
                all[2] = if reflected.1 < expanded.1 { expanded } else { reflected };
            } else if second.1 < reflected.1 {
                all[2] = reflected;
            } else {
                let toward = if worst.1 < reflected.1 { 0.5 } else { -0.5 };
                let contracted = at(middle + toward * away);
                if worst.1.max(reflected.1) < contracted.1 {
                    all[2] = contracted;
                } else {
                    all[1] = at(0.5 * (best.0 + second.0));
                    all[2] = at(0.5 * (best.0 + worst.0));
                }
            }
        }
        all.into_iter().reduce(|a, b| if a.1 < b.1 { b } else { a }).unwrap_or((places[0], f64::NEG_INFINITY))
    }
}
