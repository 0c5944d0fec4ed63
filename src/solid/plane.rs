//! Planes as sheets: floors and backdrops.

use std::sync::Arc;

use glam::DVec3;

use super::block::Block;
use super::table::{Build, Primitive};
use super::{Answer, Body, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "plane",
        group: Group::Primitive,
        doc: "A plane across one axis, such as a floor. A Sheet: it has no inside.",
        params: &[
            Param::named("z", Kind::Length, "a floor at this height"),
            Param::named("x", Kind::Length, "a wall across x"),
            Param::named("y", Kind::Length, "a wall across y"),
        ],
        example: "plane(z: 0)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let given: Vec<(DVec3, f64)> = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)]
        .into_iter()
        .filter_map(|(name, axis)| call.number(name).map(|at| (axis, at)))
        .collect();
    match given[..] {
        [(normal, at)] => Ok(Arc::new(Plane { normal, at })),
        _ => Err(BuildError {
            param: "",
            message: "a plane lies across exactly one axis".into(),
            help: "write `plane(z: 0)`; for a solid below it, `half_space(z < 0)`".into(),
        }),
    }
}

/// Points with `normal . p = at`.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Along an axis.
    pub normal: DVec3,
    /// The coordinate.
    pub at: f64,
}

impl Solid for Plane {
    fn body(&self) -> Body {
        Body::Sheet
    }

    fn bounds(&self) -> Aabb {
        Aabb::ALL
    }

    fn crossings(&self, ray: &Ray, range: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let slope = self.normal.dot(ray.dir);
        if slope != 0.0 {
            let t = (self.at - self.normal.dot(ray.origin)) / slope;
            if range.lo < t {
                out.push(Crossing::exact(t, slope < 0.0, 0));
            }
        }
        Answer { inside: false, range: Interval::new(range.lo, f64::INFINITY) }
    }

    fn thickened(&self, by: f64) -> Option<Arc<dyn Solid>> {
        let along = self.normal.cmpeq(DVec3::ONE);
        let face = |far: f64, near: f64| DVec3::select(along, DVec3::splat(near), DVec3::splat(far));
        let min = face(f64::NEG_INFINITY, self.at - 0.5 * by);
        let max = face(f64::INFINITY, self.at + 0.5 * by);
        Some(Arc::new(Block(Aabb { min, max })))
    }

    fn normal(&self, _: &Ray, _: &Crossing, _: &mut Scratch) -> DVec3 {
        self.normal
    }
}
