//! The watertight test of ray and triangle of Woop, Benthin and Wald (JCGT 2013), in `f64` with exact signs.
//!
//! Corners are moved so that the ray starts at the origin, and sheared so that it runs along one axis: what is left is
//! whether the origin of a plane lies in a triangle of that plane. A corner lands at one place whichever triangle asks,
//! and the side of an edge on which the origin lies is the exact sign of b x c for those places: rounded products keep
//! their order, so a difference that is not zero has the right sign, and one that is zero is computed again exactly
//! (Shewchuk 1997, by the crate `robust`). So neighbours agree about their edge, and the triangles about a corner about
//! the corner. An origin exactly on an edge is settled by a shift of the ray by less than anything along x, by less
//! than that along y, and by less still along z: low faces are inside, high ones are not, as with a box. Seen along
//! that shifted ray a triangle edge-on has no inside and is not met; its neighbours are.
//!
//! Tested by parity against closed meshes of all kinds, and against all triangles one by one, in `tests/solid_mesh.rs`.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use crate::geom::Ray;

/// The shear of a ray.
pub struct Shear {
    origin: DVec3,
    /// The axes across, and the one along which the direction is longest.
    axes: [usize; 3],
    slope: DVec2,
    per_length: f64,
    /// Where shifts along x, y and z appear in the plane.
    shifts: [DVec2; 3],
}

impl Shear {
    /// The ray's direction must not be zero.
    pub fn new(ray: &Ray) -> Shear {
        let z = ray.dir.abs().max_position();
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let along = ray.dir[z];
        let slope = DVec2::new(ray.dir[axes[0]] / along, ray.dir[axes[1]] / along);
        let shift = |axis: usize| match axes.iter().position(|a| *a == axis) {
            Some(0) => DVec2::X,
            Some(1) => DVec2::Y,
            _ => -slope,
        };
        Shear { origin: ray.origin, axes, slope, per_length: 1.0 / along, shifts: [0, 1, 2].map(shift) }
    }

    /// A corner in the plane, and its `t`.
    fn place(&self, p: DVec3) -> (DVec2, f64) {
        let [x, y, z] = self.axes;
        let v = p - self.origin;
        (DVec2::new(v[x] - self.slope.x * v[z], v[y] - self.slope.y * v[z]), self.per_length * v[z])
    }

    /// b x c, and on which side of the edge from b to c the origin lies, 0 where the edge is seen as a point.
    fn side(&self, b: DVec2, c: DVec2) -> (f64, f64) {
        let mut area = b.perp_dot(c);
        if area == 0.0 {
            let coord = |p: DVec2| Coord { x: p.x, y: p.y };
            area = orient2d(coord(b), coord(c), coord(DVec2::ZERO));
        }
        if area != 0.0 {
            return (area, area.signum());
        }
        // (b - s) x (c - s) = b x c + s x (b - c).
        let moved = self.shifts.iter().map(|s| s.perp_dot(b - c)).find(|s| *s != 0.0);
        (0.0, moved.map_or(0.0, f64::signum))
    }

    /// Where the ray meets a triangle.
    pub fn hit(&self, corners: [DVec3; 3]) -> Option<f64> {
        let [(a, ta), (b, tb), (c, tc)] = corners.map(|p| self.place(p));
        let (u, su) = self.side(b, c);
        let (v, sv) = self.side(c, a);
        if su != sv || su == 0.0 {
            return None;
        }
        let (w, sw) = self.side(a, b);
        if sw != su {
            return None;
        }
        let t = (u * ta + v * tb + w * tc) / (u + v + w);
        // A sliver's areas may be lost in rounding; the place stays between its corners.
        let (low, high) = (ta.min(tb).min(tc), ta.max(tb).max(tc));
        Some(if t.is_nan() { 0.5 * (low + high) } else { t.clamp(low, high) })
    }
}
