//! What the program sees in a cloud: the numbers that decide how it is drawn, measured at one place for people to read.

use glam::DVec3;
use serde::Serialize;

use super::build::try_holes;
use super::fitness::{Fitness, asked};
use crate::cloud::holes::holes_by;
use crate::cloud::neighbours::{Near, Neighbours};
use crate::cloud::{Cloud, CloudError, SampleOptions, Samples, is_single};
use crate::solid::Body;
use crate::solid::point_set::{Options, PointSet};

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
    /// How many of them lines go through: the surface spans the others.
    pub open: u32,
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
    /// Points in the file, with those whose coordinates are not finite.
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
    /// Root mean square distance of the samples within two widths from their plane, the median: noise, with some
    /// curvature in it.
    pub noise: f64,
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
    let points = cloud.points.len() + cloud.dropped as usize;
    let given = |n: &Vec<DVec3>| n.iter().any(|n| *n != DVec3::ZERO);
    let normals = if cloud.normals.as_ref().is_some_and(given) { "file" } else { "estimated" };
    let single = is_single(&cloud.points);
    let (mut samples, known) = Samples::with_known(cloud, &SampleOptions::default())?;
    let bounds = samples.bounds();
    let options = Options::default();
    let surface = PointSet::new(&samples.points, &samples.normals, &samples.widths, &options);
    let mut solidity = surface.measure_whole();
    let found = holes_by(&samples, &known);
    try_holes(&mut solidity, &surface, &samples, &found);
    let body = if solidity.body() == Body::Solid { "Solid" } else { "Sheet" };
    let width = spread(&samples.widths);
    let fitness = Fitness::new(&samples, &known.tree, single, options.mixed);
    Ok(Survey {
        version: 1,
        points,
        samples: samples.len(),
        min: bounds.min,
        max: bounds.max,
        diagonal: bounds.diagonal(),
        spacing: spread(&samples.spacing),
        unevenness: unevenness(&samples, &known.tree),
        noise: fitness.noise,
        width,
        smallest_wall: fitness.smallest_wall,
        thin: fitness.thin,
        normals,
        opposed: samples.opposed,
        colors: samples.colors.is_some(),
        holes: Holes {
            count: found.len(),
            open: solidity.open_holes,
            widest: found.iter().map(|h| h.width).fold(0.0, f64::max),
        },
        inside: Inside { body, chords: solidity.chords, odd: solidity.odd },
        notes: std::mem::take(&mut samples.notes),
        warnings: fitness.concerns().into_iter().map(|c| format!("{}: {}", c.message, c.help)).collect(),
    })
}

fn spread(values: &[f64]) -> Spread {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |i: usize| sorted.get(i).copied().unwrap_or(0.0);
    Spread { least: at(0), median: at(sorted.len() / 2), most: at(sorted.len().saturating_sub(1)) }
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
