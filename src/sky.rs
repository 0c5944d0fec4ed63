//! Radiance from images, for skies: a PNG decoded from sRGB, a Radiance HDR or an EXR as they stand. What direction each pixel
//! is of is left to [`crate::shot::Environment`].

use std::io::{BufRead, Seek};
use std::path::Path;

use glam::Vec3;
use image::{DynamicImage, ImageFormat};

use crate::cloud::CloudError;
use crate::num::srgb;
use crate::raster::{self, Format};

/// More pixels are refused: with the table of what is bright they need some 1.4 GB.
pub const MOST_PIXELS: u64 = 1 << 26;

/// A rectangle of radiances.
#[derive(Clone, Debug, PartialEq)]
pub struct Radiances {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Row by row from the top; zero or more, finite.
    pub pixels: Vec<Vec3>,
    /// What was mended on the way, one sentence each.
    pub notes: Vec<String>,
}

/// Reads an image file. Fails where it is missing, is no PNG, HDR or EXR, is malformed, or has too many pixels.
pub fn read_path(path: &Path) -> Result<Radiances, CloudError> {
    read_from(raster::stream(path, "name an EXR, HDR or PNG file")?)
}

/// The same of a stream.
pub fn read_from(mut stream: impl BufRead + Seek + Send) -> Result<Radiances, CloudError> {
    match raster::format(&mut stream)? {
        Some(Format::Png) => {
            let linear = |c: f32| srgb::decode(f64::from(c)) as f32;
            let image = raster::decoded(stream, ImageFormat::Png, fits)?;
            Ok(of_image(image, |p| Vec3::from_array(p.map(linear))))
        }
        Some(Format::Hdr) => Ok(of_image(raster::decoded(stream, ImageFormat::Hdr, fits)?, Vec3::from_array)),
        Some(Format::Exr) => of_exr(&raster::channels(stream, fits)?),
        None => {
            Err(CloudError::bad("neither an EXR, an HDR nor a PNG image").help("export the sky as an EXR"))
        }
    }
}

fn fits(width: u64, height: u64) -> Result<(), CloudError> {
    if width.saturating_mul(height) == 0 || MOST_PIXELS < width.saturating_mul(height) {
        let message = format!("the image has {width} x {height} pixels, beyond the limit of {MOST_PIXELS}");
        return Err(CloudError::bad(message).help("make it smaller: 4096 x 2048 are plenty for light"));
    }
    Ok(())
}

fn of_image(image: DynamicImage, linear: impl Fn([f32; 3]) -> Vec3) -> Radiances {
    let size = [image.width() as usize, image.height() as usize];
    mended(size, image.into_rgb32f().pixels().map(|p| linear(p.0)).collect())
}

/// `R`, `G` and `B`; for those that are missing `Y`.
fn of_exr(channels: &raster::Channels) -> Result<Radiances, CloudError> {
    let grey = channels.named(&["Y"]).first().copied();
    let named = |name: &str| channels.named(&[name]).first().copied().or(grey);
    let (Some(r), Some(g), Some(b)) = (named("R"), named("G"), named("B")) else {
        let error = CloudError::bad("the EXR has neither channels `R`, `G` and `B` nor `Y`, at full size");
        return Err(error.help("export the sky as an EXR of three channels"));
    };
    let pixel = |i: usize| Vec3::from_array([r, g, b].map(|c| c.value_by_flat_index(i).to_f32()));
    let [width, height] = channels.size;
    Ok(mended(channels.size, (0..width * height).map(pixel).collect()))
}

/// Light is neither less than nothing nor without bounds.
fn mended(size: [usize; 2], mut pixels: Vec<Vec3>) -> Radiances {
    let mut count = 0;
    for pixel in &mut pixels {
        let whole = Vec3::from_array(pixel.to_array().map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 }));
        count += usize::from(whole != *pixel);
        *pixel = whole;
    }
    let note = || format!("{count} pixels were negative or not finite; black was taken");
    Radiances { size, pixels, notes: if count == 0 { Vec::new() } else { vec![note()] } }
}
