//! Superellipsoids: from box over ball to octahedron.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray};
use crate::num::convex::{Bend, Knot, roots};
use crate::num::power::{exp, ln, ln_1p};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "superellipsoid",
        group: Group::Primitive,
        doc: "A ball with squarer (towards 0) or sharper (towards 2) sections: e1 across z, e2 along it; 1 is round.",
        params: &[
            Param::required("r", Kind::SizeOrVector, "reach along the axes, or one for all"),
            Param::named("e1", Kind::Positive, "exponent of the section across z, up to 2 (default 1)"),
            Param::named("e2", Kind::Positive, "exponent of the sections along z, up to 2 (default 1)"),
            Param::named("at", Kind::Vector(3), "centre (default the origin)"),
        ],
        example: "superellipsoid(r: 1, e1: 0.4, e2: 0.6)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let radii = match call.get("r") {
        Some(Value::Vector(v)) if v.len() == 3 => DVec3::new(v[0], v[1], v[2]),
        _ => DVec3::splat(call.number("r").unwrap_or(0.0)),
    };
    let mut powers = [2.0; 2];
    for (power, param) in powers.iter_mut().zip(["e1", "e2"]) {
        let e = call.number(param).unwrap_or(1.0);
        if MOST < e {
            let message = format!("`{param}` is above 2, where a superellipsoid has hollows");
            let help = "write 2 for flat faces, less for round ones".into();
            return Err(BuildError { param, message, help });
        }
        *power = 2.0 / e;
    }
    let center = call.vec3("at").unwrap_or(DVec3::ZERO);
    Ok(Arc::new(Superellipsoid { center, radii, powers }))
}

/// The largest exponent with which the shape is convex.
const MOST: f64 = 2.0;

/// Points p with G(x / rx, y / ry, z / rz) < 1 about the centre, where
///
/// G(x, y, z) = (N^q + |z|^q)^(1/q), N = (|x|^p + |y|^p)^(1/p), p = 2 / e1, q = 2 / e2.
///
/// This is (|x|^(2/e1) + |y|^(2/e1))^(e1/e2) + |z|^(2/e2) < 1 (Barr 1981, with e1 the east-west exponent and e2 the
/// north-south one, the order of POV-Ray's `<e, n>`) taken to a power at which it is a length: for exponents up to 2, G
/// is a norm, convex along every line, and 1 - G is on the scale of a distance however extreme the exponents are.
#[derive(Clone, Copy, Debug)]
pub struct Superellipsoid {
    /// The centre.
    pub center: DVec3,
    /// Reach along each axis.
    pub radii: DVec3,
    /// p across z and q along it, both from 1 up.
    pub powers: [f64; 2],
}

/// The norm (x^p + y^p)^(1/p) of x, y >= 0, and its derivatives by them: with the larger taken out of the bracket no
/// power of it over- or underflows to harm.
fn norm(x: f64, y: f64, p: f64) -> [f64; 3] {
    let (large, small) = if x < y { (y, x) } else { (x, y) };
    if large == 0.0 {
        return [0.0; 3];
    }
    // Where the square does not underflow.
    if p == 2.0 && f64::MIN_POSITIVE < large * large {
        let length = (x * x + y * y).sqrt();
        return [length, x / length, y / length];
    }
    let ratio = small / large;
    let u = exp(p * ln(ratio));
    let l = ln_1p(u) / p;
    let by_large = exp((1.0 - p) * l);
    let by_small = if u == 0.0 { 0.0 } else { by_large * (u / ratio) };
    let [by_x, by_y] = if x < y { [by_small, by_large] } else { [by_large, by_small] };
    [large * exp(l), by_x, by_y]
}

/// The dual norm: how far the unit ball of the norm with power p reaches along (x, y).
fn reach(x: f64, y: f64, p: f64) -> f64 {
    if p == 1.0 { x.max(y) } else { norm(x, y, p / (p - 1.0))[0] }
}

/// By how much the range of a search is taken wider than the box around: its ends are then well outside. It decides
/// nothing.
const AROUND: f64 = 1.0 + 1.0 / 16.0;

impl Superellipsoid {
    /// G - 1 and its derivative along the line o + u d, in units of the radii.
    fn at(&self, o: DVec3, d: DVec3, u: f64) -> [f64; 2] {
        let at = o + u * d;
        let (size, sign) = (at.abs(), at.signum());
        let [across, by_x, by_y] = norm(size.x, size.y, self.powers[0]);
        let [value, by_across, by_z] = norm(across, size.z, self.powers[1]);
        let gradient = DVec3::new(by_across * by_x, by_across * by_y, by_z) * sign;
        [value - 1.0, gradient.dot(d)]
    }
}

impl Solid for Superellipsoid {
    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radii, max: self.center + self.radii }
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        let rows = (to_from.matrix3 * glam::DMat3::from_diagonal(self.radii)).transpose();
        let [p, q] = self.powers;
        let far = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| {
            let row = row.abs();
            reach(reach(row.x, row.y, p), row.z, q)
        });
        let (center, far) = (to_from.transform_point3(self.center), DVec3::from_array(far));
        Aabb { min: center - far, max: center + far }
    }

    /// G is convex along the line: at most one entry and one exit.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let miss = Answer::whole_line(false);
        if self.radii.min_element() <= 0.0 {
            return miss;
        }
        let unit = Ray::new((ray.origin - self.center) / self.radii, ray.dir / self.radii);
        let (shift, o) = unit.nearest_to(DVec3::ZERO);
        let d = unit.dir;
        let cube = Aabb { min: DVec3::splat(-AROUND), max: DVec3::splat(AROUND) };
        let range = cube.clip(&Ray { origin: o, dir: d });
        if range.is_empty() {
            return miss;
        }
        let knot = |u: f64| {
            let [y, slope] = self.at(o, d, u);
            Knot { x: u, y, slope }
        };
        let first = out.len();
        roots(
            |u| self.at(o, d, u),
            knot(range.lo),
            knot(range.hi),
            Bend::Up,
            |u| {
                out.push(Crossing::exact(shift + u, out.len() == first, 0));
            },
        );
        if matches!(out[first..], [a, b] if b.t <= a.t) {
            out.truncate(first);
        }
        miss
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let p = (ray.at(crossing.t) - self.center) / self.radii;
        let gradient = DVec3::AXES.map(|axis| self.at(p, axis, 0.0)[1]);
        (DVec3::from_array(gradient) / self.radii).try_normalize().unwrap_or(DVec3::Z)
    }
}
