//! An object as an operand of another: every instance of one shape shares it, and has only its place of its own.
//!
//! A group answers with the changes of its object's truth as they are, before any clean-up, so that an expression means
//! the same whether a part of it is a group or written out. Faces are owned by the leaves within it.

use glam::DVec3;

use super::cleanup::{Face, reach};
use super::leaf::Leaf;
use super::object::{Core, Object, Scratch};
use super::owner::{Claim, claim, filling, window};
use super::sweep::{Change, Sweep};
use crate::geom::{Aabb, Interval, Lean, Ray, tolerance};
use crate::solid::{self, Answer, Cost, Crossing, Solid};

/// An object as a solid of its own frame. Its crossings' `part` is the leaf that crosses.
#[derive(Clone, Debug)]
pub struct Group(pub(super) Object);

/// Asks with the scratch of a solid lent to an object in a frame of which this is the lean.
pub(super) fn lent<T>(scratch: &mut solid::Scratch, lean: Lean, ask: impl FnOnce(&mut Scratch) -> T) -> T {
    let kept = scratch.inner.take().and_then(|kept| kept.downcast::<Scratch>().ok());
    let mut whole = kept.unwrap_or_default();
    // What the next depth of nesting keeps stays where it is.
    std::mem::swap(&mut whole.solid, scratch);
    std::mem::swap(&mut whole.solid.inner, &mut scratch.inner);
    let above = whole.solid.frame.replace(lean);
    let answer = ask(&mut whole);
    (whole.solid.frame, whole.solid.lean) = (above, lean);
    std::mem::swap(&mut whole.solid.inner, &mut scratch.inner);
    std::mem::swap(&mut whole.solid, scratch);
    scratch.inner = Some(whole);
    answer
}

impl Group {
    fn core(&self) -> &Core {
        self.0.core()
    }

    fn sweep<T>(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut solid::Scratch,
        ask: impl FnOnce(&mut Sweep<'_>) -> T,
    ) -> T {
        let lean = scratch.lean;
        lent(scratch, lean, |Scratch { solid, room, .. }| {
            ask(&mut Sweep::new(self.core(), ray, range, room, solid))
        })
    }

    /// Who owns a crossing of the group; the normal points out of the group.
    pub(super) fn owner(&self, ray: &Ray, crossing: &Crossing, scratch: &mut solid::Scratch) -> Claim {
        let normal = self.normal(ray, crossing, scratch);
        let slope = ray.dir.dot(normal).abs();
        let reach = reach(self.core(), ray);
        // With room for the faces of neighbours of neighbours.
        let wide = 4.0 * window(reach, ray, crossing.t, slope);
        let about = Interval::new(crossing.t - wide, crossing.t + wide);
        self.sweep(ray, about, scratch, |sweep| {
            sweep.begin();
            let change = std::iter::from_fn(|| sweep.next_until(crossing.t)).find(|c| c.t == crossing.t);
            let Some(change) = change else { return self.own(ray, crossing, normal, sweep) };
            let normal = sweep.leaf_normal(change.met, &change.crossing);
            claim(sweep, &Face { change, normal, slope }, reach)
        })
    }

    /// The claim of the leaf that crosses, where the range about it begins too late to see it do so.
    fn own(&self, ray: &Ray, crossing: &Crossing, normal: DVec3, sweep: &mut Sweep<'_>) -> Claim {
        let leaf = &self.core().tree.leaves()[crossing.part as usize];
        let own = own_crossing(leaf, ray, crossing, sweep.scratch).unwrap_or(*crossing);
        let turned = own.entering != crossing.entering;
        let index = self.core().first(crossing.part);
        Claim { index, key: leaf.least_key(), material: leaf.material, crossing: own, normal, turned }
    }

    /// Of the leaves with a material that fill a point, the last written: its rank and index.
    pub(super) fn filler(&self, ray: &Ray, t: f64, scratch: &mut solid::Scratch) -> Option<(u64, u32)> {
        self.sweep(ray, Interval::new(t, t), scratch, |sweep| filling(sweep, t))
    }

    /// What the leaf that crosses does not resolve, length of the group's frame.
    pub(super) fn grain_at(&self, crossing: &Crossing) -> f64 {
        let leaf = &self.core().tree.leaves()[crossing.part as usize];
        leaf.solid.grain() * leaf.place.stretch
    }
}

/// The crossing of a leaf that makes one of its group.
fn own_crossing(leaf: &Leaf, ray: &Ray, of: &Crossing, scratch: &mut solid::Scratch) -> Option<Crossing> {
    let local = leaf.place.ray_to_local(ray);
    let mut found = Vec::new();
    for lo in [of.t.next_down(), f64::NEG_INFINITY] {
        found.clear();
        leaf.crossings(&local, Interval::new(lo, of.t), scratch, &mut found);
        // One that was found late stands before its group's.
        if let Some(own) = found.iter().rfind(|c| c.t <= of.t && (lo < c.t)) {
            return Some(*own);
        }
    }
    None
}

impl Solid for Group {
    fn bounds(&self) -> Aabb {
        self.core().bounds
    }

    /// Stops past the first crossing, far enough for the clean-up of what is around to see that nothing is near.
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut solid::Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        self.sweep(ray, range, scratch, |sweep| {
            let inside = sweep.begin();
            let mut limit = range.hi;
            while let Some(change) = sweep.next_until(limit) {
                if limit == range.hi {
                    let normal = sweep.leaf_normal(change.met, &change.crossing);
                    let near = window(reach(self.core(), ray), ray, change.t, ray.dir.dot(normal).abs());
                    limit = limit.min(change.t + tolerance::AHEAD * near);
                }
                out.push(crossing(sweep, &change));
            }
            Answer { inside, range: Interval::new(range.lo, limit) }
        })
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut solid::Scratch) -> DVec3 {
        let leaf = &self.core().tree.leaves()[crossing.part as usize];
        let lean = scratch.lean;
        lent(scratch, lean, |Scratch { solid, .. }| {
            let Some(own) = own_crossing(leaf, ray, crossing, solid) else {
                let facing = if crossing.entering { -ray.dir } else { ray.dir };
                return facing.normalize_or_zero();
            };
            let normal = leaf.solid.normal(&leaf.place.ray_to_local(ray), &own, solid);
            let normal = leaf.place.normal_to_world(normal);
            if own.entering == crossing.entering { normal } else { -normal }
        })
    }

    fn shift_bound(&self) -> f64 {
        self.core().bound.shift
    }

    fn grain(&self) -> f64 {
        self.core().bound.grain
    }

    fn cost(&self) -> Cost {
        self.core().costs.iter().copied().fold(Cost::Search, Cost::max)
    }
}

/// A change as a crossing of the group.
fn crossing(sweep: &Sweep<'_>, change: &Change) -> Crossing {
    let leaf = sweep.room.met[change.met as usize].leaf;
    let stretch = sweep.core.tree.leaves()[leaf as usize].place.stretch;
    let Change { t, crossing, entering, .. } = *change;
    Crossing { t, entering, part: leaf, shift: crossing.shift * stretch, ..crossing }
}
