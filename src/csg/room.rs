//! Room for sweeps, lent by a thread: what a ray meets, what leaves have answered, what is inside.

use super::object::Core;
use super::open::Open;
use super::queue::Queue;
use super::slots::Few;
use super::truth::State;
use super::walk::Walk;
use crate::geom::{Interval, Ray};
use crate::solid::{Answer, Crossing};

/// A leaf whose box the ray meets, and what it has answered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub leaf: u32,
    /// Where the ray is inside its box; not cut to the range.
    pub range: Interval,
    /// The ray in its frame, once it was asked.
    pub local: Option<Ray>,
    /// The range of its last answer in the sweep; empty before.
    pub answered: Interval,
    /// Whether the ray is inside where that begins.
    pub inside: bool,
    /// Its crossings in [`Room::pool`].
    pub crossings: [u32; 2],
    /// The next of them.
    pub next: u32,
}

impl Met {
    pub fn new(leaf: u32, range: Interval) -> Met {
        Met { leaf, range, local: None, answered: Interval::EMPTY, inside: false, crossings: [0; 2], next: 0 }
    }

    /// Whether its last answer in the sweep tells everything about a stretch of the ray.
    pub fn covers(&self, about: Interval) -> bool {
        self.answered.lo < about.lo && about.hi <= self.answered.hi
    }
}

/// Of the leaves met those whose boxes the ray has not left, and some more: a ray that meets thousands one after the other
/// looks at few of them at a time.
#[derive(Debug, Default)]
pub(super) struct Near {
    /// Ascending.
    list: Vec<u32>,
    /// So many of those met have been looked at.
    seen: usize,
    /// When it is longer than this, those left behind are dropped.
    most: usize,
    /// All that were dropped have been left up to here.
    dropped: Option<f64>,
}

impl Near {
    /// Twice as many as are near, and this, are kept before any is dropped.
    const SPARE: usize = 64;

    fn forget(&mut self) {
        self.list.clear();
        (self.seen, self.most, self.dropped) = (0, Near::SPARE, None);
    }

    /// Lists all whose boxes the ray has not left before `t`, and perhaps others; how many.
    pub fn since(&mut self, t: f64, met: &[Met]) -> usize {
        if self.dropped.is_some_and(|dropped| t <= dropped) {
            self.forget();
        }
        self.list.extend(self.seen as u32..met.len() as u32);
        self.seen = met.len();
        self.list.len()
    }

    /// Drops those that the ray left before `t`, now and then.
    pub fn drop_before(&mut self, t: f64, met: &[Met]) {
        if self.list.len() <= self.most {
            return;
        }
        let mut dropped = self.dropped;
        self.list.retain(|i| {
            let hi = met[*i as usize].range.hi;
            if hi < t {
                dropped = Some(dropped.map_or(hi, |known| known.max(hi)));
            }
            t <= hi
        });
        (self.dropped, self.most) = (dropped, 2 * self.list.len() + Near::SPARE);
    }
}

/// Room for sweeps of one tree at a time.
#[derive(Debug, Default)]
pub(super) struct Room {
    /// The tree it has been made for.
    pub tree: Option<u64>,
    pub state: State,
    /// For asking about one place, beside the sweep's own state.
    pub here: State,
    /// And about a place before.
    pub before: State,
    pub met: Vec<Met>,
    pub near: Near,
    /// Leaves whose state is open.
    pub open: Open,
    pub walk: Walk,
    pub queue: Queue,
    /// Crossings that leaves have answered in the sweep.
    pub pool: Vec<Crossing>,
    /// Of those met, how many were asked.
    pub asked: u32,
    /// For rays that meet little.
    pub few: Few,
    /// The last answer outside the sweep.
    pub fresh: Vec<Crossing>,
}

impl Room {
    /// How many of those met the ray may not have left before `t`; [`Room::near_by`] tells which.
    pub fn count_since(&mut self, t: f64) -> usize {
        self.near.since(t, &self.met)
    }

    /// One of those that were counted last.
    #[inline]
    pub fn near_by(&self, which: usize) -> usize {
        self.near.list[which] as usize
    }

    /// Makes the states those of a tree.
    pub fn states_of(&mut self, core: &Core) {
        if self.tree != Some(core.id) {
            self.tree = Some(core.id);
            self.state.clone_from(&core.outside);
            self.here.clone_from(&core.outside);
            self.before.clone_from(&core.outside);
        }
    }

    /// Gets ready for a sweep of a tree.
    pub fn enter(&mut self, core: &Core) {
        self.states_of(core);
        self.met.clear();
        self.near.forget();
        self.open.clear();
        self.queue.clear();
        self.pool.clear();
        self.asked = 0;
    }

    /// Keeps an answer of the sweep; crossings past its end are left out, and come again.
    pub fn keep(&mut self, met: usize, answer: Answer, end: f64) {
        let first = self.pool.len() as u32;
        let last = answer.range.hi.min(end);
        self.pool.extend(self.fresh.iter().filter(|c| c.t <= last));
        let met = &mut self.met[met];
        met.crossings = [first, self.pool.len() as u32];
        met.next = first;
        met.inside = answer.inside;
        met.answered = Interval::new(answer.range.lo, last);
    }

    /// A leaf's crossings in its last answer.
    pub fn crossings(&self, met: usize) -> &[Crossing] {
        let [first, end] = self.met[met].crossings;
        &self.pool[first as usize..end as usize]
    }
}
