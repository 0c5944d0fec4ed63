//! Signs of noisy normals, from a coarser cloud that has less noise.
//!
//! Where layers of several scans lie over each other, the plane of a few neighbours stands across them as often as along,
//! and signs spread over such normals go astray. The mean of all samples within some spacings lies on the surface
//! again; a cloud of such means, a tenth as many, has normals to trust.

use glam::DVec3;
use rayon::prelude::*;

use super::{NORMAL_NEIGHBOURS, Scene};
use crate::cloud::neighbours::{Near, Neighbours, Table};
use crate::cloud::spacing;

/// So many widths about a sample are covered by its mean: 1.5 spacings. From 1.25 to 2 spacings all was as right on
/// the raw scans at hand; more merges the sides of thin walls.
const COVERED: f64 = 0.75;
/// A mean takes in so much more than it covers, so that neighbouring means share samples.
const OVERLAP: f64 = 1.5;
/// Means that a sample's normal is taken from.
const NEAREST: usize = 4;

/// A cloud of means.
#[derive(Debug)]
pub(super) struct Coarse {
    /// Means of the samples about chosen ones.
    pub points: Vec<DVec3>,
    table: Table,
    widths: Vec<f64>,
}

impl Coarse {
    /// Chooses samples that no one chosen before covers, and takes the mean about each.
    pub fn new(scene: Scene<'_>) -> Coarse {
        let Scene { points, widths, .. } = scene;
        let tree = Neighbours::new(points);
        let mut covered = vec![false; points.len()];
        let mut centers = Vec::new();
        let mut near: Vec<Near> = Vec::new();
        for i in 0..points.len() {
            if covered[i] {
                continue;
            }
            centers.push(i);
            tree.within(points[i], COVERED * widths[i], &mut near);
            near.iter().for_each(|n| covered[n.index as usize] = true);
        }
        let mean = |near: &mut Vec<Near>, i: usize| {
            let (center, radius) = (points[i], OVERLAP * COVERED * widths[i]);
            tree.within(center, radius, near);
            let weight = |n: &Near| (1.0 - n.distance_squared / (radius * radius)).powi(2);
            let total: f64 = near.iter().map(weight).sum();
            near.iter().map(|n| points[n.index as usize] * weight(n)).sum::<DVec3>() / total
        };
        let points: Vec<DVec3> = centers.par_iter().map_init(Vec::new, |near, i| mean(near, *i)).collect();
        let table = Neighbours::new(&points).table(NORMAL_NEIGHBOURS);
        let widths = spacing::widths(&spacing::spacing(&points, &table), &table);
        Coarse { points, table, widths }
    }

    /// What its own normals are made from.
    pub fn scene(&self) -> Scene<'_> {
        Scene { points: &self.points, table: &self.table, widths: &self.widths }
    }

    /// Unit normals of samples from those of the means nearest to them, the nearer the more.
    pub fn spread(&self, samples: &[DVec3], normals: &[DVec3]) -> Vec<DVec3> {
        let tree = Neighbours::new(&self.points);
        let at = |near: &mut Vec<Near>, p: &DVec3| {
            tree.nearest(*p, NEAREST, near);
            // A little beyond the farthest, so that it counts too.
            let reach = 1.2 * near.last().map_or(0.0, |n| n.distance_squared);
            let share = |n: &Near| if 0.0 < reach { 1.0 - n.distance_squared / reach } else { 1.0 };
            let sum: DVec3 = near.iter().map(|n| normals[n.index as usize] * share(n)).sum();
            sum.try_normalize().unwrap_or(normals[near[0].index as usize])
        };
        samples.par_iter().map_init(Vec::new, at).collect()
    }
}
