//! Where a surface has its colour from: one colour, its own, or a pattern in space.
//!
//! Patterns fill space in the scene's coordinates, so that they go on across cuts, as the rings of a sawn log do.

use fastnoise_lite::{CellularReturnType, FastNoiseLite, FractalType, NoiseType};
use glam::{DVec3, Vec3};

use super::{DEFAULT_COLOR, color, positive};
use crate::scene::{BuildError, Call, Kind, Param};

/// Where a surface has its colour from; colours are linear.
#[derive(Clone, PartialEq, Debug)]
pub enum Paint {
    /// One colour.
    Plain([f32; 3]),
    /// From what has a colour of its own.
    Own {
        /// Multiplies it.
        tint: [f32; 3],
    },
    /// Two colours, mixed by where a point is.
    Pattern {
        /// How.
        pattern: &'static Pattern,
        /// The colours.
        colors: [[f32; 3]; 2],
        /// The size of its features, scene units.
        grain: f64,
    },
}

/// A pattern in space.
#[derive(Debug)]
pub struct Pattern {
    word: &'static str,
    /// The share of the second colour, from 0 to 1, at a point measured in grains.
    share: fn(DVec3) -> f64,
}

impl PartialEq for Pattern {
    fn eq(&self, other: &Pattern) -> bool {
        self.word == other.word
    }
}

/// All patterns; a new one is its line here.
const PATTERNS: &[Pattern] = &[
    Pattern { word: "checker", share: |p| odd(p.x.floor() + p.y.floor() + p.z.floor()) },
    Pattern { word: "stripes", share: |p| odd(p.z.floor()) },
    Pattern { word: "rings", share: |p| odd(p.truncate().length().floor()) },
    Pattern { word: "gradient", share: |p| p.z.clamp(0.0, 1.0) },
    Pattern { word: "noise", share: |p| 0.5 + 0.5 * clouds(p) },
    Pattern { word: "marble", share: |p| 0.5 + 0.5 * libm::sin(std::f64::consts::TAU * (p.x + clouds(p))) },
    Pattern {
        word: "wood",
        share: |p| saw(p.truncate().length() + 0.3 * clouds(p * DVec3::new(0.5, 0.5, 0.1))),
    },
    Pattern { word: "cells", share: cells },
];

const WORDS: [&str; 1 + PATTERNS.len()] = {
    let mut words = ["plain"; 1 + PATTERNS.len()];
    let mut i = 0;
    while i < PATTERNS.len() {
        words[1 + i] = PATTERNS[i].word;
        i += 1;
    }
    words
};

/// What a material with a colour takes to have two.
pub(super) const PATTERN: Param = Param::named(
    "pattern",
    Kind::Choice(&WORDS),
    "how `color` and `color2` are spread in space; default plain, `color` alone",
);
/// The second colour.
pub(super) const COLOR2: Param =
    Param::named("color2", Kind::Color, "a pattern's second colour; default #404040");
/// The size.
pub(super) const GRAIN: Param =
    Param::named("grain", Kind::Width, "the size of a pattern's features; default 1 scene unit");

/// `#404040` decoded.
const SECOND: [f32; 3] = [0.051_269_46; 3];

impl Paint {
    /// That of a call with the arguments above.
    pub(super) fn build(call: &Call) -> Result<Paint, BuildError> {
        let first = color(call, "color", DEFAULT_COLOR)?;
        let (second, grain) = (color(call, "color2", SECOND)?, positive(call, "grain", 1.0)?);
        let word = call.text("pattern").unwrap_or("plain");
        let Some(pattern) = PATTERNS.iter().find(|p| p.word == word) else {
            return match ["color2", "grain"].into_iter().find(|name| call.get(name).is_some()) {
                Some(param) => Err(BuildError {
                    param,
                    message: format!("only a pattern has `{param}`"),
                    help: format!("`pattern:` is one of {}", WORDS[1..].join(", ")),
                }),
                None => Ok(Paint::Plain(first)),
            };
        };
        Ok(Paint::Pattern { pattern, colors: [first, second], grain })
    }

    /// The colour at a point of the scene; `own` is that of what is there, if it has one.
    pub fn at(&self, point: DVec3, own: Option<[f32; 3]>) -> [f32; 3] {
        match self {
            Paint::Plain(color) => *color,
            Paint::Own { tint } => {
                (Vec3::from_array(own.unwrap_or(DEFAULT_COLOR)) * Vec3::from_array(*tint)).to_array()
            }
            Paint::Pattern { pattern, colors: [first, second], grain } => {
                let share = (pattern.share)(point / *grain).clamp(0.0, 1.0) as f32;
                Vec3::from_array(*first).lerp(Vec3::from_array(*second), share).to_array()
            }
        }
    }
}

fn odd(x: f64) -> f64 {
    x.rem_euclid(2.0)
}

/// From 0 up to 1 and back, once for each whole number, smoothly.
fn saw(x: f64) -> f64 {
    0.5 - 0.5 * libm::cos(std::f64::consts::TAU * x)
}

/// Four octaves of noise, about -1 to 1.
fn clouds(p: DVec3) -> f64 {
    let mut noise = FastNoiseLite::with_seed(1);
    noise.set_noise_type(Some(NoiseType::OpenSimplex2));
    noise.set_frequency(Some(1.0));
    noise.set_fractal_type(Some(FractalType::FBm));
    noise.set_fractal_octaves(Some(4));
    f64::from(noise.get_noise_3d(p.x, p.y, p.z))
}

/// Dark in the middle of cells scattered about, light where they meet.
fn cells(p: DVec3) -> f64 {
    let mut noise = FastNoiseLite::with_seed(1);
    noise.set_noise_type(Some(NoiseType::Cellular));
    noise.set_frequency(Some(1.0));
    noise.set_fractal_type(Some(FractalType::None));
    noise.set_cellular_return_type(Some(CellularReturnType::Distance));
    1.0 + f64::from(noise.get_noise_3d(p.x, p.y, p.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_mix_two_colours_and_each_shows_both() {
        for pattern in PATTERNS {
            let paint = Paint::Pattern { pattern, colors: [[0.0; 3], [1.0; 3]], grain: 0.5 };
            let at = |i: i32| {
                let [x, y, z] = [i % 23, i % 29, i % 31].map(|k| 0.07 * f64::from(k) - 0.9);
                paint.at(DVec3::new(x, y, z), None)[0]
            };
            let all: Vec<f32> = (0..5000).map(at).collect();
            assert!(all.iter().all(|c| (0.0..=1.0).contains(c)), "{}", pattern.word);
            let (lo, hi) = all.iter().fold((1.0_f32, 0.0_f32), |(lo, hi), c| (lo.min(*c), hi.max(*c)));
            assert!(lo < 0.25 && 0.75 < hi, "{}: {lo} {hi}", pattern.word);
        }
    }

    #[test]
    fn a_checker_changes_at_each_grain() {
        let at = |p: [f64; 3]| (PATTERNS[0].share)(DVec3::from_array(p));
        assert_eq!(
            [at([0.5; 3]), at([1.5, 0.5, 0.5]), at([-0.5, 0.5, 0.5]), at([1.5, 1.5, 0.5])],
            [0.0, 1.0, 1.0, 0.0]
        );
    }
}
