//! All roots of functions that are convex or concave on pieces that are known beforehand.
//!
//! A convex function has at most two roots on a piece. It needs no minimum to tell them apart: where both ends are
//! positive, any point below zero does, and the tangents at the ends bound the function from below, so that their
//! intersection above zero proves that there is none. (The isolation of Yuksel 2022, "High-performance polynomial
//! root finding for graphics", with convexity in place of the derivative's roots.)

use super::roots::bracketed;

/// A function's value and derivative at an end of a piece.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Knot {
    /// Where.
    pub x: f64,
    /// The value.
    pub y: f64,
    /// The derivative, from within the piece.
    pub slope: f64,
}

/// How a function bends on a piece.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Bend {
    /// Convex: the derivative rises.
    Up,
    /// Concave: the derivative falls.
    Down,
}

/// Hands the places between `a` and `b` where `f` passes from `>= 0` to `< 0` or back to `found`, ascending. Where the
/// function only touches zero from either side it is told nothing.
///
/// Preconditions: `a.x <= b.x`; `f` bends one way between them. `f` gives value and derivative. Rounding that hides a
/// dip less deep than itself loses both its roots, never one. Oracle: the closed forms of the solids that use it, and
/// dense sampling in the tests below.
pub fn roots(f: impl Fn(f64) -> [f64; 2], a: Knot, b: Knot, bend: Bend, mut found: impl FnMut(f64)) {
    // NaN at an end counts as outside.
    let (in_a, in_b) = (a.y < 0.0, b.y < 0.0);
    let up = bend == Bend::Up;
    let between = |lo: f64, hi: f64, start: f64, rising: bool| bracketed(&f, lo, hi, start, rising);
    if in_a != in_b {
        // From the end on the convex side of zero Newton's method does not overshoot.
        let start = if in_a == up { b.x } else { a.x };
        found(between(a.x, b.x, start, in_a));
    } else if in_a != up
        && let Some(x) = dip(&f, a, b, up)
    {
        found(between(a.x, x, a.x, in_a));
        found(between(x, b.x, b.x, !in_a));
    }
}

/// Rounds after which a dip that is still not found is too shallow to be told from a tangent.
const MOST_ROUNDS: u32 = 200;

/// A point between two ends where `f` (`up`; else `-f`), convex and not below zero at the ends, is below zero.
fn dip(f: impl Fn(f64) -> [f64; 2], a: Knot, b: Knot, up: bool) -> Option<f64> {
    let sign = if up { 1.0 } else { -1.0 };
    let turned = |k: Knot| Knot { x: k.x, y: sign * k.y, slope: sign * k.slope };
    let (mut a, mut b) = (turned(a), turned(b));
    for round in 0..MOST_ROUNDS {
        if !(a.slope < 0.0 && 0.0 < b.slope) {
            return None;
        }
        // Where the tangents meet, and how high: no lower is the function anywhere.
        let width = b.x - a.x;
        let meet = (b.y - a.y - b.slope * width) / (a.slope - b.slope);
        if 0.0 <= a.y + a.slope * meet {
            return None;
        }
        // Where a parabola with these slopes has its lowest point; in turn with the other, for a kink.
        let lowest = if round % 2 == 0 { width * (a.slope / (a.slope - b.slope)) } else { meet };
        let x = a.x + lowest;
        if !(a.x < x && x < b.x) {
            return None;
        }
        let [y, slope] = f(x).map(|v| sign * v);
        if y < 0.0 {
            return Some(x);
        }
        let knot = Knot { x, y, slope };
        if slope < 0.0 {
            a = knot;
        } else {
            b = knot;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    fn all(f: impl Fn(f64) -> [f64; 2] + Copy, lo: f64, hi: f64, bend: Bend) -> Vec<f64> {
        let knot = |x: f64| Knot { x, y: f(x)[0], slope: f(x)[1] };
        let mut out = Vec::new();
        roots(f, knot(lo), knot(hi), bend, |x| out.push(x));
        out
    }

    #[test]
    fn convex_and_concave_functions_have_the_roots_that_dense_sampling_sees() {
        let mut stream = Stream::new(1);
        for _ in 0..2000 {
            // |x - p| + c (x - q)^2 - y: convex, with a kink.
            let [p, q, c, y] = std::array::from_fn(|_| stream.unit());
            let value = |x: f64| (x - p).abs() + c * (x - q) * (x - q) - y;
            let f = |x: f64| [value(x), if x < p { -1.0 } else { 1.0 } + 2.0 * c * (x - q)];
            let minus = |x: f64| f(x).map(|v| -v);
            let signs: Vec<bool> = (0..=2000).map(|i| value(f64::from(i) * 0.001 - 0.5) < 0.0).collect();
            let changes = signs.windows(2).filter(|w| w[0] != w[1]).count();
            let seen = signs.contains(&true) || value(p.min(q)).min(value(p.max(q))) > 1e-3;
            let up = all(f, -0.5, 1.5, Bend::Up);
            assert!(up.len() == changes || !seen, "{up:?} {changes} {p} {q} {c} {y}");
            assert_eq!(up, all(minus, -0.5, 1.5, Bend::Down));
            assert!(up.iter().all(|x| value(*x).abs() < 1e-15));
        }
    }

    #[test]
    fn a_function_that_touches_zero_has_no_roots() {
        let f = |x: f64| [x * x, 2.0 * x];
        assert!(all(f, -1.0, 2.0, Bend::Up).is_empty());
        assert!(all(|x| f(x).map(|v| -v), -1.0, 2.0, Bend::Down).is_empty());
        let corner = |x: f64| [x.abs(), if x < 0.0 { -1.0 } else { 1.0 }];
        assert!(all(corner, -1.0, 2.0, Bend::Up).is_empty());
    }

    #[test]
    fn a_dip_of_a_few_ulps_is_found_with_both_its_roots() {
        let depth = 8.0 * f64::EPSILON;
        let found = all(|x: f64| [x * x - depth, 2.0 * x], -3.0, 1.0, Bend::Up);
        assert!(found.len() == 2 && (found[1] / depth.sqrt() - 1.0).abs() < 1e-12, "{found:?}");
    }
}
