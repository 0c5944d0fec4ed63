//! Tori.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Exact, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::num::convex::{Bend, Knot, roots};
use crate::num::roots::cube_root;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "torus",
        group: Group::Primitive,
        doc: "A torus around z: all points nearer than minor to a circle of radius major. Where minor is the larger, it has no hole.",
        params: &[
            Param::required("major", Kind::Size, "radius of the circle"),
            Param::required("minor", Kind::Size, "radius of the tube"),
            Param::named("at", Kind::Vector(3), "centre (default the origin)"),
        ],
        example: "torus(major: 1, minor: 0.4)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let size = |name| call.number(name).unwrap_or(0.0);
    let center = call.vec3("at").unwrap_or(DVec3::ZERO);
    Ok(Arc::new(Torus { center, major: size("major"), minor: size("minor") }))
}

/// All points nearer than `minor` to a circle of radius `major` around the z axis: with rho the distance from the axis,
/// (rho - major)^2 + z^2 < minor^2. A spindle torus (minor > major) is all of what its outer sheet encloses.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    /// The centre.
    pub center: DVec3,
    /// Radius of the circle.
    pub major: f64,
    /// Radius of the tube.
    pub minor: f64,
}

/// By how much the range of a search is taken wider than the torus: its ends are then well outside, where the sign of
/// the function is beyond doubt. It decides nothing.
const AROUND: f64 = 1.0 + 1.0 / 16.0;

/// A line in the torus's frame, about the point nearest to the centre.
///
/// g(u) = (rho - R)^2 + z^2 - r^2 with z = z0 + u dz and rho = sqrt(q w^2 + m^2): w = u - v is counted from the point
/// nearest to the axis, m is the distance from it, q = dx^2 + dy^2. So
///
/// g'' = 2 a - 2 R q m^2 / rho^3, with a = |d|^2,
///
/// rises with rho: g is concave where rho < rho* = (R q m^2 / a)^(1/3), convex outside. No quartic is expanded: it has
/// twice the roots for a spindle torus, and its coefficients lose the digits that g keeps.
struct Line {
    major: f64,
    minor: f64,
    z: [f64; 2],
    q: f64,
    v: f64,
    m: f64,
}

impl Line {
    fn new(torus: &Torus, o: DVec3, d: DVec3) -> Line {
        let (o2, d2) = (o.truncate(), d.truncate());
        let mut line = Line { major: torus.major, minor: torus.minor, z: [o.z, d.z], q: 0.0, v: 0.0, m: 0.0 };
        let q = d2.length_squared();
        // A line that strays from the axis's direction by less than rounding is parallel to it.
        if q <= tolerance::EPS * tolerance::EPS * d.length_squared() {
            line.m = o2.length();
        } else {
            (line.q, line.v, line.m) = (q, -o2.dot(d2) / q, o2.perp_dot(d2).abs() / q.sqrt());
        }
        line
    }

    fn value(&self, rho: f64, z: f64) -> f64 {
        (rho - self.major - self.minor) * (rho - self.major + self.minor) + z * z
    }

    /// g and g'.
    fn at(&self, u: f64) -> [f64; 2] {
        let (w, z) = (u - self.v, self.z[0] + u * self.z[1]);
        let rho = (self.q * w * w + self.m * self.m).sqrt();
        let growth = if 0.0 < rho { self.q * w / rho } else { 0.0 };
        [self.value(rho, z), 2.0 * ((rho - self.major) * growth + z * self.z[1])]
    }

    fn knot(&self, u: f64) -> Knot {
        let [y, slope] = self.at(u);
        Knot { x: u, y, slope }
    }

    /// Where g'' changes its sign, given a: none, or two knots with all that is known of them beforehand, so that the
    /// kink that they become where the line meets the axis (m = 0) has its slopes from either side.
    fn inflections(&self, a: f64) -> Option<[Knot; 2]> {
        // In units of R: m < rho* asks m < R q / a.
        let (share, m) = (self.q / a, self.m / self.major);
        if share <= m {
            return None;
        }
        let rho = self.major * cube_root(share * m * m).max(m);
        let across = ((rho - self.m) * (rho + self.m)).sqrt();
        let growth = if 0.0 < rho { self.q.sqrt() * (across / rho) } else { self.q.sqrt() };
        Some([-1.0, 1.0].map(|side: f64| {
            let u = self.v + side * across / self.q.sqrt();
            let z = self.z[0] + u * self.z[1];
            let slope = 2.0 * ((rho - self.major) * side * growth + z * self.z[1]);
            Knot { x: u, y: self.value(rho, z), slope }
        }))
    }

    /// A range of u that holds all roots, with ends outside; `None` where there are none. `o2` is |o|^2.
    fn range(&self, o2: f64, a: f64) -> Option<[f64; 2]> {
        let reach = AROUND * (self.major + self.minor);
        let flat = AROUND * self.minor;
        let left = reach * reach - o2;
        if left <= 0.0 || self.major + self.minor <= self.m {
            return None;
        }
        let half = (left / a).sqrt();
        let [z, dz] = self.z;
        if dz == 0.0 {
            return (z.abs() < self.minor).then_some([-half, half]);
        }
        let (s, t) = ((-flat - z) / dz, (flat - z) / dz);
        let (lo, hi) = (s.min(t).max(-half), s.max(t).min(half));
        (lo < hi).then_some([lo, hi])
    }

    /// Hands every root in the range to `found`, ascending, piece by piece.
    fn roots(&self, [lo, hi]: [f64; 2], a: f64, mut found: impl FnMut(f64)) {
        let (first, last) = (self.knot(lo), self.knot(hi));
        let mut piece = |a: Knot, b: Knot, bend| roots(|u| self.at(u), a, b, bend, &mut found);
        let Some([left, right]) = self.inflections(a) else {
            return piece(first, last, Bend::Up);
        };
        let (begins, ends) = (lo < left.x, right.x < hi);
        if hi <= left.x || right.x <= lo {
            return piece(first, last, Bend::Up);
        }
        if begins {
            piece(first, left, Bend::Up);
        }
        let (near, far) = (if begins { left } else { first }, if ends { right } else { last });
        if near.x < far.x {
            piece(near, far, Bend::Down);
        }
        if ends {
            piece(right, last, Bend::Up);
        }
    }
}

impl Solid for Torus {
    fn bounds(&self) -> Aabb {
        self.extent_under(&DAffine3::IDENTITY)
    }

    /// Pappus and Guldin, of the ring; a spindle is none.
    fn exact(&self) -> Option<Exact> {
        let (major, minor) = (self.major, self.minor);
        let (volume, area) = (2.0 * PI * PI * major * minor * minor, 4.0 * PI * PI * major * minor);
        if minor <= major { Exact::new(volume, area) } else { None }
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        // Its convex hull is that of a disc and a ball added up; along each axis it reaches what both reach.
        let rows = to_from.matrix3.transpose();
        let reach = [rows.x_axis, rows.y_axis, rows.z_axis]
            .map(|row| self.major * row.truncate().length() + self.minor * row.length());
        let (center, reach) = (to_from.transform_point3(self.center), DVec3::from_array(reach));
        Aabb { min: center - reach, max: center + reach }
    }

    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let miss = Answer::whole_line(false);
        if self.major.min(self.minor) <= 0.0 {
            return miss;
        }
        let (shift, o) = ray.nearest_to(self.center);
        let line = Line::new(self, o, ray.dir);
        let a = ray.dir.length_squared();
        let Some(range) = line.range(o.length_squared(), a) else { return miss };
        let first = out.len();
        line.roots(range, a, |u| {
            let (t, count) = (shift + u, out.len());
            // Where it comes out and goes in again at one place it has not come out.
            if first < count && t <= out[count - 1].t {
                out.pop();
            } else {
                out.push(Crossing::exact(t, (count - first).is_multiple_of(2), 0));
            }
        });
        miss
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        if by < 0.0 && self.major < self.minor {
            return Err("what lies inside a torus without a hole is no torus");
        }
        let minor = self.minor + by;
        let left = 0.0 < self.major.min(self.minor) && 0.0 < minor;
        Ok(left.then(|| Arc::new(Torus { minor, ..*self }) as Arc<dyn Solid>))
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let p = ray.at(crossing.t) - self.center;
        let rho = p.truncate().length();
        let out = if 0.0 < rho { (rho - self.major) / rho } else { 0.0 };
        DVec3::new(out * p.x, out * p.y, p.z).try_normalize().unwrap_or(DVec3::Z)
    }
}
