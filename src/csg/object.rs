//! An object: a tree with what its sweeps share.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::cleanup::{Bound, Cleaner};
use super::expr::Expr;
use super::few::{All, Look};
use super::hierarchy::{Hierarchy, worst_condition};
use super::leaf::Leaf;
use super::reach::reaches;
use super::room::Room;
use super::spans::{Boundary, Spans};
use super::sweep::Sweep;
use super::tree::Tree;
use super::truth::State;
use crate::geom::{Interval, Ray};
use crate::solid::{self, Cost};

/// What queries of objects need beside their arguments, one for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    /// What solids need; the counts of work.
    pub solid: solid::Scratch,
    pub(super) room: Room,
}

impl Scratch {
    /// With what a solid lends.
    pub(super) fn lent(solid: solid::Scratch) -> Scratch {
        Scratch { solid, room: Room::default() }
    }
}

/// What all sweeps of an object read.
#[derive(Debug, Default)]
pub(super) struct Core {
    /// Tells the objects of a process apart; no result depends on it.
    pub id: u64,
    pub tree: Tree,
    pub hierarchy: Hierarchy,
    pub outside: State,
    /// For each leaf what asking it costs.
    pub costs: Vec<Cost>,
    /// All leaves, where they are few and of closed form.
    pub few: Option<All>,
    /// For each leaf [`Leaf::scale`].
    pub scales: Vec<f64>,
    pub bound: Bound,
}

impl Core {
    fn new(leaves: Vec<Leaf>, expr: &Expr) -> Core {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let most = |of: fn(&Leaf) -> f64| leaves.iter().map(of).fold(0.0, f64::max);
        let bound = Bound {
            scale: most(Leaf::scale),
            shift: most(|l| l.solid.shift_bound() * l.place.stretch),
            grain: most(|l| l.solid.grain() * l.place.stretch),
        };
        let costs: Vec<Cost> = leaves.iter().map(|l| l.solid.cost()).collect();
        let scales = leaves.iter().map(Leaf::scale).collect();
        let condition = worst_condition(leaves.iter().map(|l| l.place.condition));
        let tree = Tree::new(leaves, expr);
        let reaches = reaches(&tree);
        let hierarchy = Hierarchy::new(&reaches, condition);
        let outside = State::outside(&tree);
        let few = All::new(&tree, &costs, &reaches, &outside);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        Core { id, tree, hierarchy, outside, costs, few, scales, bound }
    }
}

/// A solid made of solids. Copies share everything.
#[derive(Clone, Debug, Default)]
pub struct Object {
    core: Arc<Core>,
}

impl Object {
    /// Combines leaves.
    pub fn new(leaves: Vec<Leaf>, expr: &Expr) -> Object {
        Object { core: Arc::new(Core::new(leaves, expr)) }
    }

    /// The leaves.
    pub fn leaves(&self) -> &[Leaf] {
        self.core.tree.leaves()
    }

    fn cleaner<'a>(&'a self, ray: &'a Ray, range: Interval, scratch: &'a mut Scratch) -> Cleaner<'a> {
        Cleaner::new(Sweep::new(&self.core, ray, range, &mut scratch.room, &mut scratch.solid))
    }

    /// The first boundary in the range, and whether the ray goes in there.
    pub fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<(Boundary, bool)> {
        if let Some(found) = Look::new(&self.core, ray, range, scratch).and_then(Look::first) {
            return found;
        }
        self.cleaner(ray, range, scratch).first()
    }

    /// Whether any part of the range is inside, for a ray that leaves a surface where the range begins: what a leaf does
    /// not resolve there ([`crate::solid::Solid::grain`]) does not count.
    pub fn any(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool {
        if let Some(found) = Look::new(&self.core, ray, range, scratch).and_then(Look::any) {
            return found;
        }
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
