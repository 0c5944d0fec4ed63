//! PNG files: what a display shows of a film.

use std::io;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};

use super::tone;
use crate::film::Film;
use crate::shot::settings::Tone;

/// Writes 8-bit sRGB without alpha: the background is what the colour under it says.
pub fn write_png(film: &Film, exposure: f64, tone: Tone, sink: &mut dyn io::Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(film.rgba.len() * 3).map_err(|_| io::ErrorKind::OutOfMemory)?;
    for [r, g, b, _] in &film.rgba {
        bytes.extend(tone::display([*r, *g, *b], exposure, tone));
    }
    PngEncoder::new(sink)
        .write_image(&bytes, film.size[0], film.size[1], ExtendedColorType::Rgb8)
        .map_err(|e| match e {
            ImageError::IoError(e) => e,
            e => io::Error::other(e),
        })
}
