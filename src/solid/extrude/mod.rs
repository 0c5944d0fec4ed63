//! Extrusions: an outline carried up along z, perhaps turned and scaled on the way.

mod extent;
mod flat;
mod turned;

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use super::outline::Outline;
use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid, parity};
use crate::geom::lean::is_between;
use crate::geom::{Aabb, Interval, Lean, Ray, tolerance};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "extrude",
        group: Group::Primitive,
        doc: "An outline in the plane z = 0 carried up to z = h, turned and scaled about the z axis on the way. \
              Several loops make holes: a point is inside where an odd number of loops surrounds it.",
        params: &[
            Param::placed("outline", Kind::Outline, "a list of points, or a list of such lists"),
            Param::required("h", Kind::Size, "height, from z = 0 up"),
            Param::named("twist", Kind::Angle, "by how much the top is turned (default 0deg)"),
            Param::named("scale", Kind::NumberOrPair, "size of the top relative to the outline (default 1)"),
        ],
        example: "extrude([[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]], h: 2)",
    },
    build: Build::Exact(build),
};

/// More than so many turns are no shape that a picture could show, and cost time for each.
const MOST_TURNS: f64 = 1000.0;

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let loops = call.loops("outline").ok_or_else(|| BuildError {
        param: "",
        message: "an extrusion needs an outline".into(),
        help: "write `extrude([[0, 0], [4, 0], [2, 3]], h: 2)`".into(),
    })?;
    let outline = Outline::new(loops, "outline")?;
    let scale = match call.get("scale") {
        Some(Value::Number(s)) => DVec2::splat(*s),
        Some(Value::Vector(v)) if v.len() == 2 => DVec2::new(v[0], v[1]),
        _ => DVec2::ONE,
    };
    if scale.min_element() < 0.0 {
        return Err(BuildError {
            param: "scale",
            message: "the top of an extrusion cannot have a negative size".into(),
            help: "write zero for a point, one for a prism".into(),
        });
    }
    let twist = call.angle("twist").unwrap_or(0.0);
    if MOST_TURNS * std::f64::consts::TAU < twist.abs() {
        return Err(BuildError {
            param: "twist",
            message: format!("a twist has at most {MOST_TURNS} turns"),
            help: "write a smaller angle, such as `90deg`".into(),
        });
    }
    Ok(Arc::new(Extrusion::new(outline, call.number("h").unwrap_or(0.0), twist, scale)))
}

/// The part of the boundary below all walls.
const BOTTOM: u32 = 0;
/// That above.
const TOP: u32 = 1;
/// The wall of the first edge; the others follow.
const WALLS: u32 = 2;

/// Points `(R(w z) M(z) q, z)`, 0 <= z <= h, of the points q of an outline: M(z) = 1 - k z scales each axis, R turns.
#[derive(Clone, Debug)]
pub struct Extrusion {
    outline: Outline,
    height: f64,
    /// By how much the scale of each axis falls, per length of z.
    k: DVec2,
    /// Radians per length of z.
    w: f64,
    bounds: Aabb,
}

/// Where the plane of a ray's point lies in the outline's own: `q = xy / m`.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// The point, turned back.
    xy: DVec2,
    /// The scale of each axis.
    m: DVec2,
    /// The cosine and the sine of the turn.
    turn: DVec2,
}

/// The turn the other way.
fn back(turn: DVec2) -> DVec2 {
    DVec2::new(turn.x, -turn.y)
}

impl Extrusion {
    /// `twist` in radians over the whole height; `scale` of the top, not negative. Nothing where `height` is zero.
    pub fn new(outline: Outline, height: f64, twist: f64, scale: DVec2) -> Extrusion {
        let (k, w) = ((1.0 - scale) / height, twist / height);
        let flat = !(0.0 < height && k.is_finite() && w.is_finite());
        let (height, k, w) = if flat { (0.0, DVec2::ZERO, 0.0) } else { (height, k, w) };
        let mut made = Extrusion { outline, height, k, w, bounds: Aabb::EMPTY };
        made.bounds = if flat { Aabb::of_points([DVec3::ZERO]) } else { made.box_under(&DAffine3::IDENTITY) };
        if made.w != 0.0 {
            // Turned walls are found to roundings.
            made.bounds = made.bounds.inflated(tolerance::noise(made.bounds.farthest()));
        }
        made
    }

    fn is_nothing(&self) -> bool {
        self.height <= 0.0
    }

    /// Whether every wall is a plane: nothing turns and both axes shrink alike.
    fn is_flat(&self) -> bool {
        self.w == 0.0 && self.k.x == self.k.y
    }

    fn frame(&self, p: DVec3) -> Frame {
        let turn = if self.w == 0.0 { DVec2::X } else { DVec2::from_angle(self.w * p.z) };
        // The top's own scale may come out as a rounding below zero.
        Frame { xy: back(turn).rotate(p.truncate()), m: (1.0 - self.k * p.z).max(DVec2::ZERO), turn }
    }

    /// Whether the plane of a point holds it.
    fn contains(&self, p: DVec3) -> bool {
        let frame = self.frame(p);
        0.0 < frame.m.min_element() && self.outline.contains(frame.xy / frame.m)
    }

    /// The part of a ray between the two ends, and which it meets first; `None` where it passes by. A ray across z in
    /// one of them is inside where it leans to.
    fn slab(&self, ray: &Ray, lean: Lean) -> Option<(Interval, [u32; 2])> {
        let (o, d) = (ray.origin.z, ray.dir.z);
        if d == 0.0 {
            let inside = is_between(o, 0.0, self.height, lean.along(2));
            return inside.then_some((Interval::ALL, [BOTTOM, TOP]));
        }
        let (bottom, top) = (-o / d, (self.height - o) / d);
        Some(match 0.0 < d {
            true => (Interval::new(bottom, top), [BOTTOM, TOP]),
            false => (Interval::new(top, bottom), [TOP, BOTTOM]),
        })
    }
}

impl Solid for Extrusion {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        if self.is_nothing() { self.bounds.transformed(to_from) } else { self.box_under(to_from) }
    }

    fn crossings(&self, ray: &Ray, _: Interval, scratch: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let near = self.bounds.clip(ray);
        if self.is_nothing() || near.is_empty() {
            return Answer::whole_line(false);
        }
        let start = out.len();
        if let Some((slab, ends)) = self.slab(ray, scratch.lean) {
            if self.is_flat() || ray.dir.z == 0.0 {
                self.straight(ray, near, slab, ends, out);
            } else {
                self.turned(ray, near, slab, ends, out);
            }
        }
        debug_assert!((out.len() - start).is_multiple_of(2));
        Answer::whole_line(false)
    }

    /// The gradient of n . q(p), n the normal of the edge, q the point in the outline's own plane.
    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let normal = match crossing.part {
            BOTTOM | TOP => DVec3::Z,
            part => {
                let [a, b] = self.outline.edges()[(part - WALLS) as usize];
                let n = (b - a).perp();
                let Frame { xy, m, turn } = self.frame(ray.at(crossing.t));
                // n . (xy / m) = n . a, times both scales, so that neither is divided by.
                let across = n * DVec2::new(m.y, m.x);
                let along = n.x * (-self.k.y * xy.x + m.y * self.w * xy.y)
                    + n.y * (-self.k.x * xy.y - m.x * self.w * xy.x)
                    + n.dot(a) * (self.k.x * m.y + self.k.y * m.x);
                turn.rotate(across).extend(along)
            }
        };
        parity::outward(normal, ray, crossing)
    }
}
