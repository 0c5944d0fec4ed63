//! Solids that another solid bounds, such as those of formulas.

use glam::DAffine3;

use super::lower::Lowering;
use crate::diag::Diagnostic;
use crate::geom::Aabb;
use crate::scene::{Call, Shape, Value};
use crate::solid::table::{self, Build};

/// The solid that bounds the one of a call, with the name of the argument.
pub(super) fn bounded_by(call: &Call) -> Option<(&'static str, &Shape)> {
    let Build::Bounded { by, .. } = table::find(&call.word)?.build else { return None };
    match call.get(by)? {
        Value::Shape(shape) => Some((by, shape)),
        _ => None,
    }
}

impl Lowering<'_, '_> {
    /// The box around the solid that bounds another.
    pub(super) fn bounding_box(&mut self, call: &Call, by: &str) -> Result<Aabb, Diagnostic> {
        let Some(Value::Shape(bounding)) = call.get(by) else { return Ok(Aabb::EMPTY) };
        let bounds = self.extent(bounding, &DAffine3::IDENTITY)?;
        if bounds.is_finite() || bounds.is_empty() {
            return Ok(bounds);
        }
        let error = Diagnostic::error("E0305", format!("`{by}` has no finite bounds"));
        let error = error.at(call.place(by), "unbounded");
        Err(error.help("bound the formula by a bounded solid, such as `inside: box(size: 100)`"))
    }
}
