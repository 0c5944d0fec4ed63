//! Pictures as they are compared: from files of either kind.

use std::io;
use std::path::Path;

use super::layers::{self, Layer};
use crate::num::srgb;
use crate::output::{Format, Pixels, read_channels, read_png};

/// Pixels row by row from the top left.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Picture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Red, green, blue and coverage.
    pub rgba: Vec<[f32; 4]>,
    /// Whether the numbers are linear light; else they are encoded as sRGB, from 0 to 1.
    pub linear: bool,
    /// Whether coverage was in the file; else it is not compared.
    pub has_alpha: bool,
    /// What an EXR holds beside its colour; `None` of a PNG, which cannot hold any.
    pub layers: Option<Vec<Layer>>,
}

impl Picture {
    /// Reads a `.png` or an `.exr`. Fails where the file cannot be read, is broken, or has another suffix.
    pub fn read(path: &Path) -> io::Result<Picture> {
        match Format::of(path) {
            Some(Format::Png) => {
                let Pixels { size, rgba, has_alpha } = read_png(path)?;
                Ok(Picture { size, rgba, linear: false, has_alpha, layers: None })
            }
            Some(Format::Exr) => {
                let channels = read_channels(path)?;
                let (size, rgba) = (channels.size, channels.rgba());
                let has_alpha = channels.values("A").is_some();
                let layers = Some(layers::of(channels.facts()));
                Ok(Picture { size, rgba, linear: true, has_alpha, layers })
            }
            None => Err(io::Error::new(io::ErrorKind::InvalidInput, "its name does not end in .png or .exr")),
        }
    }

    /// Linear light.
    pub fn light(&self) -> Vec<[f32; 4]> {
        let decoded = |&[r, g, b, a]: &[f32; 4]| {
            let [r, g, b] = [r, g, b].map(|c| srgb::decode(f64::from(c)) as f32);
            [r, g, b, a]
        };
        if self.linear { self.rgba.clone() } else { self.rgba.iter().map(decoded).collect() }
    }

    /// What a display shows: sRGB from 0 to 1, without a curve; numbers that are none as black.
    pub fn shown(&self) -> Vec<[f64; 3]> {
        let shown = |&[r, g, b, _]: &[f32; 4]| {
            [r, g, b].map(|c| {
                let c = f64::from(c);
                let c = if c.is_nan() { 0.0 } else { c.clamp(0.0, 1.0) };
                if self.linear { srgb::encode(c) } else { c }
            })
        };
        self.rgba.iter().map(shown).collect()
    }
}

/// A colour for a value from 0 (black) over violet and orange to 1 (light yellow), 8-bit sRGB: the map known as magma, by a
/// polynomial of degree 6 fitted to it (M. Zucker), off by two levels at most.
pub fn heat(value: f64) -> [u8; 3] {
    const C: [[f64; 3]; 7] = [
        [-0.002_136_485, -0.000_749_655, -0.005_386_128],
        [0.251_660_541, 0.677_523_244, 2.494_026_599],
        [8.353_717_279, -3.577_719_515, 0.314_467_903],
        [-27.668_733_086, 14.264_730_781, -13.649_213_188],
        [52.176_139_812, -27.943_606_072, 12.944_169_442],
        [-50.768_525_365, 29.046_582_821, 4.234_152_994],
        [18.655_705_066, -11.489_773_520, -5.601_961_509],
    ];
    let t = if value.is_nan() { 1.0 } else { value.clamp(0.0, 1.0) };
    let channel = |i: usize| C.iter().rev().fold(0.0, |sum, c| sum * t + c[i]);
    std::array::from_fn(|i| (255.0 * channel(i).clamp(0.0, 1.0)).round() as u8)
}
