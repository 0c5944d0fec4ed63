//! What a scene may ask of its shapes while it is evaluated: the geometry is measured by whoever reads the scene.

use std::sync::Arc;

use glam::DVec3;

use super::args::{Bound, Formal};
use super::budget;
use super::builtins::{Builtin, line};
use super::estimate::{Estimate, Question, Source};
use super::value::{Eval, List, Located, Record, Val};
use crate::diag::Diagnostic;
use crate::geom::Aabb;
use crate::scene::{Call, Shape};
use crate::source::Span;

/// A shape that is asked about, what its materials are, and where it is asked.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The shape.
    pub shape: &'a Shape,
    /// The materials made so far.
    pub materials: &'a [Call],
    /// The place of the argument.
    pub at: Span,
    /// How exactly: 0 as far as most want it, each level more some four times closer.
    pub level: usize,
}

/// A number with a bar of error: the true one is within it but for one time in a thousand, or with certainty where the
/// bar is zero.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct Measured {
    /// The number.
    pub value: f64,
    /// Half the width of the bar.
    pub err: f64,
    /// What the bar is held against: the number's own size, or that of what it is taken in.
    pub size: f64,
    /// Whether a level more may narrow the bar.
    pub is_open: bool,
}

/// A box around a shape.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Extent {
    /// The box; empty for nothing, unbounded where the shape is.
    pub bounds: Aabb,
    /// How far its sides may be off; zero where it is known without measuring.
    pub err: f64,
}

/// Where a ray passes through a boundary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RayHit {
    /// In multiples of the ray's direction.
    pub t: f64,
    /// The point.
    pub point: DVec3,
    /// Outward, of unit length.
    pub normal: DVec3,
    /// Whether the ray goes in.
    pub entering: bool,
}

/// The outcome of a question; errors are located.
pub type Answer<T> = Result<T, Vec<Diagnostic>>;

/// Measures shapes. Answers depend on the shape alone.
pub trait Geometry {
    /// The box around the shape.
    fn bounds(&self, asked: &Asked) -> Answer<Extent>;
    /// Whether it has an inside everywhere: a solid, no sheet.
    fn is_solid(&self, asked: &Asked) -> Answer<bool>;
    /// Whether nothing is in it.
    fn is_empty(&self, asked: &Asked) -> Answer<bool>;
    /// Whether a point is inside.
    fn inside(&self, asked: &Asked, point: DVec3) -> Answer<bool>;
    /// The volume, cubic units.
    fn volume(&self, asked: &Asked) -> Answer<Measured>;
    /// The area of the boundary, of sheets on one side; square units.
    fn area(&self, asked: &Asked) -> Answer<Measured>;
    /// The middle of the inside.
    fn centroid(&self, asked: &Asked) -> Answer<[Measured; 3]>;
    /// What a ray crosses, ascending.
    fn raycast(&self, asked: &Asked, from: DVec3, dir: DVec3) -> Answer<Vec<RayHit>>;
}

const SHAPE: &[Formal] = &[Formal::place("shape").is("a shape")];
const POINT: &[Formal] = &[Formal::place("shape").is("a solid"), Formal::place("point").is("a vector")];
const RAY: &[Formal] = &[
    Formal::place("shape").is("a shape"),
    Formal::named("from").is("a vector: where the ray begins"),
    Formal::named("dir").is("a vector: its direction, in which t is measured"),
];

/// The functions.
pub const TABLE: &[Builtin] = &[
    line("bounds", SHAPE, "The box around a shape: its `.min`, `.max`, `.size` and `.center`.", bounds),
    line("inside", POINT, "Whether a point is inside a solid.", |b| {
        let point = b.need("point")?.vec3("point")?;
        ask(b, |g, asked| g.inside(asked, point)).map(Val::Bool)
    }),
    line("volume", SHAPE, "The volume of a solid, cubic units.", |b| {
        measured(b, Question::Volume, ask(b, |g, asked| g.volume(asked))?)
    }),
    line("area", SHAPE, "The area of a shape's boundary, square units; of a sheet that of one side.", |b| {
        measured(b, Question::Area, ask(b, |g, asked| g.area(asked))?)
    }),
    line("centroid", SHAPE, "The middle of the inside of a solid.", |b| {
        vector(b, ask(b, |g, asked| g.centroid(asked))?, Question::Middle)
    }),
    line("empty", SHAPE, "Whether nothing is in a shape.", |b| {
        ask(b, |g, asked| g.is_empty(asked)).map(Val::Bool)
    }),
    line("solid", SHAPE, "Whether a shape has an inside: no sheet is in it.", |b| {
        ask(b, |g, asked| g.is_solid(asked)).map(Val::Bool)
    }),
    line(
        "raycast",
        RAY,
        "Where a ray crosses a shape's boundary, nearest first: a list of `.t`, `.point`, `.normal`, `.entering`.",
        raycast,
    ),
];

fn ask<T>(bound: &Bound, question: impl FnOnce(&dyn Geometry, &Asked) -> Answer<T>) -> Eval<T> {
    let given = bound.need("shape")?;
    let shape = given.shape("shape")?;
    let Some(geometry) = bound.geometry else {
        let error = Diagnostic::error("E0708", format!("`{}` cannot be asked here", bound.callee.word));
        return Err(error.at(bound.callee.at, "no geometry").help("ask in the scene itself").into());
    };
    let asked = Asked { shape, materials: bound.materials, at: given.at, level: 0 };
    question(geometry, &asked).map_err(|errors| {
        let first = errors.into_iter().next();
        first
            .unwrap_or_else(|| Diagnostic::error("E0708", "the shape cannot be measured").at(given.at, ""))
            .into()
    })
}

/// The number, with its bar where it has one.
fn measured(bound: &Bound, question: Question, measured: Measured) -> Eval<Val> {
    if measured.err == 0.0 {
        return Ok(Val::Number(measured.value));
    }
    let given = bound.need("shape")?;
    let source = Source { question, shape: given.shape("shape")?.clone(), at: given.at };
    Ok(Val::Measured(Arc::new(Estimate::of(measured, source.into()))))
}

fn vector(bound: &Bound, all: [Measured; 3], question: impl Fn(usize) -> Question) -> Eval<Val> {
    let at = bound.callee.at;
    let located = |(i, one): (usize, Measured)| Ok(Located { value: measured(bound, question(i), one)?, at });
    Ok(Val::vector_of(all.into_iter().enumerate().map(located).collect::<Eval<Vec<_>>>()?))
}

fn bounds(bound: &Bound) -> Eval<Val> {
    let given = bound.need("shape")?;
    let Extent { bounds: found, err } = ask(bound, |g, asked| g.bounds(asked))?;
    if found.is_empty() || !found.is_finite() {
        let (what, help) = match found.is_empty() {
            true => ("is nothing, and has no bounds", "ask `empty(shape)` first"),
            false => ("has no finite bounds", "cut it with something that has: `shape & box(size: 100)`"),
        };
        let error = Diagnostic::error("E0305", format!("the shape {what}"));
        return Err(error.at(given.at, "").help(help).into());
    }
    let size = found.diagonal();
    let fields = [
        ("min", found.min, 1.0),
        ("max", found.max, 1.0),
        ("size", found.size(), 2.0),
        ("center", found.center(), 1.0),
    ];
    let field = |(name, v, bars): (&str, DVec3, f64)| {
        let one = |value| Measured { value, err: bars * err, size, is_open: false };
        Ok((name.to_owned(), vector(bound, v.to_array().map(one), |_| Question::Settled)?))
    };
    let fields = fields.into_iter().map(field).collect::<Eval<Vec<_>>>()?;
    Ok(Val::Record(Arc::new(Record { kind: "bounds", fields, failed: Vec::new() })))
}

fn raycast(bound: &Bound) -> Eval<Val> {
    let (from, given) = (bound.need("from")?.vec3("from")?, bound.need("dir")?);
    let dir = given.vec3("dir")?;
    if dir == DVec3::ZERO {
        let error =
            Diagnostic::error("E0503", "the direction of a ray is not zero").at(given.at, "no direction");
        return Err(error.help("write a direction: `dir: [0, 0, -1]`").into());
    }
    let hits = ask(bound, |g, asked| g.raycast(asked, from, dir))?;
    let at = bound.callee.at;
    bound.budget.keep(hits.len() * budget::RECORD, at)?;
    let record = |hit: RayHit| {
        let fields = vec![
            ("t".to_owned(), Val::Number(hit.t)),
            ("point".to_owned(), Val::vector(hit.point.to_array(), at)),
            ("normal".to_owned(), Val::vector(hit.normal.to_array(), at)),
            ("entering".to_owned(), Val::Bool(hit.entering)),
        ];
        Located {
            value: Val::Record(Arc::new(Record { kind: "a crossing", fields, failed: Vec::new() })),
            at,
        }
    };
    List::value(hits.into_iter().map(record).collect(), bound.budget, at)
}
