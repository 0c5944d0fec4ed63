//! The rays of interval goldens: a pure function of a box, a seed and the ray's number, so that the head of a golden says all
//! about them.

use glam::DVec3;

use crate::geom::{Aabb, Ray};
use crate::num::hash::{mix, unit};

/// So many rays a scene has where nothing else is said.
pub const COUNT: u32 = 1000;

/// The rays of a golden.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rays {
    /// The box that they are aimed at; world frame, finite, of a diagonal above zero.
    pub bounds: Aabb,
    /// How many there are.
    pub count: u32,
    /// Chooses them.
    pub seed: u64,
}

impl Rays {
    /// [`COUNT`] rays at what is bounded of a scene; at a unit cube about its middle, or the origin, where that has no size.
    pub fn of(bounds: Aabb) -> Rays {
        let usable = !bounds.is_empty() && bounds.is_finite();
        let center = if usable { bounds.center() } else { DVec3::ZERO };
        let sized = usable && 0.0 < bounds.diagonal();
        let bounds = if sized { bounds } else { Aabb::of_points([center]).inflated(0.5) };
        Rays { bounds, count: COUNT, seed: 0 }
    }

    /// The ray of a number. It reaches its target, a point of the box, at t = 1, from a diagonal away: whole scenes are met at t of
    /// about 1, whatever their size. Every fourth runs along an axis, as faces do that users write.
    pub fn get(&self, index: u32) -> Ray {
        let seed = mix(self.seed) ^ u64::from(index);
        let share = DVec3::from_array([1, 2, 3].map(|k| unit(seed, k)));
        let target = self.bounds.min + share * self.bounds.size();
        let way = if index.is_multiple_of(4) { axis(index / 4) } else { direction(seed) };
        let dir = self.bounds.diagonal() * way;
        Ray::new(target - dir, dir)
    }
}

/// The axes by turns, both ways.
fn axis(index: u32) -> DVec3 {
    let axis = DVec3::AXES[index as usize % 3];
    if (index / 3).is_multiple_of(2) { axis } else { -axis }
}

/// A unit vector, even over the sphere, without functions that differ between machines.
fn direction(seed: u64) -> DVec3 {
    let draws = (4..).step_by(3).map(|k| {
        let cube = [k, k + 1, k + 2].map(|k| 2.0 * unit(seed, k) - 1.0);
        DVec3::from_array(cube)
    });
    let mut inside = draws.filter(|v| (0.01..=1.0).contains(&v.length_squared()));
    // The draws do not end; half of them lie in the ball.
    inside.next().map_or(DVec3::X, DVec3::normalize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ray_reaches_the_box_at_one_and_begins_outside_of_it() {
        let rays = Rays::of(Aabb { min: DVec3::new(1.0, -2.0, 0.0), max: DVec3::new(4.0, 2.0, 0.5) });
        for ray in (0..COUNT).map(|i| rays.get(i)) {
            assert!(rays.bounds.inflated(1e-9).contains(ray.at(1.0)) && !rays.bounds.contains(ray.origin));
        }
    }

    #[test]
    fn boxes_of_no_size_are_aimed_at_as_a_unit_cube() {
        for bounds in [Aabb::EMPTY, Aabb::ALL, Aabb::of_points([DVec3::ONE])] {
            let Rays { bounds, .. } = Rays::of(bounds);
            assert_eq!(bounds.size(), DVec3::ONE);
        }
    }
}
