//! What a ray from the eye brings back, and the pixels of a tile made of it.

use super::ghosts::Ghosts;
use super::layers;
use super::lighting::{Lights, open_sky};
use super::sampler::{PixelSampler, Sample};
use super::scenery::{Rays, Scenery, Seen, Tracer};
use super::tiles::Tile;
use super::{RenderError, View};
use crate::csg::Bundle;
use crate::film::Film;
use crate::geom::{Beam, Interval, Ray};
use crate::shot::settings::Integrator;
use crate::solid::Counts;

/// The pair of a sample that chooses a place on the lens: none of those that lights take.
const LENS_PAIR: u32 = 1 << 20;

/// Everything that painting a pixel needs.
pub struct Painter<'a, S> {
    scenery: &'a S,
    view: View<'a>,
    lights: Lights,
    /// What is seen through; only pictures of colours and light show it.
    ghosts: Option<Ghosts<'a>>,
    /// Distances between which the picture of distances goes from white to black, world length.
    depths: Interval,
}

impl<'a, S: Scenery> Painter<'a, S> {
    /// Gets ready.
    pub fn new(scenery: &'a S, view: &View<'a>) -> Painter<'a, S> {
        let depths = match view.settings.integrator {
            Integrator::Depth => depths(scenery, view),
            _ => Interval::EMPTY,
        };
        let shown =
            matches!(view.settings.integrator, Integrator::Direct | Integrator::Ao | Integrator::Flat);
        let ghosts = view.ghosts.filter(|_| shown).map(|world| Ghosts::new(world, view.materials));
        Painter { scenery, view: *view, lights: Lights::new(view.lights), ghosts, depths }
    }

    /// Paints a tile.
    pub fn tile(&self, tile: &Tile) -> Result<(Film, Rays, Counts), RenderError> {
        let mut film = Film::new(tile.size, &self.view.settings.aov)?;
        let mut tracer = Tracer::new(self.scenery);
        let whole = self.beam(tile).map_or_else(Bundle::default, |beam| self.scenery.bundle(&beam));
        for part in tile.parts() {
            if let Some(beam) = self.beam(&part) {
                tracer.bundle = self.scenery.part_of_bundle(&whole, &beam);
            }
            for (y, x) in
                (0..part.size[1]).flat_map(|y| (0..part.size[0]).map(move |x| (part.y + y, part.x + x)))
            {
                let pixel = (y - tile.y) as usize * tile.size[0] as usize + (x - tile.x) as usize;
                self.pixel(&mut tracer, x, y, pixel, &mut film);
            }
        }
        Ok((film, tracer.rays, tracer.scratch.solid.counts))
    }

    /// The rays from the eye through a tile.
    fn beam(&self, tile: &Tile) -> Option<Beam> {
        let [x, y] = [tile.x, tile.y].map(f64::from);
        let [w, h] = tile.size.map(f64::from);
        self.view.camera.beam([x, y], [x + w, y + h], self.view.settings.size)
    }

    /// Paints a pixel of the whole picture to a place of a film.
    fn pixel(&self, tracer: &mut Tracer<S>, x: u32, y: u32, pixel: usize, film: &mut Film) {
        let settings = self.view.settings;
        let ray_at =
            |dx: f64, dy: f64| self.view.camera.ray(f64::from(x) + dx, f64::from(y) + dy, settings.size);
        let centre = (!film.layers.is_empty()).then(|| {
            let ray = ray_at(0.5, 0.5);
            let seen = tracer.see(&ray);
            if let Some(seen) = &seen {
                layers::keep(film, pixel, &ray, seen, self.albedo(tracer, seen));
            }
            seen
        });
        let mut sum = [0.0_f32; 4];
        for ([dx, dy], sample) in PixelSampler::new(settings.seed, x, y, settings.samples).samples() {
            // A single sample is what `probe` sees: it goes through the middle of the lens as well.
            let on_lens = || if settings.samples == 1 { [0.0; 2] } else { sample.pair(LENS_PAIR) };
            let [x, y] = [f64::from(x) + dx, f64::from(y) + dy];
            let ray = self.view.camera.ray_through(x, y, settings.size, on_lens);
            // A single sample goes through the centre as well.
            let seen = centre.filter(|_| settings.samples == 1).unwrap_or_else(|| tracer.see(&ray));
            let mut value = self.value(tracer, &ray, seen.as_ref(), sample);
            if let Some(ghosts) = &self.ghosts {
                value = ghosts.over(&mut tracer.scratch, &ray, seen.as_ref(), value);
            }
            for (s, v) in sum.iter_mut().zip(value) {
                *s += v;
            }
        }
        film.rgba[pixel] = sum.map(|s| s / settings.samples as f32);
    }

    /// The colour and coverage that one ray brings back.
    fn value(&self, tracer: &mut Tracer<S>, ray: &Ray, seen: Option<&Seen>, sample: Sample) -> [f32; 4] {
        let integrator = self.view.settings.integrator;
        let Some(seen) = seen else {
            return match self.lights.sky {
                Some([r, g, b]) if integrator == Integrator::Direct => [r, g, b, 1.0],
                _ => [0.0; 4],
            };
        };
        let [r, g, b] = match integrator {
            Integrator::Direct => self.direct(tracer, ray, seen, sample),
            Integrator::Ao => [f32::from(u8::from(open_sky(tracer, seen, sample))); 3],
            Integrator::Normals => {
                let normal = if seen.hit.sheet { seen.normal } else { seen.surface.normal };
                (0.5 * normal + 0.5).as_vec3().to_array()
            }
            Integrator::Depth => [self.brightness(layers::distance(ray, seen)); 3],
            Integrator::Flat => self.albedo(tracer, seen),
        };
        [r, g, b, 1.0]
    }

    /// Light from the lights that the surface sends to the eye.
    fn direct(&self, tracer: &mut Tracer<S>, ray: &Ray, seen: &Seen, sample: Sample) -> [f32; 3] {
        let albedo = self.albedo(tracer, seen);
        if albedo == [0.0; 3] {
            return albedo;
        }
        let light = self.lights.arriving(tracer, ray, seen, sample);
        std::array::from_fn(|i| albedo[i] * light[i])
    }

    fn albedo(&self, tracer: &mut Tracer<S>, seen: &Seen) -> [f32; 3] {
        let material = self.view.materials.get(seen.surface.material as usize).copied().unwrap_or_default();
        material.albedo(if material.reads_color() { tracer.color(seen) } else { None })
    }

    /// 1 at the near end of what is drawn, 0 at the far end.
    fn brightness(&self, distance: f64) -> f32 {
        ((self.depths.hi - distance) / self.depths.length()).clamp(0.0, 1.0) as f32
    }
}

/// The distances from the eye between which the bounds of a scenery lie. Where nothing is bounded, or the
/// bounds are a point, all surfaces are alike.
fn depths<S: Scenery>(scenery: &S, view: &View) -> Interval {
    let bounds = scenery.bounds();
    let all_white = Interval::new(0.0, f64::MAX);
    if bounds.is_empty() || !bounds.is_finite() {
        return all_white;
    }
    let eye = view.camera.eye();
    let farthest = bounds.corners().map(|c| c.distance(eye)).into_iter().fold(0.0, f64::max);
    let depths = Interval::new(bounds.distance_squared(eye).sqrt(), farthest);
    if 0.0 < depths.length() { depths } else { all_white }
}
