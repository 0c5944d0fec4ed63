//! An object: a tree with what its sweeps share.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::bundle::Bundle;
use super::cleanup::{Bound, Cleaner};
use super::convex::Convex;
use super::expr::Expr;
use super::few::Look;
use super::handful::Handful;
use super::hierarchy::{Hierarchy, worst_condition};
use super::leaf::{Key, Leaf};
use super::reach::{bounds_of_nodes, reaches};
use super::room::Room;
use super::spans::{Boundary, Spans};
use super::sweep::Sweep;
use super::tree::Tree;
use super::truth::State;
use glam::DAffine3;

use crate::geom::{Aabb, Interval, Placement, Ray};
use crate::solid::{self, Cost, Crossing};

/// What queries of objects need beside their arguments, one for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    /// What solids need; the counts of work.
    pub solid: solid::Scratch,
    /// Room for the crossings of one leaf that is asked by itself.
    pub found: Vec<Crossing>,
    pub(super) room: Room,
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
    pub handful: Option<Handful>,
    /// What the object is where it is the intersection of more leaves.
    convex: Option<Convex>,
    /// For each leaf [`Leaf::scale`].
    pub scales: Vec<f64>,
    pub bound: Bound,
    /// A box outside of which nothing is inside; unbounded where there is none.
    pub bounds: Aabb,
    /// How many leaves there are, those in groups counted; past 2^32 the count stays there.
    pub count: u32,
    /// For each leaf how many come before it, counted so; nothing where no leaf is a group.
    firsts: Vec<u32>,
    /// The smallest key of all leaves.
    pub least_key: Key,
    /// Whether any leaf shows on faces of leaves without a material.
    pub can_fill: bool,
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
        let (count, firsts) = numbered(&leaves);
        let least_key = leaves.iter().map(Leaf::least_key).min().unwrap_or_default();
        let can_fill = leaves.iter().any(Leaf::can_fill);
        let grown: Vec<Aabb> = leaves.iter().map(Leaf::grown).collect();
        let tree = Tree::new(leaves, expr);
        let bounds = bounds_of_nodes(&tree, &grown).last().copied().unwrap_or_default();
        let bounds = if bounds.is_finite() { bounds } else { Aabb::ALL };
        let reaches = reaches(&tree);
        let outside = State::outside(&tree);
        let handful = Handful::new(&tree, &costs, &reaches, &outside);
        let convex = if handful.is_none() { Convex::new(&tree, &costs, expr) } else { None };
        let hierarchy = Hierarchy::new(reaches, condition);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        Core {
            id,
            tree,
            hierarchy,
            outside,
            costs,
            handful,
            convex,
            scales,
            bound,
            bounds,
            count,
            firsts,
            least_key,
            can_fill,
        }
    }

    /// The index by which boundaries name the first leaf of a leaf.
    #[inline]
    pub fn first(&self, leaf: u32) -> u32 {
        self.firsts.get(leaf as usize).copied().unwrap_or(leaf)
    }

    /// The scale of a leaf, of a group that of its own leaf that crosses.
    #[inline]
    pub fn scale_at(&self, leaf: usize, crossing: &Crossing) -> f64 {
        let Leaf { group, place, .. } = &self.tree.leaves()[leaf];
        let Some(group) = group else { return self.scales[leaf] };
        place.offset().max(group.0.core().scales[crossing.part as usize] * place.stretch)
    }

    /// The leaf that a boundary's index is, or is in.
    #[inline]
    fn holder(&self, index: u32) -> u32 {
        if self.firsts.is_empty() {
            return index;
        }
        self.firsts.partition_point(|first| *first <= index) as u32 - 1
    }
}

/// How many leaves there are in all, and for each how many come before it, if that is not how it stands.
fn numbered(leaves: &[Leaf]) -> (u32, Vec<u32>) {
    if leaves.iter().all(|leaf| leaf.group.is_none()) {
        return (leaves.len() as u32, Vec::new());
    }
    let mut count = 0u32;
    let first = |leaf: &Leaf| {
        let first = count;
        count = count.saturating_add(leaf.count());
        first
    };
    let firsts = leaves.iter().map(first).collect();
    (count, firsts)
}

/// A leaf as a boundary names it, perhaps of an object within the object.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// The leaf.
    pub leaf: &'a Leaf,
    /// From the world to its frame.
    pub local_from_world: DAffine3,
    /// A bound on how much a length of its frame can grow on the way to the world.
    pub stretch: f64,
    /// [`Leaf::scale`] of what stands in the world.
    pub scale: f64,
}

impl<'a> Part<'a> {
    /// A leaf that stands in the world.
    pub fn of(leaf: &'a Leaf) -> Part<'a> {
        let Placement { local_from_world, stretch, .. } = leaf.place;
        Part { leaf, local_from_world, stretch, scale: leaf.scale() }
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

    /// The leaf that a boundary's index is, or is in: an index into [`Object::leaves`].
    pub fn holder(&self, index: u32) -> u32 {
        self.core.holder(index)
    }

    /// How many leaves there are, those of every copy counted; past 2^32 the count stays there.
    pub fn leaf_count(&self) -> u32 {
        self.core.count
    }

    /// For each leaf the box in which it can matter, empty where it never does: a line that misses all of them sees what it
    /// would see without any.
    pub fn reaches(&self) -> &[Aabb] {
        &self.core.hierarchy.boxes
    }

    /// A box outside of which nothing is inside; unbounded where none is known.
    pub fn bounds(&self) -> Aabb {
        self.core.bounds
    }

    pub(super) fn core(&self) -> &Core {
        &self.core
    }

    /// The same for all copies, and for nothing else.
    pub(super) fn address(&self) -> *const () {
        Arc::as_ptr(&self.core).cast()
    }

    /// The leaf that a boundary names.
    #[inline]
    pub fn part(&self, index: u32) -> Part<'_> {
        let mut core = &*self.core;
        let mut holder = core.holder(index);
        let leaf = &core.tree.leaves()[holder as usize];
        let Placement { local_from_world, stretch, .. } = leaf.place;
        let mut part = Part { leaf, local_from_world, stretch, scale: core.scales[holder as usize] };
        let mut index = index - core.first(holder);
        while let Some(group) = &part.leaf.group {
            core = group.0.core();
            holder = core.holder(index);
            index -= core.first(holder);
            let leaf = &core.tree.leaves()[holder as usize];
            let local_from_world = leaf.place.local_from_world * part.local_from_world;
            part = Part { leaf, local_from_world, stretch: part.stretch * leaf.place.stretch, ..part };
        }
        part
    }

    fn cleaner<'a>(&'a self, ray: &'a Ray, range: Interval, scratch: &'a mut Scratch) -> Cleaner<'a> {
        Cleaner::new(Sweep::new(&self.core, ray, range, &mut scratch.room, &mut scratch.solid))
    }

    /// The first boundary in the range, and whether the ray goes in there.
    pub fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<(Boundary, bool)> {
        self.first_of(&Bundle::default(), ray, range, scratch)
    }

    /// The same for a ray of a bundle and a range from 0 or later on, sooner.
    #[inline]
    pub fn first_of(
        &self,
        bundle: &Bundle,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
    ) -> Option<(Boundary, bool)> {
        debug_assert!(0.0 <= range.lo || bundle.is_of_all());
        if let Some(handful) = &self.core.handful
            && let Some(found) = handful.first(&self.core, bundle.slots, ray, range, scratch)
        {
            return found;
        }
        if let Some(convex) = &self.core.convex
            && let Some(found) = convex.first(&self.core, ray, range, scratch)
        {
            return found;
        }
        if let Some(found) = Look::new(&self.core, ray, range, bundle, scratch).and_then(Look::first) {
            return found;
        }
        self.cleaner(ray, range, scratch).first()
    }

    /// Whether any part of the range is inside, for a ray that leaves a surface where the range begins: what a leaf does
    /// not resolve there ([`crate::solid::Solid::grain`]) does not count.
    #[inline]
    pub fn any(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool {
        if let Some(handful) = &self.core.handful
            && let Some(found) = handful.any(&self.core, u64::MAX, ray, range, scratch)
        {
            return found;
        }
        if let Some(convex) = &self.core.convex
            && let Some(found) = convex.any(&self.core, ray, range, scratch)
        {
            return found;
        }
        if let Some(found) =
            Look::new(&self.core, ray, range, &Bundle::default(), scratch).and_then(Look::any)
        {
            return found;
        }
        self.cleaner(ray, range, scratch).any()
    }

    /// All spans, cut to the range: an end is `None` where the range ends first.
    pub fn spans(&self, ray: &Ray, range: Interval, scratch: &mut Scratch, out: &mut Spans) {
        if let Some(convex) = &self.core.convex
            && let Some(found) = convex.span(&self.core, ray, range, scratch)
        {
            return out.extend(found);
        }
        let mut cleaner = self.cleaner(ray, range, scratch);
        while let Some(span) = cleaner.span() {
            out.push(span);
            if span.exit.is_none() {
                break;
            }
        }
    }
}
