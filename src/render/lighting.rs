//! Light that reaches a matte point straight from the lights.

use std::f64::consts::TAU;

use glam::DVec3;

use super::sampler::Sample;
use super::scenery::{Scenery, Seen, Tracer};
use crate::geom::{Interval, Ray};
use crate::shot::Light;

/// The lights of a scene, sorted by how they are asked.
#[derive(Debug)]
pub struct Lights {
    /// Lights with a place or a direction; dark ones are left out.
    shining: Vec<Light>,
    /// Radiance of all skies together; `None` where there is none.
    pub sky: Option<[f32; 3]>,
}

impl Lights {
    /// Lights that can contribute; of an empty list, the default ones.
    pub fn new(lights: &[Light]) -> Lights {
        let lights = if lights.is_empty() { &crate::shot::light::DEFAULT } else { lights };
        let mut sky: Option<[f32; 3]> = None;
        let mut shining = Vec::new();
        for light in lights {
            match light {
                Light::Sky { color } => sky = Some(plus(sky.unwrap_or_default(), *color)),
                Light::Sun { color, .. }
                | Light::Point { color, .. }
                | Light::Area { color, .. }
                | Light::Headlight { color } => {
                    if *color != [0.0; 3] {
                        shining.push(*light);
                    }
                }
            }
        }
        Lights { shining, sky }
    }

    /// What a white matte surface sends to the eye, one sample of it.
    pub fn arriving<S: Scenery>(
        &self,
        tracer: &mut Tracer<S>,
        ray: &Ray,
        seen: &Seen,
        sample: Sample,
    ) -> [f32; 3] {
        let mut sum = [0.0; 3];
        // Pair 0 is the place in the pixel, pair 1 the sky's.
        for (light, pair) in self.shining.iter().zip(2..) {
            if let Some((color, share)) = arriving_from(light, tracer, ray, seen, sample, pair) {
                sum = plus(sum, color.map(|c| c * share as f32));
            }
        }
        if let Some(sky) = self.sky.filter(|sky| *sky != [0.0; 3])
            && open_sky(tracer, seen, sample)
        {
            sum = plus(sum, sky);
        }
        sum
    }
}

/// Sum of two colours.
fn plus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Where rays that leave a surface on the eye's side start.
fn start(seen: &Seen) -> DVec3 {
    seen.surface.point + seen.surface.offset * seen.normal
}

/// Whether one ray into the sky, cosine-weighted, meets nothing.
pub fn open_sky<S: Scenery>(tracer: &mut Tracer<S>, seen: &Seen, sample: Sample) -> bool {
    const SKY_PAIR: u32 = 1;
    let [u, v] = sample.pair(SKY_PAIR);
    // A disc lifted to the hemisphere (Malley): height sqrt(1 - u) over radius sqrt(u).
    let dir = around(seen.normal, (1.0 - u).sqrt(), u.sqrt(), v);
    !tracer.shadowed(&Ray::new(start(seen), dir), Interval::AHEAD)
}

/// The light's colour and the share of it that a white matte surface sends on.
fn arriving_from<S: Scenery>(
    light: &Light,
    tracer: &mut Tracer<S>,
    ray: &Ray,
    seen: &Seen,
    sample: Sample,
    pair: u32,
) -> Option<([f32; 3], f64)> {
    match *light {
        Light::Sun { toward, half_angle, color } => {
            let (dir, weight) = toward_sun(toward, half_angle, sample, pair);
            let cosine = seen.normal.dot(dir);
            if cosine <= 0.0 || tracer.shadowed(&Ray::new(start(seen), dir), Interval::AHEAD) {
                return None;
            }
            Some((color, weight * cosine))
        }
        Light::Point { at, falloff, color } => {
            let to_light = at - seen.surface.point;
            let cosine = from_place(tracer, seen, at)?;
            Some((color, if falloff { cosine / to_light.length_squared() } else { cosine }))
        }
        Light::Area { at, half, facing, color } => {
            // An even place on the rectangle, whose radiance is that of all its light over its area and pi.
            let [u, v] = sample.pair(pair).map(|x| 2.0 * x - 1.0);
            let at = at + u * half[0] + v * half[1];
            let to_light = at - seen.surface.point;
            let shines = -facing.dot(to_light.normalize_or_zero());
            if shines <= 0.0 {
                return None;
            }
            Some((color, from_place(tracer, seen, at)? * shines / to_light.length_squared()))
        }
        Light::Headlight { color } => {
            let cosine = -seen.normal.dot(ray.dir.normalize_or_zero());
            (0.0 < cosine).then_some((color, cosine))
        }
        Light::Sky { .. } => None,
    }
}

/// The cosine under which light of a place falls on a surface; `None` where it does not, or something stands between.
fn from_place<S: Scenery>(tracer: &mut Tracer<S>, seen: &Seen, at: DVec3) -> Option<f64> {
    let cosine = seen.normal.dot((at - seen.surface.point).normalize_or_zero());
    if cosine <= 0.0 {
        return None;
    }
    let start = start(seen);
    // A surface that the light itself lies on does not cover it.
    let before = Interval::new(0.0, 1.0_f64.next_down());
    let shadow = Ray::new(start, at - start);
    (shadow.is_valid() && !tracer.shadowed(&shadow, before)).then_some(cosine)
}

/// A direction to the sun's disc, even in solid angle, and what its cosine is to be multiplied with: the mean
/// cosine over a cone of half angle a around the normal is (1 + cos a) / 2, and facing the sun shall give 1.
fn toward_sun(toward: DVec3, half_angle: f64, sample: Sample, pair: u32) -> (DVec3, f64) {
    if half_angle == 0.0 {
        return (toward, 1.0);
    }
    let [u, v] = sample.pair(pair);
    // 1 - cos a without cancellation for a small sun.
    let cap = 2.0 * (0.5 * half_angle).sin().powi(2);
    let drop = u * cap;
    let dir = around(toward, 1.0 - drop, (drop * (2.0 - drop)).sqrt(), v);
    (dir, 1.0 / (1.0 - 0.5 * cap))
}

/// The unit vector with a height along an axis and a radius around it, `turn` of a turn round.
fn around(axis: DVec3, height: f64, radius: f64, turn: f64) -> DVec3 {
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let (sin, cos) = (TAU * turn).sin_cos();
    height * axis + radius * cos * tangent + radius * sin * bitangent
}
