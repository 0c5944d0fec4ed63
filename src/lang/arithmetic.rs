//! What operators do to numbers, angles, vectors and truth values. Operators on shapes are left to `sets`.

use super::ast::InfixOp;
use super::budget::Budget;
use super::estimate::{self, is_measured, lifted};
use super::parts::Parts;
use super::value::{Eval, Located, Val};
use crate::diag::Diagnostic;
use crate::source::Span;

/// Applies an operator of numbers or truth values.
pub fn infix(op: InfixOp, a: &Located, b: &Located, sign: Span, budget: &Budget) -> Eval<Val> {
    let value = match op {
        InfixOp::Or | InfixOp::And => logic(op, a, b),
        InfixOp::Equal | InfixOp::Unequal => {
            let same = equal(&a.value, &b.value, budget, sign)?;
            same.map(|same| Val::Bool(same == (op == InfixOp::Equal)))
        }
        InfixOp::AtMost | InfixOp::AtLeast | InfixOp::Below | InfixOp::Above => order(op, &a.value, &b.value),
        InfixOp::Range => match (&nominal(&a.value), &nominal(&b.value)) {
            (Val::Number(lo), Val::Number(hi)) => Some(Val::Range(*lo, *hi, false)),
            (Val::Angle(lo), Val::Angle(hi)) => Some(Val::Range(*lo, *hi, true)),
            _ => None,
        },
        _ if is_measured(&a.value) || is_measured(&b.value) => {
            let at = a.at.to(b.at);
            estimate::infix(op, &a.value, &b.value, at, number)
                .or_else(|| numeric(op, &nominal(&a.value), &nominal(&b.value), at))
        }
        _ => numeric(op, &a.value, &b.value, a.at.to(b.at)),
    };
    let value = value.ok_or_else(|| refuse(op, a, b, sign))?;
    finite(&value, op.sign(), sign)?;
    Ok(value)
}

/// Turns the sign of a number, an angle or a vector.
pub fn negate(a: &Located, sign: Span) -> Eval<Val> {
    match &a.value {
        Val::Number(x) => Ok(Val::Number(-x)),
        value if is_measured(value) => {
            let parts = estimate::components(value).unwrap_or_default();
            let parts = parts.iter().filter_map(|part| lifted(&[part], |x| -x[0]));
            Ok(estimate::gathered(parts.collect(), a.at))
        }
        value => match value.parts() {
            Some((parts, of_angles)) => Ok(parts.map(|x| -x).value(of_angles, a.at)),
            None => Err(Diagnostic::error("E0203", format!("`-` cannot be put before {}", value.kind()))
                .at(sign, "wants a number, an angle or a vector")
                .at(a.at, value.kind())
                .help(if matches!(value, Val::Shape(_)) {
                    "the complement of a solid is `!solid`"
                } else {
                    "remove the `-`"
                })
                .into()),
        },
    }
}

/// A measured number as if it were exact: angles have no bars.
fn nominal(value: &Val) -> Val {
    value.plain().map_or_else(|| value.clone(), Val::Number)
}

fn logic(op: InfixOp, a: &Located, b: &Located) -> Option<Val> {
    match (&a.value, &b.value) {
        (Val::Bool(a), Val::Bool(b)) => Some(Val::Bool(if op == InfixOp::Or { *a || *b } else { *a && *b })),
        _ => None,
    }
}

/// Whether two values of one kind are the same; `None` where that cannot be asked. Each element of a list is a step.
pub fn equal(a: &Val, b: &Val, budget: &Budget, at: Span) -> Eval<Option<bool>> {
    Ok(match (a, b) {
        (Val::Number(a), Val::Number(b)) | (Val::Angle(a), Val::Angle(b)) => Some(a == b),
        (Val::Color(a), Val::Color(b)) => Some(a == b),
        (Val::Text(a, _), Val::Text(b, _)) => Some(a == b),
        (Val::Bool(a), Val::Bool(b)) => Some(a == b),
        (Val::Range(a, b, of), Val::Range(c, d, of_angles)) => Some((a, b, of) == (c, d, of_angles)),
        (Val::List(a), Val::List(b)) if a.items.len() != b.items.len() => Some(false),
        (Val::List(a), Val::List(b)) => {
            let pairs = a.items.iter().zip(&b.items).map(|(a, b)| (&a.value, &b.value));
            all_equal(pairs, budget, at)?
        }
        (Val::Record(a), Val::Record(b)) if a.names().ne(b.names()) => Some(false),
        (Val::Record(a), Val::Record(b)) => {
            let pairs = a.fields.iter().zip(&b.fields).map(|(a, b)| (&a.1, &b.1));
            all_equal(pairs, budget, at)?
        }
        _ => return Ok(a.plain().zip(b.plain()).map(|(a, b)| a == b)),
    })
}

fn all_equal<'a>(
    mut pairs: impl Iterator<Item = (&'a Val, &'a Val)>,
    budget: &Budget,
    at: Span,
) -> Eval<Option<bool>> {
    let differs = pairs.find_map(|(a, b)| match budget.spend(1, at).and_then(|()| equal(a, b, budget, at)) {
        Ok(Some(true)) => None,
        other => Some(other),
    });
    differs.unwrap_or(Ok(Some(true)))
}

fn order(op: InfixOp, a: &Val, b: &Val) -> Option<Val> {
    let (a, b) = match (a, b) {
        (Val::Number(a), Val::Number(b)) | (Val::Angle(a), Val::Angle(b)) => (a, b),
        _ => return None,
    };
    Some(Val::Bool(match op {
        InfixOp::AtMost => a <= b,
        InfixOp::AtLeast => a >= b,
        InfixOp::Below => a < b,
        _ => a > b,
    }))
}

fn numeric(op: InfixOp, a: &Val, b: &Val, at: Span) -> Option<Val> {
    if let (Val::Number(a), Val::Number(b)) = (a, b) {
        return Some(Val::Number(number(op, *a, *b)));
    }
    let ((a, a_is_angle), (b, b_is_angle)) = (a.parts()?, b.parts()?);
    let of_angles = is_angle(op, a_is_angle, b_is_angle)?;
    Some(a.zip(b)?.map(|(x, y)| number(op, x, y)).value(of_angles, at))
}

/// Whether an operator makes an angle of two sides that are angles or not; `None` where it makes nothing of them.
pub fn is_angle(op: InfixOp, a: bool, b: bool) -> Option<bool> {
    use InfixOp::{Add, Divide, Multiply, Remainder, Subtract};
    match (a, b) {
        (false, false) => Some(false),
        (true, true) if op == Divide => Some(false),
        (true, true) => matches!(op, Add | Subtract | Remainder).then_some(true),
        (true, false) => matches!(op, Multiply | Divide).then_some(true),
        (false, true) => (op == Multiply).then_some(true),
    }
}

/// One operation; the remainder has the sign of the divisor.
fn number(op: InfixOp, a: f64, b: f64) -> f64 {
    match op {
        InfixOp::Add => a + b,
        InfixOp::Subtract => a - b,
        InfixOp::Multiply => a * b,
        InfixOp::Divide => a / b,
        InfixOp::Remainder => a - b * (a / b).floor(),
        _ => a.powf(b),
    }
}

/// Refuses numbers that are infinite or undefined, at the operator or function that made them.
pub fn finite(value: &Val, made_by: &str, at: Span) -> Eval<()> {
    let fine = match value {
        Val::Number(x) | Val::Angle(x) => x.is_finite(),
        Val::Measured(estimate) => estimate.value.is_finite(),
        Val::List(_) => match value.parts() {
            Some((Parts::Many(v), _)) => v.iter().all(|x| x.is_finite()),
            _ => true,
        },
        _ => true,
    };
    if fine {
        return Ok(());
    }
    let help = match made_by {
        "asin" | "acos" => "a sine and a cosine lie from -1 to 1: `clamp(x, -1, 1)` mends roundings",
        "ln" => "logarithms are of numbers above zero",
        "sqrt" => "roots are of numbers from zero on: `sqrt(max(x, 0))`, `sqrt(abs(x))`",
        "/" | "%" => "the right side is zero, or the left is too large",
        "**" => "a root of a negative number, a power of zero below zero, or a number too large",
        "normalize" => "a vector of length zero has no direction",
        "exp" | "*" | "+" | "-" => "the result is beyond the largest number",
        _ => "look for a division by zero or a root of a negative number",
    };
    let error = Diagnostic::error("E0504", format!("the result of `{made_by}` is not finite"));
    Err(error.at(at, "infinite or undefined").help(help).into())
}

fn refuse(op: InfixOp, a: &Located, b: &Located, sign: Span) -> Diagnostic {
    let (left, right) = (a.value.kind(), b.value.kind());
    let shapes = matches!(a.value, Val::Shape(_)) || matches!(b.value, Val::Shape(_));
    let error = Diagnostic::error("E0203", format!("`{}` cannot take {left} and {right}", op.sign()))
        .at(sign, "does not fit its operands")
        .at(a.at, left)
        .at(b.at, right);
    match op {
        InfixOp::Or | InfixOp::And => error.help("conditions are wanted; shapes are combined by `|` and `&`"),
        InfixOp::Equal | InfixOp::Unequal if shapes => error.help("a shape is compared with a shape"),
        InfixOp::AtMost | InfixOp::AtLeast | InfixOp::Below | InfixOp::Above
            if left == "a vector" && right == "a vector" =>
        {
            error.help(
                "vectors have no order: compare `length(a) < length(b)`, or a part of each, `a.x < b.x`",
            )
        }
        InfixOp::Add
        | InfixOp::Subtract
        | InfixOp::Equal
        | InfixOp::Unequal
        | InfixOp::AtMost
        | InfixOp::AtLeast
        | InfixOp::Below
        | InfixOp::Above
            if left == "an angle" || right == "an angle" =>
        {
            error.help("an angle has a unit, `30deg`, and goes with angles alone")
        }
        InfixOp::Equal | InfixOp::Unequal if left == right => error.help(format!("{left} has no equal")),
        InfixOp::Equal | InfixOp::Unequal => {
            error.help("values of one type are compared: a number is written without quotes")
        }
        _ if left == "an angle" && right == "an angle" => {
            error.help("divide by a unit to get a number: `angle / 1deg`")
        }
        _ if left == "a vector" && right == "a vector" => error.help("vectors of one size are wanted"),
        _ => error.help("numbers or vectors are wanted"),
    }
}
