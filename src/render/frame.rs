//! Directions around a normal.

use glam::DVec3;

/// A frame with a unit vector as its z; the other two axes follow from it.
#[derive(Clone, Copy)]
pub struct Frame([DVec3; 3]);

impl Frame {
    /// Around a unit vector.
    pub fn new(z: DVec3) -> Frame {
        let (x, y) = z.any_orthonormal_pair();
        Frame([x, y, z])
    }

    /// A direction of the world in it.
    pub fn to(self, dir: DVec3) -> DVec3 {
        DVec3::from_array(self.0.map(|axis| axis.dot(dir)))
    }

    /// A direction in it, in the world.
    pub fn from(self, dir: DVec3) -> DVec3 {
        dir.z * self.0[2] + dir.x * self.0[0] + dir.y * self.0[1]
    }
}
