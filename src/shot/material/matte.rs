//! Surfaces that send light on evenly to all sides (Lambert).

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::{DVec3, Vec3};

use super::finish::{Finish, Share, Toward};
use super::paint::{COLOR2, GRAIN, PATTERN, Paint};
use super::{Make, Material, color};
use crate::scene::{Decl, Group, Kind, Param};

/// Chalk, clay.
#[derive(Clone, Copy, Debug)]
pub struct Matte;

/// One direction above the surface, the density being that of its cosine: a disc lifted to the hemisphere (Malley), height
/// sqrt(1 - u) over radius sqrt(u).
pub fn lifted([u, v]: [f64; 2]) -> DVec3 {
    let (sin, cos) = (TAU * v).sin_cos();
    DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt())
}

/// The share of light that is sent on evenly, by the cosine of where it comes from.
pub fn even_share(color: Vec3, cosine: f64) -> Share {
    let density = cosine.max(0.0) * FRAC_1_PI;
    Share { value: color * density as f32, density, pointed: 0.0 }
}

impl Finish for Matte {
    fn is_even(&self) -> bool {
        true
    }

    fn share(&self, color: Vec3, _: DVec3, light: DVec3) -> Share {
        even_share(color, light.z)
    }

    fn toward(&self, color: Vec3, _: DVec3, place: [f64; 2], _: f64) -> Option<Toward> {
        (color != Vec3::ZERO).then(|| Toward { dir: lifted(place), weight: color, even: true, sharp: false })
    }
}

pub(super) const MAKE: Make = Make {
    decl: Decl {
        word: "matte",
        group: Group::Material,
        doc: "Equally bright from all sides, as chalk or clay.",
        params: &[Param::placed("color", Kind::Color, "its colour; default #cccccc"), PATTERN, COLOR2, GRAIN],
        example: "matte(#b8683c)",
    },
    build: |call| Material::painted(call, Matte),
};

pub(super) const POINTS: Make = Make {
    decl: Decl {
        word: "points",
        group: Group::Material,
        doc: "Matte, in the colours of the scan's own points.",
        params: &[Param::placed("color", Kind::Color, "multiplies them; default #ffffff")],
        example: "material own(kind: \"points\")",
    },
    build: |call| {
        let tint = color(call, "color", [1.0; 3])?;
        Ok(Material { paint: Paint::Own { tint }, ..Material::new(tint, Matte) })
    },
};
