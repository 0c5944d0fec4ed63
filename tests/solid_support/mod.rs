//! What the tests of solids share: solids from the text of a call, rays that like to be awkward, and crossings as
//! spans.
#![allow(dead_code)]

use std::sync::Arc;

use glam::DVec3;
use pss::geom::{Aabb, Interval, Ray};
use pss::num::hash::Stream;
use pss::prepare;
use pss::scene::{Call, ShapeKind};
use pss::solid::table::{self, Build};
use pss::solid::{Answer, Crossing, Scratch, Solid};
use pss::source::SourceMap;

pub const EPS: f64 = f64::EPSILON;

/// The call that a text is, checked by the language.
pub fn call(text: &str) -> Call {
    let mut sources = SourceMap::default();
    let file = sources.add("test.pss", None, format!("draw {text}"));
    let read = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]);
    let (scene, _) = read.unwrap_or_else(|e| panic!("{text}: {e:?}"));
    match &scene.draws[0].shape.0.kind {
        ShapeKind::Leaf { call, .. } => call.clone(),
        _ => panic!("{text} is no call of a primitive"),
    }
}

/// The solid of a call, if it is made from its arguments alone.
pub fn built(call: &Call) -> Option<Arc<dyn Solid>> {
    match table::find(&call.word).expect("a primitive").build {
        Build::Exact(build) => Some(build(call).unwrap_or_else(|e| panic!("{call:?}: {e:?}"))),
        _ => None,
    }
}

/// The solid that a text is.
pub fn solid(text: &str) -> Arc<dyn Solid> {
    built(&call(text)).expect("a closed form")
}

/// All crossings of the ray's line, and whether it begins inside.
pub fn line(solid: &dyn Solid, ray: &Ray) -> (Vec<Crossing>, bool) {
    let mut out = Vec::new();
    let Answer { inside, range } = solid.crossings(ray, Interval::ALL, &mut Scratch::default(), &mut out);
    assert!(range.lo == f64::NEG_INFINITY && range.hi == f64::INFINITY, "a closed form answers for the line");
    (out, inside)
}

/// The t of all crossings.
pub fn ts(solid: &dyn Solid, ray: &Ray) -> Vec<f64> {
    line(solid, ray).0.iter().map(|c| c.t).collect()
}

/// Whether the points just after `t` are inside.
pub fn holds(line: &(Vec<Crossing>, bool), t: f64) -> bool {
    line.0.iter().rev().find(|c| c.t <= t).map_or(line.1, |c| c.entering)
}

/// Whether a point is inside, by the crossings of a line through it.
pub fn inside(solid: &dyn Solid, p: DVec3, dir: DVec3) -> bool {
    holds(&line(solid, &Ray::new(p, dir)), 0.0)
}

pub fn normal(solid: &dyn Solid, ray: &Ray, c: &Crossing) -> DVec3 {
    solid.normal(ray, c, &mut Scratch::default())
}

/// |d . n| in units of lengths: what a difference of t is multiplied by to be one along the normal.
pub fn slope(solid: &dyn Solid, ray: &Ray, c: &Crossing) -> f64 {
    ray.dir.dot(normal(solid, ray, c)).abs()
}

/// A solid with a place and a size to aim at.
#[derive(Clone, Debug)]
pub struct Subject {
    pub text: String,
    pub call: Call,
    pub solid: Arc<dyn Solid>,
    pub center: DVec3,
    pub size: f64,
}

impl Subject {
    /// `None` where a text's solid is not made from its arguments alone. An unbounded solid is aimed at where one of
    /// some lines through the origin first meets it.
    pub fn new(text: &str) -> Option<Subject> {
        let call = call(text);
        let solid = built(&call)?;
        let bounds = solid.bounds();
        let (center, size) = if bounds.is_finite() {
            (bounds.center(), bounds.diagonal())
        } else {
            let mut stream = Stream::new(5);
            let near = (0..200).filter_map(|_| {
                let ray = Ray::new(DVec3::ZERO, stream.direction());
                ts(&*solid, &ray)
                    .into_iter()
                    .map(|t| ray.at(t))
                    .min_by(|a, b| a.length().total_cmp(&b.length()))
            });
            let at = near.min_by(|a, b| a.length().total_cmp(&b.length())).expect("a boundary");
            (at, at.length().max(1.0))
        };
        Some(Subject { text: text.to_owned(), call, solid, center, size })
    }

    /// The largest length in play on a ray.
    pub fn scale(&self, ray: &Ray) -> f64 {
        ray.origin.length().max(self.center.length() + self.size)
    }

    /// A point in or about the solid's box, a third of them with coordinates from its corners and middle.
    pub fn target(&self, stream: &mut Stream) -> DVec3 {
        let half = 0.5 * self.size / 3f64.sqrt();
        let mut at = self.center + 1.2 * half * cube(stream);
        let bounds = self.solid.bounds();
        if bounds.is_finite() && stream.unit() < 0.3 {
            for axis in 0..3 {
                let pick = [bounds.min[axis], self.center[axis], bounds.max[axis], at[axis]];
                at[axis] = pick[(4.0 * stream.unit()) as usize];
            }
        }
        at
    }

    /// A ray: through two points, along an axis, of small whole directions; its length is anything, and one in ten comes
    /// from far.
    pub fn ray(&self, stream: &mut Stream) -> Ray {
        let at = self.target(stream);
        let dir = match (6.0 * stream.unit()) as u32 {
            0 => DVec3::AXES[(3.0 * stream.unit()) as usize] * if stream.unit() < 0.5 { -1.0 } else { 1.0 },
            1 => (3.0 * cube(stream)).round(),
            2 => self.target(stream) - at,
            _ => stream.direction(),
        };
        let dir = if dir == DVec3::ZERO { DVec3::X } else { dir.normalize() };
        let far = if stream.unit() < 0.1 { 10f64.powf(7.0 * stream.unit()) } else { 2.0 * stream.unit() };
        let length = self.size * 10f64.powf(6.0 * stream.unit() - 3.0);
        Ray::new(at - far * self.size * dir, length * dir)
    }
}

/// Even in the cube from -1 to 1.
pub fn cube(stream: &mut Stream) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| 2.0 * stream.unit() - 1.0))
}

/// Solids that the examples of the table do not show: limits and degenerate kinds.
pub const MORE: &[&str] = &[
    "box(size: [4, 1, 0.01], at: [1, 2, 3])",
    "box([0, 0, 0], [2, 1, 3], round: 0.2)",
    "box(size: 2, round: 1)",
    "sphere(r: [3, 1, 0.1], at: [0, 0, 1])",
    "cylinder(r: 0.3, from: [1, 2, 3], to: [-1, 0, 2])",
    "cone(r1: 1, r2: 0, h: 1)",
    "cone(r1: 0.2, r2: 1.5, from: [1, 1, 0], to: [0, 2, 3])",
    "capsule(r: 1, from: [1, 2, 3], to: [1, 2, 3])",
    "capsule(r: 0.2, from: [1, 2, 3], to: [-3, 2, 1])",
    "tube([[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, 1, 0], [1, 0.4, 0.5]], r: 0.3)",
    "torus(major: 1, minor: 1)",
    "torus(major: 0.5, minor: 1, at: [0, 1, 0])",
    "torus(major: 3, minor: 0.01)",
    "superellipsoid(r: [1, 2, 0.5], e1: 2, e2: 2)",
    "superellipsoid(r: 1, e1: 0.05, e2: 1.7)",
    "superellipsoid(r: 1)",
    "quadric(squares: [1, 2, 3], products: [0.5, 0, 1], linear: [1, -2, 0], constant: -1)",
    "quadric(squares: [1, 1, 0], linear: [0, 0, -1])",
    "quadric(squares: [1, -1, 0], linear: [0, 0, 0.5], constant: 0.1)",
    "quadric(squares: [1, 1, -1], constant: 0.25)",
    "quadric(linear: [1, 2, 3], constant: -1)",
];

/// All subjects: the example of each primitive that is made from its arguments alone, and more of them.
pub fn subjects() -> Vec<Subject> {
    let examples = table::PRIMITIVES.iter().map(|p| p.decl.example);
    let all: Vec<Subject> = examples.chain(MORE.iter().copied()).filter_map(Subject::new).collect();
    assert!(20 < all.len());
    all
}

/// A box grown by rounding on the scale of its own coordinates and a ray.
pub fn grown(bounds: &Aabb, scale: f64) -> Aabb {
    bounds.inflated(16.0 * EPS * scale)
}
