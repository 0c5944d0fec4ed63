//! Capsules: all points nearer to a segment than a radius.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Exact, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray};
use crate::num::roots::ball;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "capsule",
        group: Group::Primitive,
        doc: "A cylinder with half a ball on either end: all points nearer to a segment than r.",
        params: &[
            Param::required("r", Kind::Size, "radius"),
            Param::required("from", Kind::Vector(3), "centre of one ball"),
            Param::required("to", Kind::Vector(3), "centre of the other"),
        ],
        example: "capsule(r: 0.5, from: [0, 0, 0], to: [0, 0, 2])",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let end = |name| call.vec3(name).unwrap_or(DVec3::ZERO);
    Ok(Arc::new(Capsule::new(call.number("r").unwrap_or(0.0), end("from"), end("to"))))
}

/// All points nearer to a segment than a radius; a ball where its ends coincide.
#[derive(Clone, Copy, Debug)]
pub struct Capsule {
    from: DVec3,
    to: DVec3,
    /// Rows: two unit vectors across, one along the axis.
    across_along: DMat3,
    radius: f64,
    /// Half the length of the segment.
    half: f64,
    /// The middle of the segment.
    middle: DVec3,
}

impl Capsule {
    /// About the segment between two points; nothing where the radius is zero.
    pub fn new(radius: f64, from: DVec3, to: DVec3) -> Capsule {
        let axis = (to - from).try_normalize().unwrap_or(DVec3::Z);
        let (u, v) = axis.any_orthonormal_pair();
        Capsule {
            from,
            to,
            across_along: DMat3::from_cols(u, v, axis).transpose(),
            radius,
            half: 0.5 * from.distance(to),
            middle: 0.5 * (from + to),
        }
    }

    /// The part of the ray's line inside.
    ///
    /// The union of the cylinder between the flat ends and two balls. It is convex, so where a line meets more than one
    /// of them the parts hang together, and the lowest beginning and the highest end are the capsule's own.
    pub fn span(&self, ray: &Ray) -> Option<[f64; 2]> {
        let (shift, o) = ray.nearest_to(self.middle);
        let reach = self.half + self.radius;
        if reach * reach * (1.0 + MARGIN) < o.length_squared() {
            return None;
        }
        let (o, d) = (self.across_along * o, self.across_along * ray.dir);
        let end = self.half * DVec3::Z;
        let flat = DVec3::new(1.0, 1.0, 0.0);
        let wall = ball(o * flat, d * flat, self.radius).and_then(|[lo, hi]| {
            if d.z == 0.0 {
                return (o.z.abs() < self.half).then_some([lo, hi]);
            }
            let (a, b) = ((-self.half - o.z) / d.z, (self.half - o.z) / d.z);
            let (lo, hi) = (lo.max(a.min(b)), hi.min(a.max(b)));
            (lo < hi).then_some([lo, hi])
        });
        let parts = [wall, ball(o + end, d, self.radius), ball(o - end, d, self.radius)];
        let hull = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let [lo, hi] = parts.into_iter().flatten().reduce(hull)?;
        let (lo, hi) = (shift + lo, shift + hi);
        (lo < hi).then_some([lo, hi])
    }

    /// The outward unit normal at a point of the boundary.
    pub fn normal_at(&self, at: DVec3) -> DVec3 {
        let axis = self.across_along.transpose().z_axis;
        let p = at - self.middle;
        let along = p.dot(axis).clamp(-self.half, self.half);
        (p - along * axis).try_normalize().unwrap_or(axis)
    }

    /// A box around the image.
    pub fn extent(&self, to_from: &DAffine3) -> Aabb {
        // The image of the unit ball under M reaches the length of M's row along each axis.
        let rows = to_from.matrix3.transpose();
        let reach =
            self.radius * DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        let ends = [self.from, self.to].map(|p| to_from.transform_point3(p));
        Aabb { min: ends[0].min(ends[1]) - reach, max: ends[0].max(ends[1]) + reach }
    }
}

/// By how much the ball around is taken wider, a share of its squared radius: it spares work and decides nothing, so
/// it only has to be above rounding.
const MARGIN: f64 = 1.0 / 64.0;

impl Solid for Capsule {
    fn bounds(&self) -> Aabb {
        self.extent(&DAffine3::IDENTITY)
    }

    fn exact(&self) -> Option<Exact> {
        let (r, h) = (self.radius, 2.0 * self.half);
        Exact::new(PI * r * r * (h + 4.0 / 3.0 * r), 2.0 * PI * r * (h + 2.0 * r))
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.extent(to_from)
    }

    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        if let Some([lo, hi]) = self.span(ray) {
            out.push(Crossing::exact(lo, true, 0));
            out.push(Crossing::exact(hi, false, 0));
        }
        Answer::whole_line(false)
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        let radius = self.radius + by;
        let left = 0.0 < self.radius && 0.0 < radius;
        Ok(left.then(|| Arc::new(Capsule::new(radius, self.from, self.to)) as Arc<dyn Solid>))
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        self.normal_at(ray.at(crossing.t))
    }
}
