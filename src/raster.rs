//! Image files that scenes read: which format they are of, and their decoding within a limit of pixels. What the numbers mean
//! is left to [`crate::heights`] and [`crate::sky`].

use std::io::{BufRead, BufReader, ErrorKind, Seek, SeekFrom};
use std::path::Path;

use exr::image::read::read;
use exr::image::{AnyChannel, FlatSamples};
use exr::prelude::{ReadChannels, ReadLayers};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use crate::cloud::{CloudError, open};

/// A format that is told by the first bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// PNG.
    Png,
    /// Radiance HDR.
    Hdr,
    /// OpenEXR.
    Exr,
}

/// Whether an image of a width and a height may be read; they are checked before its pixels are.
pub type Fits = fn(u64, u64) -> Result<(), CloudError>;

/// The channels of an EXR, by name.
pub struct Channels {
    /// Width and height, pixels.
    pub size: [usize; 2],
    list: Vec<AnyChannel<FlatSamples>>,
}

impl Channels {
    /// Those that are there, in the order of the names; row by row from the top. A channel at less than full size is none.
    pub fn named(&self, names: &[&str]) -> Vec<&FlatSamples> {
        let whole = |c: &&AnyChannel<FlatSamples>| c.sample_data.len() == self.size[0] * self.size[1];
        let named = |name: &&str| self.list.iter().filter(whole).find(|c| c.name.eq(name));
        names.iter().filter_map(named).map(|c| &c.sample_data).collect()
    }

    /// The only one, if it is that.
    pub fn only(&self) -> Option<&FlatSamples> {
        let [only] = self.list.as_slice() else { return None };
        Some(&only.sample_data).filter(|data| data.len() == self.size[0] * self.size[1])
    }
}

/// Opens a file; `name_one` says what to name where it is missing.
pub fn stream(path: &Path, name_one: &'static str) -> Result<impl BufRead + Seek + Send + use<>, CloudError> {
    let (file, _) = open(path, name_one)?;
    Ok(BufReader::with_capacity(1 << 16, file))
}

/// The format of what a stream begins with.
pub fn format(stream: &mut impl BufRead) -> Result<Option<Format>, CloudError> {
    let head = stream.fill_buf()?;
    Ok(match head {
        _ if head.starts_with(b"\x89PNG") => Some(Format::Png),
        _ if head.starts_with(b"#?") => Some(Format::Hdr),
        _ if head.starts_with(&[0x76, 0x2f, 0x31, 0x01]) => Some(Format::Exr),
        _ => None,
    })
}

/// A PNG or an HDR.
pub fn decoded(
    stream: impl BufRead + Seek,
    format: ImageFormat,
    fits: Fits,
) -> Result<DynamicImage, CloudError> {
    let kind = if format == ImageFormat::Png { "a whole PNG" } else { "a whole image" };
    let bad = |e: image::ImageError| match e {
        image::ImageError::IoError(e) if e.kind() != ErrorKind::UnexpectedEof => CloudError::from(e),
        e => broken(kind, &e),
    };
    let decoder = ImageReader::with_format(stream, format).into_decoder().map_err(bad)?;
    let (width, height) = decoder.dimensions();
    fits(width.into(), height.into())?;
    DynamicImage::from_decoder(decoder).map_err(bad)
}

/// The first layer of an EXR, at its largest resolution.
pub fn channels(mut stream: impl BufRead + Seek + Send, fits: Fits) -> Result<Channels, CloudError> {
    let bad = |e: exr::error::Error| match e {
        exr::error::Error::Io(e) if e.kind() != ErrorKind::UnexpectedEof => CloudError::from(e),
        e => broken("a whole EXR", &e),
    };
    let begin = stream.stream_position()?;
    let meta = exr::meta::MetaData::read_from_buffered(&mut stream, true).map_err(bad)?;
    for header in &meta.headers {
        fits(header.layer_size.x() as u64, header.layer_size.y() as u64)?;
    }
    stream.seek(SeekFrom::Start(begin))?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(stream)
        .map_err(bad)?;
    let size = [image.layer_data.size.x(), image.layer_data.size.y()];
    fits(size[0] as u64, size[1] as u64)?;
    Ok(Channels { size, list: image.layer_data.channel_data.list.into_vec() })
}

fn broken(kind: &str, error: &dyn std::fmt::Display) -> CloudError {
    CloudError::bad(format!("not {kind}: {error}")).help("copy or export the image again")
}
