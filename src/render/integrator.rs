//! What a ray from the eye brings back, and the pixels of a tile made of it.

use super::filter::Spread;
use super::ghosts::Ghosts;
use super::layers;
use super::lighting::{Lights, open_sky};
use super::sampler::Sample;
use super::scenery::{Rays, Scenery, Seen, Tracer};
use super::tiles::Tile;
use super::{Progress, RenderError, View};
use crate::csg::Bundle;
use crate::film::Film;
use crate::geom::{Beam, Interval, Ray};
use crate::shot::settings::Integrator;
use crate::solid::Counts;

/// Everything that painting a pixel needs.
pub struct Painter<'a, S> {
    scenery: &'a S,
    pub(super) view: View<'a>,
    pub(super) lights: Lights,
    /// What is seen through; only pictures of colours and light show it.
    pub(super) ghosts: Option<Ghosts<'a>>,
    /// Where samples lie around their pixel.
    pub(super) spread: Spread,
    /// Whether samples are judged, or a layer tells of a pixel's samples and their work.
    pub(super) keeps_book: bool,
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
        let shown = !matches!(view.settings.integrator, Integrator::Normals | Integrator::Depth);
        let ghosts = view.ghosts.filter(|_| shown).map(|world| Ghosts::new(world, view.materials));
        let spread = Spread::new(view.settings.filter);
        let keeps_book = view.settings.error.is_some() || view.settings.aov.iter().any(|aov| aov.is_summed());
        Painter { scenery, view: *view, lights: Lights::new(view.lights), ghosts, spread, keeps_book, depths }
    }

    /// Paints a tile, or the first pixels of one that is given up.
    pub fn tile(&self, tile: &Tile, progress: &Progress) -> Result<(Film, Rays, Counts), RenderError> {
        let mut film = Film::new(tile.size, &self.view.settings.aov)?;
        let mut tracer = Tracer::new(self.scenery);
        match self.view.settings.error {
            Some(error) => self.to_an_error(&mut tracer, error, (tile, progress), &mut film),
            None => self.evenly(&mut tracer, (tile, progress), &mut film),
        }
        Ok((film, tracer.rays, tracer.scratch.solid.counts))
    }

    /// What the rays from the eye through a tile may meet.
    pub(super) fn bundle(&self, tile: &Tile) -> Bundle {
        self.beam(tile).map_or_else(Bundle::default, |beam| self.scenery.bundle(&beam))
    }

    /// Turns to a part of a tile: its rays meet less than those of the tile's bundle.
    pub(super) fn turn_to(&self, tracer: &mut Tracer<S>, bundle: &Bundle, part: &Tile) {
        if let Some(beam) = self.beam(part) {
            tracer.bundle = self.scenery.part_of_bundle(bundle, &beam);
        }
    }

    /// The rays from the eye through a tile, and as far around it as the filter reaches.
    fn beam(&self, tile: &Tile) -> Option<Beam> {
        let [x, y] = [tile.x, tile.y].map(f64::from);
        let [w, h] = tile.size.map(f64::from);
        let m = self.spread.margin();
        self.view.camera.beam([x - m, y - m], [x + w + m, y + h + m], self.view.settings.size)
    }

    /// The colour and coverage that one ray brings back.
    pub(super) fn value(
        &self,
        tracer: &mut Tracer<S>,
        ray: &Ray,
        seen: Option<&Seen>,
        sample: Sample,
    ) -> [f32; 4] {
        let integrator = self.view.settings.integrator;
        if matches!(integrator, Integrator::Direct | Integrator::Path) {
            return self.light(tracer, ray, seen, sample);
        }
        let Some(seen) = seen else { return [0.0; 4] };
        let [r, g, b] = match integrator {
            Integrator::Ao => [f32::from(u8::from(open_sky(tracer, seen, sample))); 3],
            Integrator::Normals => {
                let normal = if seen.hit.sheet { seen.normal } else { seen.surface.normal };
                (0.5 * normal + 0.5).as_vec3().to_array()
            }
            Integrator::Depth => [self.brightness(layers::distance(ray, seen)); 3],
            Integrator::Direct | Integrator::Path | Integrator::Flat => self.albedo(tracer, seen),
        };
        [r, g, b, 1.0]
    }

    /// The share of light that a surface sends on, linear.
    pub(super) fn albedo(&self, tracer: &mut Tracer<S>, seen: &Seen) -> [f32; 3] {
        let material = self.material(seen.surface.material);
        let own = if material.reads_color() { tracer.color(seen) } else { None };
        material.albedo(seen.surface.point, own)
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
