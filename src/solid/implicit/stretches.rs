//! A ray's part in a box, cut into stretches that are always the same: a ray that asks for its first crossing has only so
//! many solved, and whatever is asked, each gives the same crossings.
//!
//! The parameter is counted from the middle of that part, so that a far origin costs nothing but what its own rounding
//! costs. What is undecided where a stretch begins or ends is settled together with the neighbour it reaches into.

use super::SURFACE;
use super::roots::{Line, Root};
use crate::geom::{Interval, tolerance};
use crate::solid::{Answer, Crossing};

/// Into so many stretches the part is cut: few enough to cost little where a shape is simple, enough to save most of the
/// work where it has many sheets.
const COUNT: u32 = 16;

/// The stretches of a ray's part in a box.
pub(super) struct Stretches {
    enter: Crossing,
    exit: Crossing,
    /// What is asked.
    range: Interval,
    /// From where the parameter is counted.
    pub middle: f64,
}

impl Stretches {
    pub fn new(enter: Crossing, exit: Crossing, range: Interval) -> Stretches {
        Stretches { enter, exit, range, middle: 0.5 * (enter.t + exit.t) }
    }

    /// Where a stretch begins and the one before ends.
    fn border(&self, k: u32) -> f64 {
        let (lo, hi) = (self.enter.t - self.middle, self.exit.t - self.middle);
        if k == COUNT { hi } else { lo + (hi - lo) * (f64::from(k) / f64::from(COUNT)) }
    }

    fn t(&self, s: f64) -> f64 {
        (self.middle + s).clamp(self.enter.t, self.exit.t)
    }

    /// Up to here the stretches before the k-th tell all: a crossing at its border may be a later one's.
    fn told(&self, k: u32) -> f64 {
        if k == COUNT { f64::INFINITY } else { self.t(self.border(k)).next_down() }
    }

    /// Appends the crossings after the low end of the range, of at least the first stretch that has any.
    pub fn answer(&self, line: &mut Line, roots: &mut Vec<Root>, out: &mut Vec<Crossing>) -> Answer {
        let [first, last] = self.solve(line, roots);
        let told = self.told(last);
        let mut inside = first != 0 && line.inside(self.border(first));
        let begin = out.len();
        if first == 0 && line.inside(self.border(0)) {
            out.push(self.enter);
        }
        for root in roots.iter() {
            let crossing = Crossing::exact(self.t(root.s), root.entering, SURFACE);
            push(out, begin, Crossing { err: root.err, ..crossing });
        }
        if last == COUNT && line.inside(self.border(COUNT)) {
            push(out, begin, self.exit);
        }
        let before = out[begin..].iter().take_while(|c| c.t <= self.range.lo).count();
        if let Some(crossing) = before.checked_sub(1).map(|i| out[begin + i]) {
            inside = crossing.entering;
        }
        out.drain(begin..begin + before);
        while out[begin..].last().is_some_and(|c| told < c.t) {
            out.pop();
        }
        Answer { inside, range: Interval::new(self.range.lo, told) }
    }

    /// Solves stretches from the one that the range begins in; says which was the first, and one past the last.
    fn solve(&self, line: &mut Line, roots: &mut Vec<Root>) -> [u32; 2] {
        let begins = |k: &u32| self.t(self.border(*k)) < self.range.lo;
        let mut first = (1..COUNT).rev().find(begins).unwrap_or(0);
        let shortest = tolerance::STRETCH * self.border(0).abs().max(self.border(COUNT).abs());
        loop {
            roots.clear();
            let (mut undecided, mut k) = (None, first);
            let enters = first == 0 && line.inside(self.border(0));
            let doubtful = loop {
                let ends = [self.border(k), self.border(k + 1)];
                let doubtful = line.isolate(ends, shortest, &mut undecided, roots);
                if k == first && doubtful && 0 < first {
                    break true;
                }
                k += 1;
                if k == COUNT || (undecided.is_none() && self.suffices(k, enters, roots)) {
                    break false;
                }
            };
            if !doubtful {
                line.close(undecided, roots);
                return [first, k];
            }
            first -= 1;
        }
    }

    /// Whether the stretches before the k-th answer the question: there is a crossing, or the range has ended.
    fn suffices(&self, k: u32, enters: bool, roots: &[Root]) -> bool {
        let told = self.told(k);
        let is_new = |t: f64| self.range.lo < t && t <= told;
        self.range.hi <= told
            || (enters && is_new(self.enter.t))
            || roots.iter().any(|root| is_new(self.t(root.s)))
    }
}

/// Appends a crossing; two at one place are none.
fn push(out: &mut Vec<Crossing>, first: usize, crossing: Crossing) {
    match out[first..].last() {
        Some(last) if crossing.t <= last.t => {
            out.pop();
        }
        _ => out.push(crossing),
    }
}
