//! `expect`: what a scene says must hold, and the complaint where it does not.

use super::arithmetic;
use super::ast::{Expect, Expr};
use super::eval::Machine;
use super::nearly::{Measure, distance, size};
use super::print::text;
use super::queries::Asked;
use super::value::{Eval, Located, Val};
use crate::diag::{Diagnostic, Fault};
use crate::scene::{BooleanOp, Operand, Shape, ShapeKind};
use crate::source::Span;

/// What `~=` allows where nothing else is said, a share of the right side.
const NEARLY: f64 = 1e-9;

/// How far two values may differ.
#[derive(Clone, Copy)]
enum Room {
    None,
    /// A length.
    Absolute(f64),
    /// A share of the right side.
    Share(f64),
}

impl Machine<'_> {
    /// `None` where an expectation holds, else what to say.
    pub fn expect(&mut self, expect: &Expect) -> Eval<Option<Diagnostic>> {
        let at = expect.right.as_ref().map_or(expect.left.at, |(_, right)| expect.left.at.to(right.at));
        self.bars.set(0.0);
        let left = self.located(&expect.left)?;
        let Some((nearly, right)) = &expect.right else {
            if let Some((room, _)) = &expect.within {
                let error = Diagnostic::error("E0802", "`within` belongs to a comparison");
                return Err(error.at(room.at, "of what?").help("write `expect a ~= b within 1%`").into());
            }
            return match left.value {
                Val::Bool(true) => Ok(None),
                Val::Bool(false) => Ok(Some(self.unmet(&expect.left, at)?)),
                _ => Err(left
                    .unlike("expect", "a condition")
                    .help("compare it: `expect volume(part) ~= 6.43 within 0.5%`")
                    .into()),
            };
        };
        let right = self.located(right)?;
        let room = self.room(expect, *nearly, [&left, &right])?;
        let holds = self.agree(&left, &right, room)?;
        Ok((!holds).then(|| self.differs(&left, &right, room, at)))
    }

    fn room(&mut self, expect: &Expect, nearly: bool, [left, right]: [&Located; 2]) -> Eval<Room> {
        let Some((expr, percent)) = &expect.within else {
            return Ok(if nearly { Room::Share(NEARLY) } else { Room::None });
        };
        let given = self.located(expr)?;
        let [of, other] = [self.measure(left)?, self.measure(right)?];
        if of.is_none() && other.is_none() {
            let kind = left.value.kind();
            let error = Diagnostic::error(
                "E0802",
                format!("{kind} is the same as another or not: nothing is `within`"),
            );
            let help = match left.value {
                Val::Shape(_) => "compare what is measured: `expect volume(a) ~= volume(b) within 1%`",
                _ => "remove the `within`",
            };
            return Err(error.at(given.at, "of what?").at(left.at, kind).help(help).into());
        }
        let x = if of == Some(Measure::Angle) && other == of && !percent {
            given.angle("within", self.written(given.at))?
        } else {
            given.number("within")?
        };
        if x < 0.0 {
            let error = Diagnostic::error("E0503", "`within` is not below zero").at(given.at, format!("{x}"));
            return Err(error.help("write how far the two sides may differ").into());
        }
        Ok(if *percent { Room::Share(x / 100.0) } else { Room::Absolute(x) })
    }

    /// Whether two values agree within some room.
    fn agree(&mut self, a: &Located, b: &Located, room: Room) -> Eval<bool> {
        if let (Val::Shape(a_shape), Val::Shape(b_shape)) = (&a.value, &b.value) {
            return self.same_solid(a_shape, b_shape, a.at.to(b.at));
        }
        let same_measure =
            self.measure(a)?.is_some_and(|of| self.measure(b).is_ok_and(|other| other == Some(of)));
        if let Some(distance) = distance(&a.value, &b.value).filter(|_| same_measure) {
            let allowed = match room {
                Room::None => 0.0,
                Room::Absolute(x) => x,
                Room::Share(x) => x * size(&b.value),
            };
            return Ok(distance <= allowed);
        }
        arithmetic::equal(&a.value, &b.value, &self.budget, b.at)?.ok_or_else(|| {
            let (left, right) = (a.value.kind(), b.value.kind());
            let error = Diagnostic::error("E0203", format!("{left} and {right} cannot be compared"));
            error
                .at(a.at, left)
                .at(b.at, right)
                .help(match left == right {
                    true => "compare a part of each",
                    false => "compare values of one kind",
                })
                .into()
        })
    }

    /// What a side is measured in.
    fn measure(&self, side: &Located) -> Eval<Option<Measure>> {
        Measure::of(&side.value, &self.budget, side.at)
    }

    /// Two solids are the same where their symmetric difference is empty.
    pub fn same_solid(&self, a: &Shape, b: &Shape, at: Span) -> Eval<bool> {
        let operand = |shape: &Shape| Operand { shape: shape.clone(), at };
        let kind = ShapeKind::Boolean { op: BooleanOp::Xor, operands: vec![operand(a), operand(b)] };
        let shape = Shape::new(kind, at);
        let Some(geometry) = self.geometry else {
            let error = Diagnostic::error("E0708", "solids cannot be compared here").at(at, "no geometry");
            return Err(error.help("compare them in the scene itself").into());
        };
        let asked = Asked { shape: &shape, materials: &self.materials, at };
        let answer = geometry.is_empty(&asked);
        answer.map_err(|errors| match errors.into_iter().next() {
            Some(error) => error.into(),
            None => Diagnostic::error("E0708", "the solids cannot be compared").at(at, "").into(),
        })
    }

    /// The complaint about a condition, with both sides of a comparison.
    fn unmet(&mut self, condition: &Expr, at: Span) -> Eval<Diagnostic> {
        let error = not_met(at);
        let super::ast::ExprKind::Infix(first, rest) = &condition.kind else { return Ok(error) };
        let [(op, _, second)] = rest.as_slice() else { return Ok(error) };
        if !op.compares() {
            return Ok(error);
        }
        let sides = [self.located(first)?, self.located(second)?];
        let [left, right] = sides.map(|side| text(&side.value));
        Ok(error.note(format!("the left side is {left}{}, the right {right}", self.bar())))
    }

    fn differs(&self, left: &Located, right: &Located, room: Room, at: Span) -> Diagnostic {
        let error = not_met(at);
        if let (Val::Shape(a), Val::Shape(b)) = (&left.value, &right.value)
            && let Some(place) = self.witness(a, b, at)
        {
            return error.note(place);
        }
        let unit = self.measure(left).ok().flatten().map_or("", Measure::unit);
        let apart = distance(&left.value, &right.value).map(|d| match room {
            Room::Share(x) if size(&right.value) == 0.0 => format!(
                "; they differ by {d:.3e}{unit}, and {} % of zero are nothing: write how far, `within 0.001{unit}`",
                short(100.0 * x)
            ),
            Room::Share(x) => {
                let share = 100.0 * d / size(&right.value);
                format!(
                    "; they differ by {d:.3e}{unit}, {} %, where {} % are allowed",
                    short(share),
                    short(100.0 * x)
                )
            }
            Room::Absolute(x) => format!("; they differ by {d:.3e}{unit}, where {x}{unit} is allowed"),
            Room::None => format!("; they differ by {d:.3e}{unit}"),
        });
        let (left, right) = (text(&left.value), text(&right.value));
        error.note(format!(
            "the left side is {left}{}, the right {right}{}",
            self.bar(),
            apart.unwrap_or_default()
        ))
    }

    /// The bar of what was measured.
    fn bar(&self) -> String {
        match self.bars.get() {
            0.0 => String::new(),
            bar => format!(" (+- {bar:.1e})"),
        }
    }
}

/// A number in few digits, however small.
fn short(x: f64) -> String {
    if 1e-3 <= x { format!("{x:.3}") } else { format!("{x:.0e}") }
}

fn not_met(at: Span) -> Diagnostic {
    Diagnostic::error("E0801", "an expectation is not met").at(at, "does not hold").fault(Fault::Unmet)
}
