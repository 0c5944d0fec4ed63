//! Values of a formula: at a point, with the gradient there, and over a stretch of a ray with the derivative along it.
//!
//! A value that is not finite is undefined, and so is all that is made of it: at a point it is NaN, over a stretch the
//! enclosure says so ([`Enclosure`]). The derivative is that of forward mode automatic differentiation (Griewank and
//! Walther 2008, chapter 3); where a function has a kink (`abs`, `min`, `max`) an enclosure holds the slopes of both
//! sides, and where it jumps (`floor`) it says so and holds the slopes before and after. Values at a point lie in the enclosures of every stretch around it: operation by operation both are rounded
//! from the same exact results. Oracle: `tests/solid_implicit.rs` compares values, slopes and differences.

use glam::DVec3;

use crate::geom::tolerance;
use crate::num::enclosure::{Enclosure, integer_power};
use crate::scene::formula::{One, Step, Two};

/// An enclosure of values and one of their derivatives along the ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    pub value: Enclosure,
    pub rate: Enclosure,
}

/// Room for evaluating formulas, one value for each step.
#[derive(Default, Debug)]
pub struct Room {
    values: Vec<f64>,
    gradients: Vec<(f64, DVec3)>,
    pub(super) enclosures: Vec<Enclosure>,
    pub(super) slopes: Vec<Slope>,
    pub(super) cells: Vec<(f64, f64)>,
    pub(super) roots: Vec<super::roots::Root>,
}

/// A function of one number.
fn one(op: One, a: f64) -> f64 {
    match op {
        One::Negate => -a,
        One::Sqrt => a.sqrt(),
        One::Abs => a.abs(),
        One::Sin => libm::sin(a),
        One::Cos => libm::cos(a),
        One::Tan => libm::tan(a),
        One::Asin => libm::asin(a),
        One::Acos => libm::acos(a),
        One::Exp => libm::exp(a),
        One::Ln => libm::log(a),
        One::Floor => a.floor(),
        One::Ceil => a.ceil(),
        One::Round => a.round(),
    }
}

/// A function of two numbers; undefined where either is.
fn two(op: Two, a: f64, b: f64) -> f64 {
    match op {
        Two::Add => a + b,
        Two::Subtract => a - b,
        Two::Multiply => a * b,
        Two::Divide => a / b,
        Two::Atan2 => libm::atan2(a, b),
        Two::Min | Two::Max if a.is_nan() || b.is_nan() => f64::NAN,
        Two::Min => a.min(b),
        Two::Max => a.max(b),
        Two::Power if a < 0.0 => f64::NAN,
        Two::Power => libm::pow(a, b),
    }
}

fn power(a: f64, n: i32) -> f64 {
    if n < 0 { 1.0 / integer_power(a, -n) } else { integer_power(a, n) }
}

fn settled(x: f64) -> f64 {
    if x.is_finite() { x } else { f64::NAN }
}

/// The value of a formula at a point; NaN where it is undefined.
pub(super) fn value(steps: &[Step], p: DVec3, room: &mut Room) -> f64 {
    let values = &mut room.values;
    values.clear();
    for step in steps {
        let at = |i: u32| values[i as usize];
        let x = match *step {
            Step::Coordinate(axis) => p[axis as usize],
            Step::Number(x) => x,
            Step::One(op, a) => one(op, at(a)),
            Step::Two(op, a, b) => two(op, at(a), at(b)),
            Step::Power(a, n) => power(at(a), n),
        };
        values.push(settled(x));
    }
    values.last().copied().unwrap_or(f64::NAN)
}

/// The slope of a function where it jumps: what goes on beside a jump is nothing to it, so that the surface there is
/// the one that the jump makes.
const JUMP: f64 = (1u64 << 40) as f64;

/// The rate of a function of one number with value x; `reach` is how far the number may be from where it is meant.
fn rate_near(op: One, a: f64, x: f64, reach: f64) -> f64 {
    let reach = reach + tolerance::NOISE * tolerance::EPS * a.abs();
    match op {
        One::Floor | One::Ceil | One::Round if one(op, a - reach) < one(op, a + reach) => JUMP,
        _ => rate_of_one(op, a, x),
    }
}

/// The value and the gradient of a formula at a point, or at most `reach` beside it; of a kink the gradient of one side,
/// of a jump that of what jumps, enlarged by [`JUMP`].
pub(super) fn gradient(steps: &[Step], p: DVec3, reach: DVec3, room: &mut Room) -> (f64, DVec3) {
    let known = &mut room.gradients;
    known.clear();
    for step in steps {
        let at = |i: u32| known[i as usize];
        let (x, g) = match *step {
            Step::Coordinate(axis) => (p[axis as usize], DVec3::AXES[axis as usize]),
            Step::Number(x) => (x, DVec3::ZERO),
            Step::One(op, a) => {
                let (a, g) = at(a);
                let x = one(op, a);
                (x, g * rate_near(op, a, x, g.dot(reach).abs()))
            }
            Step::Two(op, a, b) => {
                let ((a, ga), (b, gb)) = (at(a), at(b));
                let x = two(op, a, b);
                let (u, v) = rates_of_two(op, a, b, x);
                // A rate of zero ends what it multiplies, infinite or not.
                let part = |rate: f64, g: DVec3| if rate == 0.0 { DVec3::ZERO } else { rate * g };
                (x, part(u, ga) + part(v, gb))
            }
            Step::Power(a, n) => {
                let (a, g) = at(a);
                let slope = if n == 1 { 1.0 } else { f64::from(n) * power(a, n - 1) };
                (power(a, n), g * slope)
            }
        };
        known.push((settled(x), g));
    }
    known.last().copied().unwrap_or((f64::NAN, DVec3::NAN))
}

fn rate_of_one(op: One, a: f64, x: f64) -> f64 {
    match op {
        One::Negate => -1.0,
        One::Sqrt => 0.5 / x,
        One::Abs => 1f64.copysign(a),
        One::Sin => libm::cos(a),
        One::Cos => -libm::sin(a),
        One::Tan => 1.0 + x * x,
        One::Asin => 1.0 / ((1.0 - a) * (1.0 + a)).sqrt(),
        One::Acos => -1.0 / ((1.0 - a) * (1.0 + a)).sqrt(),
        One::Exp => x,
        One::Ln => 1.0 / a,
        One::Floor | One::Ceil | One::Round => 0.0,
    }
}

/// The partial derivatives of a function of two numbers with value x.
fn rates_of_two(op: Two, a: f64, b: f64, x: f64) -> (f64, f64) {
    match op {
        Two::Add => (1.0, 1.0),
        Two::Subtract => (1.0, -1.0),
        Two::Multiply => (b, a),
        Two::Divide => (1.0 / b, -x / b),
        Two::Min if a < b => (1.0, 0.0),
        Two::Max if b < a => (1.0, 0.0),
        Two::Min | Two::Max => (0.0, 1.0),
        Two::Atan2 => {
            let square = a * a + b * b;
            (b / square, -a / square)
        }
        Two::Power => (b * libm::pow(a, b - 1.0), if a == 0.0 { 0.0 } else { x * libm::log(a) }),
    }
}

/// The values of a formula at the points of a box, each coordinate in an enclosure.
pub(super) fn enclose(steps: &[Step], p: &[Enclosure; 3], room: &mut Room) -> Enclosure {
    enclose_within(steps, p, &[], room)
}

/// The same where it is known already what the values of steps lie in: of the first, one for each.
pub(super) fn enclose_within(
    steps: &[Step],
    p: &[Enclosure; 3],
    within: &[Enclosure],
    room: &mut Room,
) -> Enclosure {
    let known = &mut room.enclosures;
    known.clear();
    for step in steps {
        let at = |i: u32| known[i as usize];
        let x = match *step {
            Step::Coordinate(axis) => p[axis as usize],
            Step::Number(x) => Enclosure::point(x),
            Step::One(op, a) => enclose_one(op, at(a)),
            Step::Two(op, a, b) => enclose_two(op, at(a), at(b)),
            Step::Power(a, n) => at(a).power(n),
        };
        let narrowed =
            within.get(known.len()).map_or(x, |w| Enclosure { lo: x.lo.max(w.lo), hi: x.hi.min(w.hi), ..x });
        known.push(narrowed);
    }
    known.last().copied().unwrap_or(Enclosure::EMPTY)
}

fn enclose_one(op: One, a: Enclosure) -> Enclosure {
    match op {
        One::Negate => -a,
        One::Sqrt => a.sqrt(),
        One::Abs => a.abs(),
        One::Sin => a.sin(),
        One::Cos => a.cos(),
        One::Tan => a.tan(),
        One::Asin => a.asin(),
        One::Acos => a.acos(),
        One::Exp => a.exp(),
        One::Ln => a.ln(),
        One::Floor => a.whole(f64::floor),
        One::Ceil => a.whole(f64::ceil),
        One::Round => a.whole(f64::round),
    }
}

fn enclose_two(op: Two, a: Enclosure, b: Enclosure) -> Enclosure {
    match op {
        Two::Add => a + b,
        Two::Subtract => a - b,
        Two::Multiply => a.times(b),
        Two::Divide => a.over(b),
        Two::Min => a.min(b),
        Two::Max => a.max(b),
        Two::Atan2 => a.atan2(b),
        Two::Power => a.power_of(b),
    }
}

/// The values over a stretch of a line and their derivatives, the coordinates going at constant rates.
pub(super) fn slope(steps: &[Step], p: &[Enclosure; 3], rates: DVec3, room: &mut Room) -> Slope {
    let known = &mut room.slopes;
    known.clear();
    for step in steps {
        let at = |i: u32| known[i as usize];
        let mut x = match *step {
            Step::Coordinate(axis) => {
                Slope { value: p[axis as usize], rate: Enclosure::point(rates[axis as usize]) }
            }
            Step::Number(x) => Slope { value: Enclosure::point(x), rate: Enclosure::point(0.0) },
            Step::One(op, a) => slope_of_one(op, at(a)),
            Step::Two(op, a, b) => slope_of_two(op, at(a), at(b)),
            Step::Power(a, n) => {
                let a = at(a);
                let outer = Enclosure::point(f64::from(n)).times(a.value.power(n - 1));
                Slope { value: a.value.power(n), rate: outer.times(a.rate) }
            }
        };
        if x.rate.is_empty() {
            x.rate = Enclosure::new(f64::NEG_INFINITY, f64::INFINITY);
        }
        known.push(x);
    }
    let unknown = Slope { value: Enclosure::EMPTY, rate: Enclosure::EMPTY };
    known.last().copied().unwrap_or(unknown)
}

fn slope_of_one(op: One, a: Slope) -> Slope {
    let value = enclose_one(op, a.value);
    let one = Enclosure::point(1.0);
    let rate = match op {
        One::Negate => -a.rate,
        One::Sqrt => a.rate.over(value + value),
        One::Abs if 0.0 <= a.value.lo => a.rate,
        One::Abs if a.value.hi <= 0.0 => -a.rate,
        One::Abs => a.rate.hull(-a.rate),
        One::Sin => a.value.cos().times(a.rate),
        One::Cos => -a.value.sin().times(a.rate),
        One::Tan => (one + value.power(2)).times(a.rate),
        One::Asin => a.rate.over(((one - a.value).times(one + a.value)).sqrt()),
        One::Acos => -a.rate.over(((one - a.value).times(one + a.value)).sqrt()),
        One::Exp => value.times(a.rate),
        One::Ln => a.rate.over(a.value),
        One::Floor | One::Ceil | One::Round => Enclosure::point(0.0),
    };
    Slope { value, rate }
}

fn slope_of_two(op: Two, a: Slope, b: Slope) -> Slope {
    let value = enclose_two(op, a.value, b.value);
    let rate = match op {
        Two::Add => a.rate + b.rate,
        Two::Subtract => a.rate - b.rate,
        Two::Multiply => a.rate.times(b.value) + a.value.times(b.rate),
        Two::Divide => (a.rate - value.times(b.rate)).over(b.value),
        Two::Min if a.value.hi < b.value.lo => a.rate,
        Two::Min if b.value.hi < a.value.lo => b.rate,
        Two::Max if b.value.hi < a.value.lo => a.rate,
        Two::Max if a.value.hi < b.value.lo => b.rate,
        Two::Min | Two::Max => a.rate.hull(b.rate),
        Two::Atan2 => {
            let square = a.value.power(2) + b.value.power(2);
            (b.value.times(a.rate) - a.value.times(b.rate)).over(square)
        }
        Two::Power => {
            let lowered = a.value.power_of(b.value - Enclosure::point(1.0));
            let by_base = b.value.times(lowered).times(a.rate);
            let constant = b.rate.lo == 0.0 && b.rate.hi == 0.0;
            if constant { by_base } else { by_base + value.times(a.value.ln()).times(b.rate) }
        }
    };
    Slope { value, rate }
}
