//! Surfaces that shine.

use glam::{DVec3, Vec3};

use super::finish::{Finish, Toward};
use super::{Make, Material, color, number};
use crate::scene::{BuildError, Decl, Group, Kind, Param};

/// Shines evenly to all sides, and reflects nothing.
#[derive(Clone, Copy, Debug)]
pub struct Emissive {
    /// Multiplies the colour to radiance.
    intensity: f32,
}

impl Finish for Emissive {
    fn toward(&self, _: Vec3, _: DVec3, _: [f64; 2], _: f64) -> Option<Toward> {
        None
    }

    fn glow(&self, color: Vec3) -> Vec3 {
        color * self.intensity
    }
}

pub(super) const MAKE: Make = Make {
    decl: Decl {
        word: "emissive",
        group: Group::Material,
        doc: "Shines by itself: seen by the eye and in mirrors, and with `integrator: \"path\"` it lights what is around it.",
        params: &[
            Param::placed("color", Kind::Color, "its colour; default #ffffff"),
            Param::named("intensity", Kind::Number, "a factor of the colour; default 1"),
        ],
        example: "emissive(#ffd9a0, intensity: 4)",
    },
    build: |call| {
        let intensity = number(call, "intensity", 1.0)?;
        if intensity < 0.0 {
            return Err(BuildError {
                param: "intensity",
                message: "`intensity` is negative".to_owned(),
                help: "a surface cannot take light away".to_owned(),
            });
        }
        Ok(Material::new(color(call, "color", [1.0; 3])?, Emissive { intensity: intensity as f32 }))
    },
};
