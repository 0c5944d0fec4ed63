//! Cones and their frusta.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray};
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
    match (call.number("h"), call.vec3("from"), call.vec3("to")) {
        (Some(h), None, None) => Ok(Arc::new(Cone::new(radii, DVec3::ZERO, DVec3::new(0.0, 0.0, h)))),
        (None, Some(from), Some(to)) => Ok(Arc::new(Cone::new(radii, from, to))),
        _ => Err(BuildError {
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
    from: DVec3,
    to: DVec3,
    radii: [f64; 2],
    /// Rows: two unit vectors across, one along the axis.
    across_along: DMat3,
    height: f64,
    /// By how much the radius grows with each length along the axis.
    slope: f64,
    /// Half way up, where rays are shifted to.
    middle: DVec3,
}

const WALL: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

impl Cone {
    /// Between the centres of its ends, with the radius at each, zero or more; nothing where the ends coincide or both
    /// radii are zero.
    pub fn new(radii: [f64; 2], from: DVec3, to: DVec3) -> Cone {
        let height = from.distance(to);
        let axis = (to - from).try_normalize().unwrap_or(DVec3::Z);
        let (u, v) = axis.any_orthonormal_pair();
        let slope = if 0.0 < height { (radii[1] - radii[0]) / height } else { 0.0 };
        let across_along = DMat3::from_cols(u, v, axis).transpose();
        Cone { from, to, radii, across_along, height, slope, middle: 0.5 * (from + to) }
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
        let q = -(b + discriminant.max(0.0).sqrt().copysign(b));
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
        // A disc spanned by u and v reaches the length of (u, v) along each axis.
        let across = self.across_along.transpose();
        let (u, v) = (to_from.matrix3 * across.x_axis, to_from.matrix3 * across.y_axis);
        let reach = (u * u + v * v).map(f64::sqrt);
        let disc = |p: DVec3, r: f64| {
            let p = to_from.transform_point3(p);
            Aabb { min: p - r * reach, max: p + r * reach }
        };
        disc(self.from, self.radii[0]).union(disc(self.to, self.radii[1]))
    }

    /// The slab between the ends and the infinite cone, about the point nearest to the middle of the axis.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let miss = Answer::whole_line(false);
        if self.height <= 0.0 || self.radii[0].max(self.radii[1]) <= 0.0 {
            return miss;
        }
        let (shift, o) = ray.nearest_to(self.middle);
        // Heights are taken from the ray's own origin: they decide flush faces, and are exact along the axes.
        let z = self.across_along.transpose().z_axis.dot(ray.origin - self.from);
        let (o, d) = (self.across_along * o, self.across_along * ray.dir);
        let (mut enter, mut exit) = ((f64::NEG_INFINITY, WALL), (f64::INFINITY, WALL));
        if d.z == 0.0 {
            if z < 0.0 || self.height <= z {
                return miss;
            }
        } else {
            let ends = [(-z / d.z, BOTTOM), ((self.height - z) / d.z, TOP)];
            (enter, exit) = if 0.0 < d.z { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        }
        let w = 0.5 * (self.radii[0] + self.radii[1]) + self.slope * o.z;
        let Some([lo, hi]) = self.nappe(o.truncate(), d.truncate(), w, self.slope * d.z) else {
            return miss;
        };
        let (lo, hi) = (shift + lo, shift + hi);
        if enter.0 < lo {
            enter = (lo, WALL);
        }
        if hi < exit.0 {
            exit = (hi, WALL);
        }
        if enter.0 < exit.0 {
            out.push(Crossing::exact(enter.0, true, enter.1));
            out.push(Crossing::exact(exit.0, false, exit.1));
        }
        miss
    }

    /// Inward each face moves by as much, and what is left is a frustum again, or a full cone where the walls meet
    /// below the moved end.
    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        if 0.0 < by {
            return Err("what lies near a cone has rounded edges");
        }
        let across = -by * (1.0 + self.slope * self.slope).sqrt();
        let radius_at = |z: f64| self.radii[0] + self.slope * z - across;
        let [mut lo, mut hi] = [-by, self.height + by];
        if 0.0 < self.slope && radius_at(lo) < 0.0 {
            lo = (across - self.radii[0]) / self.slope;
        } else if self.slope < 0.0 && radius_at(hi) < 0.0 {
            hi = (across - self.radii[0]) / self.slope;
        }
        let radii = [radius_at(lo).max(0.0), radius_at(hi).max(0.0)];
        if hi <= lo || radii[0].max(radii[1]) <= 0.0 {
            return Ok(None);
        }
        let axis = self.across_along.transpose().z_axis;
        Ok(Some(Arc::new(Cone::new(radii, self.from + lo * axis, self.from + hi * axis))))
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let across_along = self.across_along.transpose();
        let axis = across_along.z_axis;
        match crossing.part {
            BOTTOM => -axis,
            TOP => axis,
            _ => {
                let p = self.across_along * (ray.at(crossing.t) - self.middle);
                let out = (p.x * across_along.x_axis + p.y * across_along.y_axis).normalize_or_zero();
                // At the apex, where there is no normal, along the axis.
                (out - self.slope * axis).try_normalize().unwrap_or(axis)
            }
        }
    }
}
