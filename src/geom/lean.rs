//! What a ray that runs in a face is taken for.

use glam::{DMat3, DVec3};

/// The way in which a ray leans: where it runs in a face of a solid it is inside if it would be when moved this way by less than
/// any length. One vector for everything in a scene, taken along into each solid's frame: of two solids that share
/// a face exactly one has the ray, whatever mirrors and turns brought them there.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Lean(DVec3);

impl Default for Lean {
    fn default() -> Lean {
        Lean::of_world()
    }
}

impl Lean {
    /// In the world's frame. All components are above zero, so a box has its low faces; they are none of the numbers that
    /// planes are written with.
    pub const fn of_world() -> Lean {
        Lean(DVec3::new(0.801_783_7, 0.476_731_3, 0.360_374_9))
    }

    /// The world's, in a local frame.
    pub fn local(local_from_world: &DMat3) -> Lean {
        Lean::of_world().taken(local_from_world)
    }

    /// The same in another frame.
    pub fn taken(self, other_from_own: &DMat3) -> Lean {
        Lean(*other_from_own * self.0)
    }

    /// Along an axis of the frame: 0 to 2.
    pub fn along(self, axis: usize) -> f64 {
        self.0[axis]
    }

    /// Along a vector of the frame.
    pub fn dot(self, v: DVec3) -> f64 {
        self.0.dot(v)
    }
}

/// Whether a ray that is level at height `o` runs between two levels, `lean` the part of its lean upward.
#[inline]
pub fn is_between(o: f64, lo: f64, hi: f64, lean: f64) -> bool {
    if 0.0 < lean { lo <= o && o < hi } else { lo < o && o <= hi }
}
