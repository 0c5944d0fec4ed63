//! Whether a cell of a line holds no root of F, exactly one, or cannot be told: two certificates from F and F' at its
//! ends, each given a bound on a higher derivative.
//!
//! Curvature, |F''| <= M over a cell of length L:
//! - ends of one sign: F stays above the parabolas `F_a + F'_a x - M x^2/2` from either end; both are concave, so the larger
//!   of them is lowest where they meet or at the ends;
//! - ends of opposite signs: where |F'| > M L/2 at both ends, with the sign of the change, F' cannot vanish (each end
//!   answers for its half), so there is one root; ends of one sign with such slopes have none between.
//!
//! Fourth derivative, |F''''| <= K: F differs from the cubic H through both ends' values and slopes by at most K L^4 / 384,
//! and F' from H' by at most K L^3 sqrt(3)/216 (Birkhoff and Priver 1967). So a line that runs along the surface a depth e
//! away is done in cells of length e^(1/4) instead of e^(1/2).
//!
//! M is 1/h of the nearest sample, and twice what the ends show where that is more. K is known for a cell whose parent
//! was split: four times what the cubic of the parent missed at the place of the split, never less than the usual. Both are
//! measured, not proved: certificates given M and K. `tests/surface_scan.rs` holds them against dense scans.

use crate::num::roots::quadratic;

/// A cell with F and F' at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Arc length from end to end.
    pub length: f64,
    /// The smaller width of its ends.
    pub width: f64,
    /// F and dF/ds where it begins.
    pub a: [f64; 2],
    /// And where it ends.
    pub b: [f64; 2],
    /// The bound K of |F''''|; infinite where nothing is known.
    pub fourth: f64,
}

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// No root.
    Empty,
    /// Exactly one.
    One,
    /// Everywhere zero, as far as rounding can tell.
    Flat,
    /// To be split at this share of it.
    Split(f64),
}

/// F is a sum over hundreds of samples: its rounding, in widths.
pub(super) const ROUNDING: f64 = 1e-14;
/// Clean and noisy tori showed at most |F''| = 0.43/h, clean scans about 0.5/h in all but one place in a hundred.
const USUAL_CURVATURE: f64 = 1.0;
/// |F''''| h^3 reached 14 on a sphere with noise of 0.3 spacings, and stays below 20 in 999 places of 1,000 of clean scans.
const USUAL_FOURTH: f64 = 16.0;
/// What was measured may be exceeded by these factors nearby.
const CURVATURE_MARGIN: f64 = 2.0;
const FOURTH_MARGIN: f64 = 4.0;
/// The cubic of a cell longer than this many widths says nothing about its halves.
const TELLING: f64 = 1.0;
/// A cell all of whose values are rounding is flat where it is no longer than this many widths.
const FLAT: f64 = 0.125;

impl Cell {
    /// Rounding of F here, world length.
    pub fn rounding(&self) -> f64 {
        ROUNDING * self.width
    }

    /// Whether F has different signs at the ends.
    pub fn changes(&self) -> bool {
        (self.a[0] < 0.0) != (self.b[0] < 0.0)
    }

    /// The verdict on a cell of at most a few widths.
    pub fn judge(&self) -> Verdict {
        if self.is_flat() {
            return Verdict::Flat;
        }
        let m = self.curvature();
        let monotone = self.slopes_hold(m) || self.cubic_slopes_hold();
        if self.changes() {
            let share = self.a[0] / (self.a[0] - self.b[0]);
            return if monotone { Verdict::One } else { Verdict::Split(share) };
        }
        if monotone {
            return Verdict::Empty;
        }
        let (lowest, share) = lower_bound(self.length, self.a, self.b, m);
        if 0.0 < lowest {
            return Verdict::Empty;
        }
        if self.fourth.is_finite() {
            let (least, at) = self.least_of_cubic();
            if self.cubic_error() + self.rounding() < least {
                return Verdict::Empty;
            }
            return Verdict::Split(at);
        }
        Verdict::Split(share)
    }

    /// What the values at a place between, at this share of the cell, say about K of the two parts.
    pub fn fourth_at(&self, share: f64, f: [f64; 2]) -> f64 {
        if TELLING * self.width < self.length {
            return f64::INFINITY;
        }
        let (x, y) = (share * self.length, (1.0 - share) * self.length);
        let [value, slope] = self.cubic(share);
        // H misses a quartic c s^4 / 24 by c x^2 y^2 / 24, its slope by c x y (y - x) / 12; a slope that misses more tells
        // of something rougher.
        let from_value = (f[0] - value).abs() * 24.0 / (x * x * y * y);
        let from_slope = (f[1] - slope).abs() * 12.0 / (x * y * self.length);
        let usual = USUAL_FOURTH / (self.width * self.width * self.width);
        usual.max(FOURTH_MARGIN * from_value.max(from_slope))
    }

    /// The bound M of |F''|.
    pub fn curvature(&self) -> f64 {
        let l = self.length;
        let slopes = (self.b[1] - self.a[1]).abs() / l;
        // Taylor's remainders from either end; at a jump they grow without bound as cells shrink.
        let change = self.b[0] - self.a[0];
        let remainder = (change - self.a[1] * l).abs().max((change - self.b[1] * l).abs());
        (USUAL_CURVATURE / self.width)
            .max(CURVATURE_MARGIN * slopes)
            .max(CURVATURE_MARGIN * 2.0 * remainder / (l * l))
    }

    /// Where the cubic through both ends vanishes first, as a share of the cell, for ends of opposite signs.
    pub fn cubic_root(&self) -> f64 {
        let (mut lo, mut hi) = (0.0, 1.0);
        // Halving and Newton's steps in turn: the cubic costs nothing beside F.
        for _ in 0..24 {
            let middle = 0.5 * (lo + hi);
            let [value, slope] = self.cubic(middle);
            let newton = middle - value / (slope * self.length);
            if (value < 0.0) == (self.a[0] < 0.0) {
                lo = middle
            } else {
                hi = middle
            }
            if lo < newton && newton < hi {
                let near = self.cubic(newton)[0];
                if (near < 0.0) == (self.a[0] < 0.0) { lo = newton } else { hi = newton }
            }
        }
        0.5 * (lo + hi)
    }

    fn is_flat(&self) -> bool {
        let none = 4.0 * self.rounding();
        let zero = |[f, slope]: [f64; 2]| f.abs() <= none && (slope * self.length).abs() <= none;
        self.length <= FLAT * self.width && zero(self.a) && zero(self.b)
    }

    fn slopes_hold(&self, m: f64) -> bool {
        let falls = if self.b[0] < self.a[0] { -1.0 } else { 1.0 };
        let steady = |slope: f64| 0.5 * m * self.length < falls * slope;
        steady(self.a[1]) && steady(self.b[1])
    }

    /// The coefficients of H in the share of the cell.
    fn coefficients(&self) -> [f64; 4] {
        let change = self.b[0] - self.a[0];
        let (c, d) = (self.a[1] * self.length, self.b[1] * self.length);
        [self.a[0], c, 3.0 * change - 2.0 * c - d, c + d - 2.0 * change]
    }

    /// H and dH/ds at a share of the cell.
    fn cubic(&self, x: f64) -> [f64; 2] {
        let [c0, c1, c2, c3] = self.coefficients();
        [((c3 * x + c2) * x + c1) * x + c0, ((3.0 * c3 * x + 2.0 * c2) * x + c1) / self.length]
    }

    fn cubic_error(&self) -> f64 {
        let l2 = self.length * self.length;
        self.fourth * l2 * l2 / 384.0
    }

    /// The least of |H| in a cell whose ends have one sign (below zero where it has the other between), and where.
    fn least_of_cubic(&self) -> (f64, f64) {
        let sign = if self.a[0] < 0.0 { -1.0 } else { 1.0 };
        let [_, c1, c2, c3] = self.coefficients();
        let turns = if c3 == 0.0 {
            [-0.5 * c1 / c2; 2]
        } else {
            quadratic(3.0 * c3, c2, c1, c2 * c2 - 3.0 * c3 * c1).unwrap_or([0.0; 2])
        };
        let inside = turns.into_iter().filter(|x| 0.0 < *x && *x < 1.0);
        inside
            .chain([0.0, 1.0])
            .map(|x| (sign * self.cubic(x)[0], x))
            .min_by(|p, q| p.0.total_cmp(&q.0))
            .unwrap_or((0.0, 0.5))
    }

    /// Whether H' keeps the sign of the change by more than F' may differ from it.
    fn cubic_slopes_hold(&self) -> bool {
        let falls = if self.b[0] < self.a[0] { -1.0 } else { 1.0 };
        let [_, _, c2, c3] = self.coefficients();
        let vertex = (-c2 / (3.0 * c3)).clamp(0.0, 1.0);
        let flattest = [0.0, 1.0, if vertex.is_nan() { 0.0 } else { vertex }]
            .map(|x| falls * self.cubic(x)[1])
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        // sqrt(3) / 216.
        const SHARE: f64 = 0.008_018_753_738_744_805;
        self.fourth.is_finite() && SHARE * self.fourth * self.length.powi(3) < flattest
    }
}

/// The least that |F| can be by a curvature `m` in a cell whose ends have one sign, and where, as a share of the cell; of
/// F and F' at both ends.
pub(super) fn lower_bound(length: f64, a: [f64; 2], b: [f64; 2], m: f64) -> (f64, f64) {
    let sign = if a[0] < 0.0 { -1.0 } else { 1.0 };
    let (va, sa) = (sign * a[0], sign * a[1]);
    let (vb, sb) = (sign * b[0], -sign * b[1]);
    // From a: va + sa x - m x^2/2; from b: vb + sb (L-x) - m (L-x)^2/2. They meet where they are equal.
    let from_a = |x: f64| va + sa * x - 0.5 * m * x * x;
    let from_b = |x: f64| vb + sb * (length - x) - 0.5 * m * (length - x) * (length - x);
    let denominator = sa + sb - m * length;
    let meet = (vb - va + sb * length - 0.5 * m * length * length) / denominator;
    // M covers the remainders of both ends, so they meet inside, up to rounding.
    let meet = meet.clamp(0.0, length);
    (from_a(meet).min(from_b(meet)).min(va).min(vb), meet / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(length: f64, a: [f64; 2], b: [f64; 2]) -> Cell {
        Cell { length, width: 1.0, a, b, fourth: f64::INFINITY }
    }

    #[test]
    fn the_lower_bound_is_below_every_function_of_that_curvature() {
        // F = c + k (x - x0)^2 / 2 with |k| <= M.
        for (c, k, x0) in [(0.2, 0.9, 0.3), (0.05, 1.0, 0.7), (0.5, -0.8, 0.4), (0.001, 0.5, 0.5)] {
            let f = |x: f64| [c + 0.5 * k * (x - x0) * (x - x0), k * (x - x0)];
            let cell = cell(1.0, f(0.0), f(1.0));
            let (low, _) = lower_bound(cell.length, cell.a, cell.b, cell.curvature());
            let least = (0..=1000).map(|i| f(i as f64 / 1000.0)[0]).fold(f64::INFINITY, f64::min);
            assert!(low <= least + 1e-12, "{low} {least}");
        }
    }

    #[test]
    fn a_clear_minimum_is_certified() {
        assert_eq!(cell(1.0, [0.5, -0.3], [0.5, 0.3]).judge(), Verdict::Empty);
    }

    #[test]
    fn the_cubic_certifies_what_a_quartic_of_its_bound_cannot_cross() {
        // F = e + K/24 (x^2 (x - 1)^2) touches e at both ends and in no other place; -K/24 dips by K/384.
        let k = 24.0;
        for (dip, verdict) in [(0.9, Verdict::Split(0.0)), (1.1, Verdict::Empty)] {
            let e = dip * k / 384.0;
            let flat = Cell { fourth: k, ..cell(1.0, [e, 0.0], [e, 0.0]) };
            let flat = Cell { width: 1e-3, ..flat };
            assert_eq!(std::mem::discriminant(&flat.judge()), std::mem::discriminant(&verdict), "{dip}");
        }
    }

    #[test]
    fn what_a_cubic_misses_measures_the_fourth_derivative() {
        let f = |x: f64| [3.0 * x.powi(4), 12.0 * x.powi(3)];
        let cell = Cell { width: 10.0, ..cell(0.8, f(0.1), f(0.9)) };
        for share in [0.3, 0.5, 0.8] {
            let k = cell.fourth_at(share, f(0.1 + 0.8 * share));
            assert!(72.0 * FOURTH_MARGIN <= k * (1.0 + 1e-9), "{k}");
        }
    }
}
