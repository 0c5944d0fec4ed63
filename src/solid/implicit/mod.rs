//! Implicit solids: the points of a bounded shape where a formula of x, y and z is at most zero.
//!
//! [`tape`] evaluates the formula, [`roots`] finds where it changes sign along a ray. The solid ends where the box around
//! the bounding shape ends; that it ends at the shape itself is left to set algebra.

mod roots;
mod tape;

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::block::Block;
use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::scene::{BuildError, Call, Decl, Formula, Group, Kind, Param, Value};

use roots::Line;
pub use tape::Room;

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "implicit",
        group: Group::Primitive,
        doc: "The points inside a bounded solid where a condition on x, y and z holds.",
        params: &[
            Param {
                required: true,
                ..Param::placed("where", Kind::Condition, "a condition, such as x*y*z <= 1")
            },
            Param::required("inside", Kind::Solid, "bounds the solid: their intersection"),
        ],
        example: "implicit(x**2 + y**2 + z**2 <= 1, inside: box(size: 2.5))",
    },
    build: Build::Bounded { by: "inside", build },
};

fn build(call: &Call, bounds: &Aabb) -> Result<Arc<dyn Solid>, BuildError> {
    let Some(Value::Formula(formula)) = call.get("where") else {
        return Err(BuildError {
            param: "where",
            message: "an implicit solid needs a condition".into(),
            help: "write `implicit(x**2 + y**2 + z**2 <= 1, inside: box(size: 2.5))`".into(),
        });
    };
    Ok(Arc::new(Implicit::new(formula.clone(), *bounds)))
}

/// Points of a box where a formula holds; where its value is not finite it does not hold.
#[derive(Clone, Debug)]
pub struct Implicit {
    formula: Arc<Formula>,
    bounds: Aabb,
    /// The box in which it is traced: a little larger, see [`tolerance::MARGIN`].
    traced: Aabb,
}

/// Parts below this are faces of the box, numbered as [`Block`] does; this one is the formula's own surface.
const SURFACE: u32 = 6;

impl Implicit {
    /// A formula within a box; nothing where the box is empty or unbounded.
    pub fn new(formula: Arc<Formula>, bounds: Aabb) -> Implicit {
        let traced = match bounds.is_finite() && !bounds.is_empty() {
            true => bounds.inflated(tolerance::MARGIN * bounds.size().max_element()),
            false => Aabb::EMPTY,
        };
        Implicit { formula, bounds, traced }
    }
}

impl Solid for Implicit {
    fn bounds(&self) -> Aabb {
        self.traced
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.bounds.transformed(to_from)
    }

    /// The ray's part in the box, its parameter counted from the middle of that part, so that a far origin costs nothing
    /// but what its own rounding costs; in it all changes of sign. The box ends the solid where the formula holds there.
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        let outside = Answer::whole_line(false);
        let first = out.len();
        Block(self.traced).crossings(ray, range, scratch, out);
        let &[enter, exit] = &out[first..] else { return outside };
        out.truncate(first);
        let mut room = std::mem::take(&mut scratch.implicit);
        let mut roots = std::mem::take(&mut room.roots);
        roots.clear();
        let middle = 0.5 * (enter.t + exit.t);
        let (lo, hi) = (enter.t - middle, exit.t - middle);
        let mut line = Line { formula: &self.formula, origin: ray.at(middle), dir: ray.dir, room: &mut room };
        scratch.counts.certificate_failures += line.isolate(lo, hi, &mut roots);
        let ends = [line.inside(lo), line.inside(hi)];
        if ends[0] {
            out.push(enter);
        }
        for root in &roots {
            let t = (middle + root.s).clamp(enter.t, exit.t);
            let crossing = Crossing { err: root.err, ..Crossing::exact(t, root.entering, SURFACE) };
            push(out, first, crossing);
        }
        if ends[1] {
            push(out, first, exit);
        }
        room.roots = roots;
        scratch.implicit = room;
        outside
    }

    /// The gradient of the formula, turned so that it points out as the crossing says: at a pole, and where the domain of
    /// the formula ends, its values fall outward. Where it has none, against or along the ray.
    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        if crossing.part != SURFACE {
            return Block(self.traced).normal(ray, crossing, scratch);
        }
        let (_, gradient) = tape::gradient(&self.formula.steps, ray.at(crossing.t), &mut scratch.implicit);
        let largest = gradient.abs().max_element();
        let against = if crossing.entering { -ray.dir } else { ray.dir };
        let normal = (gradient / largest).try_normalize().unwrap_or_else(|| unit(against));
        if normal.dot(against) < 0.0 { -normal } else { normal }
    }

    fn is_costly(&self) -> bool {
        true
    }
}

/// A vector of any length as a unit vector.
fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize_or_zero()
}

/// Appends a crossing; two at one place are none.
fn push(out: &mut Vec<Crossing>, first: usize, crossing: Crossing) {
    match out[first..].last() {
        Some(last) if crossing.t <= last.t => {
            out.pop();
        }
        _ => out.push(crossing),
    }
}
