//! Plastics, lacquers, glazes: a clear coat over a matte ground.
//!
//! The coat reflects by Fresnel off facets; what it lets through the ground sends on evenly, and the coat lets out again what
//! keeps the whole in balance: the ground's share is (1 - E(eye)) (1 - E(light)) / (1 - mean E), with E the coat's albedo
//! (Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model", 2001). White ground then sends on all
//! light.

use std::f64::consts::FRAC_1_PI;

use glam::{DVec3, Vec3};

use super::finish::{Finish, Share, Toward};
use super::glass::fresnel;
use super::matte::lifted;
use super::microfacet::{Albedo, Facets, reflected};
use super::paint::{COLOR2, GRAIN, PATTERN};
use super::{Make, Material, positive, roughness};
use crate::scene::{Decl, Group, Kind, Param};

/// A coat over a ground.
#[derive(Clone, Debug)]
pub struct Plastic {
    /// The index beyond the coat's face over that of the coat.
    ratio: f64,
    /// `None` for a polished coat.
    facets: Option<Facets>,
    albedo: Albedo,
}

impl Plastic {
    /// For a roughness from 0 to 1 and an index of refraction.
    pub fn new(roughness: f64, ior: f64) -> Plastic {
        let (ratio, facets) = (1.0 / ior, Facets::new(roughness));
        let reflects = |cosine: f64| fresnel(cosine, ratio);
        let albedo = facets.map_or_else(|| Albedo::smooth(reflects), |facets| Albedo::new(facets, reflects));
        Plastic { ratio, facets, albedo }
    }

    /// What the ground sends on of the light of one direction, against a ground without coat.
    fn ground(&self, eye: DVec3, light: DVec3) -> f64 {
        (1.0 - self.albedo.at(eye.z)) * (1.0 - self.albedo.at(light.z)) / (1.0 - self.albedo.mean)
    }

    /// How often the coat is chosen: its part of what is sent on.
    fn coat_share(&self, color: Vec3, eye: DVec3) -> f64 {
        let coat = self.albedo.at(eye.z);
        let ground = (1.0 - coat) * f64::from(color.max_element());
        if ground == 0.0 { 1.0 } else { coat / (coat + ground) }
    }
}

impl Finish for Plastic {
    fn share(&self, color: Vec3, eye: DVec3, light: DVec3) -> Share {
        if eye.z <= 0.0 || light.z <= 0.0 {
            return Share::default();
        }
        let coat_share = self.coat_share(color, eye);
        let lambert = light.z * FRAC_1_PI;
        let mut share = Share {
            value: color * (lambert * self.ground(eye, light)) as f32,
            density: (1.0 - coat_share) * lambert,
            pointed: 0.0,
        };
        if let Some(facets) = self.facets {
            let (value, density) = facets.mirrored(eye, light);
            let half = (eye + light).normalize_or(DVec3::Z);
            share.value += Vec3::splat((value * fresnel(eye.dot(half), self.ratio)) as f32);
            share.pointed = coat_share * density;
            share.density += share.pointed;
        }
        share
    }

    fn toward(&self, color: Vec3, eye: DVec3, place: [f64; 2], lobe: f64) -> Option<Toward> {
        let coat_share = self.coat_share(color, eye);
        if lobe < coat_share {
            let Some(facets) = self.facets else {
                let weight = Vec3::splat((fresnel(eye.z, self.ratio) / coat_share) as f32);
                return Some(Toward { dir: reflected(eye, DVec3::Z), weight, even: false, sharp: true });
            };
            let dir = reflected(eye, facets.facing(eye, place));
            return self.weighed(color, eye, dir, false);
        }
        self.weighed(color, eye, lifted(place), true)
    }
}

impl Plastic {
    /// A direction that either choice could have led to.
    fn weighed(&self, color: Vec3, eye: DVec3, dir: DVec3, even: bool) -> Option<Toward> {
        let Share { value, density, .. } = self.share(color, eye, dir);
        (0.0 < density).then(|| Toward { dir, weight: value / density as f32, even, sharp: false })
    }
}

pub(super) const MAKE: Make = Make {
    decl: Decl {
        word: "plastic",
        group: Group::Material,
        doc: "A matte ground under a clear coat, as plastic, lacquer or glazed ware.",
        params: &[
            Param::placed("color", Kind::Color, "the ground's colour; default #cccccc"),
            Param::named("roughness", Kind::Number, "of the coat, 0 (polished) to 1; default 0.2"),
            Param::named("ior", Kind::Positive, "the coat's index of refraction; default 1.5"),
            PATTERN,
            COLOR2,
            GRAIN,
        ],
        example: "plastic(#2060a0, roughness: 0.1)",
    },
    build: |call| {
        let plastic = Plastic::new(roughness(call, 0.2)?, positive(call, "ior", 1.5)?);
        Material::painted(call, plastic)
    },
};
