//! EXR files: linear colour and all layers of a film as named channels of one part, which every reader opens.
//! Nothing in the file depends on anything but the film and what is said about it.

mod write;

use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

use exr::error::Error;
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers};

pub use write::{ExrRows, write_exr};

use crate::film::{Aov, Film, Layer};

/// The names of the colour's channels.
const COLOR: [&str; 4] = ["R", "G", "B", "A"];

/// Reads a film that [`write_exr`] wrote; channels of no known layer are left out.
pub fn read_exr(path: &Path) -> io::Result<Film> {
    let file = BufReader::new(std::fs::File::open(path)?);
    let reader = exr::image::read::read().no_deep_data().largest_resolution_level();
    let image =
        reader.all_channels().first_valid_layer().all_attributes().from_buffered(file).map_err(io_error)?;
    let part = image.layer_data;
    let samples = |name: &str| -> Option<Vec<f32>> {
        let channel = part.channel_data.list.iter().find(|c| c.name.eq(name))?;
        Some(channel.sample_data.values_as_f32().collect())
    };
    let pixels = part.size.area();
    let color = COLOR.map(|name| samples(name).unwrap_or_else(|| vec![0.0; pixels]));
    let rgba = (0..pixels).map(|i| std::array::from_fn(|c| color[c][i])).collect();
    let layer = |aov: Aov| -> Option<Layer> {
        let channels: Vec<Vec<f32>> = aov.channels().iter().map(|n| samples(n)).collect::<Option<_>>()?;
        let data = (0..pixels).flat_map(|i| channels.iter().map(move |c| c[i])).collect();
        Some(Layer { aov, data })
    };
    let layers = Aov::ALL.into_iter().filter_map(layer).collect();
    let side = |n: usize| u32::try_from(n).map_err(io::Error::other);
    Ok(Film { size: [side(part.size.0)?, side(part.size.1)?], rgba, layers })
}

/// The size that the head of a file tells; fails where it cannot be read.
pub fn exr_size(file: impl Read + Seek) -> io::Result<[u32; 2]> {
    let meta = MetaData::read_from_buffered(BufReader::new(file), true).map_err(io_error)?;
    let part = meta.headers.first().ok_or(io::ErrorKind::InvalidData)?;
    let side = |n: usize| u32::try_from(n).map_err(io::Error::other);
    Ok([side(part.layer_size.0)?, side(part.layer_size.1)?])
}

fn io_error(e: Error) -> io::Error {
    match e {
        Error::Io(e) => e,
        e => io::Error::other(e),
    }
}
