//! Half-spaces.

use std::sync::Arc;

use glam::DVec3;

use super::table::{Build, Primitive};
use super::{Chord, Cost, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Lean, Ray};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "half_space",
        group: Group::Primitive,
        doc: "Everything on one side of a plane: a condition on x, y, z, or an outward normal and a point.",
        params: &[
            Param::placed("where", Kind::HalfSpace, "a linear condition, such as z < 60"),
            Param::named("normal", Kind::Vector(3), "points out of the solid"),
            Param::named("at", Kind::Vector(3), "a point of the plane (default the origin)"),
        ],
        example: "half_space(z < 60)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let wrong = |param, message: &str| BuildError {
        param,
        message: message.into(),
        help: "write `half_space(z < 60)` or `half_space(normal: [0, 0, 1], at: [0, 0, 60])`".into(),
    };
    let (normal, offset, param) = match (call.get("where"), call.vec3("normal")) {
        (Some(Value::HalfSpace { normal, offset }), None) if call.get("at").is_none() => {
            (*normal, *offset, "where")
        }
        (None, Some(normal)) => (normal, normal.dot(call.vec3("at").unwrap_or(DVec3::ZERO)), "normal"),
        (None, None) => return Err(wrong("", "a half-space needs a condition or a normal")),
        _ => return Err(wrong("", "a half-space has either a condition or a normal and a point")),
    };
    let length = normal.length();
    if length == 0.0 || !length.is_finite() {
        return Err(wrong(param, "the plane of the half-space has no direction"));
    }
    Ok(Arc::new(HalfSpace { normal: normal / length, offset: offset / length }))
}

/// Points with `normal . p < offset`; a ray that runs in the plane is inside where it leans to.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpace {
    /// Outward, of unit length.
    pub normal: DVec3,
    /// Signed distance of the plane from the origin.
    pub offset: f64,
}

impl Solid for HalfSpace {
    fn bounds(&self) -> Aabb {
        Aabb::ALL
    }

    fn limits(&self) -> [Aabb; 2] {
        let mut limits = [Aabb::ALL; 2];
        if let Some(axis) = (0..3).find(|axis| self.normal.abs() == DVec3::AXES[*axis]) {
            let [below, above] = &mut limits;
            below.max[axis] = self.offset;
            above.min[axis] = self.offset;
            if self.normal[axis] < 0.0 {
                (below.max[axis], above.min[axis]) = (f64::INFINITY, f64::NEG_INFINITY);
                (below.min[axis], above.max[axis]) = (-self.offset, -self.offset);
            }
        }
        limits
    }

    fn chord(&self, ray: &Ray, lean: &Lean) -> Option<Chord> {
        let (height, slope) = (self.offset - self.normal.dot(ray.origin), self.normal.dot(ray.dir));
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let ends = if slope == 0.0 {
            let leans_in = || height == 0.0 && lean.dot(self.normal) < 0.0;
            if 0.0 < height || leans_in() { all } else { Chord::NONE.ends }
        } else if slope < 0.0 {
            [height / slope, all[1]]
        } else {
            [all[0], height / slope]
        };
        Some(Chord { ends, parts: [0; 2] })
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        Ok(Some(Arc::new(HalfSpace { normal: self.normal, offset: self.offset + by })))
    }

    fn cost(&self) -> Cost {
        Cost::Closed
    }

    fn normal(&self, _: &Ray, _: &Crossing, _: &mut Scratch) -> DVec3 {
        self.normal
    }
}
