//! Solids of revolution: an outline in the half-plane of x and z, turned about the z axis.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3, Vec3Swizzles as _};

use super::outline::Outline;
use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid, parity};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::num::roots;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "revolve",
        group: Group::Primitive,
        doc: "An outline turned about the z axis: its points are a distance from the axis and a height. It starts \
              in the half-plane of positive x. Several loops make holes: a point is inside where an odd number of \
              loops surrounds it.",
        params: &[
            Param::placed(
                "outline",
                Kind::Outline,
                "a list of points [x, z], x >= 0, or a list of such lists",
            ),
            Param::named("angle", Kind::Angle, "how far it is turned, from x towards y (default 1turn)"),
        ],
        example: "revolve([[0, 0], [3, 0], [1, 2], [1, 4], [0, 5]])",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let wrong = |param, message: &str, help: &str| {
        Err(BuildError { param, message: message.into(), help: help.into() })
    };
    let Some(loops) = call.loops("outline") else {
        return wrong(
            "",
            "a solid of revolution needs an outline",
            "write `revolve([[1, 0], [2, 0], [2, 1]])`",
        );
    };
    let outline = Outline::new(loops, "outline")?;
    if outline.corners()[0].x < 0.0 {
        let help = "the first number of a point is its distance from the axis: zero or more";
        return wrong("outline", "the outline crosses the axis that it turns about", help);
    }
    let angle = call.angle("angle").unwrap_or(TAU);
    // A full turn written in degrees may exceed tau by the rounding of its unit.
    if angle <= 0.0 || TAU * (1.0 + tolerance::noise(1.0)) < angle {
        let help = "leave `angle` out for a full turn; turn the other way by `.rotate_z`";
        return wrong(
            "angle",
            "a solid of revolution is turned by more than nothing, at most a full turn",
            help,
        );
    }
    Ok(Arc::new(Revolution::new(outline, angle)))
}

/// The face in the half-plane where the turn starts.
const FIRST: u32 = 0;
/// That where it ends.
const LAST: u32 = 1;
/// The surface of the first edge; the others follow.
const EDGES: u32 = 2;

/// Points whose distance from the z axis and height lie in an outline, and whose azimuth is less than an angle.
#[derive(Clone, Debug)]
pub struct Revolution {
    outline: Outline,
    /// Where the turn ends: its cosine and sine, and whether it is more than half a turn; `None` for a full one.
    end: Option<(DVec2, bool)>,
    bounds: Aabb,
}

impl Revolution {
    /// `angle` in radians, above zero, at most a full turn. The outline must not cross the axis.
    pub fn new(outline: Outline, angle: f64) -> Revolution {
        let end = (angle < TAU * (1.0 - tolerance::noise(1.0))).then(|| (direction(angle), PI < angle));
        let [low, high] = outline.corners();
        let mut reach = [direction(0.0), direction(angle)].to_vec();
        reach.extend(
            (1..4).map(f64::from).filter(|i| i * FRAC_PI_2 < angle).map(|i| direction(i * FRAC_PI_2)),
        );
        if end.is_none() {
            reach.extend([DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]);
        }
        let radii = [low.x, high.x];
        let ring = radii.iter().flat_map(|r| reach.iter().map(move |e| *r * *e));
        let bounds = Aabb::of_points(ring.flat_map(|p| [low.y, high.y].map(|z| p.extend(z))));
        Revolution { outline, end, bounds }
    }

    /// Whether a point is inside; at the first azimuth it is, at the last it is not.
    fn contains(&self, p: DVec3) -> bool {
        let turned = match self.end {
            None => true,
            Some((e, false)) => (0.0 < p.y || (p.y == 0.0 && 0.0 <= p.x)) && 0.0 < p.xy().perp_dot(e),
            Some((e, true)) => 0.0 <= p.y || 0.0 < p.xy().perp_dot(e),
        };
        turned && self.outline.contains(DVec2::new(p.xy().length(), p.z))
    }
}

/// A unit vector by its azimuth, exact for quarters of a turn.
fn direction(angle: f64) -> DVec2 {
    match angle / FRAC_PI_2 {
        0.0 => DVec2::X,
        1.0 => DVec2::Y,
        2.0 => DVec2::NEG_X,
        3.0 => DVec2::NEG_Y,
        _ => DVec2::from_angle(angle),
    }
}

/// The ray from a point near the solid: what every edge asks about it.
struct Line {
    ray: Ray,
    /// |d|^2 across the axis.
    across: f64,
    /// Where it is nearest to the axis.
    nearest: f64,
    /// The square of how near.
    least: f64,
    /// By how much boxes are grown.
    slack: f64,
}

impl Line {
    fn new(ray: Ray, slack: f64) -> Line {
        let (o, d) = (ray.origin.xy(), ray.dir.xy());
        let across = d.length_squared();
        let nearest = if across == 0.0 { 0.0 } else { -o.dot(d) / across };
        let least = if across == 0.0 { o.length_squared() } else { o.perp_dot(d) * o.perp_dot(d) / across };
        Line { ray, across, nearest, least, slack }
    }

    /// The t of all heights between two, a little more; the whole line, or nothing, where it is level.
    fn between(&self, low: f64, high: f64) -> Interval {
        let (o, d) = (self.ray.origin.z, self.ray.dir.z);
        let (low, high) = (low - self.slack, high + self.slack);
        if d == 0.0 {
            return if low <= o && o <= high { Interval::ALL } else { Interval::EMPTY };
        }
        let (a, b) = ((low - o) / d, (high - o) / d);
        Interval::new(a.min(b), a.max(b))
    }

    /// Whether it passes through the ring of a box of radii and heights, or close by.
    fn meets(&self, min: DVec2, max: DVec2) -> bool {
        let range = self.between(min.y, max.y);
        if range.is_empty() {
            return false;
        }
        let square = |t: f64| {
            let off = t - self.nearest;
            if self.across == 0.0 { self.least } else { self.least + self.across * off * off }
        };
        let near = square(self.nearest.clamp(range.lo, range.hi)).sqrt();
        let far = square(range.lo).max(square(range.hi)).sqrt();
        near <= max.x + self.slack && min.x - self.slack <= far
    }

    /// Shows the places where the ray may cross what an edge from `a` to `b` sweeps. With a = (r0, z0) and the edge
    /// (dr, dz), dz (rho - r0) = dr (z - z0): a level ring, or rho dz = L = r0 dz + dr (z - z0), squared the cone
    /// |X|^2 = L^2, X = dz (x, y). For p + t d that is A t^2 + 2 B t + C = 0 with the discriminant, by Lagrange's
    /// identity for the form x x + y y - L L, (X L' - L X')^2 - (X x X')^2, which loses no digits where it is small
    /// but in the factors themselves. Roots on the cone's other half, and beyond the edge, go by their height.
    fn roots(&self, [a, b]: [DVec2; 2], mut show: impl FnMut(f64)) {
        let (dr, dz) = (b.x - a.x, b.y - a.y);
        let (p, d) = (self.ray.origin, self.ray.dir);
        if a.x == 0.0 && b.x == 0.0 {
            // An edge on the axis sweeps nothing.
            return;
        }
        if dz == 0.0 {
            if d.z != 0.0 {
                show((a.y - p.z) / d.z);
            }
            return;
        }
        let range = self.between(a.y.min(b.y), a.y.max(b.y));
        // Through the tip of a cone both halves are met in a double root.
        let at_height = |end: &DVec2| (end.y - p.z) / d.z;
        let tips = [a, b].into_iter().filter(|end| end.x == 0.0 && d.z != 0.0).map(|end| at_height(&end));
        tips.filter(|t| self.ray.at(*t).xy().length() <= self.slack).for_each(&mut show);
        let (x, v) = (dz * p.xy(), dz * d.xy());
        let (l, m) = (a.x * dz + dr * (p.z - a.y), dr * d.z);
        let (root, speed) = (x.length(), v.length_squared());
        let square = (speed.sqrt() - m.abs()) * (speed.sqrt() + m.abs());
        let (half, rest) = (x.dot(v) - l * m, (root - l.abs()) * (root + l.abs()));
        if square == 0.0 {
            let t = -rest / (2.0 * half);
            if range.contains(t) {
                show(t);
            }
            return;
        }
        let (long, cross) = ((x * m - l * v).length(), x.perp_dot(v).abs());
        if let Some(both) = roots::quadratic(square, half, rest, (long - cross) * (long + cross)) {
            both.into_iter().filter(|t| range.contains(*t)).for_each(show);
        }
    }
}

impl Solid for Revolution {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        if self.end.is_some() {
            return self.bounds.transformed(to_from);
        }
        // A level ring of radius r reaches r times the length of the row's part across the axis.
        let rows = to_from.matrix3.transpose();
        let across =
            DVec3::new(rows.x_axis.xy().length(), rows.y_axis.xy().length(), rows.z_axis.xy().length());
        let ring = |[corner, _]: &[DVec2; 2]| {
            let middle = to_from.transform_point3(DVec3::new(0.0, 0.0, corner.y));
            Aabb { min: middle - corner.x * across, max: middle + corner.x * across }
        };
        self.outline.edges().iter().map(ring).fold(Aabb::EMPTY, Aabb::union)
    }

    /// Candidates are the roots of the edges that the ray can meet, and the planes of both ends; which of them count
    /// is decided by the outline in the middle of the gaps between them, so that joints count once and parity cannot
    /// fail. Tested against cylinders and cones in closed form, and the states at mid-points.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let near = self.bounds.clip(ray);
        if near.is_empty() {
            return Answer::whole_line(false);
        }
        let start = out.len();
        let from = 0.5 * (near.lo + near.hi);
        let own = Ray { origin: ray.at(from), dir: ray.dir };
        let [low, high] = self.outline.corners();
        let size = high.abs().max(low.abs()).max_element();
        let line = Line::new(own, tolerance::JOINT * size);
        self.outline.visit(
            |min, max| line.meets(min, max),
            |edge| {
                let ends = self.outline.edges()[edge as usize];
                line.roots(ends, |t| out.push(Crossing::exact(t, true, EDGES + edge)));
            },
        );
        if let Some((e, _)) = self.end {
            let (p, d) = (own.origin.xy(), own.dir.xy());
            out.push(Crossing::exact(-p.y / d.y, true, FIRST));
            out.push(Crossing::exact(-p.perp_dot(e) / d.perp_dot(e), true, LAST));
        }
        parity::where_it_changes(out, start, |t| self.contains(own.at(t)));
        parity::shift(out, start, from);
        Answer::whole_line(false)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let normal = match (crossing.part, self.end) {
            (FIRST, _) => DVec3::Y,
            (LAST, Some((e, _))) => e.perp().extend(0.0),
            (part, _) => {
                let [a, b] = self.outline.edges()[part.saturating_sub(EDGES) as usize];
                let along = ray.at(crossing.t).xy().normalize_or_zero();
                (along * (b.y - a.y)).extend(a.x - b.x)
            }
        };
        parity::outward(normal, ray, crossing)
    }
}
