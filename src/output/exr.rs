//! EXR files: linear colour and all layers of a film as named channels of one part, which every reader opens.
//! Nothing in the file depends on anything but the film.

use std::io::{self, BufReader};
use std::path::Path;

use exr::error::Error;
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer as Part};
use exr::meta::attribute::Chromaticities;
use exr::meta::header::LayerAttributes;
use exr::prelude::{ReadChannels, ReadLayers, Vec2, WritableImage};

use super::Sink;
use crate::film::{Aov, Film, Layer};

/// The names of the colour's channels.
const COLOR: [&str; 4] = ["R", "G", "B", "A"];

/// The primaries of linear Rec. 709 and its white, D65.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Writes a film.
pub fn write_exr(film: &Film, sink: &mut dyn Sink) -> io::Result<()> {
    let color = COLOR.iter().enumerate().map(|(i, name)| {
        AnyChannel::new(*name, FlatSamples::F32(film.rgba.iter().map(|pixel| pixel[i]).collect()))
    });
    let layers = film.layers.iter().flat_map(|layer| {
        let names = layer.aov.channels();
        names.iter().enumerate().map(move |(i, name)| {
            let samples = layer.data.iter().skip(i).step_by(names.len()).copied().collect();
            // Marks the values as facts, not as something an eye sees.
            AnyChannel { quantize_linearly: true, ..AnyChannel::new(*name, FlatSamples::F32(samples)) }
        })
    });
    let channels = AnyChannels::sort(color.chain(layers).collect());
    let size = (film.size[0] as usize, film.size[1] as usize);
    // Other compressions of the library were seen to give other bytes from run to run.
    let part = Part::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut image = Image::from_layer(part);
    image.attributes.chromaticities = Some(REC_709);
    // The library's own threads would not respect the number of threads asked for.
    image.write().non_parallel().to_buffered(sink).map_err(io_error)
}

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

fn io_error(e: Error) -> io::Error {
    match e {
        Error::Io(e) => e,
        e => io::Error::other(e),
    }
}
