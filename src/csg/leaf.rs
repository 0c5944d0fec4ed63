//! A solid with its place, as an operand of an expression.

use std::sync::Arc;

use crate::geom::{Aabb, Interval, Placement, Ray, tolerance};
use crate::solid::{Answer, Crossing, Scratch, Solid};

/// A solid, placed, as an operand.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// The solid in its own frame.
    pub solid: Arc<dyn Solid>,
    /// Where it stands.
    pub place: Placement,
    /// A world box around its boundary; unbounded where the solid is.
    pub bounds: Aabb,
    /// Its name, as the scene calls it.
    pub name: Arc<str>,
    /// Its own material, an index that CSG does not interpret.
    pub material: Option<u32>,
    /// Whether it is taken away from something: its faces are cuts.
    pub cutter: bool,
    /// The source position of the call that made it: earlier calls own shared faces.
    pub rank: u64,
}

impl Leaf {
    /// Places a solid; name, material, cutter and rank are set by the caller.
    pub fn new(solid: Arc<dyn Solid>, place: Placement) -> Leaf {
        let bounds = solid.bounds().transformed(&place.world_from_local);
        Leaf { solid, place, bounds, name: "".into(), material: None, cutter: false, rank: 0 }
    }

    /// The largest length of the leaf that enters its rounding errors: its size and its distance from the world's
    /// origin.
    pub fn scale(&self) -> f64 {
        let reach =
            if self.bounds.is_finite() && !self.bounds.is_empty() { self.bounds.farthest() } else { 0.0 };
        reach.max(self.place.offset())
    }

    /// The box grown by what rounding may move a crossing out of it. Box and crossings are rounded apart, each by as much
    /// as two faces that were one; so it is grown by what the clean-up takes for nothing, and more where the frame is
    /// skewed. A ray that starts far away adds its own share ([`super::hierarchy::Probe`]).
    pub(super) fn grown(&self) -> Aabb {
        if self.bounds.is_empty() {
            return Aabb::EMPTY;
        }
        self.bounds.inflated(tolerance::cleanup(self.scale()) * self.place.condition)
    }

    /// The part of a ray's line that can meet the leaf.
    pub fn met(&self, ray: &Ray) -> Interval {
        let far = tolerance::cleanup(ray.origin.length()) * self.place.condition;
        self.grown().inflated(far).clip(ray)
    }

    /// Appends crossings of a ray given in the leaf's frame ([`Solid::crossings`]), and counts. An answer that is none says
    /// that the ray passes by.
    pub fn crossings(
        &self,
        local: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        scratch.counts.leaf_queries += 1;
        scratch.lean = self.place.lean;
        let first = out.len();
        let answer = self.solid.crossings(local, range, scratch, out);
        if answer.is_sound(&out[first..], || self.solid.body()) {
            return answer;
        }
        scratch.counts.bad_leaves += 1;
        out.truncate(first);
        Answer::whole_line(false)
    }

    /// Whether it shows on faces of leaves without a material that it fills.
    pub(super) fn can_fill(&self) -> bool {
        self.material.is_some() && !self.cutter
    }

    /// Who owns a face that several leaves share: the smallest key.
    pub fn key(&self) -> (bool, bool, u64) {
        (self.material.is_none(), self.cutter, self.rank)
    }
}
