//! The short way of a ray that meets few leaves, all of closed form: each is asked at once and for the whole line, and truth is
//! read from a table. It answers only where nothing else lies near the face it finds, so that neither clean-up nor
//! ties have a say; all other rays go the long way ([`super::sweep`]), with the same answers.

use super::object::{Core, Scratch};
use super::room::Room;
use super::spans::Boundary;
use super::tree::Tree;
use super::truth::{State, Truth};
use glam::DVec3;

use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::solid::{self, Cost, Crossing};

/// A table of all states of so many leaves is a word.
const FEW: usize = 6;
/// Closed forms are convex: a line crosses each at most twice.
const MOST: usize = 2 * FEW;

/// The leaves that a ray meets, ascending; places past the last hold [`NO_LEAF`].
type Leaves = [u32; FEW];
const NO_LEAF: u32 = u32::MAX;

/// Truth of an object's root for each state of some leaves, all others outside.
#[derive(Clone, Copy, Debug)]
struct Table {
    tree: u64,
    leaves: Leaves,
    /// Bit i: whether it is inside where the leaves are that have a bit in i.
    root: u64,
}

/// All leaves of an object that has few, all of closed form: their boxes would spare less than they cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct All {
    leaves: Leaves,
    count: usize,
    root: u64,
}

impl All {
    /// `None` where there are too many, or others.
    pub fn new(tree: &Tree, costs: &[Cost], reaches: &[Aabb], outside: &State) -> Option<All> {
        let matter = || (0u32..).zip(reaches).filter(|(_, b)| !b.is_empty()).map(|(leaf, _)| leaf);
        if matter().nth(FEW).is_some() || matter().any(|leaf| costs[leaf as usize] != Cost::Closed) {
            return None;
        }
        let (leaves, count) =
            (std::array::from_fn(|slot| matter().nth(slot).unwrap_or(NO_LEAF)), matter().count());
        let root = truths(tree, &leaves[..count], &mut outside.clone());
        Some(All { leaves, count, root })
    }
}

/// Truth of the root for all states of some leaves, in an order in which one leaf changes at a time (Gray's).
fn truths(tree: &Tree, leaves: &[u32], state: &mut State) -> u64 {
    state.reset(tree);
    let mut root = 0;
    for step in 0..1u64 << leaves.len() {
        let mask = step ^ step >> 1;
        if 0 < step {
            let slot = step.trailing_zeros();
            state.set(tree, leaves[slot as usize] as usize, Truth::known(mask >> slot & 1 == 1));
        }
        root |= u64::from(state.root() == Truth::Yes) << mask;
    }
    state.reset(tree);
    root
}

/// Neighbouring rays mostly meet the same leaves.
const TABLES: usize = 16;

/// A crossing of one of the leaves met.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// Of the leaves met, which.
    slot: u32,
    crossing: Crossing,
}

/// Room for the short way, lent by a thread.
#[derive(Debug)]
pub(super) struct Few {
    leaves: Leaves,
    count: usize,
    /// Bit i: whether the line comes from inside the leaf in slot i.
    inside: u64,
    /// The last answer of a leaf.
    fresh: Vec<Crossing>,
    /// Ascending.
    hits: [Hit; MOST],
    hit_count: usize,
    tables: [Table; TABLES],
}

impl Default for Few {
    fn default() -> Few {
        let no_table = Table { tree: 0, leaves: [NO_LEAF; FEW], root: 0 };
        let no_hit = Hit { slot: 0, crossing: Crossing::exact(0.0, false, 0) };
        let (hits, tables) = ([no_hit; MOST], [no_table; TABLES]);
        Few { leaves: [NO_LEAF; FEW], count: 0, inside: 0, fresh: Vec::new(), hits, hit_count: 0, tables }
    }
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
    room: &'a mut Room,
    scratch: &'a mut solid::Scratch,
    root: u64,
}

impl<'a> Look<'a> {
    /// `None` where the ray meets too many leaves, or others than closed forms.
    #[inline]
    pub fn new(core: &'a Core, ray: &'a Ray, range: Interval, scratch: &'a mut Scratch) -> Option<Look<'a>> {
        let Scratch { solid: scratch, room } = scratch;
        let root = match &core.few {
            Some(all) => {
                (room.few.leaves, room.few.count) = (all.leaves, all.count);
                all.root
            }
            None if room.meet_few(core, ray, range) => room.table(core),
            None => return None,
        };
        room.few.ask(core, ray, scratch).then_some(Look { core, ray, range, room, scratch, root })
    }

    /// Whether it is inside where these leaves are.
    #[inline]
    fn inside(&self, mask: u64) -> bool {
        self.root >> mask & 1 == 1
    }

    /// The leaves that the ray is inside of where its range begins, and how many crossings come before.
    #[inline]
    fn begin(&self) -> (u64, usize) {
        let (mut mask, mut before) = (self.room.few.inside, 0);
        for hit in self.room.few.hits().iter().take_while(|hit| hit.crossing.t <= self.range.lo) {
            mask ^= 1 << hit.slot;
            before += 1;
        }
        (mask, before)
    }

    /// The next change of truth in the range, from a crossing and the leaves before it on: its place in the order and the
    /// leaves after it.
    #[inline]
    fn change(&self, mut mask: u64, from: usize) -> Found<Option<(usize, u64)>> {
        let hits = self.room.few.hits();
        let was = self.inside(mask);
        for (i, hit) in hits.iter().enumerate().skip(from) {
            let t = hit.crossing.t;
            if self.range.hi < t {
                break;
            }
            if hits.get(i + 1).is_some_and(|next| next.crossing.t == t) {
                return Found::Unclear;
            }
            mask ^= 1 << hit.slot;
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
        let hits = self.room.few.hits();
        let Hit { slot, crossing } = hits[at];
        let (core, t, leaf) = (self.core, crossing.t, self.room.few.leaves[slot as usize]);
        let own = &core.tree.leaves()[leaf as usize];
        let normal = own.solid.normal(&own.place.ray_to_local(self.ray), &crossing, self.scratch);
        let normal = own.place.normal_to_world(normal);
        let slope = self.ray.dir.dot(normal).abs();
        // No less than the lengths that the long way takes.
        let length = |v: DVec3| v.abs().element_sum();
        let (scale, point) = (core.bound.scale.max(length(self.ray.origin)), length(self.ray.at(t)));
        let reach = 2.0 * core.bound.shift + tolerance::cleanup(scale) + tolerance::cleanup(point);
        let window = 2.0 * reach / slope;
        let before = at == 0 || hits[at - 1].crossing.t < t - window;
        let behind = hits.get(at + 1).is_none_or(|next| t + window < next.crossing.t);
        if !before || !behind || !window.is_finite() {
            return None;
        }
        let entering = self.inside(after);
        let within = if entering { after } else { after ^ 1 << slot };
        let filler = if own.material.is_some() { None } else { self.room.filler(core, within) };
        let flipped = crossing.entering != entering;
        let normal = if flipped { -normal } else { normal };
        Some(Alone { boundary: Boundary { t, leaf, crossing, normal, flipped, filler }, entering })
    }
}

impl Room {
    /// Meets the leaves of a ray; false where they are too many, or not closed forms.
    #[inline]
    fn meet_few(&mut self, core: &Core, ray: &Ray, range: Interval) -> bool {
        let few = &mut self.few;
        (few.leaves, few.count) = ([NO_LEAF; FEW], 0);
        let mut all = true;
        let mut meet = |leaf: u32| core.costs[leaf as usize] == Cost::Closed && few.meet(leaf);
        self.walk.begin(&core.hierarchy, ray, range, |leaf, _| all &= meet(leaf));
        while all && self.walk.least() < f64::INFINITY {
            self.walk.step(&core.hierarchy, |leaf, _| all &= meet(leaf));
        }
        all
    }

    /// Truth of the root for all states of the leaves met.
    #[inline]
    fn table(&mut self, core: &Core) -> u64 {
        let leaves = &self.few.leaves;
        let mix = |hash: u64, leaf: &u32| (hash ^ u64::from(*leaf)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let which = (leaves.iter().fold(core.id, mix) >> 60) as usize;
        let table = &self.few.tables[which];
        if table.tree == core.id && table.leaves == *leaves {
            return table.root;
        }
        self.make_table(core, which)
    }

    #[cold]
    fn make_table(&mut self, core: &Core, which: usize) -> u64 {
        self.enter(core.id, &core.outside);
        let Few { leaves, count, tables, .. } = &mut self.few;
        let root = truths(&core.tree, &leaves[..*count], &mut self.here);
        tables[which] = Table { tree: core.id, leaves: *leaves, root };
        root
    }

    /// Of the leaves with a material that fill the object where these leaves are, the last written.
    #[inline]
    fn filler(&mut self, core: &Core, mask: u64) -> Option<u32> {
        let (leaves, slots, met) = (core.tree.leaves(), 0..self.few.count, self.few.leaves);
        let inside = slots.filter(|slot| mask >> slot & 1 == 1).map(|slot| met[slot]);
        let can = |leaf: &u32| leaves[*leaf as usize].can_fill();
        if !inside.clone().any(|leaf| can(&leaf)) {
            return None;
        }
        self.enter(core.id, &core.outside);
        let state = &mut self.here;
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
    fn hits(&self) -> &[Hit] {
        &self.hits[..self.hit_count]
    }

    /// Asks every leaf and puts the crossings in order; false where a line crosses one more than twice.
    #[inline]
    fn ask(&mut self, core: &Core, ray: &Ray, scratch: &mut solid::Scratch) -> bool {
        (self.inside, self.hit_count) = (0, 0);
        for slot in 0..self.count {
            let leaf = &core.tree.leaves()[self.leaves[slot] as usize];
            self.fresh.clear();
            let answer =
                leaf.crossings(&leaf.place.ray_to_local(ray), Interval::ALL, scratch, &mut self.fresh);
            debug_assert_eq!(answer.range, Interval::ALL, "closed forms answer for the whole line");
            self.inside |= u64::from(answer.inside) << slot;
            if 2 < self.fresh.len() {
                return false;
            }
            for crossing in &self.fresh {
                let mut at = self.hit_count;
                while 0 < at && crossing.t < self.hits[at - 1].crossing.t {
                    self.hits[at] = self.hits[at - 1];
                    at -= 1;
                }
                self.hits[at] = Hit { slot: slot as u32, crossing: *crossing };
                self.hit_count += 1;
            }
        }
        true
    }
}
