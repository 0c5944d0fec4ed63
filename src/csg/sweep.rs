//! One sweep along a ray over the crossings of all leaves of an object.
//!
//! Crossings are taken by their exact t, all at one t together, and truth is compared before and after: no tolerance
//! in here. Leaves come out of the hierarchy front to back. A leaf is out until the ray enters its box, then open; only
//! where the object's truth is open is a leaf asked, the cheap before the costly, and only one whose answer can tell. So
//! cutters are asked only where the base lives. What a leaf answers does not depend on when or for which range it is
//! asked, so neither does any boundary.

use super::object::Core;
use super::queue::{Event, Queue, What};
use super::room::{Met, Room};
use super::truth::{State, Truth};
use super::walk::Walk;
use crate::geom::{Interval, Ray};
use crate::solid::{self, Answer, Crossing};
use glam::DVec3;

/// A change of the object's truth, before clean-up.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Change {
    /// Where.
    pub t: f64,
    /// A leaf that crosses here: of several the one with the smallest key. Of the leaves met, which.
    pub met: u32,
    /// Its crossing.
    pub crossing: Crossing,
    /// Whether the ray goes into the object.
    pub entering: bool,
    /// Whether others may cross at the same t.
    pub tied: bool,
}

/// A sweep in progress.
pub(super) struct Sweep<'a> {
    pub core: &'a Core,
    pub ray: &'a Ray,
    pub range: Interval,
    pub room: &'a mut Room,
    pub scratch: &'a mut solid::Scratch,
    /// Everything up to here is settled.
    pub at: f64,
    inside: bool,
}

impl<'a> Sweep<'a> {
    /// Meets the boxes that have no end; the others are met on the way.
    pub fn new(
        core: &'a Core,
        ray: &'a Ray,
        range: Interval,
        room: &'a mut Room,
        scratch: &'a mut solid::Scratch,
    ) -> Sweep<'a> {
        room.enter(core);
        let Room { met, walk, queue, open, state, .. } = room;
        walk.begin(&core.hierarchy, ray, range, |sight, leaf| {
            let Some(inside) = sight.inside(&core.hierarchy, leaf) else { return };
            if range.lo < inside.lo {
                return show(met, queue, range, leaf, inside);
            }
            // Open from the beginning: nothing has to come before.
            open.push(core.costs[leaf as usize], leaf, met.len() as u32);
            state.set(&core.tree, leaf as usize, Truth::Open);
            met.push(Met::new(leaf, inside));
        });
        Sweep { core, ray, range, room, scratch, at: range.lo, inside: false }
    }

    /// Lets the hierarchy show every leaf whose box begins up to `t`.
    #[inline]
    pub fn meet(&mut self, t: f64) {
        let (core, range) = (self.core, self.range);
        let Room { met, walk, queue, .. } = &mut *self.room;
        while walk.least() <= t {
            step(core, walk, met, queue, range);
            if walk.least() == f64::INFINITY {
                break;
            }
        }
    }

    /// The t of the next event up to `limit`, every leaf that begins before it met; infinite where there is none.
    #[inline]
    fn next_event(&mut self, limit: f64) -> f64 {
        let (core, range) = (self.core, self.range);
        let Room { met, walk, queue, .. } = &mut *self.room;
        loop {
            let next = queue.next_t();
            let least = walk.least();
            if next < least || limit < least || least == f64::INFINITY {
                return next;
            }
            step(core, walk, met, queue, range);
        }
    }

    /// Whether the ray is inside the object where the range begins.
    pub fn begin(&mut self) -> bool {
        self.meet(self.range.lo);
        self.take_group(self.range.lo);
        self.resolve();
        self.inside = self.room.state.root() == Truth::Yes;
        self.inside
    }

    /// The next change of the object's truth in the range and not after `limit`; a later call goes on from there.
    pub fn next_until(&mut self, limit: f64) -> Option<Change> {
        let limit = limit.min(self.range.hi);
        loop {
            let t = self.next_event(limit);
            if limit < t || t == f64::INFINITY {
                return None;
            }
            self.at = t;
            let (toggled, tied) = self.take_group(t);
            let found = self.resolve();
            let inside = self.room.state.root() == Truth::Yes;
            // Truth changes where something crosses. A leaf that turns out to be inside where the ray enters its box
            // has crossed before: its box is too small. Its crossing is then late, but not lost.
            if inside != self.inside
                && let Some((met, crossing)) = toggled.or(found)
            {
                self.inside = inside;
                // A leaf asked only now may have crossed here too.
                let tied = tied || found.is_some();
                return Some(Change { t, met, crossing, entering: inside, tied });
            }
        }
    }

    /// Applies all events at one t; returns the crossing of the leaf with the smallest key, and whether others cross.
    fn take_group(&mut self, t: f64) -> (Option<(u32, Crossing)>, bool) {
        let tree = &self.core.tree;
        let mut best: Option<(u32, Crossing)> = None;
        let mut crossings = 0;
        while let Some(Event { met, what, .. }) = self.room.queue.pop_at(t) {
            let m = &mut self.room.met[met as usize];
            let leaf = m.leaf as usize;
            match what {
                What::Open => {
                    self.room.open.push(self.core.costs[leaf], m.leaf, met);
                    self.room.state.set(tree, leaf, Truth::Open);
                }
                What::Cross => {
                    let crossing = self.room.pool[m.next as usize];
                    m.next += 1;
                    self.room.state.set(tree, leaf, Truth::known(crossing.entering));
                    self.schedule(met as usize);
                    crossings += 1;
                    let key = |met: u32| self.key(met);
                    if best.is_none_or(|(other, _)| key(met) < key(other)) {
                        best = Some((met, crossing));
                    }
                }
            }
        }
        let tied = 1 < crossings;
        self.scratch.counts.ties += u64::from(tied);
        (best, tied)
    }

    /// Who owns what of two leaves; the earlier in the object where they are alike.
    fn key(&self, met: u32) -> ((bool, bool, u64), u32) {
        let leaf = self.room.met[met as usize].leaf;
        (self.core.tree.leaves()[leaf as usize].key(), leaf)
    }

    /// Puts what a leaf does next into the queue: its next crossing, or the end of its answer.
    fn schedule(&mut self, met: usize) {
        let m = &self.room.met[met];
        let (t, what) = if m.next < m.crossings[1] {
            (self.room.pool[m.next as usize].t, What::Cross)
        } else if m.answered.hi < m.range.hi.min(self.range.hi) {
            (m.answered.hi, What::Open)
        } else {
            return;
        };
        self.room.queue.push(Event { t, met: met as u32, what });
    }

    /// Asks leaves until the object's truth just after `at` is known; returns the last crossing up to there.
    fn resolve(&mut self) -> Option<(u32, Crossing)> {
        let mut last = None;
        while self.room.state.root() == Truth::Open {
            let Some(met) = self.room.open.pop(&self.core.tree, &mut self.room.state) else { break };
            last = self.ask(met as usize).map(|c| (met, c)).or(last);
        }
        last
    }

    /// Asks an open leaf from `at` on; returns its last crossing up to there, if it was asked for one.
    fn ask(&mut self, met: usize) -> Option<Crossing> {
        let tree = &self.core.tree;
        let Met { leaf, range, answered, .. } = self.room.met[met];
        let end = range.hi.min(self.range.hi);
        if end < self.at {
            // The ray has left its box.
            self.room.state.set(tree, leaf as usize, Truth::No);
            return None;
        }
        if answered.is_empty() {
            self.room.asked += 1;
        }
        let answer = self.query(met, Interval::new(self.at, end));
        self.room.keep(met, answer, self.range.hi);
        let (mut inside, mut last) = (answer.inside, None);
        let m = &mut self.room.met[met];
        while m.next < m.crossings[1] && self.room.pool[m.next as usize].t <= self.at {
            last = Some(self.room.pool[m.next as usize]);
            inside = self.room.pool[m.next as usize].entering;
            m.next += 1;
        }
        self.schedule(met);
        self.room.state.set(tree, leaf as usize, Truth::known(inside));
        last
    }

    /// A leaf's crossings in a range, into `room.fresh`.
    pub fn query(&mut self, met: usize, range: Interval) -> Answer {
        let local = self.local(met);
        let leaf = &self.core.tree.leaves()[self.room.met[met].leaf as usize];
        self.room.fresh.clear();
        leaf.crossings(&local, range, self.scratch, &mut self.room.fresh)
    }

    /// The ray in the frame of a leaf.
    pub fn local(&mut self, met: usize) -> Ray {
        let m = &mut self.room.met[met];
        let place = &self.core.tree.leaves()[m.leaf as usize].place;
        *m.local.get_or_insert_with(|| place.ray_to_local(self.ray))
    }

    /// The state just after `t` of all leaves that the ray meets there, in one of the room's spare states.
    fn state_at(&mut self, t: f64, which: fn(&mut Room) -> &mut State) {
        self.meet(t);
        let tree = &self.core.tree;
        let mut state = std::mem::take(which(self.room));
        state.reset(tree, &self.core.outside);
        for which in 0..self.room.count_since(t) {
            let met = self.room.near_by(which);
            if self.room.met[met].range.contains(t) && self.holds(met, t) {
                state.set(tree, self.room.met[met].leaf as usize, Truth::Yes);
            }
        }
        *which(self.room) = state;
    }

    /// Whether a leaf is inside just after `t`.
    fn holds(&mut self, met: usize, t: f64) -> bool {
        let m = &self.room.met[met];
        let inside = if m.covers(Interval::new(t, t)) {
            let last = self.room.crossings(met).iter().rfind(|c| c.t <= t);
            return last.map_or(m.inside, |c| c.entering);
        } else {
            self.query(met, Interval::new(t, t)).inside
        };
        self.room.fresh.iter().rfind(|c| c.t <= t).map_or(inside, |c| c.entering)
    }

    /// Puts the state of all leaves just after `t` into `room.here`.
    pub fn fill(&mut self, t: f64) {
        self.state_at(t, |room| &mut room.here);
    }

    /// Whether a leaf makes the object's truth change from `t[0]` to `t[1]`, both included: it changes, and so does every
    /// node from one of its uses up. A leaf cut away here has no part in the face, even where its own runs along.
    pub fn makes(&mut self, met: usize, t: [f64; 2]) -> bool {
        self.state_at(t[0].next_down(), |room| &mut room.before);
        self.state_at(t[1], |room| &mut room.here);
        let leaf = self.room.met[met].leaf as usize;
        self.room.here.differs(&self.room.before, &self.core.tree, leaf)
    }

    /// The outward unit normal of a leaf, the object's frame.
    pub fn leaf_normal(&mut self, met: u32, crossing: &Crossing) -> DVec3 {
        let local = self.local(met as usize);
        let leaf = &self.core.tree.leaves()[self.room.met[met as usize].leaf as usize];
        leaf.normal(&local, crossing, self.scratch)
    }
}

/// Opens a node of the hierarchy.
#[inline]
fn step(core: &Core, walk: &mut Walk, met: &mut Vec<Met>, queue: &mut Queue, range: Interval) {
    walk.step(&core.hierarchy, |sight, leaf| {
        if let Some(inside) = sight.inside(&core.hierarchy, leaf) {
            show(met, queue, range, leaf, inside);
        }
    });
}

/// A leaf comes in sight.
#[inline]
fn show(met: &mut Vec<Met>, queue: &mut Queue, range: Interval, leaf: u32, inside: Interval) {
    queue.push(Event { t: inside.lo.max(range.lo), met: met.len() as u32, what: What::Open });
    met.push(Met::new(leaf, inside));
}

impl Drop for Sweep<'_> {
    fn drop(&mut self) {
        self.room.state.reset(&self.core.tree, &self.core.outside);
        self.room.state.woken.clear();
        let skipped = self.room.met.len() as u64 - u64::from(self.room.asked);
        self.scratch.counts.leaves_skipped += skipped;
    }
}
