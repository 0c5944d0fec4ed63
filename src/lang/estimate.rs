//! Numbers that come of what was measured: the value, and how it follows what was measured, so that its bar is known and can be
//! made narrower.
//!
//! A number is kept as an affine form (Stolfi and de Figueiredo, "Self-validated numerical methods", 1997): the value, for each
//! thing measured how much it adds for a unit of that, and the rest that is no straight line. The bar of `volume(a) - volume(a)`
//! is so zero. A function is taken for straight between the ends of the bars of its arguments; by how much it is not at the
//! corners of these is the rest. That is no proof for functions that turn around in between, as nothing is that has a bar of
//! one in a thousand.

use std::sync::Arc;

use super::ast::InfixOp;
use super::queries::{Asked, Geometry, Measured};
use super::value::{Located, Val};
use crate::geom::tolerance;
use crate::scene::{Call, Shape};
use crate::source::Span;

/// More things measured than this in one number are not told apart any more.
const MOST: usize = 64;
/// Measured numbers below the one, and from the other on, are written with a power of ten.
const SMALL: f64 = 1e-5;
const LARGE: f64 = 1e9;
/// Functions of more arguments have no rest: their corners are too many.
const CORNERS: usize = 6;

/// What was measured.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Question {
    /// The volume.
    Volume,
    /// The area.
    Area,
    /// A coordinate of the middle.
    Middle(usize),
    /// What no more lines tell better: bounds.
    Settled,
}

/// Something measured, to be asked again.
#[derive(Clone, Debug)]
pub struct Source {
    /// What about it.
    pub question: Question,
    /// Of what.
    pub shape: Shape,
    /// Where it was asked.
    pub at: Span,
}

/// What something measured adds to a number.
#[derive(Clone, Debug)]
struct Term {
    source: Arc<Source>,
    measured: Measured,
    /// For a unit of it.
    factor: f64,
}

/// A number that comes of what was measured.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    terms: Vec<Term>,
    /// What else it may be off.
    rest: f64,
    /// The sizes of what it is made of, as far as they make it.
    size: f64,
}

impl Estimate {
    /// Something measured, as it is.
    pub fn of(measured: Measured, source: Arc<Source>) -> Estimate {
        let terms = vec![Term { source, measured, factor: 1.0 }];
        Estimate { value: measured.value, terms, rest: 0.0, size: measured.size }
    }

    fn exact(value: f64) -> Estimate {
        Estimate { value, terms: Vec::new(), rest: 0.0, size: value.abs() }
    }

    /// Of a number, measured or not; `None` of other values.
    pub fn read(value: &Val) -> Option<Estimate> {
        match value {
            Val::Number(x) => Some(Estimate::exact(*x)),
            Val::Measured(estimate) => Some((**estimate).clone()),
            _ => None,
        }
    }

    /// Half the width of the bar.
    pub fn bar(&self) -> f64 {
        self.rest + self.terms.iter().map(|term| (term.factor * term.measured.err).abs()).sum::<f64>()
    }

    /// What the bar is held against: of a difference that is about zero what it is one of.
    pub fn size(&self) -> f64 {
        self.size.max(self.value.abs())
    }

    /// A function of such numbers.
    pub fn apply(args: &[Estimate], f: impl Fn(&[f64]) -> f64) -> Estimate {
        let values: Vec<f64> = args.iter().map(|arg| arg.value).collect();
        let bars: Vec<f64> = args.iter().map(Estimate::bar).collect();
        let value = f(&values);
        let slope = |i: usize| {
            let at = |x: f64| {
                f(&values.iter().enumerate().map(|(k, v)| if k == i { x } else { *v }).collect::<Vec<_>>())
            };
            let (lo, hi) = (values[i] - bars[i], values[i] + bars[i]);
            if hi <= lo { 0.0 } else { (at(hi) - at(lo)) / (hi - lo) }
        };
        let slopes: Vec<f64> = (0..args.len()).map(slope).collect();
        let mut made = Estimate::exact(value);
        for (arg, slope) in args.iter().zip(&slopes) {
            made.rest += (slope * arg.rest).abs();
            made.size += (slope * arg.size()).abs();
            arg.terms.iter().for_each(|term| made.add(term, slope * term.factor));
        }
        made.rest += bend(&values, &bars, &slopes, value, f);
        made.fold();
        made
    }

    /// The sum of such numbers, however many.
    pub fn sum(args: &[Estimate]) -> Estimate {
        let mut sum = Estimate::exact(0.0);
        for arg in args {
            sum.value += arg.value;
            sum.rest += arg.rest;
            sum.size += arg.size();
            arg.terms.iter().for_each(|term| sum.add(term, term.factor));
            sum.fold();
        }
        sum
    }

    fn add(&mut self, term: &Term, factor: f64) {
        let is_same = |known: &&mut Term| {
            known.source.question == term.source.question
                && known.source.question != Question::Settled
                && Arc::ptr_eq(&known.source.shape.0, &term.source.shape.0)
        };
        match self.terms.iter_mut().find(is_same) {
            Some(known) => known.factor += factor,
            None => self.terms.push(Term { factor, ..term.clone() }),
        }
    }

    /// Makes one rest of too many terms.
    fn fold(&mut self) {
        if MOST < self.terms.len() {
            (self.rest, self.terms) = (self.bar(), Vec::new());
        }
    }

    /// The same number by what is measured at a level of accuracy; `None` where none of it can be told better than one level
    /// below.
    pub fn at_level(&self, level: usize, geometry: &dyn Geometry, materials: &[Call]) -> Option<Estimate> {
        if !self.terms.iter().any(|term| term.measured.is_open) {
            return None;
        }
        let mut finer = self.clone();
        for term in &mut finer.terms {
            let Source { question, shape, at } = &*term.source;
            let asked = Asked { shape, materials, at: *at, level };
            let measured = match question {
                Question::Volume => geometry.volume(&asked).ok()?,
                Question::Area => geometry.area(&asked).ok()?,
                Question::Middle(axis) => geometry.centroid(&asked).ok()?[*axis],
                Question::Settled => continue,
            };
            finer.value += term.factor * (measured.value - term.measured.value);
            term.measured = measured;
        }
        Some(finer)
    }

    /// The number in the digits that its bar leaves, down to that of the bar's first one, as it is read back.
    pub fn digits(&self) -> String {
        let (bar, x) = (self.bar(), self.value);
        if bar <= tolerance::ROUNDINGS * self.size() || !bar.is_finite() || !x.is_finite() {
            return if x != 0.0 && x.abs() < SMALL { format!("{x:e}") } else { format!("{}", x + 0.0) };
        }
        let first = |x: f64| x.abs().log10().floor();
        // Nothing is left of a number below its bar; zeros that are no digits are not written where there are many.
        let kept = first(x) - first(bar);
        if x == 0.0 || kept < 0.0 {
            return "0".to_owned();
        }
        let written = format!("{:.*e}", kept.min(17.0) as usize, x);
        let (digits, power) = written.split_once('e').unwrap_or((&written, "0"));
        let digits =
            if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
        if (SMALL..LARGE).contains(&x.abs()) {
            let places = (-first(bar)).max(0.0) as usize;
            let rounded: f64 = format!("{digits}e{power}").parse().unwrap_or(x);
            let fixed = format!("{rounded:.places$}");
            return match fixed.contains('.') {
                true => fixed.trim_end_matches('0').trim_end_matches('.').to_owned(),
                false => fixed,
            };
        }
        format!("{digits}e{power}")
    }
}

/// By how much a function is off the plane of these slopes at the corners of the bars, at most.
fn bend(values: &[f64], bars: &[f64], slopes: &[f64], value: f64, f: impl Fn(&[f64]) -> f64) -> f64 {
    let moved: Vec<usize> = (0..values.len()).filter(|i| 0.0 < bars[*i]).collect();
    if CORNERS < moved.len() {
        return 0.0;
    }
    let corner = |bits: usize| {
        let (mut at, mut plane) = (values.to_vec(), value);
        for (k, i) in moved.iter().enumerate() {
            let by = if bits >> k & 1 == 0 { -bars[*i] } else { bars[*i] };
            at[*i] += by;
            plane += slopes[*i] * by;
        }
        let apart = (f(&at) - plane).abs();
        // Where it is not even defined nothing is known.
        if apart.is_finite() { apart } else { f64::INFINITY }
    };
    (0..1usize << moved.len()).map(corner).fold(0.0, f64::max)
}

/// Applies a function of numbers to values, some of them measured; `None` where one is no number.
pub fn lifted(args: &[&Val], f: impl Fn(&[f64]) -> f64) -> Option<Val> {
    let args = args.iter().map(|arg| Estimate::read(arg)).collect::<Option<Vec<_>>>()?;
    Some(Val::Measured(Arc::new(Estimate::apply(&args, f))))
}

/// The sum of values, some of them measured; `None` where one is no number.
pub fn summed(args: &[&Val]) -> Option<Val> {
    let args = args.iter().map(|arg| Estimate::read(arg)).collect::<Option<Vec<_>>>()?;
    Some(Val::Measured(Arc::new(Estimate::sum(&args))))
}

/// The numbers of a vector, or the one.
pub fn components(value: &Val) -> Option<Vec<Val>> {
    match value {
        Val::Number(_) | Val::Measured(_) => Some(vec![value.clone()]),
        Val::List(list) => {
            value.numbers()?;
            Some(list.items.iter().map(|item| item.value.clone()).collect())
        }
        _ => None,
    }
}

/// Whether any number in a value was measured.
pub fn is_measured(value: &Val) -> bool {
    match value {
        Val::Measured(_) => true,
        Val::List(list) => {
            list.items.len() <= 4 && list.items.iter().any(|item| matches!(item.value, Val::Measured(_)))
        }
        _ => false,
    }
}

/// A vector of values, or one alone.
pub fn gathered(mut values: Vec<Val>, at: Span) -> Val {
    if values.len() == 1 {
        return values.remove(0);
    }
    Val::vector_of(values.into_iter().map(|value| Located { value, at }).collect())
}

/// An operator on numbers and vectors some of which were measured; `None` where they do not fit it.
pub fn infix(op: InfixOp, a: &Val, b: &Val, at: Span, f: fn(InfixOp, f64, f64) -> f64) -> Option<Val> {
    use InfixOp::{Add, Divide, Multiply, Power, Remainder, Subtract};
    if !matches!(op, Add | Subtract | Multiply | Divide | Remainder | Power) {
        return None;
    }
    let (u, v) = (components(a)?, components(b)?);
    let count = u.len().max(v.len());
    let fits = u.len() == v.len() || u.len() == 1 || v.len() == 1;
    let made = (0..count).map(|i| {
        let args = [Estimate::read(&u[i % u.len()])?, Estimate::read(&v[i % v.len()])?];
        let mut made = Estimate::apply(&args, |x| f(op, x[0], x[1]));
        // What is divided by may be zero: nothing is known.
        if op == Divide && args[1].value.abs() <= args[1].bar() {
            made.rest = f64::INFINITY;
        }
        Some(Val::Measured(Arc::new(made)))
    });
    if fits { Some(gathered(made.collect::<Option<Vec<_>>>()?, at)) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{BooleanOp, ShapeKind};

    fn estimate(value: f64, err: f64) -> Estimate {
        let kind = ShapeKind::Boolean { op: BooleanOp::Union, operands: Vec::new() };
        let (question, shape, at) = (Question::Volume, Shape::new(kind, Span::default()), Span::default());
        let measured = Measured { value, err, size: value, is_open: true };
        Estimate::of(measured, Arc::new(Source { question, shape, at }))
    }

    #[test]
    fn bars_follow_what_was_measured() {
        let (a, b) = (estimate(4.0, 0.1), estimate(3.0, 0.2));
        let both =
            |f: fn(&[f64]) -> f64, second: &Estimate| Estimate::apply(&[a.clone(), second.clone()], f).bar();
        // What is off in both is off together, or adds up.
        assert!(both(|x| x[0] - x[1], &a) < 1e-12);
        assert!((both(|x| x[0] - x[1], &b) - 0.3).abs() < 1e-12);
        // Of a product the corners are 4.1 * 3.2 and so on; the slopes say 4 * 0.2 + 3 * 0.1, the rest is 0.1 * 0.2.
        assert!((both(|x| x[0] * x[1], &b) - 1.12).abs() < 1e-12);
        let root = Estimate::apply(std::slice::from_ref(&a), |x| x[0].sqrt());
        assert!((4.1f64.sqrt() - 2.0).abs() <= root.bar() && root.bar() < 0.026);
    }

    #[test]
    fn sums_of_very_many_keep_their_bar() {
        let many: Vec<Estimate> = (0..500).map(|_| estimate(1.0, 0.01)).collect();
        let sum = Estimate::sum(&many);
        assert!((sum.bar() - 5.0).abs() < 1e-9 && sum.value == 500.0 && sum.terms.len() <= MOST);
    }

    #[test]
    fn numbers_have_the_digits_that_their_bars_leave() {
        for (value, err, told) in [
            (4.18881, 1.8e-4, "4.1888"),
            (60000.0, 0.3, "60000"),
            (8.0, 1e-14, "8"),
            (20396.8, 8.4, "20397"),
            (20396.8, 84.0, "20400"),
            (12569271332061.0, 6.2e9, "1.2569e13"),
            (4.18879e-18, 1.1e-21, "4.189e-18"),
            (-4.18879e-7, 1.1e-9, "-4.19e-7"),
            (4.1887902e-18, 0.0, "4.1887902e-18"),
            (1e-9, 1e-3, "0"),
            (-0.2, 0.3, "-0.2"),
        ] {
            let written = estimate(value, err).digits();
            assert_eq!(written, told);
            let back = written.parse::<f64>().unwrap();
            assert!((back - value).abs() <= err);
        }
    }
}
