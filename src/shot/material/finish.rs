//! How a surface sends light on: the part of a material that integrators ask.

use std::fmt::Debug;

use glam::{DVec3, Vec3};

use super::glass::Glass;

/// One way that light may take to the eye. Directions are unit vectors in the frame of the surface: z is the normal on the
/// eye's side.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Toward {
    /// To where the light comes from.
    pub dir: DVec3,
    /// What the light of that direction is to be multiplied with: the surface's share times the cosine over the density
    /// with which the direction was chosen.
    pub weight: Vec3,
    /// Whether light goes evenly to all sides from here, so that a path for direct light ends.
    pub even: bool,
    /// Whether no other direction could have been chosen: lights cannot aim at it.
    pub sharp: bool,
}

/// What a surface sends to the eye of the light of one direction.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Share {
    /// The share of the light, a steradian, times the cosine.
    pub value: Vec3,
    /// With what density [`Finish::toward`] chooses the direction, a steradian.
    pub density: f64,
    /// The same of choices that are not [`Toward::even`].
    pub pointed: f64,
}

/// How a surface sends light on. Both directions given point away from the surface, as in [`Toward`]; colours are linear.
pub trait Finish: Debug + Send + Sync {
    /// The share of the light of one direction that goes to the eye; nothing of what is sharp.
    fn share(&self, color: Vec3, eye: DVec3, light: DVec3) -> Share {
        let _ = (color, eye, light);
        Share::default()
    }

    /// Chooses where light comes from by three numbers in [0, 1); `None` where no light comes.
    fn toward(&self, color: Vec3, eye: DVec3, place: [f64; 2], lobe: f64) -> Option<Toward>;

    /// Whether all light that it sends on goes evenly to all sides: its shares are those of [`super::even_share`] then, and no
    /// other numbers than those of the place are asked for.
    fn is_even(&self) -> bool {
        false
    }

    /// What it sends by itself, radiance.
    fn glow(&self, color: Vec3) -> Vec3 {
        let _ = color;
        Vec3::ZERO
    }

    /// What is behind it, if light goes through.
    fn glass(&self) -> Option<&Glass> {
        None
    }
}
