//! Enclosures of the functions of `libm`.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Breaks, Enclosure};
use crate::geom::tolerance;

impl Enclosure {
    /// From bounds of results of `libm`.
    fn of_libm(lo: f64, hi: f64, breaks: Breaks) -> Enclosure {
        let by = f64::from(tolerance::LIBM_ULPS) * tolerance::EPS;
        let out = |x: f64| by * x.abs() + f64::MIN_POSITIVE;
        Enclosure::rounded(lo - out(lo), hi + out(hi), breaks)
    }

    /// A function that grows.
    fn growing(self, f: fn(f64) -> f64) -> Enclosure {
        Enclosure::of_libm(f(self.lo), f(self.hi), self.breaks)
    }

    /// e to all powers.
    pub fn exp(self) -> Enclosure {
        if self.is_empty() {
            return self;
        }
        let e = self.growing(libm::exp);
        Enclosure { lo: e.lo.max(0.0), ..e }
    }

    /// All natural logarithms.
    pub fn ln(self) -> Enclosure {
        if self.is_empty() || self.hi <= 0.0 {
            return Enclosure::EMPTY;
        }
        let breaks = self.breaks | Breaks::undefined_if(self.lo <= 0.0);
        Enclosure { lo: self.lo.max(0.0), hi: self.hi, breaks }.growing(libm::log)
    }

    /// The whole numbers that a function makes which only grows, and only by jumps: `floor`, `ceil` and `round`, exact.
    pub fn whole(self, f: fn(f64) -> f64) -> Enclosure {
        if self.is_empty() {
            return self;
        }
        let (lo, hi) = (f(self.lo), f(self.hi));
        let jumps = if lo < hi { Breaks::JUMPS } else { Breaks::NONE };
        Enclosure { lo, hi, breaks: self.breaks | jumps }
    }

    /// The angles with these sines, radians.
    pub fn asin(self) -> Enclosure {
        if self.is_empty() || self.hi < -1.0 || 1.0 < self.lo {
            return Enclosure::EMPTY;
        }
        let breaks = self.breaks | Breaks::undefined_if(self.lo < -1.0 || 1.0 < self.hi);
        Enclosure { lo: self.lo.max(-1.0), hi: self.hi.min(1.0), breaks }.growing(libm::asin)
    }

    /// The angles with these cosines, radians.
    pub fn acos(self) -> Enclosure {
        if self.is_empty() || self.hi < -1.0 || 1.0 < self.lo {
            return Enclosure::EMPTY;
        }
        let breaks = self.breaks | Breaks::undefined_if(self.lo < -1.0 || 1.0 < self.hi);
        Enclosure::of_libm(libm::acos(self.hi.min(1.0)), libm::acos(self.lo.max(-1.0)), breaks)
    }

    /// Whether `quarter` + 4 k quarter turns is among the angles, for any whole k. In doubt yes: quarters of large
    /// angles carry an error of their own size times a few units of rounding.
    fn meets_quarter(self, quarter: f64) -> bool {
        let (a, b) = (self.lo / FRAC_PI_2, self.hi / FRAC_PI_2);
        let slack = 4.0 * tolerance::EPS * a.abs().max(b.abs());
        let turns = ((a - slack - quarter) / 4.0).ceil();
        turns * 4.0 + quarter <= b + slack
    }

    fn wave(self, f: fn(f64) -> f64, crest: f64) -> Enclosure {
        if self.is_empty() {
            return self;
        }
        if !self.lo.is_finite() || !self.hi.is_finite() {
            return Enclosure { lo: -1.0, hi: 1.0, breaks: Breaks::UNDEFINED };
        }
        let (a, b) = (f(self.lo), f(self.hi));
        let ends = Enclosure::of_libm(a.min(b), a.max(b), self.breaks);
        let lo = if self.meets_quarter(crest + 2.0) { -1.0 } else { ends.lo.max(-1.0) };
        let hi = if self.meets_quarter(crest) { 1.0 } else { ends.hi.min(1.0) };
        Enclosure { lo, hi, breaks: self.breaks }
    }

    /// The sines of angles, radians.
    pub fn sin(self) -> Enclosure {
        self.wave(libm::sin, 1.0)
    }

    /// The cosines of angles, radians.
    pub fn cos(self) -> Enclosure {
        self.wave(libm::cos, 0.0)
    }

    /// The tangents of angles, radians; which may be undefined at the poles.
    pub fn tan(self) -> Enclosure {
        if self.is_empty() {
            return self;
        }
        let poles = self.meets_quarter(1.0) || self.meets_quarter(3.0);
        if poles || PI <= self.width() || !self.width().is_finite() {
            return Enclosure::ALL_BROKEN;
        }
        self.growing(libm::tan)
    }

    /// The angles of the points (x, self), radians; which jump where they meet the cut along negative x.
    pub fn atan2(self, x: Enclosure) -> Enclosure {
        self.unless_empty(x, || {
            let breaks = self.breaks | x.breaks;
            if self.lo <= 0.0 && 0.0 <= self.hi && x.lo <= 0.0 {
                return Enclosure::of_libm(-PI, PI, breaks | Breaks::JUMPS);
            }
            // The extreme angles of a box that does not meet the cut are those of corners.
            let corners = [(self.lo, x.lo), (self.lo, x.hi), (self.hi, x.lo), (self.hi, x.hi)];
            let angles = corners.map(|(y, x)| libm::atan2(y, x));
            let lo = angles.into_iter().fold(f64::INFINITY, f64::min);
            let hi = angles.into_iter().fold(f64::NEG_INFINITY, f64::max);
            Enclosure::of_libm(lo, hi, breaks)
        })
    }

    /// All powers of the numbers that are not negative: b^e = exp(e ln b); 0^e is 0 for e > 0.
    pub fn power_of(self, e: Enclosure) -> Enclosure {
        if self.is_empty() || e.is_empty() || self.hi < 0.0 {
            return Enclosure::EMPTY;
        }
        let zero = self.lo <= 0.0;
        let breaks = self.breaks | e.breaks | Breaks::undefined_if(self.lo < 0.0 || (zero && e.lo <= 0.0));
        if self.hi == 0.0 {
            // 0^0 is 1.
            let (lo, hi) = (f64::from(e.hi <= 0.0), f64::from(e.contains(0.0)));
            return if e.hi < 0.0 { Enclosure::EMPTY } else { Enclosure { lo, hi, breaks } };
        }
        let all = [(self.lo.max(0.0), e.lo), (self.lo.max(0.0), e.hi), (self.hi, e.lo), (self.hi, e.hi)];
        let all = all.map(|(b, e)| libm::pow(b, e));
        let lo = all.into_iter().fold(f64::INFINITY, f64::min);
        let hi = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let bound = Enclosure::of_libm(lo, hi, breaks);
        Enclosure { lo: bound.lo.max(0.0), ..bound }
    }
}
