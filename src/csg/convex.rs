//! The short way through an intersection of many convex closed forms, such as a polytope: the ray is inside from where it
//! enters the last to where it leaves the first. It answers only where nothing else crosses near an end that it tells, so
//! that neither the clean-up nor the choice of an owner has a say; all other rays go the long way ([`super::sweep`]), with
//! the same answers. A leaf costs its own roots so, not also its place among thousands that wait.

use super::expr::Expr;
use super::few::far_at;
use super::object::{Core, Scratch};
use super::spans::{Boundary, Span};
use super::tree::Tree;
use crate::geom::{Interval, Ray};
use crate::solid::{Cost, Crossing};

/// The leaves of an object that is the intersection of all of them.
#[derive(Clone, Debug)]
pub(super) struct Convex {
    leaves: Vec<u32>,
    /// Of those with a material that can show on others' faces the last written: wherever the object is, all are.
    filler: Option<u32>,
}

/// One end of the part inside.
#[derive(Clone, Copy)]
struct End {
    t: f64,
    leaf: u32,
    part: u32,
    /// The end of the next leaf, further out.
    next: f64,
}

impl End {
    /// Whether it is a boundary that a range holds.
    fn is_in(&self, range: Interval) -> bool {
        range.lo < self.t && self.t <= range.hi && self.t.is_finite()
    }
}

impl Convex {
    /// `None` where it is not only an intersection, or of other leaves.
    pub fn new(tree: &Tree, costs: &[Cost], expr: &Expr) -> Option<Convex> {
        let mut open = vec![expr];
        while let Some(next) = open.pop() {
            match next {
                Expr::Leaf(_) => {}
                Expr::And(list) => open.extend(list),
                Expr::Shared(inner) => open.push(inner),
                Expr::Not(_) | Expr::Or(_) | Expr::Xor(_) => return None,
            }
        }
        // Of leaves alike only one counts.
        let counts = |leaf: &u32| !tree.leaf_ups.of(*leaf as usize).is_empty();
        let leaves: Vec<u32> = (0..tree.leaves().len() as u32).filter(counts).collect();
        if leaves.iter().any(|leaf| costs[*leaf as usize] != Cost::Closed) {
            return None;
        }
        let can = leaves.iter().copied().filter(|leaf| tree.leaves()[*leaf as usize].can_fill());
        let filler = can.max_by_key(|leaf| (tree.last[*leaf as usize], *leaf));
        Some(Convex { leaves, filler })
    }

    /// The first boundary in the range, and whether the ray goes in there; `None` where the long way has to tell.
    pub fn first(
        &self,
        core: &Core,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
    ) -> Option<Option<(Boundary, bool)>> {
        let Some(ends) = self.look(core, ray, range, scratch)? else { return Some(None) };
        let Some(which) = ends.iter().position(|end| end.is_in(range)) else { return Some(None) };
        let boundary = self.boundary(core, ray, ends, which, scratch)?;
        Some(Some((boundary, which == 0)))
    }

    /// Whether any part of the range is inside; `None` where the long way has to tell.
    pub fn any(&self, core: &Core, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<bool> {
        Some(self.span(core, ray, range, scratch)?.is_some())
    }

    /// The one span, cut to the range; `None` where the long way has to tell.
    pub fn span(
        &self,
        core: &Core,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
    ) -> Option<Option<Span>> {
        let Some(ends) = self.look(core, ray, range, scratch)? else { return Some(None) };
        let mut told = [None; 2];
        for which in [0, 1] {
            if ends[which].is_in(range) {
                told[which] = Some(self.boundary(core, ray, ends, which, scratch)?);
            }
        }
        let [enter, exit] = told;
        Some(Some(Span { enter, exit }))
    }

    /// The last entry and the first exit, where what is between them reaches into the range; `None` where the long way has to
    /// tell.
    fn look(
        &self,
        core: &Core,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
    ) -> Option<Option<[End; 2]>> {
        let none = |t: f64| End { t, leaf: 0, part: 0, next: t };
        let mut ends = [none(f64::NEG_INFINITY), none(f64::INFINITY)];
        for &leaf in &self.leaves {
            let chord = core.tree.leaves()[leaf as usize].chord(ray, &mut scratch.solid)?;
            let [lo, hi] = chord.ends;
            if ends[0].t < lo {
                ends[0] = End { t: lo, leaf, part: chord.parts[0], next: ends[0].t };
            } else {
                ends[0].next = ends[0].next.max(lo);
            }
            if hi < ends[1].t {
                ends[1] = End { t: hi, leaf, part: chord.parts[1], next: ends[1].t };
            } else {
                ends[1].next = ends[1].next.min(hi);
            }
            if ends[1].t <= ends[0].t {
                return Some(None);
            }
        }
        Some((range.lo < ends[1].t && ends[0].t <= range.hi).then_some(ends))
    }

    /// The boundary at one of the ends; `None` where something else lies near.
    fn boundary(
        &self,
        core: &Core,
        ray: &Ray,
        ends: [End; 2],
        which: usize,
        scratch: &mut Scratch,
    ) -> Option<Boundary> {
        let End { t, leaf, part, next } = ends[which];
        let crossing = Crossing::exact(t, which == 0, part);
        let own = &core.tree.leaves()[leaf as usize];
        let normal = own.normal_along(ray, &crossing, &mut scratch.solid);
        let is_far = far_at(core, ray, t, normal);
        if [next, ends[1 - which].t].iter().any(|other| !is_far((other - t).abs())) {
            return None;
        }
        let filler = if own.material.is_some() { None } else { self.filler.map(|leaf| core.first(leaf)) };
        Some(Boundary { t, leaf: core.first(leaf), crossing, normal, flipped: false, filler })
    }
}
