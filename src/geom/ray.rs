//! Rays.

use glam::{DAffine3, DVec3};

use crate::num::hash::Stream;

/// A line with a direction: points `origin + t dir`. `dir` is not normalised, so `t` survives affine maps.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ray {
    /// The point at `t = 0`.
    pub origin: DVec3,
    /// The direction; never zero, and no component is -0.0.
    pub dir: DVec3,
}

impl Ray {
    /// A ray. Adding zero turns a component of -0.0 into +0.0, so that mirrored rays take the same branches.
    #[inline]
    pub fn new(origin: DVec3, dir: DVec3) -> Ray {
        Ray { origin, dir: dir + DVec3::ZERO }
    }

    /// A uniform random chord of a sphere, in the measure of lines: through two independent points of it, which it
    /// meets at `t = 0` and `t = 1`.
    pub fn chord(stream: &mut Stream, center: DVec3, radius: f64) -> Ray {
        let (a, b) = (stream.direction(), stream.direction());
        Ray::new(center + radius * a, radius * (b - a))
    }

    /// The point at `t`.
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.dir
    }

    /// The `t` at which the line is nearest to a point, and the vector from there to the point of the line: however far
    /// the origin lies, a polynomial about this place keeps its digits. Two steps, as the first is rounded on the scale
    /// of the distance.
    pub fn nearest_to(&self, center: DVec3) -> (f64, DVec3) {
        let from = self.origin - center;
        let per = 1.0 / self.dir.length_squared();
        let first = -from.dot(self.dir) * per;
        let foot = from + first * self.dir;
        let second = -foot.dot(self.dir) * per;
        (first + second, foot + second * self.dir)
    }

    /// The same ray in another frame; `t` keeps its meaning.
    pub fn transformed(&self, to_from: &DAffine3) -> Ray {
        Ray::new(to_from.transform_point3(self.origin), to_from.transform_vector3(self.dir))
    }

    /// Whether it can be traced: with a direction whose length has a square, from where its products with places have one.
    #[inline]
    pub fn is_valid(&self) -> bool {
        let squared = self.dir.length_squared();
        let products = self.origin.length_squared() * squared;
        products.is_finite() && (f64::MIN_POSITIVE..f64::INFINITY).contains(&squared)
    }
}
