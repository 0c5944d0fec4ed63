//! The samples of pixels, and what they tell of a pixel's error.
//!
//! The error is told by how the four quarters of its samples differ: each quarter of a Sobol sequence is spread well by itself,
//! so that this is nearer to the truth than how single samples differ, and still above it.

use super::Progress;
use super::integrator::Painter;
use super::layers::{self, Sums};
use super::sampler::{PixelSampler, Sample};
use super::scenery::{Scenery, Seen, Tracer};
use super::tiles::Tile;
use crate::film::Film;
use crate::geom::Ray;
use crate::solid::Counts;

/// The pair of a sample that chooses a place on the lens: none of those that lights take.
const LENS_PAIR: u32 = 1 << 20;

/// A pixel on its way.
#[derive(Clone, Copy, Default)]
pub(super) struct Pixel {
    /// Weighted colour and coverage of all samples: in `f64`, so that a late dim sample counts as an early one.
    sum: [f64; 4],
    /// Their weights.
    weight: f64,
    /// Samples taken.
    pub taken: u32,
    /// The samples of each quarter.
    quarters: [Quarter; 4],
    /// The work of its rays.
    work: Counts,
}

/// A quarter of a pixel's samples.
#[derive(Clone, Copy, Default)]
struct Quarter {
    /// Weighted brightness.
    sum: f64,
    weight: f64,
    taken: u32,
}

impl Quarter {
    fn and(self, other: Quarter) -> Quarter {
        Quarter {
            sum: self.sum + other.sum,
            weight: self.weight + other.weight,
            taken: self.taken + other.taken,
        }
    }
}

/// What weighted sums are divided by. By their weights: a filter with negative lobes would make noise of an even light else. Of
/// few samples the weights may cancel; their number is what they come to on the mean.
fn whole(weight: f64, taken: u32) -> f64 {
    let taken = f64::from(taken);
    if 0.5 * taken < weight { weight } else { taken }
}

impl Pixel {
    /// Makes room for as many samples again: the quarters so far become two.
    pub fn fold(&mut self) {
        let [a, b, c, d] = self.quarters;
        self.quarters = [a.and(b), c.and(d), Quarter::default(), Quarter::default()];
    }

    /// The mean brightness.
    pub fn brightness(&self) -> f64 {
        luminance(self.mean())
    }

    /// The mean colour and coverage.
    fn mean(&self) -> [f64; 4] {
        self.sum.map(|sum| sum / whole(self.weight, self.taken))
    }

    /// The squared standard error of the brightness; infinite where a single sample tells nothing.
    pub fn variance(&self) -> f64 {
        let mean = self.brightness();
        let quarters = self.quarters.iter().filter(|q| 0 < q.taken);
        let apart = |q: &Quarter| f64::from(q.taken) * (q.sum / whole(q.weight, q.taken) - mean).powi(2);
        let degrees = quarters.clone().count() as f64 - 1.0;
        if degrees == 0.0 {
            f64::INFINITY
        } else {
            quarters.map(apart).sum::<f64>() / f64::from(self.taken) / degrees
        }
    }
}

/// Rec. 709 luminance.
fn luminance([r, g, b, _]: [f64; 4]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

impl<S: Scenery> Painter<'_, S> {
    /// Paints a tile with one number of samples for every pixel, or anything where the render is given up.
    pub(super) fn evenly(
        &self,
        tracer: &mut Tracer<S>,
        (tile, progress): (&Tile, &Progress),
        film: &mut Film,
    ) {
        let whole = self.bundle(tile);
        for part in tile.parts() {
            self.turn_to(tracer, &whole, &part);
            for at in part.each() {
                let mut pixel = Pixel::default();
                self.begin(tracer, at, (&mut pixel, self.view.settings.samples), Some(tile), progress, film);
                self.end(&pixel, tile.index(at), film);
            }
            if progress.gives_up() {
                break;
            }
        }
    }

    /// Takes the first samples of a pixel; where it belongs to a tile its layers are kept there.
    pub(super) fn begin(
        &self,
        tracer: &mut Tracer<S>,
        at: [u32; 2],
        (pixel, first): (&mut Pixel, u32),
        tile: Option<&Tile>,
        progress: &Progress,
        film: &mut Film,
    ) {
        let quarter = |i| (4 * u64::from(i) / u64::from(first)) as usize;
        match tile.filter(|_| !film.layers.is_empty()) {
            Some(tile) => {
                let centre = self.centre(tracer, at, tile, film);
                self.sample(tracer, at, (pixel, first), Some(&centre), progress, quarter);
            }
            None => self.sample(tracer, at, (pixel, first), None, progress, quarter),
        }
    }

    /// Writes a pixel that is done.
    pub(super) fn end(&self, pixel: &Pixel, index: usize, film: &mut Film) {
        film.rgba[index] = pixel.mean().map(|mean| mean as f32);
        if self.keeps_book {
            let sums = Sums { work: pixel.work, variance: pixel.variance(), samples: pixel.taken };
            layers::sum_up(film, index, &sums);
        }
    }

    /// Keeps what the ray through a pixel's centre sees.
    fn centre(&self, tracer: &mut Tracer<S>, at: [u32; 2], tile: &Tile, film: &mut Film) -> Option<Seen> {
        let [x, y] = at.map(|i| f64::from(i) + 0.5);
        let ray = self.view.camera.ray(x, y, self.view.settings.size);
        let seen = tracer.see(&ray);
        let albedo = seen.as_ref().map(|seen| (seen, self.albedo(tracer, seen)));
        layers::keep(film, tile.index(at), &ray, albedo, tracer);
        seen
    }

    /// The value of a sample, ghosts before it.
    fn shown(&self, tracer: &mut Tracer<S>, ray: &Ray, seen: Option<&Seen>, sample: Sample) -> [f32; 4] {
        let value = self.value(tracer, ray, seen, sample);
        match &self.ghosts {
            Some(ghosts) => ghosts.over(&mut tracer.scratch, ray, seen, value),
            None => value,
        }
    }

    /// Takes samples of a pixel of the whole picture up to a number; `centre` is what the ray through its centre is known to
    /// see, `quarter` says where each sample counts.
    pub(super) fn sample(
        &self,
        tracer: &mut Tracer<S>,
        [x, y]: [u32; 2],
        (pixel, to): (&mut Pixel, u32),
        centre: Option<&Option<Seen>>,
        progress: &Progress,
        quarter: impl Fn(u32) -> usize,
    ) {
        let settings = self.view.settings;
        let single = settings.samples == 1;
        let known = centre.filter(|_| single);
        let before = self.keeps_book.then_some(tracer.scratch.solid.counts);
        let sampler = PixelSampler::new(settings.seed, x, y);
        for i in pixel.taken..to {
            if progress.gives_up() {
                break;
            }
            let sample = sampler.sample(i);
            // A single sample is what `probe` sees: it goes through the middles of pixel and lens.
            let ([dx, dy], weight) = if single { ([0.5; 2], 1.0) } else { self.spread.place(sample.pair(0)) };
            let on_lens = || if single { [0.0; 2] } else { sample.pair(LENS_PAIR) };
            let [x, y] = [f64::from(x) + dx, f64::from(y) + dy];
            let ray: Ray = self.view.camera.ray_through(x, y, settings.size, on_lens);
            let value = match known {
                Some(centre) => self.shown(tracer, &ray, centre.as_ref(), sample),
                None => {
                    let seen = tracer.see(&ray);
                    self.shown(tracer, &ray, seen.as_ref(), sample)
                }
            };
            let value = value.map(|v| f64::from(v) * weight);
            pixel.sum.iter_mut().zip(value).for_each(|(s, v)| *s += v);
            pixel.weight += weight;
            if self.keeps_book {
                let more = Quarter { sum: luminance(value), weight, taken: 1 };
                let quarter = &mut pixel.quarters[quarter(i)];
                *quarter = quarter.and(more);
            }
        }
        pixel.taken = to;
        if let Some(before) = before {
            pixel.work.add(&tracer.scratch.solid.counts.since(&before));
        }
    }
}
