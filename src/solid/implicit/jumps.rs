//! Where a function that only jumps (`floor`, `ceil`, `round`) jumps within a part of a line.
//!
//! Halving finds a jump in some fifty steps. Its argument u is smooth where it has derivatives U' that do not reach zero,
//! and then u passes a number k within m + (k - u(m)) / U', m any point of the part: one step of interval Newton (Moore,
//! Kearfott and Cloud 2009, chapter 8), exact up to rounding where u is linear, as it mostly is.

use super::tape::Slope;
use crate::geom::tolerance;
use crate::num::enclosure::Enclosure;
use crate::scene::formula::{One, Step};

/// Bounds of the place between `a` and `b` where the first step that jumps does so, from what is known of all steps over
/// the part and at its middle; `None` where that is not narrower than halving.
pub(super) fn first(
    steps: &[Step],
    [a, b]: [f64; 2],
    over: &[Slope],
    at_middle: &[Enclosure],
    shortest: f64,
) -> Option<[f64; 2]> {
    let (argument, target) = steps.iter().zip(over).find_map(|(step, over_it)| match *step {
        Step::One(op @ (One::Floor | One::Ceil | One::Round), u) if over_it.value.lo < over_it.value.hi => {
            let middle = at_middle[u as usize];
            Some((u as usize, threshold(op, over[u as usize].value, 0.5 * (middle.lo + middle.hi))))
        }
        _ => None,
    })?;
    let Slope { value, rate } = over[argument];
    if value.breaks.any() || rate.contains(0.0) {
        return None;
    }
    let m = 0.5 * (a + b);
    let place = Enclosure::point(m) + (Enclosure::point(target) - at_middle[argument]).over(rate);
    // The argument's rounding at the ends of what is left must not reach the jump again.
    let spare = 2.0 * place.width() + 2.0 * shortest + tolerance::STRETCH * (target / rate.lo).abs();
    let (lo, hi) = ((place.lo - spare).max(a), (place.hi + spare).min(b));
    // Where the bounds of the argument are wider than its values, it may pass the number elsewhere or nowhere.
    (lo < hi && hi - lo <= 0.5 * (b - a)).then_some([lo, hi])
}

/// The argument's value, between its bounds, at which the function jumps nearest to a value.
fn threshold(op: One, bounds: Enclosure, near: f64) -> f64 {
    let shift = if op == One::Round { 0.5 } else { 0.0 };
    let (least, most) = ((bounds.lo - shift).ceil(), (bounds.hi - shift).floor());
    (near - shift).round().max(least).min(most) + shift
}
