//! EXR files: linear colour and all layers of a film as named channels of one part, which every reader opens.
//! Nothing in the file depends on anything but the film and what is said about it.

mod write;

use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

use exr::error::Error;
use exr::meta::MetaData;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers};

pub use write::{ExrRows, write_exr};

use crate::film::{Aov, Film, Layer};

/// The names of the colour's channels.
const COLOR: [&str; 4] = ["R", "G", "B", "A"];

/// A channel of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct Channel {
    /// Its name, such as `depth.Z`.
    pub name: String,
    /// Whether it is stored as whole numbers.
    pub is_whole: bool,
    /// Row by row from the top left.
    pub values: Vec<f32>,
}

/// All that the first part of a file holds.
#[derive(Clone, PartialEq, Debug)]
pub struct Channels {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// In the order of their names.
    pub list: Vec<Channel>,
}

impl Channels {
    /// The values of a channel.
    pub fn values(&self, name: &str) -> Option<&[f32]> {
        self.list.iter().find(|channel| channel.name == name).map(|channel| &channel.values[..])
    }

    /// Red, green, blue and coverage; zero where there is no such channel.
    pub fn rgba(&self) -> Vec<[f32; 4]> {
        let color = COLOR.map(|name| self.values(name));
        let pixels = self.size.map(|n| n as usize);
        (0..pixels[0] * pixels[1]).map(|i| color.map(|values| values.map_or(0.0, |v| v[i]))).collect()
    }

    /// Those that are no colour.
    pub fn facts(self) -> impl Iterator<Item = Channel> {
        self.list.into_iter().filter(|channel| !COLOR.contains(&channel.name.as_str()))
    }
}

/// Reads every channel of a file's first part, whoever wrote it; one at less than full size is none.
pub fn read_channels(path: &Path) -> io::Result<Channels> {
    let file = BufReader::new(std::fs::File::open(path)?);
    let reader = exr::image::read::read().no_deep_data().largest_resolution_level();
    let image =
        reader.all_channels().first_valid_layer().all_attributes().from_buffered(file).map_err(io_error)?;
    let part = image.layer_data;
    let is_full = |values: &FlatSamples| values.len() == part.size.area();
    let full = part.channel_data.list.iter().filter(|channel| is_full(&channel.sample_data));
    let list = full.map(|channel| Channel {
        name: channel.name.to_string(),
        is_whole: matches!(channel.sample_data, FlatSamples::U32(_)),
        values: channel.sample_data.values_as_f32().collect(),
    });
    let side = |n: usize| u32::try_from(n).map_err(io::Error::other);
    Ok(Channels { size: [side(part.size.0)?, side(part.size.1)?], list: list.collect() })
}

/// Reads a film that [`write_exr`] wrote; channels of no known layer are left out.
pub fn read_exr(path: &Path) -> io::Result<Film> {
    let channels = read_channels(path)?;
    let rgba = channels.rgba();
    let layer = |aov: Aov| -> Option<Layer> {
        let from: Vec<&[f32]> = aov.channels().iter().map(|n| channels.values(n)).collect::<Option<_>>()?;
        let data = (0..rgba.len()).flat_map(|i| from.iter().map(move |c| c[i])).collect();
        Some(Layer { aov, data })
    };
    let layers = Aov::ALL.into_iter().filter_map(layer).collect();
    Ok(Film { size: channels.size, rgba, layers })
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
