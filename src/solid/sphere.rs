//! Spheres and ellipsoids.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::table::{Build, Primitive};
use super::{Chord, Cost, Crossing, Exact, Scratch, Solid};
use crate::geom::{Aabb, Lean, Ray};
use crate::num::roots;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "sphere",
        group: Group::Primitive,
        doc: "A ball; with a vector for r, an ellipsoid.",
        params: &[
            Param::required("r", Kind::SizeOrVector, "radius, or one for each axis"),
            Param::named("at", Kind::Vector(3), "centre (default the origin)"),
        ],
        example: "sphere(r: 1, at: [0, 0, 0])",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let radii = match call.get("r") {
        Some(Value::Vector(v)) if v.len() == 3 => DVec3::new(v[0], v[1], v[2]),
        _ => DVec3::splat(call.number("r").unwrap_or(0.0)),
    };
    Ok(Arc::new(Sphere { center: call.vec3("at").unwrap_or(DVec3::ZERO), radii }))
}

/// Points whose distance from `center`, each axis in units of its radius, is less than one.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// The centre.
    pub center: DVec3,
    /// One radius an axis.
    pub radii: DVec3,
}

impl Solid for Sphere {
    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radii, max: self.center + self.radii }
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        // The image of the unit ball under M reaches the length of M's row along each axis.
        let m = to_from.matrix3 * glam::DMat3::from_diagonal(self.radii);
        let rows = m.transpose();
        let reach = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        let center = to_from.transform_point3(self.center);
        Aabb { min: center - reach, max: center + reach }
    }

    /// |o + t d|^2 = r^2, for an ellipsoid in units of its radii.
    fn chord(&self, ray: &Ray, _: &Lean) -> Option<Chord> {
        if self.radii.min_element() <= 0.0 {
            return Some(Chord::NONE);
        }
        let (mut o, mut d, mut r) = (ray.origin - self.center, ray.dir, self.radii.x);
        if self.radii != DVec3::splat(r) {
            (o, d, r) = (o / self.radii, d / self.radii, 1.0);
        }
        let (a, b) = (d.length_squared(), o.dot(d));
        let discriminant = discriminant(o, d, [a, b], r);
        if discriminant.is_nan() || discriminant <= 0.0 {
            return Some(Chord::NONE);
        }
        let ends = roots::quadratic(a, b, squares_apart(o.length_squared(), r), discriminant);
        Some(ends.map_or(Chord::NONE, |ends| Chord { ends, parts: [0; 2] }))
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        if self.radii.min_element() != self.radii.max_element() {
            return Err("what lies at one distance from an ellipsoid is no ellipsoid");
        }
        let radii = self.radii + by;
        let left = 0.0 < self.radii.x && 0.0 < radii.x;
        Ok(left.then(|| Arc::new(Sphere { center: self.center, radii }) as Arc<dyn Solid>))
    }

    fn exact(&self) -> Option<Exact> {
        let DVec3 { x, y, z } = self.radii;
        let area = (x == y && y == z).then_some(4.0 * PI * x * x);
        Some(Exact { volume: 4.0 / 3.0 * PI * x * y * z, area })
    }

    fn cost(&self) -> Cost {
        Cost::Closed
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let p = ray.at(crossing.t) - self.center;
        if self.radii == DVec3::splat(self.radii.x) {
            return p.normalize();
        }
        // In two steps, as a square may have no room.
        (p / self.radii / self.radii).normalize()
    }
}

/// That of a t^2 + 2 b t + |o|^2 - r^2, with a = |d|^2 and b = o . d: a r^2 - |o x d|^2 (Lagrange), whose error is that of the
/// line's distance from the centre, eps |o|, however far the origin lies. Near the rim, where the difference loses digits, and where
/// squares have no room, it is a (r^2 - |foot|^2) with the point nearest to the centre.
#[inline]
fn discriminant(o: DVec3, d: DVec3, [a, b]: [f64; 2], r: f64) -> f64 {
    let whole = a * (r * r);
    let difference = whole - o.cross(d).length_squared();
    if 0.125 * whole < difference.abs() {
        return difference;
    }
    let foot = o - (b / a) * d;
    -a * squares_apart(foot.length_squared(), r)
}

/// A length squared less r squared. Where they are near each other it is the product of sum and difference: that is exact
/// where the length is, as on rays along an axis, so that touching and grazing lines are told apart; where they are not, no
/// digit is lost by the short way.
#[inline]
fn squares_apart(squared: f64, r: f64) -> f64 {
    let other = r * r;
    if squared < 0.5 * other || 2.0 * other < squared {
        return squared - other;
    }
    let length = squared.sqrt();
    (length - r) * (length + r)
}
