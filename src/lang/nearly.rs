//! How far two values are apart, and in what that is measured; and where two shapes differ.

use glam::DVec3;

use super::budget::Budget;
use super::eval::Machine;
use super::print::text;
use super::queries::{Asked, Geometry};
use super::value::{Eval, Val};
use crate::scene::{BooleanOp, Operand, Shape, ShapeKind};
use crate::source::Span;

/// What the difference of two values is measured in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Measure {
    /// Numbers and lengths.
    Number,
    /// Degrees.
    Angle,
    /// The linear channels of colours.
    Color,
}

impl Measure {
    /// What stands after a number of it.
    pub fn unit(self) -> &'static str {
        if self == Measure::Angle { "deg" } else { "" }
    }

    /// That of a value, of a list if it is that of all that is in it; `None` for what is the same or not.
    pub fn of(value: &Val, budget: &Budget, at: Span) -> Eval<Option<Measure>> {
        Ok(match value {
            Val::Number(_) | Val::Measured(_) => Some(Measure::Number),
            Val::Angle(_) => Some(Measure::Angle),
            Val::Color(_) => Some(Measure::Color),
            Val::List(list) => {
                budget.spend(list.items.len(), at)?;
                let mut all = None;
                for item in &list.items {
                    match (Measure::of(&item.value, budget, at)?, all) {
                        (Some(one), None) => all = Some(one),
                        (one, _) if one == all => {}
                        _ => return Ok(None),
                    }
                }
                all
            }
            _ => None,
        })
    }
}

/// How far two values of one measure are apart, the largest of the components; `None` for lists of different lengths.
pub fn distance(a: &Val, b: &Val) -> Option<f64> {
    match (a, b) {
        (Val::Number(a), Val::Number(b)) | (Val::Angle(a), Val::Angle(b)) => Some((a - b).abs()),
        (Val::Color(a), Val::Color(b)) => {
            Some(a.iter().zip(b).map(|(x, y)| f64::from((x - y).abs())).fold(0.0, f64::max))
        }
        (Val::List(a), Val::List(b)) if a.items.len() == b.items.len() => {
            let mut pairs = a.items.iter().zip(&b.items);
            pairs.try_fold(0.0, |most: f64, (x, y)| Some(most.max(distance(&x.value, &y.value)?)))
        }
        _ => a.plain().zip(b.plain()).map(|(a, b)| (a - b).abs()),
    }
}

/// What a share of a value is a share of: its largest component.
pub fn size(value: &Val) -> f64 {
    match value {
        Val::Number(x) | Val::Angle(x) => x.abs(),
        Val::Measured(x) => x.value.abs(),
        Val::Color(channels) => channels.iter().map(|x| f64::from(x.abs())).fold(0.0, f64::max),
        Val::List(list) => list.items.iter().map(|item| size(&item.value)).fold(0.0, f64::max),
        _ => 0.0,
    }
}

/// What is in one of two solids alone.
pub fn apart(a: &Shape, b: &Shape, at: Span) -> Shape {
    let operand = |shape: &Shape| Operand { shape: shape.clone(), at };
    Shape::new(ShapeKind::Boolean { op: BooleanOp::Xor, operands: vec![operand(a), operand(b)] }, at)
}

/// Lines along each axis on which a place is sought where two shapes differ: a square of so many.
const LINES: usize = 9;

impl Machine<'_> {
    /// Where two shapes differ, in words; `None` where no such place is found.
    pub fn witness(&self, a: &Shape, b: &Shape, at: Span) -> Option<String> {
        let geometry = self.geometry?;
        let both = apart(a, b, at);
        let asked = |shape| Asked { shape, materials: &self.materials, at, level: 0 };
        let point = inner_point(geometry, &asked(&both))?;
        let side = if geometry.inside(&asked(a), point).ok()? { "left" } else { "right" };
        Some(format!("{} is inside the {side} side alone", text(&Val::vector(point.to_array(), at))))
    }
}

/// A point inside a shape: the middle of the longest stretch inside that the lines of a grid over its bounds meet.
fn inner_point(geometry: &dyn Geometry, asked: &Asked) -> Option<DVec3> {
    let bounds = geometry.bounds(asked).ok()?.bounds;
    if bounds.is_empty() || !bounds.is_finite() {
        return None;
    }
    let share = |i: usize| (i as f64 + 0.5) / LINES as f64;
    let mut best: Option<(f64, DVec3)> = None;
    for axis in 0..3 {
        let dir = DVec3::AXES[axis];
        for (i, j) in (0..LINES * LINES).map(|k| (k / LINES, k % LINES)) {
            let mut from = bounds.min;
            from[(axis + 1) % 3] += share(i) * bounds.size()[(axis + 1) % 3];
            from[(axis + 2) % 3] += share(j) * bounds.size()[(axis + 2) % 3];
            // From outside of the bounds, so that the first crossing goes in.
            from[axis] -= bounds.size()[axis];
            let hits = geometry.raycast(asked, from, dir).ok()?;
            for pair in hits.windows(2).filter(|pair| pair[0].entering && !pair[1].entering) {
                let long = pair[1].t - pair[0].t;
                if best.is_none_or(|(most, _)| most < long) {
                    best = Some((long, (pair[0].point + pair[1].point) / 2.0));
                }
            }
        }
    }
    best.map(|(_, point)| point)
}
