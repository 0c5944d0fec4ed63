//! Where a formula's value changes sign along a ray: every place, none twice.
//!
//! The stretch of the ray is divided until each part is decided. With F an enclosure of the values over a part and D one of
//! their derivatives: where F does not reach zero there is no root; where the formula is defined and D does not reach
//! zero the values are monotone, and the signs at the two ends decide (Moore, Kearfott and Cloud 2009, chapters 5 and 8).
//! F is narrowed by the mean value form f(m) + D (T - m), whose excess falls with the square of the part's width. A part
//! that cannot be decided, because it is a few units in the last place long or because rounding alone spreads the values
//! as wide, is undecided: neighbours of this kind are one part, and it has a crossing iff the signs at its ends differ.
//! Such are tangents, the apex of a cone, kinks, poles, jumps and ends of the domain; each is counted. Signs are those of the
//! values in `f64`, which lie in all enclosures, so crossings alternate whatever rounding does.
//!
//! Cost: a few parts for each root, some fifty for each tangent. A formula that is zero up to rounding over a whole stretch
//! stops at [`MAX_CELLS`].

use glam::DVec3;

use super::jumps;
use super::tape::{self, Room, Slope};
use crate::geom::tolerance;
use crate::num::enclosure::{Breaks, Enclosure};
use crate::scene::Formula;

/// The most parts that are looked at in one stretch; what is left then is undecided.
const MAX_CELLS: usize = 1 << 11;

/// A change of sign.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Root {
    /// Where.
    pub s: f64,
    /// Half the width of a stretch that holds the exact root.
    pub err: f64,
    /// Whether the value goes from outside to inside.
    pub entering: bool,
}

/// A formula along the points `origin + s dir`.
pub(super) struct Line<'a> {
    pub formula: &'a Formula,
    pub origin: DVec3,
    pub dir: DVec3,
    pub room: &'a mut Room,
    /// How many parts were undecided so far.
    pub failures: u64,
}

/// What is known of a part.
enum Found {
    /// No root.
    None,
    /// The values grow or fall all along; their derivatives.
    Monotone(Enclosure),
    /// Dividing tells no more.
    Undecided,
    /// Not yet: to be divided in half.
    Open,
    /// Not yet: a jump lies here, to be parted from what is before and after.
    Jump([f64; 2]),
}

impl Line<'_> {
    fn value(&mut self, s: f64) -> f64 {
        tape::value(&self.formula.steps, self.origin + s * self.dir, self.room)
    }

    fn holds(&self, value: f64) -> bool {
        if self.formula.closed { value <= 0.0 } else { value < 0.0 }
    }

    /// Whether a point is inside; undefined values are outside.
    pub fn inside(&mut self, s: f64) -> bool {
        let value = self.value(s);
        self.holds(value)
    }

    fn box_of(&self, s: Enclosure) -> [Enclosure; 3] {
        [0, 1, 2].map(|i| Enclosure::point(self.origin[i]) + s.times(Enclosure::point(self.dir[i])))
    }

    fn enclose(&mut self, s: Enclosure) -> Enclosure {
        let p = self.box_of(s);
        tape::enclose(&self.formula.steps, &p, self.room)
    }

    fn slope(&mut self, s: Enclosure) -> Slope {
        let p = self.box_of(s);
        tape::slope(&self.formula.steps, &p, self.dir, self.room)
    }

    /// Whether all values are on one side.
    fn is_decided(&self, f: Enclosure) -> bool {
        let outside = if self.formula.closed { 0.0 < f.lo } else { 0.0 <= f.lo };
        let inside = if self.formula.closed { f.hi <= 0.0 } else { f.hi < 0.0 };
        f.is_empty() || outside || (inside && !f.breaks.undefined())
    }

    fn judge(&mut self, a: f64, b: f64, shortest: f64) -> Found {
        let Slope { value: mut f, rate } = self.slope(Enclosure::new(a, b));
        if self.is_decided(f) {
            return Found::None;
        }
        if !f.breaks.any() && !rate.contains(0.0) {
            return Found::Monotone(rate);
        }
        if b - a <= shortest {
            return Found::Undecided;
        }
        if f.breaks.undefined() {
            return Found::Open;
        }
        let m = 0.5 * (a + b);
        let at_m = self.enclose(Enclosure::point(m));
        if f.breaks.any() {
            let known = (&self.room.slopes[..], &self.room.enclosures[..]);
            let place = jumps::first(&self.formula.steps, [a, b], known.0, known.1, shortest);
            return place.map_or(Found::Open, Found::Jump);
        }
        let reach = Enclosure::new(a, b) - Enclosure::point(m);
        f = f.intersect(at_m + rate.times(reach));
        // The mean value form may overflow where the values do not.
        f.breaks = Breaks::NONE;
        match f {
            f if self.is_decided(f) => Found::None,
            f if !self.is_decided(at_m) && f.width() <= tolerance::FLAT * at_m.width() => Found::Undecided,
            _ => Found::Open,
        }
    }

    /// Appends all changes of sign between `lo` and `hi` to `out`, ascending; parts no longer than `shortest` are not
    /// divided. `undecided` is a part that ended undecided where this one begins, and afterwards one that does so where it
    /// ends. Returns whether it begins with an undecided part.
    pub fn isolate(
        &mut self,
        [lo, hi]: [f64; 2],
        shortest: f64,
        undecided: &mut Option<[f64; 2]>,
        out: &mut Vec<Root>,
    ) -> bool {
        let mut cells = std::mem::take(&mut self.room.cells);
        cells.clear();
        cells.push((lo, hi));
        let (mut looked, mut doubtful) = (0, false);
        while let Some((a, b)) = cells.pop() {
            looked += 1;
            let m = 0.5 * (a + b);
            let found = if looked <= MAX_CELLS { self.judge(a, b, shortest) } else { Found::Undecided };
            match found {
                Found::Open if a < m && m < b => {
                    cells.push((m, b));
                    cells.push((a, m));
                    continue;
                }
                Found::Jump([lo, hi]) => {
                    let parts = [(hi, b), (lo, hi), (a, lo)];
                    cells.extend(parts.into_iter().filter(|(from, to)| from < to));
                    continue;
                }
                Found::Open | Found::Undecided => {
                    doubtful |= a == lo;
                    *undecided = Some([undecided.map_or(a, |u| u[0]), b]);
                    continue;
                }
                _ => {}
            }
            self.close(undecided.take(), out);
            if let Found::Monotone(rate) = found {
                self.change(a, b, Some(rate), out);
            }
        }
        self.room.cells = cells;
        doubtful
    }

    /// Ends an undecided part.
    pub fn close(&mut self, part: Option<[f64; 2]>, out: &mut Vec<Root>) {
        if let Some([a, b]) = part {
            self.failures += 1;
            self.change(a, b, None, out);
        }
    }

    /// The change of sign between two places, if there is one.
    fn change(&mut self, a: f64, b: f64, rate: Option<Enclosure>, out: &mut Vec<Root>) {
        let (va, vb) = (self.value(a), self.value(b));
        let entering = self.holds(vb);
        if self.holds(va) == entering {
            return;
        }
        let s = self.refine((a, va), (b, vb));
        let err = rate.map_or(0.5 * (b - a), |rate| self.doubt(s, rate).min(b - a));
        out.push(Root { s, err, entering });
    }

    /// How far from `s` the exact root can be: what rounding leaves open of the value there, over the least slope.
    fn doubt(&mut self, s: f64, rate: Enclosure) -> f64 {
        let value = self.enclose(Enclosure::point(s));
        let value = value.lo.abs().max(value.hi.abs());
        let least = |rate: Enclosure| rate.lo.abs().min(rate.hi.abs());
        let wide = value / least(rate);
        let near = self.slope(Enclosure::new(s - wide, s + wide));
        if near.value.breaks.any() || near.rate.contains(0.0) { wide } else { value / least(near.rate) }
    }

    /// Two neighbouring numbers of unlike signs between two places of unlike signs: the one with the smaller value.
    ///
    /// Secants with a probe a few units beyond each, so that both ends close in; halving where that gains less than half.
    fn refine(&mut self, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
        let low = self.holds(a.1);
        let probe = tolerance::STRETCH * a.0.abs().max(b.0.abs());
        loop {
            let width = b.0 - a.0;
            let middle = 0.5 * (a.0 + b.0);
            if !(a.0 < middle && middle < b.0) {
                break;
            }
            let secant = a.0 - a.1 * (width / (b.1 - a.1));
            let guess = if a.0 < secant && secant < b.0 { secant } else { middle };
            let on_low = self.narrow(&mut a, &mut b, guess, low);
            self.narrow(&mut a, &mut b, if on_low { guess + probe } else { guess - probe }, low);
            if 0.5 * width < b.0 - a.0 {
                let middle = 0.5 * (a.0 + b.0);
                self.narrow(&mut a, &mut b, middle, low);
            }
        }
        if b.1.abs() < a.1.abs() || a.1.is_nan() { b.0 } else { a.0 }
    }

    /// Moves one end to `s`, if that lies between; says whether it is the low one.
    fn narrow(&mut self, a: &mut (f64, f64), b: &mut (f64, f64), s: f64, low: bool) -> bool {
        if !(a.0 < s && s < b.0) {
            return false;
        }
        let value = self.value(s);
        let is_low = self.holds(value) == low;
        *(if is_low { a } else { b }) = (s, value);
        is_low
    }
}
