//! Samples to an error: how many each pixel of a tile gets.
//!
//! What is asked is the root of the mean squared error over a tile, of what a display shows, at most. With n samples a pixel errs by
//! sigma / sqrt(n), so that one more sample takes sigma^2 / n^2 away from its squared error: samples are best spent where the
//! squared error over n is largest, which makes n go with sigma (Neyman 1934, "On the two different aspects of the
//! representative method", for strata). To give every pixel one error instead, n with sigma^2, takes as many samples in all as
//! to give every pixel one number of samples.
//!
//! The samples of a pixel double each time, as halves of a Sobol sequence fit together; a pixel's few samples may miss what is
//! rare, so that neighbours are judged together. Tiles are those of the whole picture, whatever is cropped.

use super::Progress;
use super::integrator::Painter;
use super::pixels::Pixel;
use super::scenery::{Scenery, Tracer};
use super::tiles::Tile;
use crate::film::Film;
use crate::num::srgb;

/// So many samples every pixel has before it is judged: four in each quarter.
const FIRST: u32 = 16;

/// What doubling the samples is expected to take from a squared error: half of it for samples by chance, more for those of a
/// Sobol sequence. What is too little is asked again.
const TAKEN: f64 = 0.7;

/// A sample pays where it takes more from a pixel's squared error than that asked over this number: tiles with noise in few
/// pixels reach their error at once, and are worth more. Measured on the scenes of `benches/light` from 32 to 1024: more is better
/// where noise is in few places, and makes the error less like the one asked.
const PAYS: f64 = 256.0;

impl<S: Scenery> Painter<'_, S> {
    /// Paints a tile to an error, or anything where the render is given up.
    pub(super) fn to_an_error(
        &self,
        tracer: &mut Tracer<S>,
        error: f64,
        (tile, progress): (&Tile, &Progress),
        film: &mut Film,
    ) {
        let most = self.view.settings.samples;
        let cell = tile.uncropped(self.view.settings.size);
        let whole = self.bundle(&cell);
        let parts: Vec<Tile> = cell.parts().collect();
        let mut pixels = vec![Pixel::default(); cell.pixels() as usize];
        for part in &parts {
            self.turn_to(tracer, &whole, part);
            for at in part.each() {
                let shown = tile.has(at).then_some(tile);
                let pixel = &mut pixels[cell.index(at)];
                self.begin(tracer, at, (pixel, most.min(FIRST)), shown, progress, film);
            }
        }
        while let Some(open) = self.open(&cell, &pixels, error).filter(|_| !progress.gives_up()) {
            for part in &parts {
                let mut here = part.each().filter(|at| open[cell.index(*at)]).peekable();
                if here.peek().is_some() {
                    self.turn_to(tracer, &whole, part);
                }
                for at in here {
                    self.double(tracer, at, &mut pixels[cell.index(at)], progress);
                }
            }
        }
        for at in tile.each() {
            self.end(&pixels[cell.index(at)], tile.index(at), film);
        }
    }

    /// Takes as many samples of a pixel as it has, up to the most.
    fn double(&self, tracer: &mut Tracer<S>, at: [u32; 2], pixel: &mut Pixel, progress: &Progress) {
        let (from, to) = (pixel.taken, self.view.settings.samples.min(2 * pixel.taken));
        pixel.fold();
        let quarter = |i| if i - from < from / 2 { 2 } else { 3 };
        self.sample(tracer, at, (pixel, to), None, progress, quarter);
    }

    /// Which pixels get more samples; `None` where the error is reached and no sample pays, or all have the most.
    fn open(&self, cell: &Tile, pixels: &[Pixel], error: f64) -> Option<Vec<bool>> {
        let squared = self.squared_errors(cell, pixels);
        let most = self.view.settings.samples;
        let gain = |i: usize| squared[i] / f64::from(pixels[i].taken);
        let pays = error * error / PAYS;
        let mut order: Vec<usize> = (0..pixels.len()).filter(|i| pixels[*i].taken < most).collect();
        order.sort_by(|a, b| gain(*b).total_cmp(&gain(*a)).then(a.cmp(b)));
        let bound = error * error * pixels.len() as f64;
        let mut left: f64 = squared.iter().sum();
        let mut open = vec![false; pixels.len()];
        for i in order {
            if left <= bound && gain(i) <= pays {
                break;
            }
            open[i] = true;
            left -= TAKEN * squared[i];
        }
        open.contains(&true).then_some(open)
    }

    /// The squared error of what a display shows of each pixel, as its neighbours know it too.
    fn squared_errors(&self, cell: &Tile, pixels: &[Pixel]) -> Vec<f64> {
        let gain = libm::exp2(self.view.settings.exposure);
        let own = |pixel: &Pixel| {
            let slope = srgb::slope((gain * pixel.brightness()).clamp(0.0, 1.0)) * gain;
            pixel.variance() * slope * slope
        };
        let own: Vec<f64> = pixels.iter().map(own).collect();
        let near = |[x, y]: [u32; 2]| {
            let around =
                Tile { x: x.saturating_sub(1), y: y.saturating_sub(1), size: [2 + x.min(1), 2 + y.min(1)] };
            let near = around.each().filter(|at| cell.has(*at)).map(|at| own[cell.index(at)]);
            let (sum, count) = near.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
            sum / count
        };
        cell.each().map(near).collect()
    }
}
