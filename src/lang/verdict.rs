//! Comparisons of what was measured. While the bar leaves open which way one goes more lines are cast; where no more help it is
//! open, and whoever expects it is told so.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use super::ast::InfixOp;
use super::estimate::{Estimate, components, gathered, is_measured};
use super::eval::Machine;
use super::print::text;
use super::value::Val;
use crate::diag::Diagnostic;
use crate::geom::tolerance;
use crate::source::Span;

/// What comparisons left open while an expectation is evaluated.
#[derive(Debug, Default)]
pub struct Doubts {
    /// What an open comparison is taken for; what its numbers say where nothing is expected.
    pub taken: Cell<Option<bool>>,
    /// What was open.
    pub open: RefCell<Vec<String>>,
    /// The finest level of accuracy that a comparison has asked for: complaints give numbers as it saw them.
    pub level: Cell<usize>,
}

/// What two numbers may differ by.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Relation {
    /// The left is below the right.
    Below,
    /// Or the same.
    AtMost,
    /// They are the same to roundings.
    Same,
    /// They are no farther apart.
    Within(f64),
}

impl Relation {
    /// Whether it holds of a difference wherever in its bar that is, or nowhere in it; `None` where neither. A bar that is made of
    /// roundings is none.
    fn holds(self, difference: &Estimate) -> Option<bool> {
        let (apart, bar, size) = (difference.value, difference.bar(), difference.size());
        let is_rounded = apart.abs() <= bar && bar <= tolerance::ROUNDINGS * size;
        match self {
            Relation::Below | Relation::AtMost if apart + bar < 0.0 => Some(true),
            Relation::Below | Relation::AtMost if bar < apart => Some(false),
            Relation::Below => is_rounded.then_some(false),
            Relation::AtMost => is_rounded.then_some(true),
            Relation::Same if bar < apart.abs() => Some(false),
            Relation::Same => is_rounded.then_some(true),
            Relation::Within(most) if apart.abs() + bar <= most => Some(true),
            Relation::Within(most) => (most < apart.abs() - bar).then_some(false),
        }
    }
}

impl Machine<'_> {
    /// Whether a relation holds of two numbers, as many lines as are needed cast, within limits; `None` where it stays open.
    fn related(&self, a: &Val, b: &Val, relation: Relation) -> Option<bool> {
        let sides = [Estimate::read(a)?, Estimate::read(b)?];
        let mut difference = Estimate::apply(&sides, |x| x[0] - x[1]);
        for level in 1.. {
            self.doubts.level.set(self.doubts.level.get().max(level - 1));
            let finer = self.geometry.and_then(|g| difference.at_level(level, g, &self.materials));
            if let Some(verdict) = relation.holds(&difference) {
                return Some(verdict);
            }
            difference = finer?;
        }
        None
    }

    /// The same of each pair of numbers in two vectors, or of two numbers; the inner `None` where it stays open, the outer where
    /// they cannot be compared.
    pub fn related_all(&self, a: &Val, b: &Val, relation: Relation) -> Option<Option<bool>> {
        let (a, b) = (components(a)?, components(b)?);
        if a.len() != b.len() {
            return None;
        }
        let mut verdict = Some(true);
        for (a, b) in a.iter().zip(&b) {
            match self.related(a, b, relation) {
                Some(true) => {}
                Some(false) => return Some(Some(false)),
                None => verdict = None,
            }
        }
        Some(verdict)
    }

    /// Compares what was measured; `None` where neither side was, or they are no numbers.
    pub fn compare(&self, op: InfixOp, a: &Val, b: &Val) -> Option<bool> {
        if !op.compares() || !(is_measured(a) || is_measured(b)) {
            return None;
        }
        let numbers = || components(a).zip(components(b)).is_some_and(|(a, b)| a.len() == 1 && b.len() == 1);
        let relation = match op {
            InfixOp::Equal | InfixOp::Unequal => Relation::Same,
            _ if !numbers() => return None,
            InfixOp::Below | InfixOp::Above => Relation::Below,
            _ => Relation::AtMost,
        };
        let [left, right] = if matches!(op, InfixOp::Above | InfixOp::AtLeast) { [b, a] } else { [a, b] };
        let verdict = self.related_all(left, right, relation)?;
        let holds = verdict.unwrap_or_else(|| {
            let difference = Estimate::read(left).zip(Estimate::read(right)).map(|(a, b)| a.value - b.value);
            let nominal = difference.is_some_and(|d| relation != Relation::Same && d < 0.0);
            let open = self.sides(a, b);
            self.doubts.open.borrow_mut().push(open);
            self.doubts.taken.get().unwrap_or(nominal)
        });
        // What is taken for open is what the comparison says, turned or not.
        Some(if op == InfixOp::Unequal && verdict.is_some() { !holds } else { holds })
    }

    /// How far two sides may be apart at most, of vectors in any component: their difference and its bar.
    pub fn most_apart(&self, a: &Val, b: &Val) -> Option<f64> {
        let pairs = components(a)?.into_iter().zip(components(b)?);
        let far = |(a, b): (Val, Val)| {
            let difference = Estimate::apply(&[Estimate::read(&a)?, Estimate::read(&b)?], |x| x[0] - x[1]);
            Some(difference.value.abs() + difference.bar())
        };
        pairs.map(far).try_fold(0.0, |most: f64, far| Some(most.max(far?)))
    }

    /// Warns of comparisons that what was measured leaves open, where nothing is expected and they are taken for something.
    pub fn warn_of_open(&mut self, at: Span) {
        if self.doubts.taken.get().is_some() {
            return;
        }
        for open in self.doubts.open.take() {
            let warning = Diagnostic::warning("W0128", "a comparison is closer than what was measured tells");
            let warning = warning.at(at, "within the bar of error").note(open);
            self.warn(warning.help("compare with room for the bar: `volume(part) < 6.43 + 0.01`"));
        }
    }

    /// A value by what was measured for the comparisons so far.
    pub fn as_compared(&self, value: &Val, at: Span) -> Val {
        let level = self.doubts.level.get();
        let Some(parts) = components(value).filter(|_| 0 < level && is_measured(value)) else {
            return value.clone();
        };
        let finer = |part: &Val| {
            let Val::Measured(estimate) = part else { return part.clone() };
            let finer = self.geometry.and_then(|g| estimate.at_level(level, g, &self.materials));
            finer.map_or_else(|| part.clone(), |finer| Val::Measured(Arc::new(finer)))
        };
        gathered(parts.iter().map(finer).collect(), at)
    }

    /// Two sides in words.
    pub fn sides(&self, a: &Val, b: &Val) -> String {
        let [a, b] = [a, b].map(|side| with_bars(&self.as_compared(side, Span::default())));
        format!("the left side is {a}, the right {b}")
    }
}

/// A value, and the bars of what was measured in it.
fn with_bars(value: &Val) -> String {
    let bars = components(value).filter(|_| is_measured(value)).into_iter().flatten();
    let bar = bars.filter_map(|value| Estimate::read(&value)).map(|e| e.bar()).fold(0.0, f64::max);
    if bar == 0.0 { text(value) } else { format!("{} (+- {bar:.1e})", text(value)) }
}
