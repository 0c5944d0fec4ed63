//! PNG files: what a display shows of a film.

use std::io::{self, BufReader};
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError, ImageFormat, ImageReader};

use super::tone;
use crate::film::Film;
use crate::shot::settings::Tone;

/// Writes 8-bit sRGB without alpha: the background is what the colour under it says.
pub fn write_png(film: &Film, exposure: f64, tone: Tone, sink: &mut dyn io::Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(film.rgba.len() * 3).map_err(|_| io::ErrorKind::OutOfMemory)?;
    let display = tone::Display::new(exposure, tone);
    for [r, g, b, _] in &film.rgba {
        bytes.extend(display.of([*r, *g, *b]));
    }
    write_rgb(film.size, &bytes, sink)
}

/// Writes 8-bit sRGB, three bytes a pixel, row by row from the top left.
pub fn write_rgb([w, h]: [u32; 2], bytes: &[u8], sink: &mut dyn io::Write) -> io::Result<()> {
    let mut remembering = Remembering { sink, failure: None };
    let encoded = PngEncoder::new(&mut remembering).write_image(bytes, w, h, ExtendedColorType::Rgb8);
    if let Some(e) = remembering.failure {
        return Err(e);
    }
    encoded.map_err(|e| match e {
        ImageError::IoError(e) => e,
        e => io::Error::other(e),
    })
}

/// Reads a PNG of any depth: its size, and red, green, blue and coverage from 0 to 1 as they are encoded, row by row from the top
/// left. Fails where it cannot be read or is broken.
pub fn read_png(path: &Path) -> io::Result<([u32; 2], Vec<[f32; 4]>)> {
    let mut reader = ImageReader::new(BufReader::new(std::fs::File::open(path)?));
    reader.set_format(ImageFormat::Png);
    let image = reader.decode().map_err(|e| match e {
        ImageError::IoError(e) => e,
        e => io::Error::new(io::ErrorKind::InvalidData, e),
    })?;
    let image = image.into_rgba32f();
    Ok(([image.width(), image.height()], image.pixels().map(|p| p.0).collect()))
}

/// Keeps the first failure: the encoder writes the end of the file when it is dropped and says nothing if
/// that fails.
struct Remembering<'a> {
    sink: &'a mut dyn io::Write,
    failure: Option<io::Error>,
}

impl Remembering<'_> {
    fn remember<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|e| {
            let kind = e.kind();
            if kind != io::ErrorKind::Interrupted && self.failure.is_none() {
                self.failure = Some(e);
            }
            kind.into()
        })
    }
}

impl io::Write for Remembering<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.sink.write(bytes);
        self.remember(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.sink.flush();
        self.remember(result)
    }
}
