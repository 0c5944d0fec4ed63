//! Cylinders.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use super::shaft::{Shaft, within};
use super::table::{Build, Primitive};
use super::{Chord, Cost, Crossing, Exact, Scratch, Solid};
use crate::geom::{Aabb, Lean, Ray};
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
    match Shaft::ends(call) {
        Some([from, to]) => Ok(Arc::new(Cylinder::new(r, from, to))),
        None => Err(BuildError {
            param: "",
            message: "a cylinder needs either a height or both its ends".into(),
            help: "write `cylinder(r: 1, h: 2)` or `cylinder(r: 1, from: [0, 0, 0], to: [0, 0, 2])`".into(),
        }),
    }
}

/// A capped cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    shaft: Shaft,
    radius: f64,
}

impl Cylinder {
    /// Between the centres of its caps; nothing where they coincide or the radius is zero.
    pub fn new(radius: f64, from: DVec3, to: DVec3) -> Cylinder {
        Cylinder { shaft: Shaft::new(from, to), radius }
    }

    /// The part of a line inside the infinite cylinder x^2 + y^2 = r^2, by its discriminant at the point nearest to the
    /// axis.
    fn within(&self, o: DVec2, d: DVec2) -> Option<[f64; 2]> {
        let a = d.length_squared();
        if a == 0.0 {
            return (o.length() < self.radius).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let b = o.dot(d);
        // Distance of the line from the axis, |o x d| / |d|.
        let m = o.perp_dot(d).abs() / a.sqrt();
        let c = (o.length() - self.radius) * (o.length() + self.radius);
        roots::quadratic(a, b, c, a * (self.radius - m) * (self.radius + m))
    }
}

impl Solid for Cylinder {
    fn bounds(&self) -> Aabb {
        self.extent_under(&DAffine3::IDENTITY)
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.shaft.extent([self.radius; 2], to_from)
    }

    /// The slab between the caps and the infinite cylinder. A ray along the axis meets the caps alone.
    fn chord(&self, ray: &Ray, lean: &Lean) -> Option<Chord> {
        let Shaft { from, across_along, height, .. } = self.shaft;
        if self.radius <= 0.0 || height <= 0.0 {
            return Some(Chord::NONE);
        }
        let (o, d) = (across_along * (ray.origin - from), across_along * ray.dir);
        let Some(ends) = self.shaft.between(o.z, d.z, *lean) else { return Some(Chord::NONE) };
        let walls = self.within(o.truncate(), d.truncate());
        Some(walls.map_or(Chord::NONE, |walls| within(ends, walls)))
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        if 0.0 < by {
            return Err("what lies near a cylinder has rounded edges");
        }
        let Shaft { from, to, height, .. } = self.shaft;
        let left = 0.0 < self.radius + by && 0.0 < height + 2.0 * by;
        let (from, to) = (from - by * self.shaft.axis(), to + by * self.shaft.axis());
        Ok(left.then(|| Arc::new(Cylinder::new(self.radius + by, from, to)) as Arc<dyn Solid>))
    }

    fn exact(&self) -> Option<Exact> {
        let (r, h) = (self.radius, self.shaft.height);
        Exact::new(PI * r * r * h, 2.0 * PI * r * (r + h))
    }

    fn cost(&self) -> Cost {
        Cost::Closed
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let away = || self.shaft.away(ray.at(crossing.t) - self.shaft.from);
        self.shaft.end_normal(crossing.part).unwrap_or_else(away)
    }
}
