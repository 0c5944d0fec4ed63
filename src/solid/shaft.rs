//! What a cylinder and a cone have in common: an axis between two flat ends.

use glam::{DAffine3, DMat3, DVec3};

use super::Chord;
use crate::geom::lean::is_between;
use crate::geom::{Aabb, Lean};
use crate::scene::Call;

/// Numbers of the parts of the boundary.
pub mod part {
    /// The wall about the axis.
    pub const WALL: u32 = 0;
    /// The end at `from`.
    pub const BOTTOM: u32 = 1;
    /// The end at `to`.
    pub const TOP: u32 = 2;
}

/// Where a ray crosses something, and which part of the boundary.
pub type End = (f64, u32);

/// An axis between two ends.
#[derive(Clone, Copy, Debug)]
pub struct Shaft {
    /// The middle of one end.
    pub from: DVec3,
    /// The middle of the other.
    pub to: DVec3,
    /// Rows: two unit vectors across, one along the axis.
    pub across_along: DMat3,
    /// From end to end.
    pub height: f64,
}

impl Shaft {
    /// Between two points; where they are one, along z.
    pub fn new(from: DVec3, to: DVec3) -> Shaft {
        let height = from.distance(to);
        let axis = (to - from).try_normalize().unwrap_or(DVec3::Z);
        let (u, v) = axis.any_orthonormal_pair();
        Shaft { from, to, across_along: DMat3::from_cols(u, v, axis).transpose(), height }
    }

    /// The ends that a call gives, by its height from z = 0 up or as both points; `None` where it gives neither, or both.
    pub fn ends(call: &Call) -> Option<[DVec3; 2]> {
        match (call.number("h"), call.vec3("from"), call.vec3("to")) {
            (Some(h), None, None) => Some([DVec3::ZERO, DVec3::new(0.0, 0.0, h)]),
            (None, Some(from), Some(to)) => Some([from, to]),
            _ => None,
        }
    }

    /// The unit vector from one end to the other.
    pub fn axis(&self) -> DVec3 {
        self.across_along.transpose().z_axis
    }

    /// A box around the image of both ends, discs of these radii.
    pub fn extent(&self, radii: [f64; 2], to_from: &DAffine3) -> Aabb {
        // A disc spanned by u and v reaches the length of (u, v) along each axis.
        let across = self.across_along.transpose();
        let (u, v) = (to_from.matrix3 * across.x_axis, to_from.matrix3 * across.y_axis);
        let reach = (u * u + v * v).map(f64::sqrt);
        let disc = |p: DVec3, r: f64| {
            let p = to_from.transform_point3(p);
            Aabb { min: p - r * reach, max: p + r * reach }
        };
        disc(self.from, radii[0]).union(disc(self.to, radii[1]))
    }

    /// Where a ray that begins at height `z` over `from` and climbs by `dz` is between the ends; the whole line where it
    /// is level there and, if it runs in an end, leans to between them.
    #[inline]
    pub fn between(&self, z: f64, dz: f64, lean: Lean) -> Option<[End; 2]> {
        if dz == 0.0 {
            let level = [(f64::NEG_INFINITY, part::WALL), (f64::INFINITY, part::WALL)];
            let lean = lean.dot(self.axis());
            return is_between(z, 0.0, self.height, lean).then_some(level);
        }
        let ends = [(-z / dz, part::BOTTOM), ((self.height - z) / dz, part::TOP)];
        Some(if 0.0 < dz { ends } else { [ends[1], ends[0]] })
    }

    /// The normal of an end; `None` for the wall.
    pub fn end_normal(&self, part: u32) -> Option<DVec3> {
        match part {
            part::BOTTOM => Some(-self.axis()),
            part::TOP => Some(self.axis()),
            _ => None,
        }
    }

    /// The unit vector away from the axis towards a point given from any point of the axis; zero on it.
    pub fn away(&self, p: DVec3) -> DVec3 {
        let across = self.across_along.transpose();
        let p = self.across_along * p;
        (p.x * across.x_axis + p.y * across.y_axis).normalize_or_zero()
    }
}

/// Appends the span between the ends that lies within the walls.
#[inline]
pub fn within([mut enter, mut exit]: [End; 2], [lo, hi]: [f64; 2]) -> Chord {
    if enter.0 < lo {
        enter = (lo, part::WALL);
    }
    if hi < exit.0 {
        exit = (hi, part::WALL);
    }
    Chord::between(enter, exit)
}
