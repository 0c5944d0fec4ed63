//! `expect`: what a scene says must hold, and the complaint where it does not.

use super::arithmetic;
use super::ast::{Expect, Expr};
use super::estimate::is_measured;
use super::eval::Machine;
use super::nearly::{Measure, apart, distance, size};
use super::queries::Asked;
use super::value::{Eval, Located, Val};
use super::verdict::Relation;
use crate::diag::{Diagnostic, Fault};
use crate::scene::Shape;
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
        let Some((nearly, right)) = &expect.right else {
            if let Some((room, _)) = &expect.within {
                let error = Diagnostic::error("E0802", "`within` belongs to a comparison");
                return Err(error.at(room.at, "of what?").help("write `expect a ~= b within 1%`").into());
            }
            return self.verdict(&expect.left, at);
        };
        self.doubts.level.set(0);
        let left = self.located(&expect.left)?;
        let right = self.located(right)?;
        let room = self.room(expect, *nearly, [&left, &right])?;
        if let Some(verdict) = self.measured(&left, &right, room) {
            return Ok(match verdict {
                Some(true) => None,
                Some(false) => Some(self.differs(&left, &right, room, at)),
                None => {
                    let error = undecided(self.sides(&left.value, &right.value), at);
                    Some(error.help(self.decidable(&left, &right)))
                }
            });
        }
        let holds = self.agree(&left, &right, room)?;
        Ok((!holds).then(|| self.differs(&left, &right, room, at)))
    }

    /// The verdict on a condition: what it says whichever way the comparisons in it go that stay open.
    fn verdict(&mut self, condition: &Expr, at: Span) -> Eval<Option<Diagnostic>> {
        let mut verdicts = [true; 2];
        self.doubts.level.set(0);
        for (verdict, taken) in verdicts.iter_mut().zip([false, true]) {
            self.doubts.open.take();
            let outside = self.doubts.taken.replace(Some(taken));
            let said = self.located(condition);
            self.doubts.taken.set(outside);
            let said = said?;
            let Val::Bool(holds) = said.value else {
                let error = said.unlike("expect", "a condition");
                return Err(error.help("compare it: `expect volume(part) ~= 6.43 within 0.5%`").into());
            };
            *verdict = holds;
            if self.doubts.open.borrow().is_empty() {
                return if holds { Ok(None) } else { Ok(Some(self.unmet(condition, at)?)) };
            }
        }
        let open = self.doubts.open.take().swap_remove(0);
        Ok(match verdicts {
            [true, true] => None,
            [false, false] => Some(self.unmet(condition, at)?),
            _ => {
                let help = "leave room for the bar, or say how far two sides may differ: `expect volume(part) ~= 6.43 within 0.01%`";
                Some(undecided(open, at).help(help))
            }
        })
    }

    /// The verdict on two sides of which one was measured; the inner `None` where it stays open, the outer where neither was.
    fn measured(&self, a: &Located, b: &Located, room: Room) -> Option<Option<bool>> {
        if !(is_measured(&a.value) || is_measured(&b.value)) {
            return None;
        }
        let relation = match room {
            Room::None => Relation::Same,
            Room::Absolute(apart) => Relation::Within(apart),
            Room::Share(share) => Relation::Within(share * size(&b.value)),
        };
        self.related_all(&a.value, &b.value, relation)
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
        let shape = apart(a, b, at);
        let Some(geometry) = self.geometry else {
            let error = Diagnostic::error("E0708", "solids cannot be compared here").at(at, "no geometry");
            return Err(error.help("compare them in the scene itself").into());
        };
        let asked = Asked { shape: &shape, materials: &self.materials, at, level: 0 };
        let answer = geometry.is_empty(&asked);
        answer.map_err(|errors| match errors.into_iter().next() {
            Some(error) => error.into(),
            None => Diagnostic::error("E0708", "the solids cannot be compared").at(at, "").into(),
        })
    }

    /// What `within` would be decided of two sides: what they are apart with the bar, in one digit more than that asks for.
    fn decidable(&self, left: &Located, right: &Located) -> String {
        let [a, b] = [left, right].map(|side| self.as_compared(&side.value, side.at));
        let far = self.most_apart(&a, &b).unwrap_or(f64::INFINITY);
        let one_digit = |x: f64| {
            let unit = 10f64.powi(x.log10().floor() as i32);
            format!("{:e}", (x / unit).ceil() * unit).parse::<f64>().unwrap_or(x)
        };
        let of = size(&b);
        let enough = if 0.0 < of {
            format!("{}%", one_digit(100.0 * far / of))
        } else {
            format!("{}", one_digit(far))
        };
        format!("the bar of error becomes no narrower; `~= ... within {enough}` is decided")
    }

    /// The complaint about a condition, with both sides of a comparison.
    fn unmet(&mut self, condition: &Expr, at: Span) -> Eval<Diagnostic> {
        let error = not_met(at);
        let super::ast::ExprKind::Infix(first, rest) = &condition.kind else { return Ok(error) };
        let [(op, _, second)] = rest.as_slice() else { return Ok(error) };
        if !op.compares() {
            return Ok(error);
        }
        let (left, right) = (self.located(first)?, self.located(second)?);
        Ok(error.note(self.sides(&left.value, &right.value)))
    }

    fn differs(&self, left: &Located, right: &Located, room: Room, at: Span) -> Diagnostic {
        let error = not_met(at);
        if let (Val::Shape(a), Val::Shape(b)) = (&left.value, &right.value)
            && let Some(place) = self.witness(a, b, at)
        {
            return error.note(place);
        }
        let unit = self.measure(left).ok().flatten().map_or("", Measure::unit);
        let [a, b] = [left, right].map(|side| self.as_compared(&side.value, side.at));
        let apart = distance(&a, &b).map(|d| match room {
            Room::Share(x) if size(&b) == 0.0 => format!(
                "; they differ by {d:.3e}{unit}, and {} % of zero are nothing: write how far, `within 0.001{unit}`",
                short(100.0 * x)
            ),
            Room::Share(x) => {
                let share = 100.0 * d / size(&b);
                format!(
                    "; they differ by {d:.3e}{unit}, {} %, where {} % are allowed",
                    short(share),
                    short(100.0 * x)
                )
            }
            Room::Absolute(x) => format!("; they differ by {d:.3e}{unit}, where {x}{unit} is allowed"),
            Room::None => format!("; they differ by {d:.3e}{unit}"),
        });
        error.note(self.sides(&left.value, &right.value) + &apart.unwrap_or_default())
    }
}

/// The complaint that what was measured leaves open whether something holds.
fn undecided(sides: String, at: Span) -> Diagnostic {
    let error =
        Diagnostic::error("E0801", "an expectation cannot be decided").at(at, "within the bar of error");
    error.note(format!("cannot be decided: {sides}")).fault(Fault::Unmet)
}

/// A number in few digits, however small.
fn short(x: f64) -> String {
    if 1e-3 <= x { format!("{x:.3}") } else { format!("{x:.0e}") }
}

fn not_met(at: Span) -> Diagnostic {
    Diagnostic::error("E0801", "an expectation is not met").at(at, "does not hold").fault(Fault::Unmet)
}
