//! The test lines of a check, and what the leaves say of one.
//!
//! Some lines go through the whole, some through the box of each leaf, of each solid drawn, and of where a cutter can meet
//! its base, so that what is small is seen as well as what is large. Each goes through a random point of its box in a
//! random direction; all follow from fixed seeds.

use glam::DVec3;

use super::extents::Extents;
use super::logic::Logic;
use crate::csg::{Leaf, Object};
use crate::geom::{Aabb, Interval, Ray};
use crate::num::hash::Stream;
use crate::prepare::Outline;
use crate::solid::{Crossing, Scratch};

/// Lines through the whole, each leaf, each solid drawn, each meeting of cutter and base or of operands.
const THROUGH: [u64; 4] = [2000, 24, 64, 48];
/// Lines times nodes of the expression that are looked at; beyond, only every so many-th line is cast.
pub(super) const WORK: u64 = 30_000_000;

/// All test lines of an object; `extents` are boxes around the nodes of its expression ([`super::extents`]).
pub(super) fn lines(object: &Object, outline: &Outline, logic: &Logic, extents: &Extents) -> Vec<Ray> {
    let (leaves, nodes) = (object.leaves(), logic.len());
    let parts = logic.parts.iter().zip(&outline.parts);
    let parts: Vec<Aabb> =
        parts.map(|(node, part)| extents.of(Some(*node)).intersection(part.bounds)).collect();
    let finite = leaves.iter().map(|l| l.bounds).chain(parts.iter().copied());
    let finite = finite.filter(|b| b.is_finite() && !b.is_empty());
    let mut whole = finite.fold(Aabb::EMPTY, Aabb::union);
    if whole.is_empty() {
        // Unbounded solids alone: a box around the origin that reaches them.
        let reach = leaves.iter().map(Leaf::scale).fold(0.0, f64::max);
        whole = Aabb { min: DVec3::ZERO, max: DVec3::ZERO }.inflated(if reach == 0.0 {
            1.0
        } else {
            2.0 * reach
        });
    }
    let mut targets: Vec<(Aabb, u64)> = vec![(whole, THROUGH[0])];
    targets.extend(leaves.iter().map(|l| (l.bounds, THROUGH[1])));
    targets.extend(parts.iter().map(|bounds| (*bounds, THROUGH[2])));
    for cut in &logic.cuts {
        let base = if cut.base.is_some() { extents.of(cut.base) } else { Aabb::ALL };
        targets.extend(cut.cutters.iter().map(|cutter| (base.intersection(extents.of(*cutter)), THROUGH[3])));
    }
    targets.extend(logic.meetings.iter().map(|meeting| (extents.of(*meeting), THROUGH[3])));
    let all: u64 = targets.iter().map(|t| t.1).sum();
    let every = (all * nodes.max(1) as u64).div_ceil(WORK).max(1);
    let mut lines = Vec::new();
    let mut number = 0;
    for (target, count) in targets {
        let target = target.intersection(whole);
        if !target.is_finite() || target.is_empty() || is_edge(&target) {
            continue;
        }
        for _ in 0..count {
            number += 1;
            if number % every == 0 {
                lines.push(through(&target, whole.diagonal(), number));
            }
        }
    }
    lines.retain(Ray::is_valid);
    lines
}

/// Whether a box is no more than a line: faces that only meet at an edge seem to coincide for lines through it.
pub(super) fn is_edge(target: &Aabb) -> bool {
    let flat = target.size().to_array().into_iter().filter(|side| *side == 0.0);
    1 < flat.count()
}

/// A line through a random point of a box.
pub(super) fn through(target: &Aabb, length: f64, number: u64) -> Ray {
    let mut stream = Stream::new(number);
    let share = DVec3::new(stream.unit(), stream.unit(), stream.unit());
    Ray::new(target.min + share * target.size(), length * stream.direction())
}

/// A place where a line crosses a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub t: f64,
    pub leaf: u32,
    pub crossing: Crossing,
    /// Outward, of unit length.
    pub normal: DVec3,
    /// |d . n|, d of unit length.
    pub slope: f64,
}

/// What the leaves say of a whole line: all crossings, ascending; `inside` says for each leaf whether the line begins in it.
pub(super) fn ask(
    object: &Object,
    ray: &Ray,
    inside: &mut [bool],
    events: &mut Vec<Event>,
    scratch: &mut Scratch,
) {
    events.clear();
    inside.fill(false);
    let unit = ray.dir.normalize();
    let mut found = Vec::new();
    for (i, leaf) in object.leaves().iter().enumerate() {
        let met = leaf.met(ray);
        if met.is_empty() {
            continue;
        }
        let local = leaf.place.ray_to_local(ray);
        let mut lo = met.lo;
        let mut begun = false;
        loop {
            found.clear();
            let answer = leaf.crossings(&local, Interval::new(lo, met.hi), scratch, &mut found);
            if !begun {
                let before = found.iter().rfind(|c| c.t <= lo);
                inside[i] = before.map_or(answer.inside, |c| c.entering);
                begun = true;
            }
            for crossing in found.iter().filter(|c| lo < c.t && c.t <= answer.range.hi) {
                let normal = leaf.place.normal_to_world(leaf.solid.normal(&local, crossing, scratch));
                let slope = unit.dot(normal).abs();
                events.push(Event { t: crossing.t, leaf: i as u32, crossing: *crossing, normal, slope });
            }
            if met.hi <= answer.range.hi || answer.range.hi <= lo {
                break;
            }
            lo = answer.range.hi;
        }
    }
    events.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.leaf.cmp(&b.leaf)));
}
