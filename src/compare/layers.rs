//! Layers beside the colour of an EXR, and how far those of two pictures are apart.

use super::{Difference, apart};
use crate::film::Aov;
use crate::output::Channel;

/// What belongs together: the channels `depth.Z`, or `N.X`, `N.Y` and `N.Z`.
#[derive(Clone, PartialEq, Debug)]
pub struct Layer {
    /// As it is asked for in a scene, where this program knows it; else what its channels have in common.
    pub name: String,
    /// Whether it counts or numbers something.
    pub is_whole: bool,
    /// In the order of their names.
    pub channels: Vec<Channel>,
}

/// Channels by layers, in their order.
pub fn of(channels: impl Iterator<Item = Channel>) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    for channel in channels {
        let known = Aov::ALL.into_iter().find(|aov| aov.channels().contains(&channel.name.as_str()));
        let common = channel.name.rsplit_once('.').map_or(channel.name.as_str(), |(layer, _)| layer);
        let name = known.map_or_else(|| common.to_owned(), |aov| aov.word().to_owned());
        let is_whole = known.map_or(channel.is_whole, Aov::is_whole);
        match layers.iter_mut().find(|layer| layer.name == name) {
            Some(layer) => {
                layer.is_whole &= is_whole;
                layer.channels.push(channel);
            }
            None => layers.push(Layer { name, is_whole, channels: vec![channel] }),
        }
    }
    layers
}

/// How a layer of two pictures differs.
#[derive(Clone, PartialEq, Debug)]
pub enum Apart {
    /// The first alone has it.
    First,
    /// The second alone has it.
    Second,
    /// Its channels have other names.
    Channels,
    /// The root of the mean squared difference of its channels.
    Rmse(Difference),
    /// How many pixels are not the same, of a layer of whole numbers.
    Pixels(Difference),
}

/// How each layer of either picture differs, by name; nothing where one cannot hold layers.
pub fn differences(a: &super::Picture, b: &super::Picture) -> Vec<(String, Apart)> {
    let (Some(a), Some(b)) = (&a.layers, &b.layers) else { return Vec::new() };
    let found = |layers: &[Layer], name: &str| layers.iter().position(|layer| layer.name == name);
    let each = a.iter().map(|layer| match found(b, &layer.name) {
        Some(other) => (layer.name.clone(), layer.apart(&b[other])),
        None => (layer.name.clone(), Apart::First),
    });
    let others = b.iter().filter(|layer| found(a, &layer.name).is_none());
    each.chain(others.map(|layer| (layer.name.clone(), Apart::Second))).collect()
}

impl Layer {
    fn apart(&self, other: &Layer) -> Apart {
        let names = |layer: &Layer| layer.channels.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
        if names(self) != names(other) {
            return Apart::Channels;
        }
        let pixels = self.channels.first().map_or(0, |channel| channel.values.len());
        let mut squares = vec![0.0; pixels];
        for (a, b) in self.channels.iter().zip(&other.channels) {
            let each = a.values.iter().zip(&b.values).map(|(a, b)| apart(*a, *b).powi(2));
            squares.iter_mut().zip(each).for_each(|(sum, square)| *sum += square);
        }
        if self.is_whole && other.is_whole {
            let map: Vec<f64> = squares.iter().map(|square| f64::from(u8::from(*square != 0.0))).collect();
            return Apart::Pixels(Difference { value: map.iter().sum(), map });
        }
        let channels = self.channels.len() as f64;
        Apart::Rmse(Difference::of_squares(squares.iter().map(|square| square / channels).collect()))
    }
}
