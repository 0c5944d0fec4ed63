//! Rays that go together.

use glam::DVec3;

use super::{Aabb, Ray};

/// All of space that rays of a patch of a picture can reach: between four planes through the sides of the patch.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Inward normals, and the least that a point within has along them.
    sides: [(DVec3, f64); 4],
    /// The length of the longest origin: what depends on how far off the eye is depends on this.
    pub origin: f64,
}

impl Beam {
    /// Of the rays through the corners of a patch, in order around it, where origins and directions of all rays between are
    /// means of theirs with weights from 0 to 1. It holds their points from t = 0 on.
    pub fn around(corners: &[Ray; 4]) -> Beam {
        let side = |k: usize| {
            let [a, b, far, _] = std::array::from_fn(|i| &corners[(k + i) % 4]);
            let along = (b.origin + b.dir) - (a.origin + a.dir);
            let normal = along.cross(a.dir + b.dir);
            let inward = if normal.dot(far.at(1.0) - a.at(1.0)) < 0.0 { -normal } else { normal };
            // Rays that went out through the side would make it none; those along it do by rounding.
            let out = |ray: &Ray| inward.dot(ray.dir) < -PARALLEL * inward.length() * ray.dir.length();
            let least = corners.iter().map(|ray| inward.dot(ray.origin)).fold(f64::INFINITY, f64::min);
            if corners.iter().any(out) { (DVec3::ZERO, 0.0) } else { (inward, least) }
        };
        let origin = corners.iter().map(|ray| ray.origin.length()).fold(0.0, f64::max);
        Beam { sides: [side(0), side(1), side(2), side(3)], origin }
    }

    /// Whether no ray can meet a box grown by `grow` on every side, world length. False tells nothing.
    pub fn misses(&self, bounds: &Aabb, grow: f64) -> bool {
        let slack = grow + ROUNDING * (self.origin + bounds.farthest());
        self.sides.iter().any(|(normal, least)| {
            let most = DVec3::select(normal.cmpgt(DVec3::ZERO), bounds.max, bounds.min);
            normal.dot(most) + slack * normal.abs().element_sum() < *least
        })
    }
}

/// A direction that goes out through a side by less than this, relative, runs along it: what rounding does to a normal, whose
/// own direction may be off by far more where the patch is small.
const PARALLEL: f64 = 16.0 * f64::EPSILON;

/// What that comes to at a point, relative to how far off it and the eye are (twice, as lengths are measured here), and the
/// roundings of rays and products.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    /// A patch of a picture: of a perspective, or with rays side by side.
    fn patch(stream: &mut Stream, parallel: bool, size: f64) -> [Ray; 4] {
        let eye = size * stream.direction();
        let forward = stream.direction();
        let (right, up) = forward.any_orthonormal_pair();
        let place = [0.3 * stream.unit(), -0.2 * stream.unit()];
        [[0.0, 0.0], [0.1, 0.0], [0.1, 0.05], [0.0, 0.05]].map(|[x, y]| {
            let offset = (place[0] + x) * right + (place[1] + y) * up;
            if parallel { Ray::new(eye + offset, forward) } else { Ray::new(eye, forward + offset) }
        })
    }

    #[test]
    fn no_box_is_missed_that_a_ray_of_the_beam_meets() {
        let mut stream = Stream::new(3);
        let (mut missed, mut met) = (0, 0);
        for i in 0..400 {
            let size = [1e-3, 1.0, 1e9][i % 3];
            let corners = patch(&mut stream, i % 2 == 0, size);
            let beam = Beam::around(&corners);
            for _ in 0..200 {
                // A ray between the corners, on the sides and at the corners too.
                let [u, v] = std::array::from_fn(|_| (1.4 * stream.unit() - 0.2).clamp(0.0, 1.0));
                let mean = |of: fn(&Ray) -> DVec3| {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|k| of(&corners[k]));
                    (a.lerp(b, u)).lerp(d.lerp(c, u), v)
                };
                let ray = Ray::new(mean(|r| r.origin), mean(|r| r.dir));
                let point = ray.at(10.0 * stream.unit().powi(3));
                assert!(!beam.misses(&Aabb::of_points([point]), 0.0), "{point} of {ray:?}");
                let other = corners[0].at(5.0) + stream.direction();
                missed += usize::from(beam.misses(&Aabb::of_points([other]).inflated(0.01), 0.0));
                met += 1;
            }
        }
        assert!(met / 2 < missed, "{missed} of {met}");
    }

    #[test]
    fn rays_that_part_have_no_sides() {
        // Corners that look outward all round: no plane has them all on one side.
        let all = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|dir| Ray::new(DVec3::ZERO, dir));
        let beam = Beam::around(&all);
        for dir in [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y] {
            assert!(!beam.misses(&Aabb::of_points([dir]), 0.0));
        }
    }
}
