//! Weights: functions of the distance between a sample and the reference point alone, zero beyond a stated
//! support, so that every part of the program sees the same surface.

use crate::num::lanes::F4;

/// A weight theta(rho), where rho is the squared distance over the squared width of the sample.
pub trait Weight: Copy + Send + Sync + std::fmt::Debug + 'static {
    /// The weight is zero from this rho on.
    fn support(&self) -> f64;

    /// The weight.
    fn value(&self, rho: F4) -> F4;

    /// The weight and its first two derivatives with respect to rho.
    fn jet(&self, rho: F4) -> [F4; 3];
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
    fn value(&self, rho: F4) -> F4 {
        let s = (F4::splat(1.0) - rho * 0.125).at_least(0.0);
        let s2 = s * s;
        let s4 = s2 * s2;
        s4 * s4
    }

    #[inline(always)]
    fn jet(&self, rho: F4) -> [F4; 3] {
        let s = (F4::splat(1.0) - rho * 0.125).at_least(0.0);
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
    fn value(&self, rho: F4) -> F4 {
        let (cut, e) = (self.support, exp_minus(rho));
        F4(std::array::from_fn(|i| if rho.0[i] < cut { e.0[i] } else { 0.0 }))
    }

    #[inline(always)]
    fn jet(&self, rho: F4) -> [F4; 3] {
        let e = self.value(rho);
        [e, -e, e]
    }
}

/// exp(-x) for 0 <= x < 700, within 2 ulp; beyond, something finite or zero that the caller cuts.
///
/// x = k ln 2 - f with |f| <= ln 2 / 2; the Taylor series of exp to degree 13 ends below 1e-17. Only
/// additions and products, so the bits are the same on every machine.
#[inline(always)]
fn exp_minus(x: F4) -> F4 {
    // Adding 1.5 * 2^52 rounds to the nearest whole number and leaves it in the low bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LN2_HI: f64 = 0.693_147_180_369_123_8;
    const LN2_LO: f64 = 1.908_214_929_270_587_7e-10;
    const C: [f64; 14] = {
        let mut c = [1.0; 14];
        let mut k = 1;
        while k < 14 {
            c[k] = c[k - 1] / k as f64;
            k += 1;
        }
        c
    };
    let shifted = x.map(|x| -(if x < 700.0 { x } else { 700.0 })) * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let f = (-x.map(|x| if x < 700.0 { x } else { 700.0 }) - k * LN2_HI) - k * LN2_LO;
    let mut p = F4::splat(C[13]);
    for c in C[..13].iter().rev() {
        p = p * f + *c;
    }
    let scale = shifted.map(|s| f64::from_bits((s.to_bits().wrapping_add(1023)) << 52));
    p * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_agrees_with_the_library_to_two_ulp() {
        for i in 0..4000 {
            let x = i as f64 * 0.0091;
            let got = exp_minus(F4::splat(x)).0[0];
            let want = (-x).exp();
            assert!((got - want).abs() <= 2.0 * f64::EPSILON * want, "{x}: {got:e} {want:e}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        fn check(w: impl Weight) {
            for i in 1..70 {
                let (x, d) = (i as f64 * 0.1, 1e-5);
                let v = |x: f64| w.value(F4::splat(x)).0[0];
                let [_, d1, d2] = w.jet(F4::splat(x)).map(|l| l.0[0]);
                assert!((d1 - (v(x + d) - v(x - d)) / (2.0 * d)).abs() < 1e-9);
                assert!((d2 - (v(x + d) - 2.0 * v(x) + v(x - d)) / (d * d)).abs() < 1e-5);
            }
        }
        check(Compact);
        check(Gaussian::for_tolerance(1e-7));
    }

    #[test]
    fn nothing_weighs_beyond_the_support() {
        assert_eq!(Compact.value(F4::splat(8.0)).0[0], 0.0);
        assert_eq!(Compact.jet(F4::splat(1e6)).map(|l| l.0[0].abs()), [0.0; 3]);
        let g = Gaussian::for_tolerance(1e-7);
        assert_eq!(g.value(F4::splat(g.support())).0[0], 0.0);
        assert_eq!(g.value(F4::splat(1e6)).0[0], 0.0);
    }
}
