//! How far two pictures of one size are apart, by metrics that answer different questions: [`Metric::Rmse`] how much in numbers,
//! [`Metric::Flip`] how much an eye sees that flips between them, [`Metric::Block`] whether something stands elsewhere.

mod block;
mod flip;
mod layers;
mod picture;

use std::borrow::Cow;

pub use layers::{Apart, Layer, differences as layers};
pub use picture::{Picture, heat};

/// How difference is measured. All are 0 where the pictures are the same, and infinite where one holds a number that is not finite
/// and the other another.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Metric {
    /// The root of the mean squared difference of red, green, blue and, where both files hold it, coverage; in the numbers that
    /// the files hold, or in linear light where one holds encoded numbers and the other light.
    Rmse,
    /// LDR-FLIP (Andersson et al. 2020), its mean over the pixels, from 0 to 1: at 67 pixels a degree, a usual screen at 0.7 m.
    Flip,
    /// In levels of 255: the largest difference by which all nine pixels of some square of 3 x 3 are off to the same side, in
    /// one channel. Noise and edges that are a pixel off do not add up to it. 0 where a side is shorter than three pixels.
    Block,
}

/// All metrics with their words.
pub const METRICS: [(&str, Metric); 3] =
    [("rmse", Metric::Rmse), ("flip", Metric::Flip), ("block", Metric::Block)];

/// What a metric says.
#[derive(Clone, PartialEq, Debug)]
pub struct Difference {
    /// Of the whole pictures.
    pub value: f64,
    /// Of each pixel, row by row from the top left, in units of [`Difference::value`].
    pub map: Vec<f64>,
}

impl Difference {
    /// The pixel that differs most, from the top left; `None` where all are alike.
    pub fn worst(&self, size: [u32; 2]) -> Option<[u32; 2]> {
        let pixels = self.map.iter().enumerate().filter(|(_, d)| **d != 0.0);
        // The first of several.
        let worst = pixels.max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(&a.0)))?.0 as u32;
        Some([worst % size[0], worst / size[0]])
    }
}

/// The difference in colour of two pictures; `None` where their sizes are not the same.
pub fn difference(a: &Picture, b: &Picture, metric: Metric) -> Option<Difference> {
    if a.size != b.size {
        return None;
    }
    let squares = squares(a, b);
    let found = match metric {
        Metric::Rmse => return Some(Difference::of_squares(squares)),
        Metric::Flip => flip::difference(a.size, &a.shown(), &b.shown()),
        Metric::Block => block::difference(a.size, &a.shown(), &b.shown()),
    };
    Some(found.with_infinite(&squares))
}

impl Difference {
    /// Of mean squared differences of each pixel.
    fn of_squares(squares: Vec<f64>) -> Difference {
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        Difference { value: mean.sqrt(), map: squares.into_iter().map(f64::sqrt).collect() }
    }

    /// What displays do not show is a difference all the same where it is without bound.
    fn with_infinite(mut self, squares: &[f64]) -> Difference {
        for (shown, _) in self.map.iter_mut().zip(squares).filter(|(_, square)| square.is_infinite()) {
            (*shown, self.value) = (f64::INFINITY, f64::INFINITY);
        }
        self
    }
}

/// How far two numbers are apart; of those that are not finite only the same are alike.
fn apart(a: f32, b: f32) -> f64 {
    match a == b || a.is_nan() && b.is_nan() {
        true => 0.0,
        false if a.is_finite() && b.is_finite() => (f64::from(a) - f64::from(b)).abs(),
        false => f64::INFINITY,
    }
}

/// The mean squared difference of the channels of each pixel.
fn squares(a: &Picture, b: &Picture) -> Vec<f64> {
    let channels = if a.has_alpha && b.has_alpha { 4 } else { 3 };
    let [a, b] = match a.linear == b.linear {
        true => [a, b].map(|picture| Cow::Borrowed(&picture.rgba[..])),
        false => [a, b].map(|picture| Cow::Owned(picture.light())),
    };
    let square = |(a, b): (&[f32; 4], &[f32; 4])| {
        let each = a.iter().zip(b).take(channels).map(|(a, b)| apart(*a, *b).powi(2));
        each.sum::<f64>() / channels as f64
    };
    a.iter().zip(&*b).map(square).collect()
}
