//! Four `f64` side by side: plain arrays whose element-wise loops the compiler turns into vector
//! instructions. Four lanes on every processor, summed in one fixed order, so the bits are the same.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// How many lanes.
pub const LANES: usize = 4;

/// Four numbers.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct F4(pub [f64; LANES]);

impl F4 {
    /// Zeros.
    pub const ZERO: F4 = F4([0.0; LANES]);

    /// Four times the same.
    #[inline(always)]
    pub fn splat(x: f64) -> F4 {
        F4([x; LANES])
    }

    /// The first four of a slice.
    #[inline(always)]
    pub fn load(from: &[f64]) -> F4 {
        F4([from[0], from[1], from[2], from[3]])
    }

    /// The sum of the lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        (self.0[0] + self.0[1]) + (self.0[2] + self.0[3])
    }

    /// Lane by lane.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f64) -> f64) -> F4 {
        F4([f(self.0[0]), f(self.0[1]), f(self.0[2]), f(self.0[3])])
    }

    /// The larger of each lane and a number; the number where the lane is not one.
    #[inline(always)]
    pub fn at_least(self, x: f64) -> F4 {
        self.map(|a| if a > x { a } else { x })
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for F4 {
            type Output = F4;
            #[inline(always)]
            fn $method(self, o: F4) -> F4 {
                let (a, b) = (self.0, o.0);
                F4([a[0] $op b[0], a[1] $op b[1], a[2] $op b[2], a[3] $op b[3]])
            }
        }
        impl $trait<f64> for F4 {
            type Output = F4;
            #[inline(always)]
            fn $method(self, o: f64) -> F4 {
                self $op F4::splat(o)
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl Neg for F4 {
    type Output = F4;
    #[inline(always)]
    fn neg(self) -> F4 {
        self.map(|a| -a)
    }
}

impl AddAssign for F4 {
    #[inline(always)]
    fn add_assign(&mut self, o: F4) {
        *self = *self + o;
    }
}

/// Three coordinates of four points or vectors.
#[derive(Clone, Copy, Debug, Default)]
pub struct V4 {
    /// First coordinates.
    pub x: F4,
    /// Second coordinates.
    pub y: F4,
    /// Third coordinates.
    pub z: F4,
}

impl V4 {
    /// Scalar products with one vector.
    #[inline(always)]
    pub fn dot(self, v: glam::DVec3) -> F4 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Squared lengths.
    #[inline(always)]
    pub fn length_squared(self) -> F4 {
        self.x * self.x + self.y * self.y + self.z * self.z
    }

    /// Each minus one vector.
    #[inline(always)]
    pub fn minus(self, v: glam::DVec3) -> V4 {
        V4 { x: self.x - v.x, y: self.y - v.y, z: self.z - v.z }
    }

    /// Each minus a multiple of one vector.
    #[inline(always)]
    pub fn minus_scaled(self, s: f64, v: glam::DVec3) -> V4 {
        self.minus(s * v)
    }

    /// Adds `w` times each to a running sum.
    #[inline(always)]
    pub fn add_to(self, w: F4, sum: &mut V4) {
        sum.x += w * self.x;
        sum.y += w * self.y;
        sum.z += w * self.z;
    }

    /// The sum of the four.
    #[inline(always)]
    pub fn sum(self) -> glam::DVec3 {
        glam::DVec3::new(self.x.sum(), self.y.sum(), self.z.sum())
    }
}
