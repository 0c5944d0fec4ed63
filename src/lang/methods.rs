//! The methods of shapes: each makes a node around the shape it is called on.

use glam::{DAffine3, DMat3, DVec3};

use super::args::{Bound, Formal};
use super::builtins::Builtin;
use super::copies;
use super::placing::{about, direction, matrix, named_direction, reflection, rotation};
use super::value::{Eval, Val};
use crate::diag::Diagnostic;
use crate::scene::{FitTo, MaterialId, Operand, Shape, ShapeKind};

const MOVE: &[Formal] = &[Formal::place("by").is("a vector: how far along each axis")];
const ABOUT: Formal =
    Formal::named("about").optional().is("a point that stays where it is (default the origin)");
const TURN: &[Formal] = &[Formal::place("angle").is("an angle: `90deg`"), ABOUT];
const ROTATE: &[Formal] = &[
    Formal::named("axis").is("a direction: `[1, 1, 0]`"),
    Formal::named("by").is("an angle, right-handed about the axis"),
    ABOUT,
];
const SCALE: &[Formal] =
    &[Formal::place("factor").is("a number, or a vector of one for each axis; none is zero"), ABOUT];
const MIRROR: &[Formal] =
    &[Formal::place("axis").is("`\"x\"`, `\"y\"`, `\"z\"`, or the direction across the mirror"), ABOUT];
const MATRIX: &[Formal] = &[Formal::place("rows").is("3 rows of 4 numbers")];
const VECTORS: &[Formal] = &[Formal::place("list").is("a list of vectors")];
const PLACES: &[Formal] =
    &[Formal::place("list").is("a list of vectors, or of matrices of 3 rows of 4 numbers")];
const AROUND: &[Formal] = &[Formal::place("n").is("a whole number above zero"), ABOUT];
const FIT: &[Formal] = &[
    Formal::place("at").is("a vector: where the middle of the bottom comes"),
    Formal::named("height").optional().is("a length: its extent along z"),
    Formal::named("size").optional().is("a length: its longest extent; one of the two is given"),
];
const WITH: &[Formal] = &[Formal::place("material").is("a material: a name, or `matte(#b8683c)`")];
const CLOSE: &[Formal] =
    &[Formal::named("max_hole").optional().is("a length: the widest hole that is capped (default: any)")];
const BY: &[Formal] = &[Formal::place("d").is("a length above zero")];
const CLIP: &[Formal] = &[Formal::place("solid").is("a solid")];

/// The methods.
pub const TABLE: &[Builtin] = &[
    Builtin { name: "move", formals: MOVE, doc: "Moved by a vector.", call: translate },
    Builtin {
        name: "rotate_x",
        formals: TURN,
        doc: "Turned around the x axis, from y to z.",
        call: |b| turn(b, DVec3::X),
    },
    Builtin {
        name: "rotate_y",
        formals: TURN,
        doc: "Turned around the y axis, from z to x.",
        call: |b| turn(b, DVec3::Y),
    },
    Builtin {
        name: "rotate_z",
        formals: TURN,
        doc: "Turned around the z axis, from x to y.",
        call: |b| turn(b, DVec3::Z),
    },
    Builtin { name: "rotate", formals: ROTATE, doc: "Turned around an axis, right-handed.", call: rotate },
    Builtin {
        name: "scale",
        formals: SCALE,
        doc: "Scaled by a factor, or by one for each axis.",
        call: scale,
    },
    Builtin {
        name: "mirror",
        formals: MIRROR,
        doc: "Mirrored along an axis, a vector or \"x\", \"y\", \"z\": at the plane across it.",
        call: mirror,
    },
    Builtin {
        name: "matrix",
        formals: MATRIX,
        doc: "Placed by 3 rows of 4 numbers; points are columns.",
        call: by_matrix,
    },
    Builtin {
        name: "array",
        formals: VECTORS,
        doc: "A copy moved by each vector of a list.",
        call: copies::array,
    },
    Builtin {
        name: "around",
        formals: AROUND,
        doc: "So many copies around the z axis, evenly over a turn.",
        call: copies::around,
    },
    Builtin {
        name: "instance",
        formals: PLACES,
        doc: "A copy at each vector of a list, or placed by each matrix.",
        call: copies::instance,
    },
    Builtin {
        name: "fit",
        formals: FIT,
        doc: "Scaled to a height or a size, the middle of the bottom of its bounds at a point.",
        call: fit,
    },
    Builtin { name: "with", formals: WITH, doc: "Wears a material where it has none.", call: with },
    Builtin {
        name: "cut",
        formals: WITH,
        doc: "The cutters below wear a material where they have none.",
        call: cut,
    },
    Builtin { name: "close", formals: CLOSE, doc: "The holes of an open scan capped.", call: close },
    Builtin {
        name: "thicken",
        formals: BY,
        doc: "An open surface given a thickness, half of it to each side.",
        call: thicken,
    },
    Builtin {
        name: "inset",
        formals: BY,
        doc: "A solid whose boundary is moved inward.",
        call: |b| offset(b, -1.0),
    },
    Builtin {
        name: "offset",
        formals: BY,
        doc: "A solid whose boundary is moved outward.",
        call: |b| offset(b, 1.0),
    },
    Builtin {
        name: "clip",
        formals: CLIP,
        doc: "The surface that lies inside a solid, without a cap: a Sheet. What lies on the boundary of the solid is kept.",
        call: clip,
    },
];

fn node(bound: &Bound, kind: impl FnOnce(Shape) -> ShapeKind) -> Eval<Val> {
    let child = bound.receiver()?.shape("shape")?.clone();
    Ok(Val::Shape(Shape::new(kind(child), bound.callee.at)))
}

fn transform(bound: &Bound, linear: DMat3) -> Eval<Val> {
    let point = bound.get("about").map_or(Ok(DVec3::ZERO), |a| a.vec3("about"))?;
    let world_from_local = about(linear, point);
    if !world_from_local.is_finite() {
        return Err(Diagnostic::error("E0504", "the placement is not finite")
            .at(bound.callee.at, "infinite or undefined")
            .help("use smaller numbers")
            .into());
    }
    node(bound, |child| ShapeKind::Transform { world_from_local, child })
}

fn translate(bound: &Bound) -> Eval<Val> {
    let world_from_local = DAffine3::from_translation(bound.need("by")?.vec3("by")?);
    node(bound, |child| ShapeKind::Transform { world_from_local, child })
}

fn turn(bound: &Bound, axis: DVec3) -> Eval<Val> {
    transform(bound, rotation(axis, bound.angle("angle")?))
}

fn rotate(bound: &Bound) -> Eval<Val> {
    let axis = direction(bound.need("axis")?)?;
    transform(bound, rotation(axis, bound.angle("by")?))
}

fn mirror(bound: &Bound) -> Eval<Val> {
    transform(bound, reflection(named_direction(bound.need("axis")?)?))
}

fn by_matrix(bound: &Bound) -> Eval<Val> {
    let world_from_local = matrix(bound.need("rows")?)?;
    node(bound, |child| ShapeKind::Transform { world_from_local, child })
}

fn scale(bound: &Bound) -> Eval<Val> {
    let given = bound.need("factor")?;
    let factor = match given.value {
        Val::Number(_) | Val::Measured(_) => DVec3::splat(given.number("factor")?),
        _ => given.vec3("factor")?,
    };
    if factor.to_array().contains(&0.0) {
        return Err(Diagnostic::error("E0510", "the scale is zero")
            .at(given.at, "flattens the shape to nothing")
            .help("a scale is any number but zero")
            .into());
    }
    transform(bound, DMat3::from_diagonal(factor))
}

fn fit(bound: &Bound) -> Eval<Val> {
    let at = bound.need("at")?.vec3("at")?;
    let (given, name) = match (bound.get("height"), bound.get("size")) {
        (Some(given), None) => (given, "height"),
        (None, Some(given)) => (given, "size"),
        (None, None) => return Err(bound.callee.missing("height").help("write `height:` or `size:`").into()),
        (Some(height), Some(size)) => {
            return Err(Diagnostic::error("E0405", "`height` and `size` are both given")
                .at(size.at, "the size")
                .at(height.at, "the height")
                .help("remove one of them")
                .into());
        }
    };
    let measure = above_zero(given.number(name)?, name, given.at)?;
    let to = if name == "height" { FitTo::Height(measure) } else { FitTo::Size(measure) };
    node(bound, |child| ShapeKind::Fit { at, to, child })
}

fn with(bound: &Bound) -> Eval<Val> {
    let material = material(bound, "with")?;
    node(bound, |child| ShapeKind::With { material, child })
}

fn cut(bound: &Bound) -> Eval<Val> {
    let material = material(bound, "cut")?;
    node(bound, |child| ShapeKind::Cut { material, child })
}

/// The argument `material` of a method.
fn material(bound: &Bound, method: &str) -> Eval<MaterialId> {
    let given = bound.need("material")?;
    if let Val::Material(material) = given.value {
        return Ok(material);
    }
    let help = match given.value {
        Val::Color(_) => "write a material of this colour, such as `matte(#b8683c)`".to_owned(),
        _ => format!("name one: `material clay(color: #b8683c)`, then `.{method}(clay)`"),
    };
    Err(given.unlike("material", "a material").help(help).into())
}

fn close(bound: &Bound) -> Eval<Val> {
    let max_hole = match bound.get("max_hole") {
        Some(given) => {
            let width = given.as_number("max_hole", "a length")?;
            Some(above_zero(width, "max_hole", given.at)?)
        }
        None => None,
    };
    node(bound, |child| ShapeKind::Close { max_hole, child })
}

fn thicken(bound: &Bound) -> Eval<Val> {
    let by = distance(bound)?;
    node(bound, |child| ShapeKind::Thicken { by, child })
}

fn offset(bound: &Bound, sign: f64) -> Eval<Val> {
    let by = sign * distance(bound)?;
    node(bound, |child| ShapeKind::Offset { by, child })
}

/// The argument `d`, above zero.
fn distance(bound: &Bound) -> Eval<f64> {
    let given = bound.need("d")?;
    above_zero(given.as_number("d", "a length")?, "d", given.at)
}

fn clip(bound: &Bound) -> Eval<Val> {
    let given = bound.need("solid")?;
    let by = Operand { shape: given.shape("solid")?.clone(), at: given.at };
    node(bound, |child| ShapeKind::Clip { by, child })
}

fn above_zero(x: f64, name: &str, at: crate::source::Span) -> Eval<f64> {
    if x > 0.0 {
        return Ok(x);
    }
    Err(Diagnostic::error("E0503", format!("`{name}` must be above zero"))
        .at(at, format!("{x}"))
        .help("write a length above zero")
        .into())
}
