//! What operators do to numbers, angles, vectors and truth values. Operators on shapes are left to `sets`.

use super::ast::InfixOp;
use super::value::{Eval, Located, Val};
use crate::diag::Diagnostic;
use crate::source::Span;

/// Applies an operator of numbers or truth values.
pub fn infix(op: InfixOp, a: &Located, b: &Located, sign: Span) -> Eval<Val> {
    let value = match op {
        InfixOp::Or | InfixOp::And => logic(op, a, b),
        InfixOp::Equal | InfixOp::Unequal => {
            equal(&a.value, &b.value).map(|e| Val::Bool(e == (op == InfixOp::Equal)))
        }
        InfixOp::AtMost | InfixOp::AtLeast | InfixOp::Below | InfixOp::Above => order(op, &a.value, &b.value),
        InfixOp::Range => match (&a.value, &b.value) {
            (Val::Number(lo), Val::Number(hi)) => Some(Val::Range(*lo, *hi, false)),
            (Val::Angle(lo), Val::Angle(hi)) => Some(Val::Range(*lo, *hi, true)),
            _ => None,
        },
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
        Val::Angle(x) => Ok(Val::Angle(-x)),
        value => match value.numbers() {
            Some(v) => Ok(Val::vector(v.into_iter().map(|x| -x), a.at)),
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

fn logic(op: InfixOp, a: &Located, b: &Located) -> Option<Val> {
    match (&a.value, &b.value) {
        (Val::Bool(a), Val::Bool(b)) => Some(Val::Bool(if op == InfixOp::Or { *a || *b } else { *a && *b })),
        _ => None,
    }
}

/// Whether two values of one kind are the same; `None` where that cannot be asked.
pub fn equal(a: &Val, b: &Val) -> Option<bool> {
    match (a, b) {
        (Val::Number(a), Val::Number(b)) | (Val::Angle(a), Val::Angle(b)) => Some(a == b),
        (Val::Color(a), Val::Color(b)) => Some(a == b),
        (Val::Text(a, _), Val::Text(b, _)) => Some(a == b),
        (Val::Bool(a), Val::Bool(b)) => Some(a == b),
        _ => Some(a.numbers()? == b.numbers()?),
    }
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
    use InfixOp::{Add, Divide, Multiply, Remainder, Subtract};
    match (a, b) {
        (Val::Number(a), Val::Number(b)) => Some(Val::Number(number(op, *a, *b)?)),
        (Val::Angle(a), Val::Angle(b)) => match op {
            Add | Subtract | Remainder => Some(Val::Angle(number(op, *a, *b)?)),
            Divide => Some(Val::Number(a / b)),
            _ => None,
        },
        (Val::Angle(a), Val::Number(b)) if matches!(op, Multiply | Divide) => {
            Some(Val::Angle(number(op, *a, *b)?))
        }
        (Val::Number(a), Val::Angle(b)) if op == Multiply => Some(Val::Angle(a * b)),
        (Val::Number(a), _) if op == Multiply => {
            let b = b.numbers()?;
            Some(Val::vector(b.into_iter().map(|x| a * x), at))
        }
        (_, Val::Number(b)) if matches!(op, Multiply | Divide) => {
            let a = a.numbers()?;
            Some(Val::vector(a.into_iter().filter_map(|x| number(op, x, *b)), at))
        }
        _ => {
            let (a, b) = (a.numbers()?, b.numbers()?);
            if a.len() != b.len() || op == InfixOp::Power {
                return None;
            }
            Some(Val::vector(a.into_iter().zip(b).filter_map(|(a, b)| number(op, a, b)), at))
        }
    }
}

/// One operation; the remainder has the sign of the divisor.
fn number(op: InfixOp, a: f64, b: f64) -> Option<f64> {
    Some(match op {
        InfixOp::Add => a + b,
        InfixOp::Subtract => a - b,
        InfixOp::Multiply => a * b,
        InfixOp::Divide => a / b,
        InfixOp::Remainder => a - b * (a / b).floor(),
        InfixOp::Power => a.powf(b),
        _ => return None,
    })
}

/// Refuses numbers that are infinite or undefined, at the operator or function that made them.
pub fn finite(value: &Val, made_by: &str, at: Span) -> Eval<()> {
    let fine = match value {
        Val::Number(x) | Val::Angle(x) => x.is_finite(),
        Val::List(_) => value.numbers().is_none_or(|v| v.iter().all(|x| x.is_finite())),
        _ => true,
    };
    if fine {
        return Ok(());
    }
    Err(Diagnostic::error("E0504", format!("the result of `{made_by}` is not finite"))
        .at(at, "infinite or undefined")
        .help("look for a division by zero or a root of a negative number")
        .into())
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
        InfixOp::Equal | InfixOp::Unequal if shapes => error.help("comparing shapes is not supported yet"),
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
            error.help("an angle has a unit: `30deg`")
        }
        InfixOp::Equal | InfixOp::Unequal => {
            error.help("values of one type are compared: a number is written without quotes")
        }
        _ if left == "a vector" && right == "a vector" => error.help("vectors of one size are wanted"),
        _ => error.help("numbers or vectors are wanted"),
    }
}
