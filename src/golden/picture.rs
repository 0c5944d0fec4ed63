//! Golden pictures, for people; and pictures of where goldens differ.

use std::io;
use std::path::Path;

use super::layers;
use crate::compare::heat;
use crate::film::Film;
use crate::output::{Pixels, png_note, read_png, tone};
use crate::shot::Settings;

/// What the file of a golden says of itself, so that it is not taken for a rendering.
pub const NOTE: [&str; 2] = ["pss.golden", "what the scene beside it shows"];

/// An 8-bit picture.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Picture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// sRGB, three bytes a pixel, row by row from the top left.
    pub bytes: Vec<u8>,
}

impl Picture {
    /// What a display shows of a film.
    pub fn of(film: &Film, settings: &Settings) -> Picture {
        let display = tone::Display::new(settings.exposure, settings.tone);
        let bytes = film.rgba.iter().flat_map(|[r, g, b, _]| display.of([*r, *g, *b])).collect();
        Picture { size: film.size, bytes }
    }

    /// Reads a `.png`; fails where it cannot be read or is broken.
    pub fn read(path: &Path) -> io::Result<Picture> {
        let Pixels { size, rgba, .. } = read_png(path)?;
        let levels = |[r, g, b, _]: [f32; 4]| [r, g, b].map(|c| (255.0 * c).round() as u8);
        Ok(Picture { size, bytes: rgba.into_iter().flat_map(levels).collect() })
    }

    /// Whether a file says that it is a golden.
    pub fn is_golden(path: &Path) -> bool {
        png_note(path, NOTE[0]).is_ok_and(|note| note.is_some())
    }

    /// The colour of a pixel, in words.
    pub fn told(&self, pixel: usize) -> String {
        let [r, g, b] = self.at(pixel);
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    fn at(&self, pixel: usize) -> [u8; 3] {
        [0, 1, 2].map(|c| self.bytes.get(3 * pixel + c).copied().unwrap_or_default())
    }
}

/// The pixels that differ between two pictures of one size by more than a level, ascending; some at edges are let pass. `film` is
/// what the later was made of.
pub fn differing(was: &Picture, now: &Picture, film: &Film) -> Vec<usize> {
    let edges = layers::edges(film);
    let far = |pixel: &usize| was.at(*pixel).iter().zip(now.at(*pixel)).any(|(a, b)| 1 < a.abs_diff(b));
    let (apart, off) = (0..edges.len()).filter(far).partition(|pixel| edges[*pixel]);
    layers::wrong(apart, off, edges.len())
}

/// What was and what is, and which pixels differ.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pair {
    /// As the golden is.
    pub was: Picture,
    /// As it is now.
    pub now: Picture,
    /// Ascending; empty where their sizes are not the same.
    pub differing: Vec<usize>,
}

/// How often a pixel is repeated each way in a picture of differences, so that people see it, and how wide the lines between are.
const ZOOM: u32 = 3;

/// A picture of differences: a row for each pair, from left to right what was, where they differ (light, and dim by how many levels
/// the rest is off; nothing where the sizes are not the same), what is.
pub fn differences(pairs: &[Pair]) -> Picture {
    let width = pairs.iter().map(|pair| 3 * pair.size()[0] + 2).max().unwrap_or(1);
    let height = pairs.iter().map(|pair| pair.size()[1] + 1).sum::<u32>().max(2) - 1;
    let mut small = vec![[64; 3]; (width * height) as usize];
    let mut top = 0;
    for pair in pairs {
        let [w, h] = pair.size();
        for (i, panel) in [&pair.was, &pair.map(), &pair.now].into_iter().enumerate() {
            let [pw, ph] = panel.size;
            for (x, y) in (0..ph).flat_map(|y| (0..pw).map(move |x| (x, y))) {
                let to = (top + y) * width + i as u32 * (w + 1) + x;
                small[to as usize] = panel.at((y * pw + x) as usize);
            }
        }
        top += h + 1;
    }
    let size = [ZOOM * width, ZOOM * height];
    let from = |x: u32, y: u32| small[(y / ZOOM * width + x / ZOOM) as usize];
    let bytes = (0..size[1]).flat_map(|y| (0..size[0]).flat_map(move |x| from(x, y))).collect();
    Picture { size, bytes }
}

impl Pair {
    /// Room for either.
    fn size(&self) -> [u32; 2] {
        [0, 1].map(|i| self.was.size[i].max(self.now.size[i]))
    }

    /// Where they differ.
    fn map(&self) -> Picture {
        if self.was.size != self.now.size {
            return Picture { size: [0, 0], bytes: Vec::new() };
        }
        let level = |pixel: usize| {
            let apart = self.was.at(pixel).iter().zip(self.now.at(pixel)).map(|(a, b)| a.abs_diff(b)).max();
            match self.differing.binary_search(&pixel) {
                Ok(_) => 1.0,
                // Half the scale for what is let pass.
                Err(_) => f64::from(apart.unwrap_or_default()) / 510.0,
            }
        };
        let bytes = (0..self.was.bytes.len() / 3).flat_map(|pixel| heat(level(pixel))).collect();
        Picture { size: self.was.size, bytes }
    }
}
