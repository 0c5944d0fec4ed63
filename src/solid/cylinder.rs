//! Cylinders.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray};
use crate::num::roots;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "cylinder",
        group: Group::Primitive,
        doc: "A capped cylinder: of height h from z = 0 up, or between two points.",
        params: &[
            Param::required("r", Kind::Size, "radius"),
            Param::named("h", Kind::Size, "height, from z = 0 up"),
            Param::named("from", Kind::Vector(3), "centre of one cap"),
            Param::named("to", Kind::Vector(3), "centre of the other"),
        ],
        example: "cylinder(r: 1, h: 2)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let r = call.number("r").unwrap_or(0.0);
    match (call.number("h"), call.vec3("from"), call.vec3("to")) {
        (Some(h), None, None) => Ok(Arc::new(Cylinder::new(r, DVec3::ZERO, DVec3::new(0.0, 0.0, h)))),
        (None, Some(from), Some(to)) => Ok(Arc::new(Cylinder::new(r, from, to))),
        _ => Err(BuildError {
            param: "",
            message: "a cylinder needs either a height or both its ends".into(),
            help: "write `cylinder(r: 1, h: 2)` or `cylinder(r: 1, from: [0, 0, 0], to: [0, 0, 2])`".into(),
        }),
    }
}

/// A capped cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    from: DVec3,
    to: DVec3,
    /// Rows: two unit vectors across, one along the axis.
    across_along: DMat3,
    radius: f64,
    height: f64,
}

const WALL: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

impl Cylinder {
    /// Between the centres of its caps; nothing where they coincide or the radius is zero.
    pub fn new(radius: f64, from: DVec3, to: DVec3) -> Cylinder {
        let height = from.distance(to);
        let axis = (to - from).try_normalize().unwrap_or(DVec3::Z);
        let (u, v) = axis.any_orthonormal_pair();
        Cylinder { from, to, across_along: DMat3::from_cols(u, v, axis).transpose(), radius, height }
    }
}

impl Solid for Cylinder {
    fn bounds(&self) -> Aabb {
        self.extent_under(&DAffine3::IDENTITY)
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        // A disc spanned by u and v reaches the length of (u, v) along each axis.
        let across = self.across_along.transpose();
        let (u, v) = (to_from.matrix3 * across.x_axis, to_from.matrix3 * across.y_axis);
        let reach = self.radius * (u * u + v * v).map(f64::sqrt);
        let ends = [self.from, self.to].map(|p| to_from.transform_point3(p));
        Aabb { min: ends[0].min(ends[1]) - reach, max: ends[0].max(ends[1]) + reach }
    }

    /// The slab between the caps and the infinite cylinder x^2 + y^2 = r^2, the latter by its discriminant at the
    /// point nearest to the axis. A ray along the axis meets the caps alone.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let miss = Answer::whole_line(false);
        let (o, d) = (self.across_along * (ray.origin - self.from), self.across_along * ray.dir);
        if self.radius <= 0.0 || self.height <= 0.0 {
            return miss;
        }
        let (mut enter, mut exit) = ((f64::NEG_INFINITY, WALL), (f64::INFINITY, WALL));
        if d.z == 0.0 {
            if o.z < 0.0 || self.height <= o.z {
                return miss;
            }
        } else {
            let (bottom, top) = (-o.z / d.z, (self.height - o.z) / d.z);
            let ends = [(bottom, BOTTOM), (top, TOP)];
            (enter, exit) = if 0.0 < d.z { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        }
        let (o, d) = (o.truncate(), d.truncate());
        let a = d.length_squared();
        if a == 0.0 {
            if self.radius <= o.length() {
                return miss;
            }
        } else {
            let b = o.dot(d);
            // Distance of the line from the axis, |o x d| / |d|.
            let m = o.perp_dot(d).abs() / a.sqrt();
            let c = (o.length() - self.radius) * (o.length() + self.radius);
            let discriminant = a * (self.radius - m) * (self.radius + m);
            let Some([t0, t1]) = roots::quadratic(a, b, c, discriminant) else { return miss };
            if enter.0 < t0 {
                enter = (t0, WALL);
            }
            if t1 < exit.0 {
                exit = (t1, WALL);
            }
        }
        if enter.0 < exit.0 {
            out.push(Crossing::exact(enter.0, true, enter.1));
            out.push(Crossing::exact(exit.0, false, exit.1));
        }
        miss
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        if 0.0 < by {
            return Err("what lies near a cylinder has rounded edges");
        }
        let axis = self.across_along.transpose().z_axis;
        let left = 0.0 < self.radius + by && 0.0 < self.height + 2.0 * by;
        let (from, to) = (self.from - by * axis, self.to + by * axis);
        Ok(left.then(|| Arc::new(Cylinder::new(self.radius + by, from, to)) as Arc<dyn Solid>))
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let across_along = self.across_along.transpose();
        let axis = across_along.z_axis;
        match crossing.part {
            BOTTOM => -axis,
            TOP => axis,
            _ => {
                let p = self.across_along * (ray.at(crossing.t) - self.from);
                (p.x * across_along.x_axis + p.y * across_along.y_axis).normalize()
            }
        }
    }
}
