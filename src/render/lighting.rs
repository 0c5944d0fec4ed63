//! Lights as integrators ask them: aimed at from a surface, or found by a ray that goes its own way.
//!
//! A light that has a size is met both ways. Each way then counts by its density against those of both, the balance of Veach
//! ("Robust Monte Carlo Methods for Light Transport Simulation", 1997, 9.2), so that neither large lights in mirrors nor small
//! ones on chalk are noisy.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::frame::Frame;
use super::sampler::Sample;
use super::scenery::{Scenery, Seen, Tracer};
use crate::geom::{Interval, Ray};
use crate::shot::Light;
use crate::shot::material::lifted;

/// The pair of a turn that chooses where light comes from; pair 0 of the first is the place in the pixel.
pub const TOWARD_PAIR: u32 = 1;
/// The first pair that chooses a place on a light.
const FIRST_PAIR: u32 = 2;
/// How many lights have a pair of their own; more share them, which costs evenness.
const PAIRS: usize = 240;

/// The lights of a scene, sorted by how they are asked.
#[derive(Debug)]
pub struct Lights {
    /// Lights that are aimed at: with a place, a direction or a picture; dark ones are left out.
    aimed: Vec<Light>,
    /// Those of them that are skies with pictures.
    images: Vec<Light>,
    /// Radiance of all plain skies together; `None` where there is none.
    pub sky: Option<[f32; 3]>,
}

/// Light that a surface may get from a light.
#[derive(Clone, Copy, Debug)]
pub struct Aimed {
    /// Unit vector to where it comes from.
    pub dir: DVec3,
    /// A ray to there from the surface.
    pub ray: Ray,
    /// The part of the ray that has to be free.
    pub range: Interval,
    /// Radiance over density: what a surface's share a steradian is multiplied with.
    pub light: Vec3,
    /// The density with which the direction was chosen; `None` where no ray can find the light.
    pub density: Option<f64>,
    /// Whether every ray into the open finds it, not only those that are followed to what they meet.
    pub open: bool,
}

/// How the direction of a ray was chosen that may find lights.
#[derive(Clone, Copy, Debug)]
pub enum Came {
    /// From the eye, straight or through glass: lights themselves are not to be seen.
    Eye,
    /// By a surface that could choose no other, or from the eye by way of a mirror.
    Sharp,
    /// By a surface with these densities, a steradian: of all its choices, and of those whose rays find lights that are not
    /// in the open.
    Spread([f64; 2]),
}

/// What a way counts for, by its density and that of the other.
pub fn balance(this: f64, other: f64) -> f32 {
    (this / (this + other)) as f32
}

impl Came {
    /// What light counts for that was found, by the density with which it is aimed at.
    fn counts(self, aimed: f64, open: bool) -> f32 {
        match self {
            Came::Eye => 0.0,
            Came::Sharp => 1.0,
            Came::Spread([all, _]) if open => balance(all, aimed),
            // Where rays of this kind are not counted on, the other way has all.
            Came::Spread([_, 0.0]) => 0.0,
            // Of the ways that the direction could have been chosen only some count: each for its part of all.
            Came::Spread([all, counted]) => balance(counted, aimed) * (all / counted) as f32,
        }
    }
}

impl Lights {
    /// Lights that can contribute; of an empty list, the default ones.
    pub fn new(lights: &[Light]) -> Lights {
        let lights = if lights.is_empty() { &crate::shot::light::DEFAULT } else { lights };
        let mut sky: Option<[f32; 3]> = None;
        let mut aimed = Vec::new();
        for light in lights {
            match light {
                Light::Sky { color } => {
                    let sum = Vec3::from_array(sky.unwrap_or_default()) + Vec3::from_array(*color);
                    sky = Some(sum.to_array());
                }
                Light::Image { .. } => aimed.push(light.clone()),
                Light::Sun { color, .. }
                | Light::Point { color, .. }
                | Light::Area { color, .. }
                | Light::Headlight { color } => {
                    if *color != [0.0; 3] {
                        aimed.push(light.clone());
                    }
                }
            }
        }
        // Lights with a place or a direction first: so they keep their numbers where a sky is added.
        aimed.sort_by_key(|light| matches!(light, Light::Image { .. }));
        let images = aimed.iter().filter(|light| matches!(light, Light::Image { .. })).cloned().collect();
        Lights { aimed, images, sky }
    }

    /// Whether a ray into the open finds any light.
    pub fn is_open_bright(&self) -> bool {
        self.sky.is_some_and(|sky| sky != [0.0; 3]) || !self.images.is_empty()
    }

    /// Aims at every light in turn from a surface. `from_eye` tells that the eye sees the surface, be it through glass or in
    /// mirrors: a headlight shines there along the way it was seen.
    #[inline(always)]
    pub fn aim(
        &self,
        ray: &Ray,
        seen: &Seen,
        sample: Sample,
        turn: u32,
        from_eye: bool,
        mut then: impl FnMut(&Aimed),
    ) {
        for (i, light) in self.aimed.iter().enumerate() {
            let place = || sample.pair(turn_pair(turn, FIRST_PAIR + (i % PAIRS) as u32));
            match light {
                Light::Headlight { color } if from_eye => then(&headlight(*color, ray, seen)),
                _ => aim_at(light, seen, place, &mut then),
            }
        }
    }

    /// The light of what a ray passes from one place on its line to another (`None`: into the open), and of the open itself.
    pub fn found(&self, ray: &Ray, from: f64, until: Option<f64>, came: Came) -> Vec3 {
        let mut sum = Vec3::ZERO;
        if !matches!(came, Came::Eye) {
            for (light, density) in self.aimed.iter().filter_map(|light| met(light, ray, from, until)) {
                sum += light * came.counts(density, false);
            }
        }
        if until.is_none() {
            sum += self.open(ray.dir.normalize_or_zero(), came);
        }
        sum
    }

    /// The light of the open in a direction: the eye sees that as it is.
    pub fn open(&self, dir: DVec3, came: Came) -> Vec3 {
        // A plain sky is never aimed at: rays by a surface's own share find it best.
        let mut sum = Vec3::from_array(self.sky.unwrap_or_default());
        for light in &self.images {
            if let Light::Image { map, color } = light {
                let counts =
                    if matches!(came, Came::Eye) { 1.0 } else { came.counts(map.density(dir), true) };
                sum += map.radiance(dir) * Vec3::from_array(*color) * counts;
            }
        }
        sum
    }

    /// Whether the open has light of its own, so that pictures show it.
    pub fn has_open(&self) -> bool {
        self.sky.is_some() || !self.images.is_empty()
    }
}

/// The number of a pair that belongs to a turn of a path.
pub fn turn_pair(turn: u32, pair: u32) -> u32 {
    (turn << 8) + pair
}

/// Where rays that leave a surface on the eye's side start.
pub fn start(seen: &Seen) -> DVec3 {
    seen.surface.point + seen.surface.offset * seen.normal
}

/// Whether one ray into the sky, cosine-weighted, meets nothing.
pub fn open_sky<S: Scenery>(tracer: &mut Tracer<S>, seen: &Seen, sample: Sample) -> bool {
    let dir = Frame::new(seen.normal).from(lifted(sample.pair(TOWARD_PAIR)));
    !tracer.shadowed(&Ray::new(start(seen), dir), Interval::AHEAD)
}

/// A matte surface that gets the light of this colour shows it times its own: its irradiance is pi times as much.
fn irradiance(color: [f32; 3]) -> Vec3 {
    Vec3::from_array(color) * PI as f32
}

// Not inlined: the compiler then makes the direction before it knows whether there is a headlight.
#[inline(never)]
fn headlight(color: [f32; 3], ray: &Ray, seen: &Seen) -> Aimed {
    let dir = -ray.dir.normalize_or_zero();
    let (ray, range) = (Ray::new(start(seen), dir), Interval::EMPTY);
    Aimed { dir, ray, range, light: irradiance(color), density: None, open: false }
}

/// Aims at a light and shows it, unless none of it arrives whatever is in between. (Shown, not returned: copies of what is
/// aimed at take a tenth of the time of direct light.)
#[inline(always)]
fn aim_at(light: &Light, seen: &Seen, place: impl Fn() -> [f64; 2], then: &mut impl FnMut(&Aimed)) {
    let mut far = |dir: DVec3, light: Vec3, density: Option<f64>, open: bool| {
        if 0.0 < seen.normal.dot(dir) {
            let ray = Ray::new(start(seen), dir);
            then(&Aimed { dir, ray, range: Interval::AHEAD, light, density, open });
        }
    };
    match light {
        Light::Sun { toward, half_angle, color } => {
            if *half_angle == 0.0 {
                return far(*toward, irradiance(*color), None, false);
            }
            let (dir, cap) = toward_sun(*toward, *half_angle, place());
            // The mean cosine over a cone of half angle a around the normal is (1 + cos a) / 2, and facing the sun gives 1.
            far(dir, irradiance(*color) / (1.0 - 0.5 * cap) as f32, Some(1.0 / (TAU * cap)), false)
        }
        Light::Point { at, falloff, color } => {
            let light = irradiance(*color);
            let faded = if *falloff { (*at - seen.surface.point).length_squared() } else { 1.0 };
            from_place(seen, *at, light / faded as f32, None, then);
        }
        Light::Area { at, half, facing, color } => {
            // An even place on the rectangle, whose radiance is that of all its light over its area and pi.
            let [u, v] = place().map(|x| 2.0 * x - 1.0);
            let at = *at + u * half[0] + v * half[1];
            let to_light = at - seen.surface.point;
            let shines = -facing.dot(to_light.normalize_or_zero());
            let distance2 = to_light.length_squared();
            let density = distance2 / (shines * area(half));
            let light = irradiance(*color) * (shines / distance2) as f32;
            if 0.0 < shines {
                from_place(seen, at, light, Some(density), then);
            }
        }
        Light::Image { map, color } => {
            let (dir, density) = map.choose(place());
            far(dir, map.radiance(dir) * Vec3::from_array(*color) / density as f32, Some(density), true)
        }
        Light::Sky { .. } | Light::Headlight { .. } => {}
    }
}

/// Light from a place.
fn from_place(seen: &Seen, at: DVec3, light: Vec3, density: Option<f64>, then: &mut impl FnMut(&Aimed)) {
    let dir = (at - seen.surface.point).normalize_or_zero();
    let start = start(seen);
    // A surface that the light itself lies on does not cover it.
    let range = Interval::new(0.0, 1.0_f64.next_down());
    let ray = Ray::new(start, at - start);
    if 0.0 < seen.normal.dot(dir) && ray.is_valid() {
        then(&Aimed { dir, ray, range, light, density, open: false });
    }
}

/// Radiance of a light with a size that a ray passes, and the density with which that is aimed at from the ray's start.
fn met(light: &Light, ray: &Ray, from: f64, until: Option<f64>) -> Option<(Vec3, f64)> {
    match light {
        Light::Sun { toward, half_angle, color } if 0.0 < *half_angle && until.is_none() => {
            let apart = ray.dir.normalize_or_zero() - *toward;
            // Half the chord is the sine of half the angle: no cancellation for a small sun.
            let sin = (0.5 * half_angle).sin();
            let cap = 2.0 * sin * sin;
            let radiance = irradiance(*color) / ((1.0 - 0.5 * cap) * TAU * cap) as f32;
            (apart.length() <= 2.0 * sin).then(|| (radiance, 1.0 / (TAU * cap)))
        }
        Light::Area { at, half, facing, color } => {
            let slope = -facing.dot(ray.dir);
            let t = (ray.origin - *at).dot(*facing) / slope;
            let point = ray.at(t) - *at;
            let within = |side: DVec3| point.dot(side).abs() <= side.length_squared();
            let passed = 0.0 < t && from <= t && t < until.unwrap_or(f64::INFINITY);
            if !(0.0 < slope && passed && half.iter().all(|side| within(*side))) {
                return None;
            }
            let length = ray.dir.length();
            let density = (t * length).powi(2) / (slope / length * area(half));
            Some((irradiance(*color) / area(half) as f32, density))
        }
        _ => None,
    }
}

fn area(half: &[DVec3; 2]) -> f64 {
    4.0 * half[0].length() * half[1].length()
}

/// A direction to the sun's disc, even in solid angle, and how much of the axis the disc spans.
fn toward_sun(toward: DVec3, half_angle: f64, [u, v]: [f64; 2]) -> (DVec3, f64) {
    // 1 - cos a without cancellation for a small sun.
    let cap = 2.0 * (0.5 * half_angle).sin().powi(2);
    let drop = u * cap;
    let radius = (drop * (2.0 - drop)).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    (Frame::new(toward).from(DVec3::new(radius * cos, radius * sin, 1.0 - drop)), cap)
}
