//! LDR-FLIP: the difference that an eye sees between two pictures shown one after the other in the same place.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating Images"
//! (2020). Colours are blurred by what contrast an eye resolves, in an opponent space (YCxCz), and compared by the HyAB
//! distance in Hunt-adjusted CIELAB; edges and points are found in the luminance; of pixel errors c of colour and f of features
//! the whole is c^(1 - f).

use std::f64::consts::{PI, SQRT_2};

use super::Difference;
use crate::num::srgb::decode;

/// Pixels a degree: 3840 pixels over 0.7 m seen from 0.7 m.
const PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Linear red, green and blue to XYZ (D65).
const XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// The inverse of [`XYZ`].
const RGB: [[f64; 3]; 3] = [
    [3.241_003_232_976_359, -1.537_398_969_488_787_2, -0.498_615_881_996_363_1],
    [-0.969_224_252_202_516_6, 1.875_929_983_695_175_5, 0.041_554_226_340_084_724],
    [0.055_639_419_851_975_47, -0.204_011_206_123_909_97, 1.057_148_977_187_533],
];

/// Two Gaussians of a contrast sensitivity: weights and widths a1, b1, a2, b2 (achromatic, red-green, blue-yellow).
const SENSITIVITY: [[f64; 4]; 3] =
    [[1.0, 0.0047, 0.0, 1e-5], [1.0, 0.0053, 0.0, 1e-5], [34.1, 0.04, 13.5, 0.025]];

/// Exponents of colour errors and of features.
const COLOR_POWER: f64 = 0.7;
const FEATURE_POWER: f64 = 0.5;
/// Colour errors up to this share of the largest become errors up to [`KNEE`].
const SHARE: f64 = 0.4;
const KNEE: f64 = 0.95;
/// How wide an edge is that an eye sees best, degrees.
const EDGE: f64 = 0.082;

type Vec3 = [f64; 3];

fn times(m: &[[f64; 3]; 3], v: Vec3) -> Vec3 {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ over that of white.
fn relative(linear: Vec3) -> Vec3 {
    let (xyz, white) = (times(&XYZ, linear), times(&XYZ, [1.0; 3]));
    std::array::from_fn(|i| xyz[i] / white[i])
}

fn opponent(linear: Vec3) -> Vec3 {
    let [x, y, z] = relative(linear);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn linear_of(opponent: Vec3) -> Vec3 {
    let y = (opponent[0] + 16.0) / 116.0;
    let white = times(&XYZ, [1.0; 3]);
    let relative = [y + opponent[1] / 500.0, y, y - opponent[2] / 200.0];
    times(&RGB, std::array::from_fn(|i| relative[i] * white[i]))
}

/// CIELAB with its colours paler in the dark, as Hunt found.
fn hunt_lab(linear: Vec3) -> Vec3 {
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| if DELTA.powi(3) < t { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z] = relative(linear).map(f);
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

fn hyab(a: Vec3, b: Vec3) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// A channel of a picture, or a filter of it.
struct Plane {
    size: [usize; 2],
    values: Vec<f64>,
}

impl Plane {
    /// The sum over a row and then over a column of weights, pixels at the border repeated beyond it.
    fn filtered(&self, along_x: &[f64], along_y: &[f64]) -> Plane {
        let [w, h] = self.size;
        let sum = |weights: &[f64], at: usize, count: usize, value: &dyn Fn(usize) -> f64| -> f64 {
            let radius = weights.len() / 2;
            let place = |k: usize| (at + k).saturating_sub(radius).min(count - 1);
            weights.iter().enumerate().map(|(k, weight)| weight * value(place(k))).sum()
        };
        let pixels = || (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
        let rows: Vec<f64> = pixels().map(|(x, y)| sum(along_x, x, w, &|x| self.values[y * w + x])).collect();
        let values = pixels().map(|(x, y)| sum(along_y, y, h, &|y| rows[y * w + x])).collect();
        Plane { size: self.size, values }
    }
}

/// What an eye resolves of an opponent channel: the sum of two Gaussians, each the product of one along x and one along y.
fn blurred(plane: &Plane, [a1, b1, a2, b2]: [f64; 4]) -> Plane {
    let widest = SENSITIVITY.iter().flat_map(|s| [s[1], s[3]]).fold(0.0, f64::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * PER_DEGREE).ceil() as i32;
    let gauss = |b: f64| -> Vec<f64> {
        let at = |i: i32| (-(PI * f64::from(i) / PER_DEGREE).powi(2) / b).exp();
        (-radius..=radius).map(at).collect()
    };
    let parts = [(a1, b1), (a2, b2)].map(|(a, b)| (a * (PI / b).sqrt(), gauss(b)));
    let whole: f64 = parts.iter().map(|(a, g)| a * g.iter().sum::<f64>().powi(2)).sum();
    let mut values = vec![0.0; plane.values.len()];
    for (a, g) in parts.iter().filter(|(a, _)| *a != 0.0) {
        let part = plane.filtered(g, g);
        values.iter_mut().zip(&part.values).for_each(|(v, p)| *v += a / whole * p);
    }
    Plane { size: plane.size, values }
}

/// Lengths of the first and of the second derivatives of luminance, at each pixel.
fn features(luminance: &Plane) -> [Vec<f64>; 2] {
    let deviation = 0.5 * EDGE * PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let line = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (-radius..=radius)
            .map(|i| f(f64::from(i)) * (-f64::from(i * i) / (2.0 * deviation * deviation)).exp())
            .collect()
    };
    let even = line(&|_| 1.0);
    let across = even.iter().sum::<f64>();
    // Weights above zero sum to one over the square, those below to minus one.
    let balanced = |weights: Vec<f64>| -> Vec<f64> {
        let sum = |sign: f64| weights.iter().map(|w| (sign * w).max(0.0)).sum::<f64>() * across;
        let (above, below) = (sum(1.0), sum(-1.0));
        weights.iter().map(|w| if 0.0 < *w { w / above } else { w / below }).collect()
    };
    let edge = balanced(line(&|x| -x));
    let point = balanced(line(&|x| x * x / (deviation * deviation) - 1.0));
    [edge, point].map(|weights| {
        let [x, y] = [luminance.filtered(&weights, &even), luminance.filtered(&even, &weights)];
        x.values.iter().zip(&y.values).map(|(x, y)| x.hypot(*y)).collect()
    })
}

/// A picture as the two parts of the metric see it.
struct Seen {
    lab: Vec<Vec3>,
    features: [Vec<f64>; 2],
}

fn seen(size: [usize; 2], shown: &[Vec3]) -> Seen {
    let opponents: Vec<Vec3> = shown.iter().map(|c| opponent(c.map(decode))).collect();
    let plane = |i: usize| Plane { size, values: opponents.iter().map(|c| c[i]).collect() };
    let soft: [Plane; 3] = std::array::from_fn(|i| blurred(&plane(i), SENSITIVITY[i]));
    let lab = |k: usize| {
        let linear = linear_of(std::array::from_fn(|i| soft[i].values[k]));
        hunt_lab(linear.map(|c| c.clamp(0.0, 1.0)))
    };
    let luminance = Plane { size, values: opponents.iter().map(|c| (c[0] + 16.0) / 116.0).collect() };
    Seen { lab: (0..shown.len()).map(lab).collect(), features: features(&luminance) }
}

/// Pictures as displays show them, sRGB from 0 to 1.
pub fn difference([w, h]: [u32; 2], a: &[Vec3], b: &[Vec3]) -> Difference {
    let size = [w as usize, h as usize];
    let [a, b] = [a, b].map(|shown| seen(size, shown));
    let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(COLOR_POWER);
    let knee = SHARE * largest;
    let color = |k: usize| {
        let error = hyab(a.lab[k], b.lab[k]).powf(COLOR_POWER);
        if error < knee {
            error * KNEE / knee
        } else {
            KNEE + (error - knee) / (largest - knee) * (1.0 - KNEE)
        }
    };
    let feature = |k: usize| {
        let off = (0..2).map(|i| (a.features[i][k] - b.features[i][k]).abs()).fold(0.0, f64::max);
        (off / SQRT_2).powf(FEATURE_POWER)
    };
    let map: Vec<f64> = (0..a.lab.len()).map(|k| color(k).powf(1.0 - feature(k))).collect();
    Difference { value: map.iter().sum::<f64>() / map.len().max(1) as f64, map }
}
