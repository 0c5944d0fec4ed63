//! Conditions on the coordinates, such as `x + 2*y <= 3`: read as a plane and the side that is inside.

use glam::DVec3;

use super::ast::{Expr, ExprKind, InfixOp, PrefixOp};
use super::eval::Machine;
use super::order;
use super::value::{Eval, bounded};
use crate::diag::Diagnostic;
use crate::source::Span;

/// `normal . p + constant`.
#[derive(Clone, Copy)]
struct Linear {
    normal: DVec3,
    constant: f64,
}

impl Linear {
    fn is_constant(&self) -> bool {
        self.normal == DVec3::ZERO
    }

    fn plus(self, other: Linear, factor: f64) -> Linear {
        Linear {
            normal: self.normal + other.normal * factor,
            constant: self.constant + other.constant * factor,
        }
    }
}

/// The normal, which points out, and the offset: inside is where `normal . p < offset`.
pub fn read(machine: &mut Machine, expr: &Expr) -> Eval<(DVec3, f64)> {
    let mut inner = expr;
    while let ExprKind::Paren(inside) = &inner.kind {
        inner = inside;
    }
    let (left, op, right) = match &inner.kind {
        ExprKind::Infix(left, rest) if rest[0].0.compares() => (left, rest[0].0, &rest[0].2),
        _ => return Err(refuse(expr, "is not a condition", "expected a comparison").into()),
    };
    let (a, b) = (linear(machine, left)?, linear(machine, right)?);
    let side = match op {
        InfixOp::Below | InfixOp::AtMost => a.plus(b, -1.0),
        InfixOp::Above | InfixOp::AtLeast => b.plus(a, -1.0),
        _ => return Err(refuse(expr, "has no inside", "a plane, not a half-space").into()),
    };
    if side.is_constant() {
        return Err(refuse(expr, "does not depend on x, y or z", "the same everywhere").into());
    }
    for x in side.normal.to_array() {
        bounded(x, expr.at)?;
    }
    Ok((side.normal, -bounded(side.constant, expr.at)?))
}

fn refuse(expr: &Expr, what: &str, label: &str) -> Diagnostic {
    Diagnostic::error("E0508", format!("the half-space {what}"))
        .at(expr.at, label)
        .help("write a linear condition on x, y and z: `z < 60` or `x + 2*y <= 3`")
}

fn bent(at: Span) -> Diagnostic {
    Diagnostic::error("E0508", "the condition is not linear")
        .at(at, "x, y and z may be added, and multiplied by numbers")
        .help("a half-space has a flat face: `x + 2*y <= 3`")
}

fn linear(machine: &mut Machine, expr: &Expr) -> Eval<Linear> {
    let axis = |normal| Ok(Linear { normal, constant: 0.0 });
    match &expr.kind {
        ExprKind::Name(n) if n == "x" => axis(DVec3::X),
        ExprKind::Name(n) if n == "y" => axis(DVec3::Y),
        ExprKind::Name(n) if n == "z" => axis(DVec3::Z),
        ExprKind::Paren(inside) => linear(machine, inside),
        ExprKind::Prefix(PrefixOp::Negate, _, operand) => {
            let zero = Linear { normal: DVec3::ZERO, constant: 0.0 };
            Ok(zero.plus(linear(machine, operand)?, -1.0))
        }
        ExprKind::Infix(first, rest) if rest[0].0.level() >= 5 => {
            let mut sum = linear(machine, first)?;
            for (op, sign, operand) in rest {
                let next = linear(machine, operand)?;
                sum = combine(*op, sum, next).ok_or_else(|| bent(*sign))?;
            }
            Ok(sum)
        }
        _ if order::uses(expr, &["x", "y", "z"]).0 => Err(bent(expr.at).into()),
        _ => {
            let constant = machine.located(expr)?.number("the condition")?;
            Ok(Linear { normal: DVec3::ZERO, constant })
        }
    }
}

fn combine(op: InfixOp, a: Linear, b: Linear) -> Option<Linear> {
    let zero = Linear { normal: DVec3::ZERO, constant: 0.0 };
    match op {
        InfixOp::Add => Some(a.plus(b, 1.0)),
        InfixOp::Subtract => Some(a.plus(b, -1.0)),
        InfixOp::Multiply if b.is_constant() => Some(zero.plus(a, b.constant)),
        InfixOp::Multiply if a.is_constant() => Some(zero.plus(b, a.constant)),
        InfixOp::Divide if b.is_constant() => {
            Some(Linear { normal: a.normal / b.constant, constant: a.constant / b.constant })
        }
        InfixOp::Remainder if a.is_constant() && b.is_constant() => {
            Some(Linear { constant: a.constant - b.constant * (a.constant / b.constant).floor(), ..zero })
        }
        InfixOp::Power if a.is_constant() && b.is_constant() => {
            Some(Linear { constant: a.constant.powf(b.constant), ..zero })
        }
        _ => None,
    }
}
