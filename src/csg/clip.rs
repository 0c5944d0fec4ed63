//! Surfaces cut off where a solid ends, without caps.

use std::sync::Arc;

use glam::DVec3;

use super::group::lent;
use super::leaf::Leaf;
use super::object::{Object, Scratch};
use super::spans::{Boundary, Spans};
use crate::geom::{Aabb, Interval, Lean, Ray};
use crate::solid::{self, Answer, Body, Crossing, Solid};

/// What is clipped.
#[derive(Clone, Debug)]
pub enum Clippee {
    /// A sheet.
    Sheet(Box<Leaf>),
    /// The faces that one leaf of an object owns.
    Faces(Arc<Object>, u32),
}

/// The part of a surface inside a solid, a [`Body::Sheet`] in the world's own frame.
#[derive(Clone, Debug)]
pub struct Clipped {
    /// The surface.
    pub of: Clippee,
    /// The solid.
    pub by: Arc<Object>,
    /// A box around the solid.
    pub within: Aabb,
}

impl Clipped {
    /// All crossings of the surface in a range, ascending.
    fn surface(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Vec<Crossing> {
        match &self.of {
            Clippee::Sheet(leaf) => {
                let local = leaf.place.ray_to_local(ray);
                let (mut lo, mut all) = (range.lo, Vec::new());
                while lo <= range.hi {
                    let rest = Interval::new(lo, range.hi);
                    let answer = leaf.crossings(&local, rest, &mut scratch.solid, &mut all);
                    if answer.range.hi <= lo {
                        break;
                    }
                    lo = answer.range.hi;
                }
                all
            }
            Clippee::Faces(object, leaf) => {
                let own = faces(object, ray, scratch);
                let own = own.filter(|(b, _)| b.leaf == *leaf && range.lo < b.t && b.t <= range.hi);
                own.map(|(b, entering)| Crossing { t: b.t, entering, ..b.crossing }).collect()
            }
        }
    }
}

/// Every boundary of an object on a ray's line, and whether the ray goes in there.
fn faces(object: &Object, ray: &Ray, scratch: &mut Scratch) -> impl Iterator<Item = (Boundary, bool)> {
    let mut spans = Spans::new();
    object.spans(ray, Interval::ALL, scratch, &mut spans);
    let ends = |s: super::Span| [s.enter.map(|b| (b, true)), s.exit.map(|b| (b, false))];
    spans.into_iter().flat_map(ends).flatten()
}

impl Solid for Clipped {
    fn body(&self) -> Body {
        Body::Sheet
    }

    fn sheet_remedy(&self) -> &'static str {
        "combine the shape before it is clipped; `&` with what clips it keeps the inside"
    }

    fn bounds(&self) -> Aabb {
        let own = match &self.of {
            Clippee::Sheet(leaf) => leaf.bounds,
            Clippee::Faces(object, leaf) => object.leaves()[*leaf as usize].bounds,
        };
        own.intersection(self.within)
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut solid::Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        let lean = scratch.lean;
        lent(scratch, lean, |scratch| {
            let found = self.surface(ray, range, scratch);
            if found.is_empty() {
                return;
            }
            let mut inside = Spans::new();
            self.by.spans(ray, Interval::ALL, scratch, &mut inside);
            out.extend(found.into_iter().filter(|c| inside.iter().any(|s| s.interval().contains(c.t))));
        });
        Answer { inside: false, range: Interval::new(range.lo, f64::INFINITY) }
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut solid::Scratch) -> DVec3 {
        match &self.of {
            Clippee::Sheet(leaf) => leaf.normal(&leaf.place.ray_to_local(ray), crossing, scratch),
            Clippee::Faces(object, leaf) => lent(scratch, Lean::of_world(), |scratch| {
                let same = |(b, _): &(Boundary, bool)| b.leaf == *leaf && b.t == crossing.t;
                let face = faces(object, ray, scratch).find(same);
                let facing = if crossing.entering { -ray.dir } else { ray.dir };
                face.map_or_else(|| facing.normalize_or_zero(), |(b, _)| b.normal)
            }),
        }
    }

    fn shift_bound(&self) -> f64 {
        match &self.of {
            Clippee::Sheet(leaf) => leaf.solid.shift_bound() * leaf.place.stretch,
            Clippee::Faces(object, leaf) => {
                let leaf = &object.leaves()[*leaf as usize];
                leaf.solid.shift_bound() * leaf.place.stretch
            }
        }
    }
}
