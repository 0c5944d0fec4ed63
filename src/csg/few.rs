//! The short way of a ray that meets few leaves, all of closed form, before its answer is known: each is asked as it comes in
//! sight and for the whole line, and truth is read from a table. It answers only where nothing else lies near the face it
//! finds, so that neither clean-up nor ties have a say; all other rays go the long way ([`super::sweep`]), with the same
//! answers.

use super::object::{Core, Scratch};
use super::room::Room;
use super::spans::Boundary;
use super::tree::Tree;
use super::truth::{State, Truth};
use glam::DVec3;

use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::solid::{self, Cost, Crossing};

/// Of more leaves than this a first surface makes most needless, which the long way finds out.
const FEW: usize = 16;
/// Closed forms are convex: a line crosses each at most twice.
const MOST: usize = 2 * FEW;
/// A table of all states of so many leaves is a word.
const TABLED: usize = 6;

/// The leaves that a ray meets, as they came; places past the last hold [`NO_LEAF`].
type Leaves = [u32; FEW];
const NO_LEAF: u32 = u32::MAX;

/// Truth of an object's root for each state of some leaves, all others outside.
#[derive(Clone, Copy, Debug)]
struct Table {
    tree: u64,
    leaves: Leaves,
    /// Bit i: whether it is inside where the leaves are that have a bit in i; made when these leaves are met again.
    root: Option<u64>,
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
        if matter().nth(TABLED).is_some() || matter().any(|leaf| costs[leaf as usize] != Cost::Closed) {
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
const TABLES: usize = 256;
/// An odd number without a pattern (the golden ratio's digits, Knuth's multiplicative hashing).
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;

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
    /// Of the object and these leaves.
    hash: u64,
    /// Leaves in sight and not asked yet.
    shown: Vec<u32>,
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
        let no_table = Table { tree: 0, leaves: [NO_LEAF; FEW], root: None };
        let no_hit = Hit { slot: 0, crossing: Crossing::exact(0.0, false, 0) };
        let (hits, tables) = ([no_hit; MOST], [no_table; TABLES]);
        Few {
            leaves: [NO_LEAF; FEW],
            count: 0,
            hash: 0,
            shown: Vec::new(),
            inside: 0,
            fresh: Vec::new(),
            hits,
            hit_count: 0,
            tables,
        }
    }
}

/// What a look finds out.
enum Found<T> {
    /// The answer.
    Answer(T),
    /// Leaves that have not been met may have a say.
    More,
    /// The long way has to tell.
    Unclear,
}

/// A look along a ray.
pub(super) struct Look<'a> {
    core: &'a Core,
    ray: &'a Ray,
    range: Interval,
    room: &'a mut Room,
    scratch: &'a mut solid::Scratch,
    /// Every leaf that begins before this has been asked.
    known: f64,
    truths: Truths,
}

/// Where truth of the root is read for states of the leaves asked.
#[derive(Clone, Copy)]
enum Truths {
    /// Not known yet.
    Sought,
    /// From this table.
    Table(u64),
    /// From the room's state, in which these leaves are inside.
    State(u64),
}

impl<'a> Look<'a> {
    /// `None` where the ray meets other leaves than closed forms at once.
    #[inline]
    pub fn new(core: &'a Core, ray: &'a Ray, range: Interval, scratch: &'a mut Scratch) -> Option<Look<'a>> {
        let Scratch { solid: scratch, room } = scratch;
        room.few.clear(core.id);
        let mut look = Look { core, ray, range, room, scratch, known: f64::INFINITY, truths: Truths::Sought };
        match &core.few {
            Some(all) => {
                look.truths = Truths::Table(all.root);
                all.leaves[..all.count].iter().all(|leaf| look.take(*leaf, true)).then_some(look)
            }
            None => {
                let Room { few, walk, .. } = &mut *look.room;
                walk.begin(&core.hierarchy, ray, range, |leaf, _| few.shown.push(leaf));
                look.take_shown().then_some(look)
            }
        }
    }

    /// The first boundary in the range, and whether the ray goes in there; `None` where the long way has to tell.
    #[inline]
    pub fn first(mut self) -> Option<Option<(Boundary, bool)>> {
        loop {
            let found = match self.begin() {
                Some((mask, from)) => self.change(mask, from),
                None => Found::More,
            };
            let found = match found {
                Found::Answer(Some((at, after))) => self.alone(at, after),
                Found::Answer(None) => return Some(None),
                Found::More => Found::More,
                Found::Unclear => Found::Unclear,
            };
            match found {
                Found::Answer(face) => return Some(Some(face)),
                Found::More if self.meet_more() => {}
                _ => return None,
            }
        }
    }

    /// Whether any part of the range is inside; `None` where the long way has to tell.
    #[inline]
    pub fn any(mut self) -> Option<bool> {
        loop {
            let found = match self.begin() {
                Some((mask, _)) if self.inside(mask) => return Some(true),
                Some((mask, from)) => self.change(mask, from),
                None => Found::More,
            };
            match found {
                Found::Answer(None) => return Some(false),
                Found::Answer(Some((at, after))) => match self.alone(at, after) {
                    Found::Answer(_) => return Some(true),
                    Found::More if self.meet_more() => {}
                    _ => return None,
                },
                Found::More if self.meet_more() => {}
                _ => return None,
            }
        }
    }

    /// Lets the hierarchy show leaves until one more has been asked; false where that is one too many or no closed form.
    #[inline]
    fn meet_more(&mut self) -> bool {
        let count = self.room.few.count;
        while self.room.few.count == count && self.known < f64::INFINITY {
            let Room { few, walk, .. } = &mut *self.room;
            walk.step(&self.core.hierarchy, |leaf, _| few.shown.push(leaf));
            if !self.take_shown() {
                return false;
            }
        }
        true
    }

    /// Asks the leaves in sight.
    #[inline]
    fn take_shown(&mut self) -> bool {
        while let Some(leaf) = self.room.few.shown.pop() {
            if self.core.costs[leaf as usize] != Cost::Closed || !self.take(leaf, false) {
                return false;
            }
        }
        self.known = self.room.walk.least();
        if self.range.hi < self.known {
            self.known = f64::INFINITY;
        }
        self.truths = match self.truths {
            Truths::State(_) => self.truths,
            _ => Truths::Sought,
        };
        true
    }

    /// Asks a leaf and puts its crossings in order; false where there is no room. One that the line passes by needs none,
    /// unless it has a place of its own.
    #[inline]
    fn take(&mut self, leaf: u32, has_place: bool) -> bool {
        let few = &mut self.room.few;
        let own = &self.core.tree.leaves()[leaf as usize];
        few.fresh.clear();
        let local = own.place.ray_to_local(self.ray);
        let answer = own.crossings(&local, Interval::ALL, self.scratch, &mut few.fresh);
        debug_assert_eq!(answer.range, Interval::ALL, "closed forms answer for the whole line");
        if few.fresh.is_empty() && !answer.inside && !has_place {
            return true;
        }
        few.keep(leaf, answer.inside)
    }

    /// Whether it is inside where these leaves are.
    #[inline]
    fn inside(&mut self, mask: u64) -> bool {
        if mask == 0 {
            return self.core.outside.root() == Truth::Yes;
        }
        if let Truths::Sought = self.truths {
            self.truths = match self.room.table(self.core) {
                Some(root) => Truths::Table(root),
                None => self.state(),
            };
        }
        match self.truths {
            Truths::Table(root) => root >> mask & 1 == 1,
            Truths::State(_) | Truths::Sought => self.inside_by_state(mask),
        }
    }

    /// The room's state with no leaf inside.
    fn state(&mut self) -> Truths {
        self.room.states_of(self.core);
        self.room.here.reset(&self.core.tree);
        Truths::State(0)
    }

    fn inside_by_state(&mut self, mask: u64) -> bool {
        let Truths::State(was) = self.truths else { return false };
        let Room { few, here, .. } = &mut *self.room;
        for slot in (0..few.count).filter(|slot| (was ^ mask) >> slot & 1 == 1) {
            let truth = Truth::known(mask >> slot & 1 == 1);
            here.set(&self.core.tree, few.leaves[slot] as usize, truth);
        }
        self.truths = Truths::State(mask);
        here.root() == Truth::Yes
    }

    /// The leaves that the ray is inside of where its range begins, and how many crossings come before; `None` where others
    /// may begin before.
    #[inline]
    fn begin(&self) -> Option<(u64, usize)> {
        if self.known <= self.range.lo {
            return None;
        }
        let (mut mask, mut before) = (self.room.few.inside, 0);
        for hit in self.room.few.hits().iter().take_while(|hit| hit.crossing.t <= self.range.lo) {
            mask ^= 1 << hit.slot;
            before += 1;
        }
        Some((mask, before))
    }

    /// The next change of truth in the range, from a crossing and the leaves before it on: its place in the order and the
    /// leaves after it.
    #[inline]
    fn change(&mut self, mut mask: u64, from: usize) -> Found<Option<(usize, u64)>> {
        let end = self.known.min(self.range.hi.next_up());
        let hits = self.room.few.hits();
        if hits.get(from).is_none_or(|hit| end <= hit.crossing.t) {
            // Nothing happens up to there, so the truth there need not be known.
            return if self.known < f64::INFINITY { Found::More } else { Found::Answer(None) };
        }
        let was = self.inside(mask);
        for i in from..self.room.few.hit_count {
            let hits = self.room.few.hits();
            let Hit { slot, crossing } = hits[i];
            if end <= crossing.t {
                break;
            }
            if hits.get(i + 1).is_some_and(|next| next.crossing.t == crossing.t) {
                return Found::Unclear;
            }
            mask ^= 1 << slot;
            if self.inside(mask) != was {
                return Found::Answer(Some((i, mask)));
            }
        }
        if self.known < f64::INFINITY { Found::More } else { Found::Answer(None) }
    }

    /// The face of a change if nothing else lies so near that the clean-up or the choice of an owner would look at it, or at
    /// what fills the point just inside.
    #[inline]
    fn alone(&mut self, at: usize, after: u64) -> Found<(Boundary, bool)> {
        let hits = self.room.few.hits();
        let Hit { slot, crossing } = hits[at];
        let (core, t, leaf) = (self.core, crossing.t, self.room.few.leaves[slot as usize]);
        let own = &core.tree.leaves()[leaf as usize];
        let normal = own.normal(&own.place.ray_to_local(self.ray), &crossing, self.scratch);
        let slope = self.ray.dir.dot(normal).abs();
        // No less than the lengths that the long way takes.
        let length = |v: DVec3| v.abs().element_sum();
        let (scale, point) = (core.bound.scale.max(length(self.ray.origin)), length(self.ray.at(t)));
        let reach = 2.0 * core.bound.shift + tolerance::cleanup(scale) + tolerance::cleanup(point);
        let window = 2.0 * reach / slope;
        let before = at == 0 || hits[at - 1].crossing.t < t - window;
        let behind = hits.get(at + 1).is_none_or(|next| t + window < next.crossing.t);
        if !before || !behind || !window.is_finite() {
            return Found::Unclear;
        }
        if self.known <= t + window {
            return Found::More;
        }
        let entering = self.inside(after);
        let within = if entering { after } else { after ^ 1 << slot };
        let filler = if own.material.is_some() { None } else { self.room.filler(core, within) };
        let flipped = crossing.entering != entering;
        let normal = if flipped { -normal } else { normal };
        let leaf = core.first(leaf);
        Found::Answer((Boundary { t, leaf, crossing, normal, flipped, filler }, entering))
    }
}

impl Room {
    /// Truth of the root for all states of the leaves met, if they have been met before.
    #[inline]
    fn table(&mut self, core: &Core) -> Option<u64> {
        if TABLED < self.few.count {
            return None;
        }
        let which = (self.few.hash >> 56) as usize;
        let table = &self.few.tables[which];
        if table.tree == core.id && table.leaves == self.few.leaves {
            return table.root.or_else(|| self.make_table(core, which));
        }
        self.few.tables[which] = Table { tree: core.id, leaves: self.few.leaves, root: None };
        None
    }

    #[cold]
    fn make_table(&mut self, core: &Core, which: usize) -> Option<u64> {
        self.states_of(core);
        let Few { leaves, count, tables, .. } = &mut self.few;
        tables[which].root = Some(truths(&core.tree, &leaves[..*count], &mut self.here));
        tables[which].root
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
        self.states_of(core);
        let state = &mut self.here;
        state.reset(&core.tree);
        inside.clone().for_each(|leaf| state.set(&core.tree, leaf as usize, Truth::Yes));
        let fill = inside.filter(can).filter(|leaf| state.fills(&core.tree, *leaf as usize));
        fill.max_by_key(|leaf| (leaves[*leaf as usize].rank, *leaf)).map(|leaf| core.first(leaf))
    }
}

impl Few {
    #[inline]
    fn clear(&mut self, tree: u64) {
        (self.leaves, self.count, self.hash) = ([NO_LEAF; FEW], 0, tree.wrapping_mul(MIX));
        (self.inside, self.hit_count) = (0, 0);
        self.shown.clear();
    }

    #[inline]
    fn hits(&self) -> &[Hit] {
        &self.hits[..self.hit_count]
    }

    /// Keeps a leaf with its crossings in `fresh`; false where there is no room for it, or more crossings than closed forms
    /// have.
    #[inline]
    fn keep(&mut self, leaf: u32, inside: bool) -> bool {
        let slot = self.count;
        if slot == FEW || 2 < self.fresh.len() {
            return false;
        }
        self.leaves[slot] = leaf;
        self.hash = (self.hash ^ u64::from(leaf)).wrapping_mul(MIX);
        self.count += 1;
        self.inside |= u64::from(inside) << slot;
        for crossing in &self.fresh {
            let mut at = self.hit_count;
            while 0 < at && crossing.t < self.hits[at - 1].crossing.t {
                self.hits[at] = self.hits[at - 1];
                at -= 1;
            }
            self.hits[at] = Hit { slot: slot as u32, crossing: *crossing };
            self.hit_count += 1;
        }
        true
    }
}
