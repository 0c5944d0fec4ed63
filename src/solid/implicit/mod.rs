//! Implicit solids: the points of a bounded shape where a formula of x, y and z is at most zero.
//!
//! [`tape`] evaluates the formula, [`roots`] finds where it changes sign along a ray, [`stretches`] asks it only for the part
//! of the ray that is asked about. The solid ends where the box around
//! the bounding shape ends; that it ends at the shape itself is left to set algebra.

mod hull;
mod jumps;
mod roots;
mod stretches;
mod tape;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::block::Block;
use super::table::{Build, Primitive};
use super::{Answer, Cost, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::scene::{BuildError, Call, Decl, Formula, Group, Kind, Param, Value};

use roots::Line;
use stretches::Stretches;
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
    /// What the formula leaves of the box around what bounds it.
    hull: Aabb,
    /// The box in which it is traced: see [`traced`].
    traced: Aabb,
}

/// Parts of the boundary below this are faces of the box, numbered as [`Block`] does; this one is the formula's own surface.
const SURFACE: u32 = 6;

impl Implicit {
    /// A formula within a box; nothing where the box is empty or unbounded.
    pub fn new(formula: Arc<Formula>, bounds: Aabb) -> Implicit {
        let bounded = bounds.is_finite() && !bounds.is_empty();
        let hull = if bounded { hull::hull(&formula, &bounds, &DAffine3::IDENTITY) } else { Aabb::EMPTY };
        let traced = if bounded { traced(&hull, &bounds) } else { Aabb::EMPTY };
        Implicit { formula, hull, traced }
    }
}

/// How much smaller than the box asked a hull is, along two axes, before it is traced in a box of its own: what is flat is met by lines
/// across it.
const SMALL: f64 = 0.25;

/// The box asked, or where the hull is small in it one around that; by [`tolerance::MARGIN`] larger. Corners of the latter are
/// multiples of a power of two some hundredths of its size: so the middle of a ray's part has few digits, and is by symmetry what it
/// seems, so that how the formula rounds there does not follow from how far the hull was proved.
fn traced(hull: &Aabb, asked: &Aabb) -> Aabb {
    let whole = asked.inflated(tolerance::MARGIN * asked.size().max_element());
    let size = hull.size().max_element();
    let unit = f64::from_bits(size.max(0.0).to_bits() >> 52 << 52) / 64.0;
    let mut shares = (hull.size() / asked.size()).to_array();
    shares.sort_by(f64::total_cmp);
    if hull.is_empty() || unit <= 0.0 || SMALL <= shares[1] {
        return whole;
    }
    let hull = hull.inflated(tolerance::MARGIN * size);
    let own = Aabb { min: (hull.min / unit).floor() * unit, max: (hull.max / unit).ceil() * unit };
    if own.is_finite() { own.intersection(whole) } else { whole }
}

impl Solid for Implicit {
    fn bounds(&self) -> Aabb {
        self.traced
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        let image = self.hull.transformed(to_from);
        let DMat3 { x_axis, y_axis, z_axis } = to_from.matrix3;
        let turned = to_from.matrix3 != DMat3::from_diagonal(DVec3::new(x_axis.x, y_axis.y, z_axis.z));
        if self.hull.is_empty() || !turned {
            return image;
        }
        // The way back is the inverse to roundings.
        let own = hull::hull(&self.formula, &self.hull, to_from);
        own.inflated(tolerance::noise(image.farthest())).intersection(image)
    }

    /// Stretches of the ray's part in the box, from where the range begins until one with a crossing is done: see
    /// [`Stretches`].
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        let first = out.len();
        Block(self.traced).crossings(ray, range, scratch, out);
        let &[enter, exit] = &out[first..] else { return Answer::whole_line(false) };
        out.truncate(first);
        if exit.t <= range.lo {
            return Answer { inside: false, range: Interval::new(range.lo, f64::INFINITY) };
        }
        let mut room = std::mem::take(&mut scratch.implicit);
        let mut roots = std::mem::take(&mut room.roots);
        let stretches = Stretches::new(enter, exit, range);
        let mut line = Line {
            formula: &self.formula,
            origin: ray.at(stretches.middle),
            dir: ray.dir,
            room: &mut room,
            failures: 0,
        };
        let answer = stretches.answer(&mut line, &mut roots, out);
        scratch.counts.certificate_failures += line.failures;
        room.roots = roots;
        scratch.implicit = room;
        answer
    }

    /// The gradient of the formula, turned so that it points out as the crossing says: at a pole, and where the domain of
    /// the formula ends, its values fall outward; at a jump it is that of what jumps. Where it has none, against or along the ray.
    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        if crossing.part != SURFACE {
            return Block(self.traced).normal(ray, crossing, scratch);
        }
        let reach = (2.0 * crossing.err + tolerance::STRETCH * crossing.t.abs()) * ray.dir;
        let (p, room) = (ray.at(crossing.t), &mut scratch.implicit);
        // At a pole itself nothing is known; just beside it the gradient is that of what goes to zero there.
        let places = [p, p - reach, p + reach].into_iter();
        let mut gradients = places.map(|p| tape::gradient(&self.formula.steps, p, reach, room).1);
        let of_some_size = |g: &DVec3| g.is_finite() && *g != DVec3::ZERO;
        let gradient = gradients.find(of_some_size).unwrap_or(DVec3::ZERO);
        let largest = gradient.abs().max_element();
        let against = if crossing.entering { -ray.dir } else { ray.dir };
        let normal = (gradient / largest).try_normalize().unwrap_or_else(|| unit(against));
        if normal.dot(against) < 0.0 { -normal } else { normal }
    }

    fn cost(&self) -> Cost {
        Cost::Heavy
    }
}

/// A vector of any length as a unit vector.
fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize_or_zero()
}
