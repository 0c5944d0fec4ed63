//! An object: a tree with what its sweeps share.

use super::cleanup::{Bound, Cleaner};
use super::spans::{Boundary, Spans};
use super::sweep::{Room, Sweep};
use super::tree::{Expr, Leaf, Tree};
use super::truth::State;
use crate::geom::{Interval, Ray};
use crate::solid;

/// What queries of objects need beside their arguments, one for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    /// What solids need; the counts of work.
    pub solid: solid::Scratch,
    room: Room,
}

impl Scratch {
    /// With what a solid lends.
    pub(super) fn lent(solid: solid::Scratch) -> Scratch {
        Scratch { solid, room: Room::default() }
    }
}

/// A solid made of solids.
#[derive(Clone, Debug, Default)]
pub struct Object {
    tree: Tree,
    outside: State,
    bound: Bound,
}

impl Object {
    /// Combines leaves.
    pub fn new(leaves: Vec<Leaf>, expr: &Expr) -> Object {
        let most = |of: fn(&Leaf) -> f64| leaves.iter().map(of).fold(0.0, f64::max);
        let bound = Bound {
            scale: most(Leaf::scale),
            shift: most(|l| l.solid.shift_bound() * l.place.stretch),
            grain: most(|l| l.solid.grain() * l.place.stretch),
        };
        let tree = Tree::new(leaves, expr);
        let outside = State::outside(&tree);
        Object { tree, outside, bound }
    }

    /// The leaves.
    pub fn leaves(&self) -> &[Leaf] {
        self.tree.leaves()
    }

    fn cleaner<'a>(&'a self, ray: &'a Ray, range: Interval, scratch: &'a mut Scratch) -> Cleaner<'a> {
        let sweep = Sweep::new(&self.tree, &self.outside, ray, range, &mut scratch.room, &mut scratch.solid);
        Cleaner::new(sweep, self.bound)
    }

    /// The first boundary in the range, and whether the ray goes in there.
    pub fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<(Boundary, bool)> {
        self.cleaner(ray, range, scratch).first()
    }

    /// Whether any part of the range is inside, for a ray that leaves a surface where the range begins: what a leaf does
    /// not resolve there ([`crate::solid::Solid::grain`]) does not count.
    pub fn any(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool {
        self.cleaner(ray, range, scratch).any()
    }

    /// All spans, cut to the range: an end is `None` where the range ends first.
    pub fn spans(&self, ray: &Ray, range: Interval, scratch: &mut Scratch, out: &mut Spans) {
        let mut cleaner = self.cleaner(ray, range, scratch);
        while let Some(span) = cleaner.span() {
            out.push(span);
            if span.exit.is_none() {
                break;
            }
        }
    }
}
