//! Eight `f64` side by side, on every processor: what differs is how many instructions they take. The same lanes and
//! one fixed order of summing give the same bits at every level of instructions; nothing is fused.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

/// How many lanes.
pub const LANES: usize = 8;

/// Eight numbers.
pub type Lanes<S> = f64x8<S>;

/// The sum of the lanes, in a fixed order.
#[inline(always)]
pub fn sum<S: Simd>(a: Lanes<S>) -> f64 {
    // ((a0 + a4) + (a2 + a6)) + ((a1 + a5) + (a3 + a7)).
    let (low, high) = a.split();
    let (low, high) = (low + high).split();
    let two = low + high;
    two[0] + two[1]
}

/// Three coordinates of eight points or vectors.
#[derive(Clone, Copy, Debug)]
pub struct Lanes3<S: Simd> {
    /// First coordinates.
    pub x: Lanes<S>,
    /// Second coordinates.
    pub y: Lanes<S>,
    /// Third coordinates.
    pub z: Lanes<S>,
}

impl<S: Simd> Lanes3<S> {
    /// Zeros.
    #[inline(always)]
    pub fn zero(simd: S) -> Lanes3<S> {
        let zero = Lanes::splat(simd, 0.0);
        Lanes3 { x: zero, y: zero, z: zero }
    }

    /// Scalar products with one vector.
    #[inline(always)]
    pub fn dot(self, v: DVec3) -> Lanes<S> {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Squared lengths.
    #[inline(always)]
    pub fn length_squared(self) -> Lanes<S> {
        self.x * self.x + self.y * self.y + self.z * self.z
    }

    /// Each minus one vector.
    #[inline(always)]
    pub fn minus(self, v: DVec3) -> Lanes3<S> {
        Lanes3 { x: self.x - v.x, y: self.y - v.y, z: self.z - v.z }
    }

    /// Adds `w` times each to a running sum.
    #[inline(always)]
    pub fn add_to(self, w: Lanes<S>, sum: &mut Lanes3<S>) {
        sum.x += w * self.x;
        sum.y += w * self.y;
        sum.z += w * self.z;
    }

    /// The sum of the eight.
    #[inline(always)]
    pub fn sum(self) -> DVec3 {
        DVec3::new(sum(self.x), sum(self.y), sum(self.z))
    }
}
