//! Weights: functions of the distance between a sample and the reference point alone, zero beyond a stated
//! support, so that every part of the program sees the same surface.

use fearless_simd::{Level, Simd, dispatch, prelude::*};

use crate::num::lanes::{LANES, Lanes};
use crate::num::power::{LN2_HI, LN2_LO, TAYLOR};

/// A weight theta(rho), where rho is the squared distance over the squared width of the sample.
pub trait Weight: Copy + Send + Sync + std::fmt::Debug + 'static {
    /// The weight is zero from this rho on.
    fn support(&self) -> f64;

    /// The weight.
    fn value<S: Simd>(&self, simd: S, rho: Lanes<S>) -> Lanes<S>;

    /// The weight at one rho: the same bits as [`Weight::value`].
    fn at(&self, rho: f64) -> f64 {
        dispatch!(Level::new(), simd => self.value(simd, Lanes::splat(simd, rho))[0])
    }

    /// The weight and its first two derivatives with respect to rho.
    fn jet<S: Simd>(&self, simd: S, rho: Lanes<S>) -> [Lanes<S>; 3];
}

/// theta = (1 - rho/8)^8: close to the Gaussian near the sample, seven continuous derivatives at its end, and
/// no exponential.
#[derive(Clone, Copy, Debug)]
pub struct Compact;

impl Weight for Compact {
    fn support(&self) -> f64 {
        8.0
    }

    #[inline(always)]
    fn value<S: Simd>(&self, simd: S, rho: Lanes<S>) -> Lanes<S> {
        let s = (Lanes::splat(simd, 1.0) - rho * 0.125).max(Lanes::splat(simd, 0.0));
        let s2 = s * s;
        let s4 = s2 * s2;
        s4 * s4
    }

    #[inline(always)]
    fn jet<S: Simd>(&self, simd: S, rho: Lanes<S>) -> [Lanes<S>; 3] {
        let s = (Lanes::splat(simd, 1.0) - rho * 0.125).max(Lanes::splat(simd, 0.0));
        let s2 = s * s;
        let s4 = s2 * s2;
        let s6 = s4 * s2;
        [s4 * s4, -(s6 * s), s6 * 0.875]
    }
}

/// theta = exp(-rho), cut at a support that the tolerance asked decides.
#[derive(Clone, Copy, Debug)]
pub struct Gaussian {
    support: f64,
}

impl Gaussian {
    /// A Gaussian whose cut moves the surface by less than `tolerance` widths.
    ///
    /// Dropping what lies beyond k widths was seen to move the surface by at most some hundred times exp(-k^2)
    /// at degrees 0 to 4; a thousand is allowed for. k is kept within 3 and 6: at 6 the cut is below rounding.
    pub fn for_tolerance(tolerance: f64) -> Gaussian {
        Gaussian { support: (1e3 / tolerance).ln().clamp(9.0, 36.0) }
    }
}

impl Weight for Gaussian {
    fn support(&self) -> f64 {
        self.support
    }

    #[inline(always)]
    fn value<S: Simd>(&self, simd: S, rho: Lanes<S>) -> Lanes<S> {
        let e = exp_minus(simd, rho);
        rho.simd_lt(Lanes::splat(simd, self.support)).select(e, Lanes::splat(simd, 0.0))
    }

    #[inline(always)]
    fn jet<S: Simd>(&self, simd: S, rho: Lanes<S>) -> [Lanes<S>; 3] {
        let e = self.value(simd, rho);
        [e, -e, e]
    }
}

/// A factor phi(c) on a sample's weight by the cosine c between its normal and the plane's.
pub trait Facing: Copy + Send + Sync + std::fmt::Debug + 'static {
    /// Whether the factor can differ from one.
    const VARIES: bool;
    /// Whether it has to be asked which side of the plane the samples call out; else they all face against its normal.
    const VOTES: bool = true;

    /// The factor and its first two derivatives with respect to c.
    fn jet<S: Simd>(simd: S, c: Lanes<S>) -> [Lanes<S>; 3];

    /// The factor at one c.
    fn at(c: f64) -> f64 {
        dispatch!(Level::new(), simd => Self::jet(simd, Lanes::splat(simd, c))[0][0])
    }
}

/// All samples weigh, whichever way they face: the definition of the paper.
#[derive(Clone, Copy, Debug)]
pub struct AnyWay;

impl Facing for AnyWay {
    const VARIES: bool = false;

    #[inline(always)]
    fn jet<S: Simd>(simd: S, _: Lanes<S>) -> [Lanes<S>; 3] {
        let zero = Lanes::splat(simd, 0.0);
        [Lanes::splat(simd, 1.0), zero, zero]
    }
}

/// All samples weigh, and all are known to face within 84 degrees of one direction, against the plane's normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct OneWay;

impl Facing for OneWay {
    const VARIES: bool = false;
    const VOTES: bool = false;

    #[inline(always)]
    fn jet<S: Simd>(simd: S, c: Lanes<S>) -> [Lanes<S>; 3] {
        AnyWay::jet(simd, c)
    }
}

/// Samples that face the plane's way within 84 degrees weigh in full, those beyond 127 not at all, with two continuous
/// derivatives between. So the two sides of a thin wall do not mix; where all normals in reach lie within 84 degrees
/// of the plane's the surface is the one of the paper, to the last bit of its definition.
#[derive(Clone, Copy, Debug)]
pub struct SameWay;

impl Facing for SameWay {
    const VARIES: bool = true;

    #[inline(always)]
    fn jet<S: Simd>(simd: S, c: Lanes<S>) -> [Lanes<S>; 3] {
        // Cosines of 127 and 84 degrees. Narrower bounds (90 and 60) cut the rims of thin walls into flaps, wider ones
        // (143 and 90) let the far side in again: seen on the ears of a scanned rabbit, a width thick.
        const NONE: f64 = -0.6;
        const FULL: f64 = 0.1;
        const PER: f64 = 1.0 / (FULL - NONE);
        let (zero, one) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, 1.0));
        let x = ((c - NONE) * PER).max(zero).min(one);
        let y = one - x;
        let value = x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
        let first = x * x * (y * y) * (30.0 * PER);
        let second = x * y * (y - x) * (60.0 * PER * PER);
        [value, first, second]
    }
}

/// exp(-x) for 0 <= x < 700, within 2 ulp; beyond, something finite or zero that the caller cuts.
///
/// x = k ln 2 - f with |f| <= ln 2 / 2; the Taylor series of exp to degree 13 ends below 1e-17. Only
/// additions and products, so the bits are the same on every machine.
#[inline(always)]
fn exp_minus<S: Simd>(simd: S, x: Lanes<S>) -> Lanes<S> {
    // Adding 1.5 * 2^52 rounds to the nearest whole number and leaves it in the low bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let x = -x.min(Lanes::splat(simd, 700.0));
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let f = (x - k * LN2_HI) - k * LN2_LO;
    let mut p = Lanes::splat(simd, TAYLOR[13]);
    for c in TAYLOR[..13].iter().rev() {
        p = p * f + *c;
    }
    let power = |s: f64| f64::from_bits(s.to_bits().wrapping_add(1023) << 52);
    let scale: [f64; LANES] = std::array::from_fn(|i| power(shifted[i]));
    p * Lanes::from_slice(simd, &scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(w: &impl Weight, rho: f64) -> f64 {
        dispatch!(Level::new(), simd => w.value(simd, Lanes::splat(simd, rho))[0])
    }

    fn jet(w: &impl Weight, rho: f64) -> [f64; 3] {
        dispatch!(Level::new(), simd => w.jet(simd, Lanes::splat(simd, rho)).map(|l| l[0]))
    }

    #[test]
    fn the_exponential_agrees_with_the_library_to_two_ulp() {
        let whole = Gaussian { support: f64::INFINITY };
        for i in 0..4000 {
            let x = f64::from(i) * 0.0091;
            let (got, want) = (value(&whole, x), (-x).exp());
            assert!((got - want).abs() <= 2.0 * f64::EPSILON * want, "{x}: {got:e} {want:e}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        fn check(w: &impl Weight) {
            for i in 1..70 {
                let (x, d) = (f64::from(i) * 0.1, 1e-5);
                let [v, d1, d2] = jet(w, x);
                assert_eq!(v, value(w, x));
                assert!((d1 - (value(w, x + d) - value(w, x - d)) / (2.0 * d)).abs() < 1e-9, "{x}");
                // The second derivative as the difference of the first, which rounding spoils less.
                assert!((d2 - (jet(w, x + d)[1] - jet(w, x - d)[1]) / (2.0 * d)).abs() < 1e-9, "{x}");
            }
        }
        check(&Compact);
        check(&Gaussian::for_tolerance(1e-7));
    }

    #[test]
    fn the_factor_of_facing_is_smooth_and_one_within_84_degrees() {
        let at =
            |c: f64| dispatch!(Level::new(), simd => SameWay::jet(simd, Lanes::splat(simd, c)).map(|l| l[0]));
        for c in [0.1, 0.3, 1.0] {
            assert_eq!(at(c).map(f64::abs), [1.0, 0.0, 0.0]);
        }
        for c in [-0.6, -0.7, -1.0] {
            assert_eq!(at(c).map(f64::abs), [0.0; 3]);
        }
        for i in 1..50 {
            let (c, d) = (0.013 * f64::from(i) - 0.6, 1e-5);
            let ([v, d1, d2], [hi, ..], [lo, ..]) = (at(c), at(c + d), at(c - d));
            assert!((d1 - (hi - lo) / (2.0 * d)).abs() < 1e-7);
            assert!((d2 - (hi - 2.0 * v + lo) / (d * d)).abs() < 1e-3);
        }
    }

    #[test]
    fn nothing_weighs_beyond_the_support() {
        assert_eq!(value(&Compact, 8.0), 0.0);
        assert_eq!(jet(&Compact, 1e6).map(f64::abs), [0.0; 3]);
        let g = Gaussian::for_tolerance(1e-7);
        assert_eq!(value(&g, g.support()), 0.0);
        assert_eq!(value(&g, 1e6), 0.0);
    }

    #[test]
    fn every_level_of_instructions_gives_the_same_bits() {
        let levels = [Some(Level::baseline()), Some(Level::new())];
        let at = |level: Level, x: f64| {
            let g = Gaussian::for_tolerance(1e-7);
            dispatch!(level, simd => g.jet(simd, Lanes::splat(simd, x)).map(|l| l[3].to_bits()))
        };
        for i in 0..1000 {
            let x = f64::from(i) * 0.02;
            let bits: Vec<_> = levels.into_iter().flatten().map(|l| at(l, x)).collect();
            assert!(bits.windows(2).all(|w| w[0] == w[1]), "{x}");
        }
    }
}
