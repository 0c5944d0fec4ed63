//! The short way of a ray that meets few leaves, all of closed form: each is asked at once and for the whole line, and truth is
//! read from a table. It answers only where nothing else lies near the face it finds, so that neither clean-up nor
//! ties have a say; all other rays go the long way ([`super::sweep`]), with the same answers.

use super::object::{Core, Scratch};
use super::spans::Boundary;
use super::truth::{State, Truth};
use crate::geom::{Interval, Ray, tolerance};
use crate::solid::{self, Cost, Crossing};

/// A table of all states of so many leaves is a word.
const FEW: usize = 6;

/// Truth of an object's root for each state of some leaves, all others outside.
#[derive(Clone, Copy, Debug, Default)]
struct Table {
    tree: u64,
    leaves: [u32; FEW],
    count: usize,
    /// Bit i: whether it is inside where the leaves are that have a bit in i.
    root: u64,
}

/// Neighbouring rays mostly meet the same leaves.
const TABLES: usize = 16;

/// Room for the short way, lent by a thread.
#[derive(Debug, Default)]
pub(super) struct Few {
    /// The leaves met, ascending, and the ray in their frames.
    leaves: [u32; FEW],
    rays: Vec<Ray>,
    count: usize,
    /// Bit i: whether the line comes from inside the leaf in slot i.
    inside: u64,
    /// Crossings, by leaf; of which leaf; and their order along the ray.
    crossings: Vec<Crossing>,
    slots: Vec<u8>,
    order: Vec<(f64, u32)>,
    tables: [Table; TABLES],
}

/// What a ray that meets few leaves finds.
pub(super) enum Found<T> {
    /// The answer.
    Answer(T),
    /// The long way has to tell.
    Unclear,
}

/// A face that nothing lies near.
struct Alone {
    boundary: Boundary,
    entering: bool,
}

/// A look along a ray that meets few leaves.
pub(super) struct Look<'a> {
    core: &'a Core,
    ray: &'a Ray,
    range: Interval,
    few: &'a mut Few,
    /// A state to ask about more than the root.
    state: &'a mut State,
    scratch: &'a mut solid::Scratch,
    root: u64,
}

impl<'a> Look<'a> {
    /// `None` where the ray meets too many leaves, or others than closed forms.
    #[inline]
    pub fn new(core: &'a Core, ray: &'a Ray, range: Interval, scratch: &'a mut Scratch) -> Option<Look<'a>> {
        let Scratch { solid: scratch, room } = scratch;
        let few = &mut room.few;
        few.count = 0;
        let (mut all, walk) = (true, &mut room.walk);
        let mut meet = |leaf: u32| core.costs[leaf as usize] == Cost::Closed && few.meet(leaf);
        walk.begin(&core.hierarchy, ray, range, |leaf, _| all &= meet(leaf));
        while all && walk.least() < f64::INFINITY {
            walk.step(&core.hierarchy, |leaf, _| all &= meet(leaf));
        }
        if !all {
            return None;
        }
        room.enter(core.id, &core.outside);
        let few = &mut room.few;
        let root = few.table(core, &mut room.here);
        few.ask(core, ray, scratch);
        Some(Look { core, ray, range, few: &mut room.few, state: &mut room.here, scratch, root })
    }
}

impl Look<'_> {
    /// Whether it is inside where these leaves are.
    #[inline]
    fn inside(&self, mask: u64) -> bool {
        self.root >> mask & 1 == 1
    }

    /// The leaves that the ray is inside of where its range begins, and how many crossings come before.
    #[inline]
    fn begin(&self) -> (u64, usize) {
        let order = &self.few.order;
        let before = order.iter().take_while(|o| o.0 <= self.range.lo).count();
        let mask = order[..before].iter().fold(self.few.inside, |mask, o| mask ^ self.few.bit(o.1));
        (mask, before)
    }

    /// The next change of truth in the range, from a crossing and the leaves before it on: its place in the order and the
    /// leaves after it.
    #[inline]
    fn change(&self, mut mask: u64, from: usize) -> Found<Option<(usize, u64)>> {
        let order = &self.few.order;
        let was = self.inside(mask);
        for (i, (t, crossing)) in order.iter().enumerate().skip(from) {
            if self.range.hi < *t {
                break;
            }
            if order.get(i + 1).is_some_and(|next| next.0 == *t) {
                return Found::Unclear;
            }
            mask ^= self.few.bit(*crossing);
            if self.inside(mask) != was {
                return Found::Answer(Some((i, mask)));
            }
        }
        Found::Answer(None)
    }

    /// The first boundary in the range, and whether the ray goes in there.
    pub fn first(mut self) -> Found<Option<(Boundary, bool)>> {
        let (mask, from) = self.begin();
        let (at, after) = match self.change(mask, from) {
            Found::Answer(Some(change)) => change,
            Found::Answer(None) => return Found::Answer(None),
            Found::Unclear => return Found::Unclear,
        };
        match self.alone(at, after) {
            Some(Alone { boundary, entering }) => Found::Answer(Some((boundary, entering))),
            None => Found::Unclear,
        }
    }

    /// Whether any part of the range is inside.
    pub fn any(mut self) -> Found<bool> {
        let (mask, from) = self.begin();
        if self.inside(mask) {
            return Found::Answer(true);
        }
        match self.change(mask, from) {
            Found::Answer(Some((at, after))) if self.alone(at, after).is_some() => Found::Answer(true),
            Found::Answer(None) => Found::Answer(false),
            _ => Found::Unclear,
        }
    }

    /// The face of a change if nothing else lies so near that the clean-up or the choice of an owner would look at it, or at
    /// what fills the point just inside.
    #[inline]
    fn alone(&mut self, at: usize, after: u64) -> Option<Alone> {
        let (t, index) = self.few.order[at];
        let crossing = self.few.crossings[index as usize];
        let slot = self.few.slots[index as usize] as usize;
        let leaf = self.few.leaves[slot];
        let leaves = self.core.tree.leaves();
        let own = &leaves[leaf as usize];
        let normal = own.solid.normal(&self.few.rays[slot], &crossing, self.scratch);
        let normal = own.place.normal_to_world(normal);
        let slope = self.ray.dir.dot(normal).abs();
        let scale = self.core.bound.scale.max(self.ray.origin.length());
        let reach = 2.0 * self.core.bound.shift
            + tolerance::cleanup(scale)
            + tolerance::cleanup(self.ray.at(t).length());
        let window = 2.0 * reach / slope;
        let order = &self.few.order;
        let before = at == 0 || order[at - 1].0 < t - window;
        let behind = order.get(at + 1).is_none_or(|next| t + window < next.0);
        if !before || !behind || !window.is_finite() {
            return None;
        }
        let entering = self.inside(after);
        let within = if entering { after } else { after ^ 1 << slot };
        let filler = if own.material.is_some() { None } else { self.filler(within) };
        let flipped = crossing.entering != entering;
        let normal = if flipped { -normal } else { normal };
        Some(Alone { boundary: Boundary { t, leaf, crossing, normal, flipped, filler }, entering })
    }

    /// Of the leaves with a material that fill the object where these leaves are, the last written.
    fn filler(&mut self, mask: u64) -> Option<u32> {
        let (core, few, state) = (self.core, &*self.few, &mut *self.state);
        let leaves = core.tree.leaves();
        let inside = (0..few.count).filter(|slot| mask >> slot & 1 == 1).map(|slot| few.leaves[slot]);
        let can = |leaf: &u32| leaves[*leaf as usize].can_fill();
        if !inside.clone().any(|leaf| can(&leaf)) {
            return None;
        }
        state.reset(&core.tree);
        inside.clone().for_each(|leaf| state.set(&core.tree, leaf as usize, Truth::Yes));
        let fill = inside.filter(can).filter(|leaf| state.fills(&core.tree, *leaf as usize));
        fill.max_by_key(|leaf| (leaves[*leaf as usize].rank, *leaf))
    }
}

impl Few {
    /// Keeps a leaf in its place; false where there is no room.
    #[inline]
    fn meet(&mut self, leaf: u32) -> bool {
        if self.count == FEW {
            return false;
        }
        let mut at = self.count;
        while 0 < at && leaf < self.leaves[at - 1] {
            self.leaves[at] = self.leaves[at - 1];
            at -= 1;
        }
        self.leaves[at] = leaf;
        self.count += 1;
        true
    }

    #[inline]
    fn bit(&self, crossing: u32) -> u64 {
        1 << self.slots[crossing as usize]
    }

    /// Truth of the root for all states of the leaves met.
    #[inline]
    fn table(&mut self, core: &Core, state: &mut State) -> u64 {
        let leaves = &self.leaves[..self.count];
        let hash = leaves
            .iter()
            .fold(core.id, |hash, leaf| (hash ^ u64::from(*leaf)).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let table = &mut self.tables[(hash >> 60) as usize];
        if table.tree != core.id || &table.leaves[..table.count] != leaves {
            *table = Table {
                tree: core.id,
                leaves: self.leaves,
                count: self.count,
                root: truths(core, leaves, state),
            };
        }
        table.root
    }

    /// Asks every leaf; puts the crossings in order.
    #[inline]
    fn ask(&mut self, core: &Core, ray: &Ray, scratch: &mut solid::Scratch) {
        self.crossings.clear();
        self.slots.clear();
        self.rays.clear();
        self.order.clear();
        self.inside = 0;
        for slot in 0..self.count {
            let leaf = &core.tree.leaves()[self.leaves[slot] as usize];
            let local = leaf.place.ray_to_local(ray);
            self.rays.push(local);
            let answer = leaf.crossings(&local, Interval::ALL, scratch, &mut self.crossings);
            debug_assert_eq!(answer.range, Interval::ALL, "closed forms answer for the whole line");
            self.inside |= u64::from(answer.inside) << slot;
            for index in self.slots.len()..self.crossings.len() {
                self.slots.push(slot as u8);
                let t = self.crossings[index].t;
                let mut at = self.order.len();
                while 0 < at && t < self.order[at - 1].0 {
                    at -= 1;
                }
                self.order.insert(at, (t, index as u32));
            }
        }
    }
}

/// Truth of the root for all states of some leaves, in an order in which one leaf changes at a time (Gray's).
fn truths(core: &Core, leaves: &[u32], state: &mut State) -> u64 {
    state.reset(&core.tree);
    let mut root = 0;
    for step in 0..1u64 << leaves.len() {
        let mask = step ^ step >> 1;
        if let Some(slot) = (0 < step).then(|| step.trailing_zeros() as usize) {
            let truth = Truth::known(mask >> slot & 1 == 1);
            state.set(&core.tree, leaves[slot] as usize, truth);
        }
        root |= u64::from(state.root() == Truth::Yes) << mask;
    }
    state.reset(&core.tree);
    root
}
