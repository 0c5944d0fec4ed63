//! Heights from images: the grey of a PNG of 8 or 16 bits, or a channel of an EXR. Rays are left to
//! [`crate::solid::heightfield`].

use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

use exr::image::read::read;
use exr::image::{AnyChannel, FlatSamples};
use exr::prelude::{ReadChannels, ReadLayers};
use image::{ImageDecoder, ImageReader};

use crate::cloud::{CloudError, open};

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
    let (file, _) = open(path, "name a PNG or EXR file")?;
    read_from(BufReader::with_capacity(1 << 16, file))
}

/// The same of a stream.
pub fn read_from(mut stream: impl BufRead + Seek + Send) -> Result<Heights, CloudError> {
    let head = stream.fill_buf()?;
    let (png, exr) = (head.starts_with(b"\x89PNG"), head.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    match (png, exr) {
        (true, _) => of_png(stream),
        (_, true) => of_exr(stream),
        _ => {
            Err(CloudError::bad("neither a PNG nor an EXR image")
                .help("export the heights as a PNG of 16 bits"))
        }
    }
}

fn check_size(width: u64, depth: u64) -> Result<(), CloudError> {
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

fn of_png(stream: impl BufRead + Seek) -> Result<Heights, CloudError> {
    let bad = |e: image::ImageError| match e {
        image::ImageError::IoError(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => CloudError::from(e),
        e => CloudError::bad(format!("not a whole PNG: {e}")).help("copy or export the image again"),
    };
    let reader = ImageReader::with_format(stream, image::ImageFormat::Png);
    let decoder = reader.into_decoder().map_err(bad)?;
    let (width, depth) = decoder.dimensions();
    check_size(width.into(), depth.into())?;
    let image = image::DynamicImage::from_decoder(decoder).map_err(bad)?;
    let values = match image {
        image::DynamicImage::ImageLuma8(grey) => {
            grey.into_raw().into_iter().map(|v| f32::from(v) / 255.0).collect()
        }
        other => other.into_luma16().into_raw().into_iter().map(|v| f32::from(v) / 65535.0).collect(),
    };
    Ok(Heights { width: width as usize, depth: depth as usize, values, notes: Vec::new() })
}

fn of_exr(mut stream: impl BufRead + Seek + Send) -> Result<Heights, CloudError> {
    let bad = |e: exr::error::Error| match e {
        exr::error::Error::Io(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => CloudError::from(e),
        e => CloudError::bad(format!("not a whole EXR: {e}")).help("copy or export the image again"),
    };
    let begin = stream.stream_position()?;
    let meta = exr::meta::MetaData::read_from_buffered(&mut stream, true).map_err(bad)?;
    for header in &meta.headers {
        let size = header.layer_size;
        check_size(size.x() as u64, size.y() as u64)?;
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
    let size = image.layer_data.size;
    check_size(size.x() as u64, size.y() as u64)?;
    grey(size.x(), size.y(), &image.layer_data.channel_data.list)
}

/// The heights of the channels of an EXR.
fn grey(width: usize, depth: usize, channels: &[AnyChannel<FlatSamples>]) -> Result<Heights, CloudError> {
    let named = |name: &str| channels.iter().find(|c| c.name.to_string() == name);
    let used: Vec<_> = match (named("Y"), channels) {
        (Some(y), _) => vec![y],
        (None, [only]) => vec![only],
        _ => ["R", "G", "B"].iter().filter_map(|n| named(n)).collect(),
    };
    let pixels = width * depth;
    if used.is_empty() || used.iter().any(|c| c.sample_data.len() != pixels) {
        let error = CloudError::bad("the EXR has neither a channel `Y` nor `R`, `G` and `B`, at full size");
        return Err(error.help("export the heights as one channel `Y`"));
    }
    let mut heights = Heights { width, depth, ..Heights::default() };
    let mut mended = 0usize;
    for i in 0..pixels {
        let sum: f32 = used.iter().map(|c| c.sample_data.value_by_flat_index(i).to_f32()).sum();
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
