//! Heights from images: the grey of a PNG of 8 or 16 bits, or a channel of an EXR. Rays are left to
//! [`crate::solid::heightfield`].

use std::io::{BufRead, Seek};
use std::path::Path;

use image::{DynamicImage, ImageFormat};

use crate::cloud::CloudError;
use crate::raster::{self, Format};

/// More pixels are refused: with what is built over them they need some 600 MB.
pub const MOST_PIXELS: u64 = 1 << 26;

/// A rectangle of heights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heights {
    /// Pixels from left to right, at least two.
    pub width: usize,
    /// Pixels from top to bottom, at least two.
    pub depth: usize,
    /// Row by row from the top; zero or more, finite. White is 1.
    pub values: Vec<f32>,
    /// What was mended on the way, one sentence each.
    pub notes: Vec<String>,
}

/// Reads an image file as heights. The stored numbers count as they stand: no curve is undone. Of a colour image the
/// luminance counts, of an EXR the channel `Y`, else the mean of `R`, `G` and `B`, else its only channel.
///
/// Fails where the file is missing, is no PNG or EXR, is malformed, or has fewer than 2 x 2 or too many pixels.
pub fn read_path(path: &Path) -> Result<Heights, CloudError> {
    read_from(raster::stream(path, "name a PNG or EXR file")?)
}

/// The same of a stream.
pub fn read_from(mut stream: impl BufRead + Seek + Send) -> Result<Heights, CloudError> {
    match raster::format(&mut stream)? {
        Some(Format::Png) => Ok(of_png(raster::decoded(stream, ImageFormat::Png, fits)?)),
        Some(Format::Exr) => of_exr(&raster::channels(stream, fits)?),
        _ => {
            Err(CloudError::bad("neither a PNG nor an EXR image")
                .help("export the heights as a PNG of 16 bits"))
        }
    }
}

fn fits(width: u64, depth: u64) -> Result<(), CloudError> {
    if width < 2 || depth < 2 {
        let message = format!("the image has {width} x {depth} pixels: heights need two each way");
        return Err(CloudError::bad(message).help("each pixel is a corner of the surface"));
    }
    if MOST_PIXELS < width.saturating_mul(depth) {
        let message = format!("the image has {width} x {depth} pixels, more than the limit of {MOST_PIXELS}");
        return Err(CloudError::bad(message).help("make it smaller"));
    }
    Ok(())
}

fn of_png(image: DynamicImage) -> Heights {
    let (width, depth) = (image.width() as usize, image.height() as usize);
    let values = match image {
        DynamicImage::ImageLuma8(grey) => grey.into_raw().into_iter().map(|v| f32::from(v) / 255.0).collect(),
        other => other.into_luma16().into_raw().into_iter().map(|v| f32::from(v) / 65535.0).collect(),
    };
    Heights { width, depth, values, notes: Vec::new() }
}

/// `Y`, else the only channel, else the mean of `R`, `G` and `B`.
fn of_exr(channels: &raster::Channels) -> Result<Heights, CloudError> {
    let mut used = channels.named(&["Y"]);
    used.extend(channels.only().filter(|_| used.is_empty()));
    if used.is_empty() {
        used = channels.named(&["R", "G", "B"]);
    }
    if used.is_empty() {
        let error = CloudError::bad("the EXR has neither a channel `Y` nor `R`, `G` and `B`, at full size");
        return Err(error.help("export the heights as one channel `Y`"));
    }
    let [width, depth] = channels.size;
    let mut heights = Heights { width, depth, ..Heights::default() };
    let mut mended = 0usize;
    for i in 0..width * depth {
        let sum: f32 = used.iter().map(|c| c.value_by_flat_index(i).to_f32()).sum();
        let mean = sum / used.len() as f32;
        let sound = mean.is_finite() && 0.0 <= mean;
        mended += usize::from(!sound);
        heights.values.push(if sound { mean } else { 0.0 });
    }
    if 0 < mended {
        heights.notes.push(format!("{mended} heights are below zero or not finite and count as zero"));
    }
    Ok(heights)
}
