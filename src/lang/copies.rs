//! The methods that make several of a shape: a union of placed uses of one shape, which is stored and built once.

use glam::{DAffine3, DVec3};

use super::args::Bound;
use super::budget::{NODE, OPERAND};
use super::placing::{about, is_matrix, matrix, rotation};
use super::value::{Eval, List, Located, Val};
use crate::diag::Diagnostic;
use crate::scene::{BooleanOp, Operand, Shape, ShapeKind};
use crate::source::Span;

/// How many copies one method may make.
const MAX_COPIES: usize = 1_000_000;

/// `.array(list)`: a copy moved by each vector.
pub fn array(bound: &Bound) -> Eval<Val> {
    let given = bound.need("list")?;
    let items = &list(given, "vectors")?.items;
    copies(bound, items.iter().map(|i| Ok((DAffine3::from_translation(i.vec3("list")?), i.at))))
}

/// `.instance(list)`: a copy at each vector, or placed by each matrix.
pub fn instance(bound: &Bound) -> Eval<Val> {
    let given = bound.need("list")?;
    let items = &list(given, "vectors or matrices")?.items;
    let place = |i: &Located| match is_matrix(i) {
        true => matrix(i),
        false => Ok(DAffine3::from_translation(i.vec3("list")?)),
    };
    copies(bound, items.iter().map(|i| Ok((place(i)?, i.at))))
}

/// `.around(n)`: copies turned around the z axis, evenly over a turn; quarter turns are exact.
pub fn around(bound: &Bound) -> Eval<Val> {
    let given = bound.need("n")?;
    let n = given.number("n")?;
    if n.fract() != 0.0 || !(1.0..=MAX_COPIES as f64).contains(&n) {
        let told = format!("`n` must be a whole number from 1 to {MAX_COPIES}");
        return Err(Diagnostic::error("E0503", told)
            .at(given.at, format!("{n}"))
            .help("write how many copies there shall be, such as `6`")
            .into());
    }
    let point = bound.get("about").map_or(Ok(DVec3::ZERO), |a| a.vec3("about"))?;
    let turned = |k: u32| about(rotation(DVec3::Z, f64::from(k) * 360.0 / n), point);
    copies(bound, (0..n as u32).map(|k| Ok((turned(k), given.at))))
}

fn list<'a>(given: &'a Located, of: &str) -> Eval<&'a List> {
    let help = "write a list of them, such as `[[0, 0, 0], [10, 0, 0]]`";
    match &given.value {
        Val::List(list) if given.value.numbers().is_none() && list.items.len() <= MAX_COPIES => Ok(list),
        Val::List(list) if list.items.len() > MAX_COPIES => {
            Err(Diagnostic::error("E0703", format!("more than {MAX_COPIES} copies of one shape"))
                .at(given.at, "too many")
                .help("make fewer copies")
                .into())
        }
        _ => Err(given.unlike("list", &format!("a list of {of}")).help(help).into()),
    }
}

fn copies(bound: &Bound, maps: impl ExactSizeIterator<Item = Eval<(DAffine3, Span)>>) -> Eval<Val> {
    let count = maps.len();
    let child = bound.receiver()?.shape("shape")?;
    let mut operands = Vec::new();
    let at = bound.callee.at;
    bound.budget.spend(count, at)?;
    bound.budget.keep(count * (NODE + OPERAND), at)?;
    for map in maps {
        let (world_from_local, at) = map?;
        let kind = ShapeKind::Transform { world_from_local, child: child.clone() };
        operands.push(Operand { shape: Shape::new(kind, at), at });
    }
    let kind = ShapeKind::Boolean { op: BooleanOp::Union, operands };
    Ok(Val::Shape(Shape::new(kind, bound.callee.at)))
}
