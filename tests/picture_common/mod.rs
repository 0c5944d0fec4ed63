//! Pictures of scenes from text, and means with their standard errors.

#![allow(dead_code)]

use pss::film::Film;
use pss::prepare::{self, Options};
use pss::shot::Shot;
use pss::source::SourceMap;

pub fn shot(text: &str) -> Shot {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text.to_owned());
    let read = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]);
    let (scene, _) = read.unwrap_or_else(|e| panic!("{text}\n{e:?}"));
    prepare::prepare(&scene, &Options::default()).unwrap_or_else(|e| panic!("{text}\n{e:?}")).shot
}

pub fn film(text: &str) -> Film {
    pss::render::render(&shot(text), &Default::default()).unwrap().film
}

/// The mean of a channel over all pixels, and its standard error by how pixels differ: for scenes that show every pixel the
/// same, but for chance.
pub fn mean(film: &Film, channel: usize) -> (f64, f64) {
    let values: Vec<f64> = film.rgba.iter().map(|p| f64::from(p[channel])).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Fails where a picture's mean is further from what is known than four standard errors, and `rounding`, the share that single
/// precision and tables may cost.
#[track_caller]
pub fn assert_mean(film: &Film, wanted: f64, rounding: f64, what: &str) {
    let (seen, error) = mean(film, 0);
    let allowed = 4.0 * error + rounding * wanted;
    assert!((seen - wanted).abs() <= allowed, "{what}: {seen} +- {error}, not {wanted}");
}
