//! Boxes.

use std::sync::Arc;

use glam::DVec3;

use super::rounded_box::RoundedBox;
use super::table::{Build, Primitive};
use super::{Chord, Cost, Crossing, Exact, Scratch, Solid};
use crate::geom::lean::is_between;
use crate::geom::{Aabb, Lean, Ray};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "box",
        group: Group::Primitive,
        doc: "A box with its sides along the axes: two corners in any order, or a size about a centre.",
        params: &[
            Param::placed("a", Kind::Vector(3), "a corner"),
            Param::placed("b", Kind::Vector(3), "the opposite corner"),
            Param::named("size", Kind::SizeOrVector, "edge lengths, or one for all"),
            Param::named("at", Kind::Vector(3), "centre, with size (default the origin)"),
            Param::named(
                "round",
                Kind::Length,
                "radius of rounded edges, up to half the shortest (default 0)",
            ),
        ],
        example: "box([0, 0, 0], [1, 1, 1])",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let corners = (call.vec3("a"), call.vec3("b"));
    let size = match call.get("size") {
        Some(Value::Vector(v)) if v.len() == 3 => Some(DVec3::new(v[0], v[1], v[2])),
        Some(Value::Number(s)) => Some(DVec3::splat(*s)),
        _ => None,
    };
    let center = call.vec3("at").unwrap_or(DVec3::ZERO);
    let wrong = |param, message: &str| {
        let help = "write `box([0, 0, 0], [1, 1, 1])` or `box(size: [1, 1, 1], at: [0, 0, 0])`";
        Err(BuildError { param, message: message.into(), help: help.into() })
    };
    match (corners, size) {
        ((Some(a), Some(b)), None) if call.get("at").is_none() => {
            rounded(Aabb { min: a.min(b), max: a.max(b) }, call)
        }
        ((None, None), Some(size)) => {
            rounded(Aabb { min: center - 0.5 * size, max: center + 0.5 * size }, call)
        }
        ((Some(_), Some(_)), None) => wrong("at", "`at` goes with `size`, not with two corners"),
        (_, Some(_)) => wrong("size", "a box has either two corners or a size"),
        ((Some(_), None) | (None, Some(_)), None) => wrong("a", "a box needs two corners"),
        ((None, None), None) => wrong("", "a box needs two corners or a size"),
    }
}

/// A box with the edges that a call asks for.
fn rounded(bounds: Aabb, call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let radius = call.number("round").unwrap_or(0.0);
    let most = 0.5 * bounds.size().min_element();
    let wrong = |message: String, help: String| Err(BuildError { param: "round", message, help });
    if radius < 0.0 {
        return wrong("`round` is negative".into(), "a radius is zero or more".into());
    }
    if 0.0 < most && most < radius {
        let message = format!("`round` is {radius}, more than half of the shortest edge");
        return wrong(message, format!("write at most {most}"));
    }
    Ok(if 0.0 < radius && 0.0 < most {
        Arc::new(RoundedBox { outer: bounds, radius })
    } else {
        Arc::new(Block(bounds))
    })
}

/// The points of a box, perhaps unbounded. A ray that runs in a face is inside where it leans to.
#[derive(Clone, Copy, Debug)]
pub struct Block(pub Aabb);

impl Solid for Block {
    fn bounds(&self) -> Aabb {
        self.0
    }

    fn chord(&self, ray: &Ray, lean: &Lean) -> Option<Chord> {
        let (o, d) = (ray.origin, ray.dir);
        let level = d.cmpeq(DVec3::ZERO);
        let (low, high) = ((self.0.min - o) / d, (self.0.max - o) / d);
        let ahead = d.cmpgt(DVec3::ZERO);
        let (mut near, mut far) = (DVec3::select(ahead, low, high), DVec3::select(ahead, high, low));
        if level.any() {
            for axis in (0..3).filter(|axis| level.test(*axis)) {
                if !is_between(o[axis], self.0.min[axis], self.0.max[axis], lean.along(axis)) {
                    return Some(Chord::NONE);
                }
                (near[axis], far[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
        }
        let (mut enter, mut exit) = ((near.x, 0), (far.x, 0));
        for axis in [1, 2] {
            enter = if enter.0 < near[axis] { (near[axis], axis) } else { enter };
            exit = if far[axis] < exit.0 { (far[axis], axis) } else { exit };
        }
        let face = |axis: usize, back: bool| 2 * axis as u32 + u32::from(back != (d[axis] < 0.0));
        Some(Chord::between((enter.0, face(enter.1, false)), (exit.0, face(exit.1, true))))
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        let moved = self.0.inflated(by);
        if !self.0.min.cmplt(self.0.max).all() || !moved.min.cmplt(moved.max).all() {
            return Ok(None);
        }
        // A slab has no edges.
        let finite = self.0.min.is_finite_mask() | self.0.max.is_finite_mask();
        let slab = finite.bitmask().count_ones() <= 1;
        Ok(Some(if by <= 0.0 || slab {
            Arc::new(Block(moved))
        } else if self.0.is_finite() {
            Arc::new(RoundedBox { outer: moved, radius: by })
        } else {
            return Err("what lies near an unbounded box has rounded edges");
        }))
    }

    fn exact(&self) -> Option<Exact> {
        Exact::new(self.0.size().element_product(), self.0.surface())
    }

    fn cost(&self) -> Cost {
        Cost::Closed
    }

    fn normal(&self, _: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let axis = DVec3::AXES[(crossing.part / 2) as usize];
        if crossing.part.is_multiple_of(2) { -axis } else { axis }
    }
}
