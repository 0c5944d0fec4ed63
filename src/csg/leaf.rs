//! A solid with its place, as an operand of an expression.

use std::sync::Arc;

use glam::DVec3;

use super::group::Group;
use super::object::Object;
use crate::geom::{Aabb, Interval, Lean, Placement, Ray, tolerance};
use crate::solid::{Answer, Chord, Crossing, Scratch, Solid};

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
    /// What the solid is, where it is an object itself ([`Leaf::instance`]).
    pub group: Option<Arc<Group>>,
}

/// Who owns what: an explicit material before none, the base before a cutter, the earlier before the later.
pub type Key = (bool, bool, u64);

impl Leaf {
    /// Places a solid; name, material, cutter and rank are set by the caller.
    pub fn new(solid: Arc<dyn Solid>, place: Placement) -> Leaf {
        let bounds = solid.bounds().transformed(&place.world_from_local);
        Leaf { solid, place, bounds, name: "".into(), material: None, cutter: false, rank: 0, group: None }
    }

    /// An object in another frame. Names, materials, cutters and ranks are those of its own leaves.
    pub fn instance(object: &Object, place: Placement) -> Leaf {
        let group = Arc::new(Group(object.clone()));
        Leaf { group: Some(group.clone()), ..Leaf::new(group, place) }
    }

    /// The largest length of the leaf that enters its rounding errors: its size and its distance from the world's
    /// origin.
    pub fn scale(&self) -> f64 {
        let reach =
            if self.bounds.is_finite() && !self.bounds.is_empty() { self.bounds.farthest() } else { 0.0 };
        let within = self.group.as_ref().map_or(0.0, |group| group.0.core().bound.scale * self.place.stretch);
        reach.max(within).max(self.place.offset())
    }

    /// The box grown by what rounding may move a crossing out of it. Box and crossings are rounded apart, each by as much
    /// as two faces that were one; so it is grown by what the clean-up takes for nothing, and more where the frame is
    /// skewed. A ray that starts far away adds its own share ([`super::walk::Walk`]).
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
    #[inline]
    pub fn crossings(
        &self,
        local: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        scratch.counts.leaf_queries += 1;
        scratch.lean = self.lean(scratch);
        let first = out.len();
        let answer = self.solid.crossings(local, range, scratch, out);
        if answer.is_sound(&out[first..], || self.solid.body()) {
            return answer;
        }
        scratch.counts.bad_leaves += 1;
        out.truncate(first);
        Answer::whole_line(false)
    }

    /// The part of a ray's line that is inside, where the leaf knows it in closed form ([`Solid::chord`]); counts as
    /// [`Leaf::crossings`] does, and tells the same.
    #[inline(always)]
    pub(super) fn chord(&self, ray: &Ray, scratch: &mut Scratch) -> Option<Chord> {
        let mut moved = None;
        let local = self.place.local_ray(ray, &mut moved);
        let taken = scratch.frame.map(|frame| frame.taken(&self.place.local_from_world.matrix3));
        let chord = self.solid.chord(local, taken.as_ref().unwrap_or(&self.place.lean))?;
        scratch.counts.leaf_queries += 1;
        if chord.is_sound() {
            return Some(chord);
        }
        scratch.counts.bad_leaves += 1;
        Some(Chord::NONE)
    }

    /// How rays lean in its frame.
    #[inline]
    fn lean(&self, scratch: &Scratch) -> Lean {
        scratch.frame.map_or(self.place.lean, |frame| frame.taken(&self.place.local_from_world.matrix3))
    }

    /// The outward unit normal at a crossing of a ray given in the leaf's frame, in the frame that its place is given in.
    #[inline]
    pub fn normal(&self, local: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        scratch.lean = self.lean(scratch);
        self.place.normal_to_world(self.solid.normal(local, crossing, scratch))
    }

    /// The same of a ray that is not in the leaf's frame.
    #[inline(always)]
    pub(super) fn normal_along(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        let mut moved = None;
        self.normal(self.place.local_ray(ray, &mut moved), crossing, scratch)
    }

    /// What is not resolved about a crossing ([`Solid::grain`]), in the frame that the place is given in.
    pub(super) fn grain_at(&self, crossing: &Crossing) -> f64 {
        let own = self.group.as_ref().map_or_else(|| self.solid.grain(), |group| group.grain_at(crossing));
        own * self.place.stretch
    }

    /// Asks the group that it is.
    pub(super) fn ask_group<T>(
        &self,
        group: &Group,
        scratch: &mut Scratch,
        ask: impl FnOnce(&Group, &mut Scratch) -> T,
    ) -> T {
        scratch.lean = self.lean(scratch);
        ask(group, scratch)
    }

    /// Whether it, or a leaf in it, shows on faces of leaves without a material that it fills.
    pub(super) fn can_fill(&self) -> bool {
        match &self.group {
            None => self.material.is_some() && !self.cutter,
            Some(group) => group.0.core().can_fill,
        }
    }

    /// Who owns a face that several leaves share: the smallest key.
    pub fn key(&self) -> Key {
        (self.material.is_none(), self.cutter, self.rank)
    }

    /// The smallest key of it and the leaves in it.
    pub(super) fn least_key(&self) -> Key {
        self.group.as_ref().map_or_else(|| self.key(), |group| group.0.core().least_key)
    }

    /// Appends the materials of it and of the leaves in it; what is taken away fills nothing.
    pub fn materials(&self, out: &mut Vec<u32>) {
        if self.cutter {
            return;
        }
        out.extend(self.material);
        if let Some(group) = &self.group {
            group.0.leaves().iter().for_each(|leaf| leaf.materials(out));
        }
    }

    /// How many leaves it is, those in it counted.
    pub(super) fn count(&self) -> u32 {
        self.group.as_ref().map_or(1, |group| group.0.core().count)
    }
}
