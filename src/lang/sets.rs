//! Shapes combined: the infix operators and the functions that take lists. The result is a node; what it
//! means for points is left to the rooms that trace it.

use super::args::{Bound, Formal};
use super::ast::InfixOp;
use super::budget::{Budget, OPERAND};
use super::builtins::Builtin;
use super::value::{Eval, Located, Val};
use crate::diag::Diagnostic;
use crate::scene::{BooleanOp, Operand, Shape, ShapeKind};
use crate::source::Span;

/// How many operands one operation may have.
const MAX_OPERANDS: usize = 1_000_000;

/// The functions.
pub const TABLE: &[Builtin] = &[
    Builtin {
        name: "union",
        formals: &[Formal::place("list").is("a list of solids")],
        doc: "Points in any shape of a list; nothing for an empty list.",
        call: |b| of_list(b, BooleanOp::Union),
    },
    Builtin {
        name: "intersection",
        formals: &[Formal::place("list").is("a list of solids")],
        doc: "Points in every solid of a list.",
        call: |b| of_list(b, BooleanOp::Intersection),
    },
    Builtin {
        name: "difference",
        formals: &[
            Formal::place("base").is("a solid"),
            Formal::place("list").is("a solid or a list: what is taken away"),
        ],
        doc: "Points of the base that are in no solid of a list.",
        call: difference,
    },
    Builtin {
        name: "xor",
        formals: &[Formal::place("list").is("a list of solids")],
        doc: "Points in an odd number of the solids of a list.",
        call: |b| of_list(b, BooleanOp::Xor),
    },
];

fn node(op: BooleanOp, operands: Vec<Operand>, at: Span) -> Val {
    Val::Shape(Shape::new(ShapeKind::Boolean { op, operands }, at))
}

fn of_list(bound: &Bound, op: BooleanOp) -> Eval<Val> {
    let list = bound.need("list")?;
    let operands = operands(bound, list)?;
    if operands.is_empty() && op == BooleanOp::Intersection {
        return Err(Diagnostic::error("E0303", "the intersection of an empty list is all of space")
            .at(list.at, "no shapes")
            .help("give it at least one shape")
            .into());
    }
    Ok(node(op, operands, bound.callee.at))
}

fn difference(bound: &Bound) -> Eval<Val> {
    let base = bound.need("base")?;
    let shape = base.shape("base")?.clone();
    let mut operands = vec![Operand { shape, at: base.at }];
    operands.extend(self::operands(bound, bound.need("list")?)?);
    Ok(node(BooleanOp::Difference, operands, bound.callee.at))
}

/// The operands that a list holds.
fn operands(bound: &Bound, list: &Located) -> Eval<Vec<Operand>> {
    let operands = flatten(list, "list", bound.budget)?;
    bound.budget.keep(operands.len() * OPERAND, list.at)?;
    Ok(operands)
}

/// The shapes of a list and of the lists in it.
pub fn flatten(list: &Located, name: &str, budget: &Budget) -> Eval<Vec<Operand>> {
    let mut out = Vec::new();
    let mut steps = 0;
    let mut open = vec![list];
    while let Some(next) = open.pop() {
        steps += 1;
        budget.spend(1, list.at)?;
        if steps > MAX_OPERANDS {
            return Err(Diagnostic::error("E0703", format!("more than {MAX_OPERANDS} shapes in one list"))
                .at(list.at, "too many")
                .help("use fewer shapes")
                .into());
        }
        match &next.value {
            Val::List(inner) => open.extend(inner.items.iter().rev()),
            _ => out.push(Operand { shape: next.shape(name)?.clone(), at: next.at }),
        }
    }
    Ok(out)
}

/// The complement.
pub fn complement(on: Located, at: Span) -> Eval<Val> {
    let shape = on.shape("!")?.clone();
    Ok(node(BooleanOp::Complement, vec![Operand { shape, at: on.at }], at))
}

/// A chain of operators of one level whose first operand is a shape, or whose operators want shapes.
pub fn chain(first: Located, rest: Vec<(InfixOp, Span, Located)>, at: Span) -> Eval<Val> {
    let mut op = BooleanOp::Union;
    for (infix, sign, right) in &rest {
        op = match infix {
            InfixOp::Union => BooleanOp::Union,
            InfixOp::Intersect => BooleanOp::Intersection,
            InfixOp::Exclude => BooleanOp::Xor,
            InfixOp::Subtract => BooleanOp::Difference,
            _ => return Err(wrong_sign(*infix, *sign, &first, right).into()),
        };
    }
    let mut operands = Vec::with_capacity(rest.len() + 1);
    operands.push(operand(first, op, rest.first().map(|r| r.1))?);
    for (_, sign, right) in rest {
        operands.push(operand(right, op, Some(sign))?);
    }
    Ok(node(op, operands, at))
}

fn operand(on: Located, op: BooleanOp, sign: Option<Span>) -> Eval<Operand> {
    if let Val::Shape(shape) = on.value {
        return Ok(Operand { shape, at: on.at });
    }
    let kind = on.value.kind();
    let error =
        Diagnostic::error("E0203", format!("`{}` combines shapes, not {kind}", op.sign())).at(on.at, kind);
    let error = if let Some(sign) = sign { error.at(sign, "wants shapes on both sides") } else { error };
    Err(match on.value {
        Val::List(_) => error.help("combine a list: `union(list)`"),
        Val::Bool(_) => error.help("conditions are joined by `and` and `or`"),
        Val::Number(_) if op == BooleanOp::Xor => error.help("a power is written `a ** b`"),
        _ => error.help("write a shape, such as `sphere(r: 10)`"),
    }
    .into())
}

/// The error for an operator of numbers between shapes.
pub fn wrong_sign(op: InfixOp, sign: Span, left: &Located, right: &Located) -> Diagnostic {
    let both = matches!((&left.value, &right.value), (Val::Shape(_), Val::Shape(_)));
    let help = match op {
        InfixOp::Add if both => "the union of two shapes is `a | b`",
        InfixOp::Multiply if both => "the intersection of two solids is `a & b`",
        InfixOp::Divide | InfixOp::Remainder if both => "a solid is taken away with `a - b`",
        InfixOp::Add | InfixOp::Subtract => "to move a shape, write `shape.move([x, y, z])`",
        InfixOp::Multiply | InfixOp::Divide => "to scale a shape, write `shape.scale(factor)`",
        _ => "shapes are combined by `|` `&` `-` `^` and `!`",
    };
    let told = format!("`{}` does not combine {} and {}", op.sign(), left.value.kind(), right.value.kind());
    let error = Diagnostic::error("E0202", told).at(sign, "an operator of numbers");
    let ours = match op {
        InfixOp::Add if both => Some("|"),
        InfixOp::Multiply if both => Some("&"),
        _ => None,
    };
    error.at(left.at, left.value.kind()).at(right.at, right.value.kind()).fix_with(sign, ours).help(help)
}
