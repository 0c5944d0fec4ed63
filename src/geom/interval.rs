//! Ranges of a ray's parameter.

/// A closed range of `t`, perhaps unbounded; empty where `hi < lo`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Interval {
    /// Low end.
    pub lo: f64,
    /// High end.
    pub hi: f64,
}

impl Default for Interval {
    fn default() -> Interval {
        Interval::EMPTY
    }
}

impl Interval {
    /// The whole line.
    pub const ALL: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// Nothing.
    pub const EMPTY: Interval = Interval { lo: f64::INFINITY, hi: f64::NEG_INFINITY };
    /// What lies ahead of a ray's origin.
    pub const AHEAD: Interval = Interval { lo: 0.0, hi: f64::INFINITY };

    /// From `lo` to `hi`.
    pub const fn new(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    /// Whether nothing lies in it.
    pub fn is_empty(self) -> bool {
        self.hi < self.lo
    }

    /// Whether `t` lies in it, ends included.
    pub fn contains(self, t: f64) -> bool {
        self.lo <= t && t <= self.hi
    }

    /// What both hold.
    pub fn intersect(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }

    /// Makes one of ascending intervals that touch.
    pub fn unite(ascending: &mut Vec<Interval>) {
        ascending.dedup_by(|next, last| {
            let touch = next.lo <= last.hi;
            last.hi = if touch { last.hi.max(next.hi) } else { last.hi };
            touch
        });
    }

    /// Length in `t`.
    pub fn length(self) -> f64 {
        self.hi - self.lo
    }
}
