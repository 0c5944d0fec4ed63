//! What the program sees in a cloud: the numbers that decide how it is drawn, measured at one place for people to read.

use glam::DVec3;
use serde::Serialize;

use crate::cloud::holes::holes;
use crate::cloud::neighbours::{Near, Neighbours};
use crate::cloud::{Cloud, CloudError, SampleOptions, Samples};
use crate::num::eigen::symmetric3;
use crate::solid::Body;
use crate::solid::point_set::{Options, PointSet};

/// A wall thinner than so many widths is moved by the far side: by 0.5 % of a width at 2.5, 2.6 % at 2 (Gaussian).
pub const THINNEST: f64 = 2.5;
/// Noise above this share of the width shows in the surface's topology: 5 of 600 lines were wrong at 0.47.
const NOISIEST: f64 = 1.0 / 3.0;
/// Samples that are asked, where not all need to be.
const ASKED: usize = 5000;
/// Neighbours of the plane that roughness is measured from.
const PLANE: usize = 25;

/// Least, middle and most.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    /// The least.
    pub least: f64,
    /// The median.
    pub median: f64,
    /// The most.
    pub most: f64,
}

/// What is known about holes.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Holes {
    /// How many.
    pub count: usize,
    /// The width of the widest: what `.close(max_hole:)` must allow.
    pub widest: f64,
}

/// Whether it has an inside.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Inside {
    /// "Solid" or "Sheet".
    pub body: &'static str,
    /// Test lines.
    pub chords: u32,
    /// How many of them cross it an odd number of times, before any repair.
    pub odd: u32,
}

/// A cloud's numbers; lengths in the units of the file.
#[derive(Clone, Debug, Serialize)]
pub struct Survey {
    /// Of this form.
    pub version: u32,
    /// Points with finite coordinates in the file.
    pub points: usize,
    /// Samples the surface is made of.
    pub samples: usize,
    /// Lowest corner of the bounds.
    pub min: DVec3,
    /// Highest corner.
    pub max: DVec3,
    /// Of the bounds.
    pub diagonal: f64,
    /// Root of the area of a sample, by its sixth neighbour.
    pub spacing: Spread,
    /// Distance to the nearest other sample: standard deviation over mean.
    pub unevenness: f64,
    /// Root mean square distance of the 25 nearest from their plane over the distance of the sixth; the median. Noise,
    /// with some curvature in it.
    pub roughness: f64,
    /// Widths of the weights.
    pub width: Spread,
    /// The thinnest wall that the median width keeps apart.
    pub smallest_wall: f64,
    /// Share of samples with another sheet, facing away, nearer than that behind them.
    pub thin: f64,
    /// "file" or "estimated".
    pub normals: &'static str,
    /// Share of near pairs of samples with opposed normals.
    pub opposed: f64,
    /// Whether there are colours.
    pub colors: bool,
    /// Holes, rims of sheets among them.
    pub holes: Holes,
    /// Solid or Sheet.
    pub inside: Inside,
    /// What was dropped or mended on the way.
    pub notes: Vec<String>,
    /// What may go wrong.
    pub warnings: Vec<String>,
}

/// Measures a cloud. Fails where it carries no surface.
pub fn survey(cloud: Cloud) -> Result<Survey, CloudError> {
    let points = cloud.points.len();
    let normals = if cloud.normals.is_some() { "file" } else { "estimated" };
    let single = cloud.points.iter().flat_map(|p| p.to_array()).all(|x| f64::from(x as f32) == x);
    let mut samples = Samples::new(cloud, &SampleOptions::default())?;
    let bounds = samples.bounds();
    let surface = PointSet::new(&samples.points, &samples.normals, &samples.widths, &Options::default());
    let solidity = surface.measure_whole();
    let found = holes(&samples);
    let body = if solidity.body() == Body::Solid { "Solid" } else { "Sheet" };
    let width = spread(&samples.widths);
    let tree = Neighbours::new(&samples.points);
    let mut survey = Survey {
        version: 1,
        points,
        samples: samples.len(),
        min: bounds.min,
        max: bounds.max,
        diagonal: bounds.diagonal(),
        spacing: spread(&samples.spacing),
        unevenness: unevenness(&samples, &tree),
        roughness: roughness(&samples, &tree),
        width,
        smallest_wall: THINNEST * width.median,
        thin: thin(&samples, &tree),
        normals,
        opposed: samples.opposed,
        colors: samples.colors.is_some(),
        holes: Holes { count: found.len(), widest: found.iter().map(|h| h.width).fold(0.0, f64::max) },
        inside: Inside { body, chords: solidity.chords, odd: solidity.odd },
        notes: std::mem::take(&mut samples.notes),
        warnings: Vec::new(),
    };
    survey.warnings = warnings(&survey, single);
    Ok(survey)
}

fn warnings(s: &Survey, single: bool) -> Vec<String> {
    let mut out = Vec::new();
    let farthest = s.min.abs().max(s.max.abs()).max_element();
    let step = farthest * f64::from(f32::EPSILON);
    if single && 0.25 * s.spacing.median < step {
        out.push(format!("float32 coordinates are {step:.3e} apart here: too coarse for this spacing"));
    }
    if NOISIEST * s.width.median < s.roughness * s.spacing.median {
        out.push("noise is more than a third of the width: raise `smoothing:`".to_owned());
    }
    if 0.01 < s.thin {
        let share = 100.0 * s.thin;
        out.push(format!(
            "{share:.1} % of samples lie on walls thinner than {:.4}: lower `smoothing:`",
            s.smallest_wall
        ));
    }
    if 0.01 < s.opposed {
        out.push("normals of neighbours disagree too often for a solid to trust".to_owned());
    }
    out
}

fn spread(values: &[f64]) -> Spread {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |i: usize| sorted.get(i).copied().unwrap_or(0.0);
    Spread { least: at(0), median: at(sorted.len() / 2), most: at(sorted.len().saturating_sub(1)) }
}

/// Samples spread over the cloud.
fn asked(samples: &Samples) -> impl Iterator<Item = usize> {
    let (n, count) = (samples.len(), samples.len().min(ASKED));
    (0..count).map(move |k| k * n / count)
}

fn unevenness(samples: &Samples, tree: &Neighbours) -> f64 {
    let mut near = Vec::new();
    let nearest: Vec<f64> = asked(samples)
        .filter_map(|i| {
            tree.nearest(samples.points[i], 2, &mut near);
            near.last().map(|n: &Near| n.distance_squared.sqrt())
        })
        .collect();
    let mean = nearest.iter().sum::<f64>() / nearest.len() as f64;
    let square = nearest.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / nearest.len() as f64;
    square.sqrt() / mean
}

fn roughness(samples: &Samples, tree: &Neighbours) -> f64 {
    let mut near: Vec<Near> = Vec::new();
    let ratios: Vec<f64> = asked(samples)
        .map(|i| {
            tree.nearest(samples.points[i], PLANE + 1, &mut near);
            let at = |n: &Near| samples.points[n.index as usize] - samples.points[i];
            let count = near.len() as f64;
            let mean = near.iter().map(at).sum::<DVec3>() / count;
            let outer = |d: DVec3| glam::DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            let all = near.iter().map(|n| outer(at(n) - mean)).fold(glam::DMat3::ZERO, |a, b| a + b);
            let sixth = near[6.min(near.len() - 1)].distance_squared.sqrt();
            (symmetric3(all).0[0].max(0.0) / count).sqrt() / sixth
        })
        .collect();
    spread(&ratios).median
}

/// The share of samples behind which, nearer than the smallest wall of their width, another sheet faces away.
fn thin(samples: &Samples, tree: &Neighbours) -> f64 {
    let mut near: Vec<Near> = Vec::new();
    let is_thin = |i: usize| {
        let (p, n) = (samples.points[i], samples.normals[i]);
        tree.within(p, THINNEST * samples.widths[i], &mut near);
        near.iter().any(|x| {
            let d = samples.points[x.index as usize] - p;
            // Behind, within 30 degrees of straight, and facing away.
            samples.normals[x.index as usize].dot(n) < -0.5 && d.dot(n) < -0.866 * d.length()
        })
    };
    let count = samples.len().clamp(1, ASKED);
    asked(samples).map(is_thin).filter(|t| *t).count() as f64 / count as f64
}
