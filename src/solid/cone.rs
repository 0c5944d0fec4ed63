//! Cones and their frusta.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use super::shaft::{Shaft, within};
use super::table::{Build, Primitive};
use super::{Chord, Cost, Crossing, Exact, Scratch, Solid};
use crate::geom::{Aabb, Lean, Ray};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "cone",
        group: Group::Primitive,
        doc: "A cone or its frustum: of height h from z = 0 up, or between two points. r2: 0 is a full cone.",
        params: &[
            Param::required("r1", Kind::Length, "radius at z = 0 or at from; zero or more"),
            Param::required("r2", Kind::Length, "radius at the other end; zero or more"),
            Param::named("h", Kind::Size, "height, from z = 0 up"),
            Param::named("from", Kind::Vector(3), "centre of one end"),
            Param::named("to", Kind::Vector(3), "centre of the other"),
        ],
        example: "cone(r1: 1, r2: 0.5, h: 2)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let mut radii = [0.0; 2];
    for (radius, param) in radii.iter_mut().zip(["r1", "r2"]) {
        *radius = call.number(param).unwrap_or(0.0);
        if *radius < 0.0 {
            let help = "a radius is zero or more; zero makes that end a point".into();
            return Err(BuildError { param, message: format!("`{param}` is negative"), help });
        }
    }
    match Shaft::ends(call) {
        Some([from, to]) => Ok(Arc::new(Cone::new(radii, from, to))),
        None => Err(BuildError {
            param: "",
            message: "a cone needs either a height or both its ends".into(),
            help: "write `cone(r1: 1, r2: 0, h: 2)` or `cone(r1: 1, r2: 0, from: [0, 0, 0], to: [0, 0, 2])`"
                .into(),
        }),
    }
}

/// The frustum between two discs across an axis.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    shaft: Shaft,
    radii: [f64; 2],
    /// By how much the radius grows with each length along the axis.
    slope: f64,
    /// Half way up, where rays are shifted to.
    middle: DVec3,
}

impl Cone {
    /// Between the centres of its ends, with the radius at each, zero or more; nothing where the ends coincide or both
    /// radii are zero.
    pub fn new(radii: [f64; 2], from: DVec3, to: DVec3) -> Cone {
        let shaft = Shaft::new(from, to);
        let slope = if 0.0 < shaft.height { (radii[1] - radii[0]) / shaft.height } else { 0.0 };
        Cone { shaft, radii, slope, middle: 0.5 * (from + to) }
    }

    /// The part of a line inside the infinite cone of radius w, the one nappe where w > 0: `o` and `d` across the axis,
    /// `w` and `dw` the radius at `o` and its growth along the line.
    ///
    /// |o + t d|^2 < (w + t dw)^2, a quadratic A t^2 + 2 B t + C whose discriminant is |o dw - d w|^2 - (o x d)^2, a
    /// difference of squares that keeps its digits at grazing incidence (B^2 - A C does not). For A > 0 the line
    /// passes through one nappe between the roots; for A < 0 it is steeper than the wall and comes from one nappe, where
    /// w < 0, into the other; for A = 0 it runs along the wall's direction and has one root. The root near to `o` is
    /// C / q, exact however small A is (Vieta).
    fn nappe(&self, o: DVec2, d: DVec2, w: f64, dw: f64) -> Option<[f64; 2]> {
        let (a, b, c) = {
            let (d_len, o_len) = (d.length(), o.length());
            ((d_len - dw.abs()) * (d_len + dw.abs()), o.dot(d) - w * dw, (o_len - w) * (o_len + w))
        };
        let (apart, beside) = ((o * dw - d * w).length(), o.perp_dot(d).abs());
        let discriminant = (apart - beside) * (apart + beside);
        if 0.0 < a && discriminant <= 0.0 {
            return None;
        }
        let q = -(b + discriminant.max(0.0).sqrt().copysign(b + 0.0));
        // Through the apex both roots are one.
        let (far, near) = (q / a, if q == 0.0 { q / a } else { c / q });
        let (lo, hi) = if far < near { (far, near) } else { (near, far) };
        let (up, down) = ([hi, f64::INFINITY], [f64::NEG_INFINITY, lo]);
        let inside = if 0.0 < a {
            (0.0 < w + 0.5 * (lo + hi) * dw).then_some([lo, hi])
        } else if a < 0.0 {
            Some(if 0.0 < dw { up } else { down })
        } else if b == 0.0 {
            // Along the wall itself, or along the axis of what is a cylinder.
            (c < 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY])
        } else {
            let root = -0.5 * c / b;
            Some(if b < 0.0 { [root, f64::INFINITY] } else { [f64::NEG_INFINITY, root] })
        };
        inside.filter(|[lo, hi]| lo < hi)
    }
}

impl Solid for Cone {
    fn bounds(&self) -> Aabb {
        self.extent_under(&DAffine3::IDENTITY)
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.shaft.extent(self.radii, to_from)
    }

    /// The slab between the ends and the infinite cone, about the point nearest to the middle of the axis.
    fn chord(&self, ray: &Ray, lean: &Lean) -> Option<Chord> {
        let Shaft { from, across_along, height, .. } = self.shaft;
        if height <= 0.0 || self.radii[0].max(self.radii[1]) <= 0.0 {
            return Some(Chord::NONE);
        }
        let (shift, o) = ray.nearest_to(self.middle);
        // Heights are taken from the ray's own origin: they decide flush faces, and are exact along the axes.
        let z = self.shaft.axis().dot(ray.origin - from);
        let (o, d) = (across_along * o, across_along * ray.dir);
        let Some(ends) = self.shaft.between(z, d.z, *lean) else { return Some(Chord::NONE) };
        let w = 0.5 * (self.radii[0] + self.radii[1]) + self.slope * o.z;
        let walls = self.nappe(o.truncate(), d.truncate(), w, self.slope * d.z);
        Some(walls.map_or(Chord::NONE, |walls| within(ends, walls.map(|t| shift + t))))
    }

    /// Inward each face moves by as much, and what is left is a frustum again, or a full cone where the walls meet
    /// below the moved end.
    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        if 0.0 < by {
            return Err("what lies near a cone has rounded edges");
        }
        let across = -by * (1.0 + self.slope * self.slope).sqrt();
        let radius_at = |z: f64| self.radii[0] + self.slope * z - across;
        let [mut lo, mut hi] = [-by, self.shaft.height + by];
        if 0.0 < self.slope && radius_at(lo) < 0.0 {
            lo = (across - self.radii[0]) / self.slope;
        } else if self.slope < 0.0 && radius_at(hi) < 0.0 {
            hi = (across - self.radii[0]) / self.slope;
        }
        let radii = [radius_at(lo).max(0.0), radius_at(hi).max(0.0)];
        if hi <= lo || radii[0].max(radii[1]) <= 0.0 {
            return Ok(None);
        }
        let (from, axis) = (self.shaft.from, self.shaft.axis());
        Ok(Some(Arc::new(Cone::new(radii, from + lo * axis, from + hi * axis))))
    }

    fn exact(&self) -> Option<Exact> {
        let ([a, b], h) = (self.radii, self.shaft.height);
        let wall = PI * (a + b) * h.hypot(a - b);
        Exact::new(PI / 3.0 * h * (a * a + a * b + b * b), PI * (a * a + b * b) + wall)
    }

    fn cost(&self) -> Cost {
        Cost::Closed
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let wall = || {
            let axis = self.shaft.axis();
            let out = self.shaft.away(ray.at(crossing.t) - self.middle);
            // At the apex, where there is no normal, along the axis.
            (out - self.slope * axis).try_normalize().unwrap_or(axis)
        };
        self.shaft.end_normal(crossing.part).unwrap_or_else(wall)
    }
}
