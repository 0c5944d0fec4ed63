//! Radiance from images, for skies: a PNG decoded from sRGB, a Radiance HDR or an EXR as they stand. What direction each pixel
//! is of is left to [`crate::shot::Environment`].

use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

use exr::image::read::read;
use exr::prelude::{ReadChannels, ReadLayers};
use glam::Vec3;
use image::{ImageDecoder, ImageFormat, ImageReader};

use crate::cloud::{CloudError, open};
use crate::num::srgb;

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
    let (file, _) = open(path, "name an EXR, HDR or PNG file")?;
    read_from(BufReader::with_capacity(1 << 16, file))
}

/// The same of a stream.
pub fn read_from(mut stream: impl BufRead + Seek + Send) -> Result<Radiances, CloudError> {
    let head = stream.fill_buf()?;
    let (size, pixels) = if head.starts_with(b"\x89PNG") {
        let ([w, h], pixels) = decoded(stream, ImageFormat::Png)?;
        let linear = |c: f32| srgb::decode(f64::from(c)) as f32;
        ([w, h], pixels.into_iter().map(|p| Vec3::from_array(p.to_array().map(linear))).collect())
    } else if head.starts_with(b"#?") {
        decoded(stream, ImageFormat::Hdr)?
    } else if head.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        of_exr(stream)?
    } else {
        return Err(
            CloudError::bad("neither an EXR, an HDR nor a PNG image").help("export the sky as an EXR")
        );
    };
    Ok(mended(size, pixels))
}

fn check_size(width: u64, height: u64) -> Result<[usize; 2], CloudError> {
    if width.saturating_mul(height) == 0 || MOST_PIXELS < width.saturating_mul(height) {
        let message = format!("the image has {width} x {height} pixels, beyond the limit of {MOST_PIXELS}");
        return Err(CloudError::bad(message).help("make it smaller: 4096 x 2048 are plenty for light"));
    }
    Ok([width as usize, height as usize])
}

fn decoded(stream: impl BufRead + Seek, format: ImageFormat) -> Result<([usize; 2], Vec<Vec3>), CloudError> {
    let bad = |e: image::ImageError| match e {
        image::ImageError::IoError(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => CloudError::from(e),
        e => CloudError::bad(format!("not a whole image: {e}")).help("copy or export the image again"),
    };
    let decoder = ImageReader::with_format(stream, format).into_decoder().map_err(bad)?;
    let (width, height) = decoder.dimensions();
    let size = check_size(width.into(), height.into())?;
    let image = image::DynamicImage::from_decoder(decoder).map_err(bad)?;
    Ok((size, image.into_rgb32f().pixels().map(|p| Vec3::from_array(p.0)).collect()))
}

fn of_exr(mut stream: impl BufRead + Seek + Send) -> Result<([usize; 2], Vec<Vec3>), CloudError> {
    let bad = |e: exr::error::Error| match e {
        exr::error::Error::Io(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => CloudError::from(e),
        e => CloudError::bad(format!("not a whole EXR: {e}")).help("copy or export the image again"),
    };
    let begin = stream.stream_position()?;
    let meta = exr::meta::MetaData::read_from_buffered(&mut stream, true).map_err(bad)?;
    for header in &meta.headers {
        check_size(header.layer_size.x() as u64, header.layer_size.y() as u64)?;
    }
    stream.seek(std::io::SeekFrom::Start(begin))?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(stream)
        .map_err(bad)?;
    let size = check_size(image.layer_data.size.x() as u64, image.layer_data.size.y() as u64)?;
    let channels = &image.layer_data.channel_data.list;
    let named = |name: &str| {
        let found = channels.iter().find(|c| c.name.to_string() == name || c.name.to_string() == "Y")?;
        (found.sample_data.len() == size[0] * size[1]).then_some(&found.sample_data)
    };
    let (Some(r), Some(g), Some(b)) = (named("R"), named("G"), named("B")) else {
        let error = CloudError::bad("the EXR has neither channels `R`, `G` and `B` nor `Y`, at full size");
        return Err(error.help("export the sky as an EXR of three channels"));
    };
    let pixel = |i: usize| Vec3::from_array([r, g, b].map(|c| c.value_by_flat_index(i).to_f32()));
    Ok((size, (0..size[0] * size[1]).map(pixel).collect()))
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
