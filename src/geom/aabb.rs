//! Axis-aligned boxes.

use glam::{DAffine3, DVec3};

use super::{Interval, Ray};

/// A box with its sides along the axes, perhaps unbounded; empty where a component of `min` exceeds `max`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Aabb {
    /// Smallest corner.
    pub min: DVec3,
    /// Largest corner.
    pub max: DVec3,
}

impl Default for Aabb {
    fn default() -> Aabb {
        Aabb::EMPTY
    }
}

impl Aabb {
    /// Nothing.
    pub const EMPTY: Aabb = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    /// All of space.
    pub const ALL: Aabb = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// The smallest box around points.
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Aabb {
        points.into_iter().fold(Aabb::EMPTY, Aabb::including)
    }

    /// The box grown to hold a point.
    pub fn including(self, p: DVec3) -> Aabb {
        Aabb { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box around both.
    pub fn union(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// What both hold.
    pub fn intersection(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Grown by `by` on every side, world length.
    pub fn inflated(self, by: f64) -> Aabb {
        Aabb { min: self.min - DVec3::splat(by), max: self.max + DVec3::splat(by) }
    }

    /// Whether nothing lies in it.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether no side is at infinity.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Whether a point lies in it, faces included.
    pub fn contains(&self, p: DVec3) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }

    /// The middle.
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// The edge lengths.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// The area of the faces.
    pub fn surface(&self) -> f64 {
        let size = self.size();
        2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
    }

    /// The length of the diagonal.
    pub fn diagonal(&self) -> f64 {
        self.size().length()
    }

    /// The largest coordinate of any corner in size: how far it reaches from the origin along an axis.
    pub fn farthest(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// The smallest box around the image of this one; all of space where this one is unbounded.
    pub fn transformed(&self, to_from: &DAffine3) -> Aabb {
        if self.is_empty() {
            Aabb::EMPTY
        } else if self.is_finite() {
            Aabb::of_points(self.corners().map(|c| to_from.transform_point3(c)))
        } else {
            Aabb::ALL
        }
    }

    /// The same where a side without an end may keep the others' ends: along each axis of the image the sum of what the
    /// sides reach, those that do not turn into it left out.
    pub fn transformed_sides(&self, to_from: &DAffine3) -> Aabb {
        if self.is_empty() || self.is_finite() {
            return self.transformed(to_from);
        }
        let rows = to_from.matrix3.transpose();
        let mut image = Aabb { min: to_from.translation, max: to_from.translation };
        for (axis, row) in [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().enumerate() {
            for from in (0..3).filter(|from| row[*from] != 0.0) {
                let (a, b) = (row[from] * self.min[from], row[from] * self.max[from]);
                image.min[axis] += a.min(b);
                image.max[axis] += a.max(b);
            }
        }
        image
    }

    /// Squared distance of a point from the box; zero inside.
    pub fn distance_squared(&self, p: DVec3) -> f64 {
        (p - p.clamp(self.min, self.max)).length_squared()
    }

    /// Squared distance of two boxes; zero where they touch.
    pub fn gap_squared(&self, other: &Aabb) -> f64 {
        (other.min - self.max).max(self.min - other.max).max(DVec3::ZERO).length_squared()
    }

    /// The part of the ray's line inside the box, widened by a few ulps so that rounding loses nothing;
    /// empty where the line misses. A ray in a face counts as inside (0 * inf never arises).
    pub fn clip(&self, ray: &Ray) -> Interval {
        let mut range = Interval::ALL;
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.dir[axis]);
            let (lo, hi) = (self.min[axis], self.max[axis]);
            if d == 0.0 {
                if o < lo || hi < o {
                    return Interval::EMPTY;
                }
                continue;
            }
            let (near, far) = if 0.0 < d { (lo, hi) } else { (hi, lo) };
            range = range.intersect(Interval::new((near - o) / d, (far - o) / d));
        }
        // Each end carries at most three roundings (subtraction, division, and the box's own corner).
        let pad = 8.0 * f64::EPSILON;
        let slack = |t: f64| if t.is_finite() { pad * t.abs() } else { 0.0 };
        Interval::new(range.lo - slack(range.lo), range.hi + slack(range.hi))
    }
}
