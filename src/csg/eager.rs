//! The short way of a sweep: where a ray meets few leaves, all of closed form, each is asked at once and for the whole
//! range. Nothing is ever open then, so nothing has to be found out about what to ask; the crossings are the same.

use super::queue::{Event, What};
use super::room::{Met, Room};
use super::sweep::Sweep;
use super::truth::Truth;
use crate::geom::Interval;
use crate::solid::Cost;

/// Where more leaves than this are met, a first surface makes most of them needless.
const FEW: usize = 12;

impl Sweep<'_> {
    /// Meets and asks every leaf of the range, if they are few and of closed form; else says no, having asked none.
    pub(super) fn ask_all(&mut self) -> bool {
        let core = self.core;
        let Room { met, walk, .. } = &mut *self.room;
        while met.len() <= FEW && walk.least() < f64::INFINITY {
            walk.step(&core.hierarchy, |leaf, inside| met.push(Met::new(leaf, inside)));
        }
        if FEW < met.len() || met.iter().any(|m| core.costs[m.leaf as usize] != Cost::Closed) {
            return false;
        }
        (0..met.len()).for_each(|met| self.ask_whole(met));
        true
    }

    /// Asks a leaf for the whole range.
    fn ask_whole(&mut self, met: usize) {
        let lo = self.range.lo;
        let answer = self.query(met, Interval::new(lo, self.range.hi));
        debug_assert!(self.range.hi <= answer.range.hi, "closed forms answer for the whole line");
        let room = &mut *self.room;
        room.asked += 1;
        room.keep(met, answer, self.range.hi);
        let (m, mut inside) = (&mut room.met[met], answer.inside);
        for at in m.crossings[0]..m.crossings[1] {
            let crossing = &room.pool[at as usize];
            if crossing.t <= lo {
                (inside, m.next) = (crossing.entering, at + 1);
            } else {
                room.queue.push(Event { t: crossing.t, met: met as u32, what: What::Cross });
            }
        }
        room.state.set(&self.core.tree, m.leaf as usize, Truth::known(inside));
    }
}
