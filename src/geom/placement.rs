//! Where a thing stands: an affine map and its inverse.

use glam::{DAffine3, DMat3, DVec3};

use super::{Lean, Ray};

/// An invertible affine map between a local frame and the world.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Placement {
    /// Takes local coordinates to the world.
    pub world_from_local: DAffine3,
    /// Takes world coordinates to the local frame.
    pub local_from_world: DAffine3,
    /// Takes local normals to world ones, not of unit length: the inverse transpose.
    normals: DMat3,
    /// A bound on how much a local length can grow (the Frobenius norm of the linear part over sqrt 3 is its
    /// mean, the norm itself is a bound); for a rotation and uniform scaling the scale itself.
    pub stretch: f64,
    /// By how much rounding errors can grow on the way there and back: 1 for a rotation and uniform scaling.
    pub condition: f64,
    /// Whether both frames are one.
    is_identity: bool,
    /// How rays lean there.
    pub lean: Lean,
}

impl Placement {
    /// Standing at the world's own origin.
    pub const IDENTITY: Placement = Placement {
        world_from_local: DAffine3::IDENTITY,
        local_from_world: DAffine3::IDENTITY,
        normals: DMat3::IDENTITY,
        stretch: 1.0,
        condition: 1.0,
        is_identity: true,
        lean: Lean::of_world(),
    };

    /// A placement; `None` where the map has no finite inverse or its condition exceeds 1e12, past which
    /// the inverse has lost its meaning in `f64`.
    pub fn new(world_from_local: DAffine3) -> Option<Placement> {
        const WORST_CONDITION: f64 = 1e12;
        let m = world_from_local.matrix3;
        let local_from_world = world_from_local.inverse();
        let frobenius = |m: DMat3| {
            (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
        };
        let condition = frobenius(m) * frobenius(local_from_world.matrix3) / 3.0;
        let finite = world_from_local.is_finite() && local_from_world.is_finite() && condition.is_finite();
        if !finite || WORST_CONDITION < condition {
            return None;
        }
        // For s times a rotation every column has length s; in general the norm of the matrix is a bound.
        let columns = [m.x_axis.length(), m.y_axis.length(), m.z_axis.length()];
        let conformal = condition <= 1.0 + 64.0 * f64::EPSILON;
        let stretch = if conformal { columns[0].max(columns[1]).max(columns[2]) } else { frobenius(m) };
        Some(Placement {
            world_from_local,
            local_from_world,
            normals: local_from_world.matrix3.transpose(),
            stretch,
            condition: condition.max(1.0),
            is_identity: world_from_local == DAffine3::IDENTITY,
            lean: Lean::local(&local_from_world.matrix3),
        })
    }

    /// A world ray in the local frame.
    #[inline]
    pub fn ray_to_local(&self, ray: &Ray) -> Ray {
        if self.is_identity { *ray } else { ray.transformed(&self.local_from_world) }
    }

    /// The same without a copy: the ray itself, or what it is in the local frame, which is put into `moved`.
    #[inline]
    pub fn local_ray<'r>(&self, ray: &'r Ray, moved: &'r mut Option<Ray>) -> &'r Ray {
        if self.is_identity { ray } else { moved.insert(ray.transformed(&self.local_from_world)) }
    }

    /// A local normal as a unit normal of the world. Mirrors keep it outward.
    #[inline]
    pub fn normal_to_world(&self, normal: DVec3) -> DVec3 {
        // Adding zero turns -0.0 into +0.0, as the product does: frames built on normals look at signs.
        if self.is_identity { normal + DVec3::ZERO } else { (self.normals * normal).normalize_or_zero() }
    }

    /// The size of the translation, world length: part of the scale of rounding errors.
    pub fn offset(&self) -> f64 {
        self.world_from_local.translation.abs().max_element()
    }
}
