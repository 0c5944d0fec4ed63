//! One sweep along a ray over the crossings of all leaves of an object.
//!
//! Crossings are taken by their exact t, all at one t together, and truth is compared before and after: no tolerance
//! in here. Leaves are asked lazily: a leaf is out until the ray enters its box, then open; only where the object's
//! truth is open is a leaf asked, the cheap before the costly, and only one whose answer can tell. So cutters are asked
//! only where the base lives. What a leaf answers does not depend on when or for which range it is asked, so
//! neither does any boundary.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::tree::Tree;
use super::truth::{State, Truth};
use crate::geom::{Interval, Ray};
use crate::solid::{self, Answer, Crossing};
use glam::DVec3;

/// A change of the object's truth, before clean-up.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Change {
    /// Where.
    pub t: f64,
    /// A leaf that crosses here: of several the one with the smallest key.
    pub leaf: u32,
    /// Its crossing.
    pub crossing: Crossing,
    /// Whether the ray goes into the object.
    pub entering: bool,
    /// Whether others may cross at the same t.
    pub tied: bool,
}

/// What happens to a leaf at some t.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Event {
    /// The ray enters the leaf's box, or the leaf's answer ends: its state is open.
    Open,
    /// A crossing.
    Cross(Crossing),
    /// The ray leaves the leaf's box.
    Far,
}

/// Orders events by t, then by leaf, then as they were made; the order within one t changes nothing but the last
/// state of a leaf that crosses twice there.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Entry {
    t: f64,
    leaf: u32,
    made: u32,
    event: Event,
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Entry) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Entry) -> std::cmp::Ordering {
        let ids = |e: &Entry| (e.leaf, e.made);
        self.t.total_cmp(&other.t).then_with(|| ids(self).cmp(&ids(other)))
    }
}

/// Room for sweeps of one tree.
#[derive(Debug, Default)]
pub(super) struct Room {
    state: State,
    /// Leaves whose box the ray meets, and where.
    pub met: Vec<(u32, Interval)>,
    /// Leaves that are open now.
    open: Vec<u32>,
    heap: BinaryHeap<Reverse<Entry>>,
    made: u32,
    /// Leaves that have been asked.
    asked: Vec<u32>,
    pub fresh: Vec<Crossing>,
}

impl Room {
    fn push(&mut self, t: f64, leaf: u32, event: Event) {
        self.made += 1;
        self.heap.push(Reverse(Entry { t, leaf, made: self.made, event }));
    }
}

/// A sweep in progress.
pub(super) struct Sweep<'a> {
    pub tree: &'a Tree,
    /// [`State::outside`] of the tree.
    pub outside: &'a State,
    pub ray: &'a Ray,
    pub range: Interval,
    pub room: &'a mut Room,
    pub scratch: &'a mut solid::Scratch,
    /// Everything up to here is settled.
    pub at: f64,
    inside: bool,
    begun: bool,
}

impl<'a> Sweep<'a> {
    /// Meets the leaves' boxes.
    pub fn new(
        tree: &'a Tree,
        outside: &'a State,
        ray: &'a Ray,
        range: Interval,
        room: &'a mut Room,
        scratch: &'a mut solid::Scratch,
    ) -> Sweep<'a> {
        room.state.copy_from(outside);
        room.met.clear();
        room.open.clear();
        room.asked.clear();
        room.heap.clear();
        room.made = 0;
        for (i, leaf) in tree.leaves().iter().enumerate() {
            let inside = leaf.met(ray).intersect(range);
            if !inside.is_empty() {
                room.met.push((i as u32, inside));
                room.push(inside.lo, i as u32, Event::Open);
                if inside.hi < range.hi {
                    room.push(inside.hi, i as u32, Event::Far);
                }
            }
        }
        Sweep { tree, outside, ray, range, room, scratch, at: range.lo, inside: false, begun: false }
    }

    /// Whether the ray is inside the object where the range begins.
    pub fn begin(&mut self) -> bool {
        self.take_group(self.range.lo);
        self.resolve();
        self.begun = true;
        self.inside = self.room.state.root(self.tree) == Truth::Yes;
        self.inside
    }

    /// The next change of the object's truth in the range and not after `limit`; a later call goes on from there.
    pub fn next_until(&mut self, limit: f64) -> Option<Change> {
        debug_assert!(self.begun, "begin comes first");
        let limit = limit.min(self.range.hi);
        while let Some(Reverse(first)) = self.room.heap.peek().copied() {
            if limit < first.t {
                break;
            }
            self.at = first.t;
            let (toggled, tied) = self.take_group(first.t);
            let found = self.resolve();
            let inside = self.room.state.root(self.tree) == Truth::Yes;
            // Truth changes where something crosses. A leaf that turns out to be inside where the ray enters its box
            // has crossed before: its box is too small. Its crossing is then late, but not lost.
            if inside != self.inside
                && let Some((leaf, crossing)) = toggled.or(found)
            {
                self.inside = inside;
                // A leaf asked only now may have crossed here too.
                let tied = tied || found.is_some();
                return Some(Change { t: first.t, leaf, crossing, entering: inside, tied });
            }
        }
        None
    }

    /// Applies all events at one t; returns the crossing of the leaf with the smallest key, and whether others cross.
    fn take_group(&mut self, t: f64) -> (Option<(u32, Crossing)>, bool) {
        let mut best: Option<(u32, Crossing)> = None;
        let mut crossings = 0;
        while let Some(Reverse(entry)) = self.room.heap.peek().copied() {
            if entry.t != t {
                break;
            }
            self.room.heap.pop();
            let (leaf, i) = (entry.leaf, entry.leaf as usize);
            match entry.event {
                Event::Open => {
                    self.room.state.set(self.tree, i, Truth::Open);
                    self.room.open.push(leaf);
                }
                Event::Far => {
                    // A leaf that was asked ends at its own crossing.
                    let open = self.room.open.len();
                    self.room.open.retain(|l| *l != leaf);
                    if self.room.open.len() < open {
                        self.room.state.set(self.tree, i, Truth::No);
                    }
                }
                Event::Cross(crossing) => {
                    self.room.state.set(self.tree, i, Truth::known(crossing.entering));
                    crossings += 1;
                    let key = |l: u32| self.tree.leaves()[l as usize].key();
                    if best.is_none_or(|(l, _)| key(leaf) < key(l)) {
                        best = Some((leaf, crossing));
                    }
                }
            }
        }
        let tied = 1 < crossings;
        self.scratch.counts.ties += u64::from(tied);
        (best, tied)
    }

    /// Asks leaves until the object's truth just after `at` is known; returns the last crossing up to there.
    fn resolve(&mut self) -> Option<(u32, Crossing)> {
        let mut last = None;
        while self.room.state.root(self.tree) == Truth::Open {
            let (tree, state) = (self.tree, &self.room.state);
            let cost = |l: &&u32| (tree.leaves()[**l as usize].solid.is_costly(), **l);
            let useful = self.room.open.iter().filter(|l| state.matters(tree, **l as usize));
            let Some(&leaf) = useful.min_by_key(cost) else { break };
            last = self.ask(leaf).map(|c| (leaf, c)).or(last);
        }
        last
    }

    /// Asks an open leaf from `at` on; returns its last crossing up to there, if it was asked for one.
    fn ask(&mut self, leaf: u32) -> Option<Crossing> {
        let met = self.room.met.iter().find(|m| m.0 == leaf);
        let end = met.map_or(self.range.hi, |m| m.1.hi);
        let answer = self.query(leaf, Interval::new(self.at, end));
        let (mut inside, mut last) = (answer.inside, None);
        let fresh = std::mem::take(&mut self.room.fresh);
        for crossing in &fresh {
            if crossing.t <= self.at {
                (inside, last) = (crossing.entering, Some(*crossing));
            } else if crossing.t <= answer.range.hi.min(self.range.hi) {
                self.room.push(crossing.t, leaf, Event::Cross(*crossing));
            }
        }
        self.room.fresh = fresh;
        if answer.range.hi < end {
            self.room.push(answer.range.hi, leaf, Event::Open);
        }
        self.room.open.retain(|l| *l != leaf);
        self.room.state.set(self.tree, leaf as usize, Truth::known(inside));
        last
    }

    /// A leaf's crossings in a range, into `room.fresh`.
    pub fn query(&mut self, leaf: u32, range: Interval) -> Answer {
        self.scratch.counts.leaf_queries += 1;
        if !self.room.asked.contains(&leaf) {
            self.room.asked.push(leaf);
        }
        let leaf = &self.tree.leaves()[leaf as usize];
        let ray = leaf.place.ray_to_local(self.ray);
        self.room.fresh.clear();
        leaf.solid.crossings(&ray, range, self.scratch, &mut self.room.fresh)
    }

    /// The state just after `t` of all leaves that the ray meets in its range.
    pub fn state_at(&mut self, t: f64) -> State {
        let mut state = self.outside.clone();
        for i in 0..self.room.met.len() {
            let leaf = self.room.met[i].0;
            let answer = self.query(leaf, Interval::new(t, t));
            let last = self.room.fresh.iter().rfind(|c| c.t <= t);
            let inside = last.map_or(answer.inside, |c| c.entering);
            state.set(self.tree, leaf as usize, Truth::known(inside));
        }
        state
    }

    /// The outward unit normal of a leaf, world frame.
    pub fn leaf_normal(&mut self, leaf: u32, crossing: &Crossing) -> DVec3 {
        let leaf = &self.tree.leaves()[leaf as usize];
        let ray = leaf.place.ray_to_local(self.ray);
        leaf.place.normal_to_world(leaf.solid.normal(&ray, crossing, self.scratch))
    }
}

impl Drop for Sweep<'_> {
    fn drop(&mut self) {
        let skipped = self.room.met.len().saturating_sub(self.room.asked.len());
        self.scratch.counts.leaves_skipped += skipped as u64;
    }
}
