//! Real roots: of quadratics in closed form, of any function on a bracket.

use glam::DVec3;

/// The real roots of `a t^2 + 2 b t + c`, ascending, given the discriminant `b^2 - a c` computed by the caller
/// in whatever form loses least; a double root gives `None`, as a tangent has no inside.
///
/// The root of larger magnitude comes from `-b -+ sqrt(disc)` without cancellation, the other from the
/// product of the roots (Vieta; Press et al., Numerical Recipes 5.6). `a` must not be zero.
#[inline]
pub fn quadratic(a: f64, b: f64, c: f64, discriminant: f64) -> Option<[f64; 2]> {
    if discriminant.is_nan() || discriminant <= 0.0 {
        return None;
    }
    // Zeros of either sign are one: mirrored rays meet mirrored places.
    let q = -(b + discriminant.sqrt().copysign(b + 0.0));
    let (t0, t1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    let (lo, hi) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
    (lo < hi).then_some([lo, hi])
}

/// The `t` with `|o + t d| < r`, given the shortest `o` on its line or one nearly so: the ray was shifted to the point
/// nearest to the ball before. `None` where there are none or the line touches.
///
/// |o + t d|^2 = r^2, its discriminant as |d|^2 (r - m)(r + m) with m the distance of the line from the centre, which
/// keeps its digits at grazing incidence. Where `d` is zero it is all of the line or nothing. With components of `o`
/// and `d` set to zero it is a cylinder or a slab.
pub fn ball(o: DVec3, d: DVec3, r: f64) -> Option<[f64; 2]> {
    let (a, b) = (d.length_squared(), o.dot(d));
    if a == 0.0 {
        return (o.length() < r).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let middle = -b / a;
    let m = (o + middle * d).length();
    if m.is_nan() || r <= m {
        return None;
    }
    let half = ((r - m) * (r + m) / a).sqrt();
    let (lo, hi) = (middle - half, middle + half);
    (lo < hi).then_some([lo, hi])
}

/// Newton's method gives way to bisection where a step is not at least this much shorter than the last.
const SLOWEST: f64 = 0.5;
/// Bisection alone ends after some 1100 halvings of any bracket of `f64`.
const MOST_STEPS: u32 = 1200;

/// The root of `f` between `lo` and `hi`, where it changes its sign; `rising` where it is negative at `lo`. `f` gives
/// its value and its derivative; `start` lies in the bracket.
///
/// Newton's method, bisection where it leaves the bracket or crawls (Press et al., Numerical Recipes 9.4). It ends
/// where the value is zero or a step is below half an ulp of the bracket's larger end: a root is as exact as numbers of
/// that size, where the function crosses zero at a slope. A derivative of zero or NaN leads to bisection. Oracle: the closed forms of the solids that use it, and the
/// tests below.
pub fn bracketed(f: impl Fn(f64) -> [f64; 2], mut lo: f64, mut hi: f64, start: f64, rising: bool) -> f64 {
    let finest = 0.5 * f64::EPSILON * lo.abs().max(hi.abs());
    let (mut x, mut last, mut passed) = (start, f64::INFINITY, false);
    for _ in 0..MOST_STEPS {
        let [y, slope] = f(x);
        if y == 0.0 {
            return x;
        }
        if (y < 0.0) == rising {
            lo = x;
        } else {
            hi = x;
        }
        let newton = x - y / slope;
        let step = (newton - x).abs();
        if step <= finest {
            return newton;
        }
        let middle = lo + 0.5 * (hi - lo);
        if hi - lo <= 4.0 * finest || middle <= lo || hi <= middle {
            return middle;
        }
        let beyond = x + 2.0 * (newton - x);
        if lo <= newton && newton <= hi && step < SLOWEST * last {
            (x, last) = (newton, step);
        } else if !passed && lo < beyond && beyond < hi {
            // Rounding holds it up just before the root: from beyond it the bracket is as short as the step.
            (x, last, passed) = (beyond, 2.0 * step, true);
        } else {
            (x, last, passed) = (middle, hi - lo, false);
        }
    }
    x
}

/// The cube root of a number from 0 up, to some ulps, by products and quotients alone: the same bits on every machine.
///
/// A third of the exponent is the first guess; Newton's method for y^3 = x thrice squares its error of 5 %.
pub fn cube_root(x: f64) -> f64 {
    if !(f64::MIN_POSITIVE <= x && x.is_finite()) {
        return if x == f64::INFINITY { x } else { 0.0 };
    }
    // A third of the bits, plus two thirds of the exponent's bias less what the linear mantissa is off on the mean.
    let mut y = f64::from_bits(x.to_bits() / 3 + 0x2a9f_7893_782d_a1ce);
    for _ in 0..4 {
        y -= (y - x / (y * y)) / 3.0;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_root_beside_a_large_one_keeps_its_digits() {
        // (t - 1e8)(t - 1e-8) = t^2 - (1e8 + 1e-8) t + 1
        let b = -0.5 * (1e8 + 1e-8);
        let [lo, hi] = quadratic(1.0, b, 1.0, b * b - 1.0).unwrap();
        assert!((lo / 1e-8 - 1.0).abs() < 1e-15 && (hi / 1e8 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_double_root_has_no_inside() {
        assert_eq!(quadratic(1.0, -1.0, 1.0, 0.0), None);
        assert_eq!(quadratic(1.0, 0.0, 1.0, -1.0), None);
    }

    #[test]
    fn a_bracketed_root_is_found_to_some_ulps_however_flat_or_kinked_the_function_is() {
        type Jet = fn(f64) -> [f64; 2];
        let cases: [(Jet, f64); 4] = [
            (|x| [x * x * x - 2.0, 3.0 * x * x], 2f64.cbrt()),
            (|x| [(x - 0.3).powi(5), 5.0 * (x - 0.3).powi(4)], 0.3),
            (|x| [if x < 0.7 { x - 0.7 } else { 1e9 * (x - 0.7) }, if x < 0.7 { 1.0 } else { 1e9 }], 0.7),
            (|x| [(x - 0.6).signum(), 0.0], 0.6),
        ];
        for (f, root) in cases {
            for start in [0.0, 0.5, 1.9] {
                let found = bracketed(f, 0.0, 2.0, start, true);
                assert!((found - root).abs() <= 4.0 * f64::EPSILON, "{found} {root} {start}");
            }
        }
    }

    #[test]
    fn cube_roots_are_right_over_the_whole_range() {
        for i in -1000..1000 {
            let x = 1.37f64 * 2f64.powi(i);
            let y = cube_root(x);
            assert!((y * y * y / x - 1.0).abs() < 8.0 * f64::EPSILON, "{x:e} {y:e}");
        }
        assert_eq!(cube_root(0.0), 0.0);
    }

    #[test]
    fn a_line_that_touches_a_ball_has_no_part_in_it() {
        let touching = ball(DVec3::new(0.0, 2.0, 0.0), DVec3::X, 2.0);
        assert_eq!(touching, None);
        let chord = ball(DVec3::new(0.0, 3.0, 0.0), 2.0 * DVec3::X, 5.0);
        assert_eq!(chord, Some([-2.0, 2.0]));
        assert_eq!(ball(DVec3::X, DVec3::ZERO, 1.5), Some([f64::NEG_INFINITY, f64::INFINITY]));
    }
}
