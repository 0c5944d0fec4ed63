//! Shapes that have no inside though no size of theirs is zero: two corners in one plane, a cone of two points.

use crate::diag::Diagnostic;
use crate::geom::Aabb;
use crate::scene::{Call, Kind, Value};
use crate::solid::table;

/// A warning about a shape that its arguments make flat, unless one of them is a size of zero: of that the language warns.
pub(super) fn flat(call: &Call, bounds: Aabb) -> Option<Diagnostic> {
    let is_flat = bounds.is_empty() || bounds.is_finite() && bounds.size().min_element() == 0.0;
    if !is_flat {
        return None;
    }
    let params = table::find(&call.word).map_or(&[][..], |primitive| primitive.decl.params);
    let is_size = |name: &str| {
        let param = params.iter().find(|param| param.name == name);
        param.is_some_and(|param| matches!(param.kind, Kind::Size | Kind::SizeOrVector))
    };
    let is_zero = |value: &Value| match value {
        Value::Number(x) => *x == 0.0,
        Value::Vector(v) => v.contains(&0.0),
        _ => false,
    };
    let told = call.args.iter().any(|(name, arg)| is_size(name) && is_zero(&arg.value));
    (!told).then(|| {
        Diagnostic::warning("W0101", format!("`{}` has no thickness here: the shape is nothing", call.word))
            .at(call.at, "no size")
            .help("give it a size, or leave the shape out")
    })
}
