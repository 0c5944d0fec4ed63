//! The shortest way: through an object of a handful of leaves, all of closed form. Each is asked for its chord, and truth is
//! read from a word of bits. As the short way ([`super::few`]) it answers only where all that lies near the face it finds
//! crosses at one and the same t, so that the clean-up has no say; all other rays go the long way ([`super::sweep`]), with the
//! same answers.

use glam::DVec3;

use super::few::far_at;
use super::object::{Core, Scratch};
use super::slots::{Few, Turn};
use super::spans::Boundary;
use super::tree::Tree;
use super::truth::{State, Truth};
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::{self, Chord, Cost, Crossing};

/// All states of so many leaves are the bits of a word.
const MOST: usize = 6;

/// All leaves of an object that has few, all of closed form: their boxes would spare less than they cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct Handful {
    /// Places past the last hold anything.
    leaves: [u32; MOST],
    count: usize,
    /// So many of the first have to be inside wherever the root is.
    needed: usize,
    /// Truth of the root for all states of them, as bits.
    root: u64,
}

impl Handful {
    /// `None` where there are too many, or others.
    pub fn new(tree: &Tree, costs: &[Cost], reaches: &[Aabb], outside: &State) -> Option<Handful> {
        let matter = || (0u32..).zip(reaches).filter(|(_, b)| !b.is_empty()).map(|(leaf, _)| leaf);
        if matter().nth(MOST).is_some() || matter().any(|leaf| costs[leaf as usize] != Cost::Closed) {
            return None;
        }
        let count = matter().count();
        let mut leaves: [u32; MOST] = std::array::from_fn(|slot| matter().nth(slot).unwrap_or_default());
        let of = |leaves: &[u32; MOST]| truths(tree, outside, &leaves[..count], &mut outside.clone());
        let (found, root) = (leaves, of(&leaves));
        let is_needed = |leaf: &u32| {
            let slot = found.iter().position(|other| other == leaf);
            (0..1u64 << count).all(|mask| root >> mask & 1 == 0 || slot.is_some_and(|s| mask >> s & 1 == 1))
        };
        leaves[..count].sort_by_key(|leaf| !is_needed(leaf));
        let needed = leaves[..count].iter().filter(|leaf| is_needed(leaf)).count();
        Some(Handful { leaves, count, needed, root: of(&leaves) })
    }

    /// Which of them are in a list, as bits.
    pub fn slots_of(&self, list: &[u32]) -> u64 {
        let leaves = self.leaves[..self.count].iter().enumerate();
        leaves.filter(|(_, leaf)| list.contains(leaf)).map(|(slot, _)| 1 << slot).sum()
    }

    /// The first boundary in the range, and whether the ray goes in there, where only the leaves in these slots can be met;
    /// `None` where the long way has to tell.
    #[inline(always)]
    pub fn first(
        &self,
        core: &Core,
        slots: u64,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
    ) -> Option<Option<(Boundary, bool)>> {
        let mut line = Line::default();
        if !self.look(core, slots, ray, &mut scratch.solid, &mut line) {
            return None;
        }
        let Some(change) = self.change(&line, range) else { return Some(None) };
        let (met, normal) = line.alone(self, core, ray, &change, &mut scratch.solid)?;
        Some(Some((self.boundary(core, ray, &line, &change, (met, normal), scratch), change.entering)))
    }

    /// Whether any part of the range is inside; `None` where the long way has to tell.
    #[inline(always)]
    pub fn any(
        &self,
        core: &Core,
        slots: u64,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
    ) -> Option<bool> {
        let mut line = Line::default();
        if !self.look(core, slots, ray, &mut scratch.solid, &mut line) {
            return None;
        }
        if self.is_inside(line.inside(range.lo)) {
            return Some(true);
        }
        let Some(change) = self.change(&line, range) else { return Some(false) };
        line.alone(self, core, ray, &change, &mut scratch.solid).map(|_| true)
    }

    /// Whether it is inside where these leaves are.
    #[inline(always)]
    fn is_inside(&self, mask: u64) -> bool {
        self.root >> mask & 1 == 1
    }

    /// Finds the chords of all leaves, none where one that is needed is passed by; false where one has no closed form, or comes
    /// and goes at once.
    #[inline(always)]
    fn look(
        &self,
        core: &Core,
        slots: u64,
        ray: &Ray,
        scratch: &mut solid::Scratch,
        line: &mut Line,
    ) -> bool {
        for (slot, leaf) in self.leaves[..self.count].iter().enumerate() {
            let chord = match slots >> slot & 1 {
                0 => Chord::NONE,
                _ => match core.tree.leaves()[*leaf as usize].chord(ray, scratch) {
                    Some(chord) => chord,
                    None => return false,
                },
            };
            let [lo, hi] = chord.ends;
            if hi <= lo {
                if !chord.is_none() {
                    return false;
                }
                if slot < self.needed {
                    line.count = 0;
                    return true;
                }
            }
            (line.lo[slot], line.hi[slot], line.parts[slot]) = (lo, hi, chord.parts);
            line.count = slot + 1;
        }
        true
    }

    /// The first change of truth in the range.
    #[inline(always)]
    fn change(&self, line: &Line, range: Interval) -> Option<Change> {
        let (mut t, mut before) = (range.lo, line.inside(range.lo));
        let was = self.is_inside(before);
        loop {
            t = line.next(t);
            if t == f64::INFINITY || range.hi < t {
                return None;
            }
            let after = line.inside(t);
            if self.is_inside(after) != was {
                return Some(Change { t, before, after, entering: !was });
            }
            before = after;
        }
    }

    /// The slot that stands for a change: of those that cross there the one with the smallest key.
    #[inline(always)]
    fn met(&self, core: &Core, change: &Change) -> usize {
        let cross = change.before ^ change.after;
        let first = cross.trailing_zeros() as usize;
        if cross.is_power_of_two() {
            return first;
        }
        let key = |slot: &usize| {
            let leaf = self.leaves[*slot];
            (core.tree.leaves()[leaf as usize].key(), leaf)
        };
        (0..self.count).filter(|slot| cross >> slot & 1 == 1).min_by_key(key).unwrap_or(first)
    }

    /// The boundary at a change that is alone.
    #[inline(always)]
    fn boundary(
        &self,
        core: &Core,
        ray: &Ray,
        line: &Line,
        change: &Change,
        (met, normal): (usize, DVec3),
        scratch: &mut Scratch,
    ) -> Boundary {
        let Change { before, after, entering, .. } = *change;
        let (mut owner, mut normal) = (met, normal);
        if !(before ^ after).is_power_of_two() {
            scratch.solid.counts.ties += 1;
            owner = self.owner(core, line, change, scratch);
            if owner != met {
                normal = self.normal(core, line, owner, ray, change.t, &mut scratch.solid);
            }
        }
        let leaf = self.leaves[owner];
        let within = if entering { after } else { before };
        let filler = if core.tree.leaves()[leaf as usize].material.is_some() || !core.can_fill {
            None
        } else {
            self.fill(core, line, &mut scratch.room.few);
            scratch.room.filler(core, within)
        };
        let crossing = line.crossing(owner, change.t);
        let flipped = crossing.entering != entering;
        let normal = if flipped { -normal } else { normal };
        Boundary { t: change.t, leaf: core.first(leaf), crossing, normal, flipped, filler }
    }

    /// The outward unit normal of a leaf that crosses at `t`, world frame.
    #[inline(always)]
    fn normal(
        &self,
        core: &Core,
        line: &Line,
        slot: usize,
        ray: &Ray,
        t: f64,
        scratch: &mut solid::Scratch,
    ) -> DVec3 {
        let leaf = &core.tree.leaves()[self.leaves[slot] as usize];
        leaf.normal_along(ray, &line.crossing(slot, t), scratch)
    }

    /// Of leaves that cross together the slot of the one that owns the face.
    fn owner(&self, core: &Core, line: &Line, change: &Change, scratch: &mut Scratch) -> usize {
        let room = &mut scratch.room;
        self.fill(core, line, &mut room.few);
        let Change { t, before, after, entering } = *change;
        let from = room.few.hits().partition_point(|hit| hit.t < t);
        let to = room.few.hits().partition_point(|hit| hit.t <= t);
        let owner = room.owner(core, &Turn { from, to, before, after, entering });
        room.few.hits()[owner].slot as usize
    }

    /// Puts the leaves and their crossings where the short way looks for them, in the same slots.
    fn fill(&self, core: &Core, line: &Line, few: &mut Few) {
        few.clear(core.id);
        for (slot, leaf) in self.leaves[..line.count].iter().enumerate() {
            few.keep(*leaf, &Chord { ends: [line.lo[slot], line.hi[slot]], parts: line.parts[slot] });
        }
    }
}

/// Where truth changes: at crossings that all have one t.
#[derive(Clone, Copy)]
struct Change {
    t: f64,
    /// The leaves that the ray is inside of before and after.
    before: u64,
    after: u64,
    /// Whether the ray goes into the object.
    entering: bool,
}

/// Where a line is inside the leaves: the ends of their chords, slot by slot, as the first so many places hold them.
#[derive(Default)]
struct Line {
    lo: [f64; MOST],
    hi: [f64; MOST],
    parts: [[u32; 2]; MOST],
    count: usize,
}

impl Line {
    #[inline(always)]
    fn chords(&self) -> impl Iterator<Item = (f64, f64)> {
        self.lo[..self.count].iter().copied().zip(self.hi[..self.count].iter().copied())
    }

    /// The leaves that the line is inside of from `t` on.
    #[inline(always)]
    fn inside(&self, t: f64) -> u64 {
        let (mut mask, mut bit) = (0, 1);
        for (lo, hi) in self.chords() {
            mask |= if (lo <= t) & (t < hi) { bit } else { 0 };
            bit <<= 1;
        }
        mask
    }

    /// The first end after `t`, infinite if there is none.
    #[inline(always)]
    fn next(&self, t: f64) -> f64 {
        let after = |end: f64| if t < end { end } else { f64::INFINITY };
        let min = |a: f64, b: f64| if a < b { a } else { b };
        self.chords().fold(f64::INFINITY, |least, (lo, hi)| min(least, min(after(lo), after(hi))))
    }

    /// The last end before `t`, infinite if there is none.
    #[inline(always)]
    fn last(&self, t: f64) -> f64 {
        let before = |end: f64| if end < t { end } else { f64::NEG_INFINITY };
        let max = |a: f64, b: f64| if b < a { a } else { b };
        self.chords().fold(f64::NEG_INFINITY, |most, (lo, hi)| max(most, max(before(lo), before(hi))))
    }

    /// The crossing of a leaf at an end of its chord, which `t` is.
    #[inline(always)]
    fn crossing(&self, slot: usize, t: f64) -> Crossing {
        let exits = t == self.hi[slot];
        Crossing::exact(t, !exits, self.parts[slot][usize::from(exits)])
    }

    /// The slot that stands for a change and its normal, if nothing but what crosses there lies so near that the clean-up or
    /// the choice of an owner would look at it, or at what fills the point just inside.
    #[inline(always)]
    fn alone(
        &self,
        handful: &Handful,
        core: &Core,
        ray: &Ray,
        change: &Change,
        scratch: &mut solid::Scratch,
    ) -> Option<(usize, DVec3)> {
        let t = change.t;
        let met = handful.met(core, change);
        let normal = handful.normal(core, self, met, ray, t, scratch);
        let is_far = far_at(core, ray, t, normal);
        let far = is_far(t - self.last(t)) && is_far(self.next(t) - t) && is_far(f64::INFINITY);
        far.then_some((met, normal))
    }
}

/// Truth of the root for all states of some leaves, in an order in which one leaf changes at a time (Gray's).
fn truths(tree: &Tree, outside: &State, leaves: &[u32], state: &mut State) -> u64 {
    state.reset(tree, outside);
    let mut root = 0;
    for step in 0..1u64 << leaves.len() {
        let mask = step ^ step >> 1;
        if 0 < step {
            let slot = step.trailing_zeros();
            state.set(tree, leaves[slot as usize] as usize, Truth::known(mask >> slot & 1 == 1));
        }
        root |= u64::from(state.root() == Truth::Yes) << mask;
    }
    state.reset(tree, outside);
    root
}
