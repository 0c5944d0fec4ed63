//! Metals: mirrors of their colour, polished or rough.
//!
//! What facets send to each other is given back by raising the whole to the energy that one reflection off a white metal
//! loses (Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019).

use glam::{DVec3, Vec3};

use super::finish::{Finish, Share, Toward};
use super::microfacet::{Albedo, Facets, reflected};
use super::paint::{COLOR2, GRAIN, PATTERN};
use super::{Make, Material, roughness};
use crate::scene::{Decl, Group, Kind, Param};

/// A metal.
#[derive(Clone, Debug)]
pub struct Metal {
    /// The facets and how much of all light they reflect where each reflects all; `None` for a polished one.
    facets: Option<(Facets, Albedo)>,
}

impl Metal {
    /// For a roughness from 0 to 1.
    pub fn new(roughness: f64) -> Metal {
        Metal { facets: Facets::new(roughness).map(|facets| (facets, Albedo::new(facets, |_| 1.0))) }
    }
}

/// Its colour at right angles, white at the horizon (Schlick, "An Inexpensive BRDF Model", 1994).
fn reflects(color: Vec3, cosine: f64) -> Vec3 {
    color + (1.0 - color) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5) as f32
}

/// What several reflections add to the first, as a factor.
fn again(color: Vec3, albedo: f64) -> Vec3 {
    1.0 + color * ((1.0 - albedo) / albedo) as f32
}

impl Finish for Metal {
    fn share(&self, color: Vec3, eye: DVec3, light: DVec3) -> Share {
        let Some((facets, albedo)) = &self.facets else { return Share::default() };
        if eye.z <= 0.0 || light.z <= 0.0 {
            return Share::default();
        }
        let (value, density) = facets.mirrored(eye, light);
        let half = (eye + light).normalize_or(DVec3::Z);
        let tint = reflects(color, eye.dot(half)) * again(color, albedo.at(eye.z));
        Share { value: tint * value as f32, density, pointed: density }
    }

    fn toward(&self, color: Vec3, eye: DVec3, place: [f64; 2], _: f64) -> Option<Toward> {
        let Some((facets, albedo)) = &self.facets else {
            let (dir, weight) = (reflected(eye, DVec3::Z), reflects(color, eye.z));
            return Some(Toward { dir, weight, even: false, sharp: true });
        };
        let half = facets.facing(eye, place);
        let dir = reflected(eye, half);
        let tint = reflects(color, eye.dot(half)) * again(color, albedo.at(eye.z));
        let weight = tint * facets.unhidden(eye, dir) as f32;
        (0.0 < dir.z).then_some(Toward { dir, weight, even: false, sharp: false })
    }
}

pub(super) const MAKE: Make = Make {
    decl: Decl {
        word: "metal",
        group: Group::Material,
        doc: "A mirror of its colour, polished or brushed.",
        params: &[
            Param::placed("color", Kind::Color, "what it reflects at right angles; default #cccccc"),
            Param::named("roughness", Kind::Number, "0 (a mirror) to 1; default 0.2"),
            PATTERN,
            COLOR2,
            GRAIN,
        ],
        example: "metal(#e6b860, roughness: 0.3)",
    },
    build: |call| Material::painted(call, Metal::new(roughness(call, 0.2)?)),
};
