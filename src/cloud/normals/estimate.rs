//! Unsigned normals from points alone.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::cloud::neighbours::Table;
use crate::num::eigen::symmetric3;

/// Neighbours of a plane: as many as a surface's weight of ordinary width holds, with those that the fading
/// weight all but ignores. Fewer follow the noise, more round off creases.
pub const NORMAL_NEIGHBOURS: usize = 16;

/// The unit normal of the plane through each sample and its [`NORMAL_NEIGHBOURS`] nearest, of either sign: the
/// direction of least spread about their mean (Hoppe et al. 1992), weighted by `(1 - d^2/D^2)^2` so that the
/// farthest, at distance `D`, comes and goes without a jump. Samples on a line give some normal across it.
pub fn estimate(points: &[DVec3], table: &Table) -> Vec<DVec3> {
    (0..points.len()).into_par_iter().map(|i| normal(points, i, table)).collect()
}

/// The same for one sample.
pub fn normal(points: &[DVec3], i: usize, table: &Table) -> DVec3 {
    spread(points, i, &table.row(i)[..table.k().min(NORMAL_NEIGHBOURS)]).1.x_axis
}

/// How much of the spread of its `k` nearest around a sample is off their plane: the least eigenvalue over their sum, 0
/// for a plane, one third for points that fill space.
pub fn roughness(points: &[DVec3], i: usize, k: usize, table: &Table) -> f64 {
    let [a, b, c] = spread(points, i, &table.row(i)[..table.k().min(k)]).0;
    let sum = a + b + c;
    if 0.0 < sum { a / sum } else { 0.0 }
}

/// Eigenvalues, ascending, and eigenvectors of the weighted covariance of a sample and some others.
fn spread(points: &[DVec3], i: usize, row: &[u32]) -> ([f64; 3], DMat3) {
    let offsets = || row.iter().map(|&j| points[j as usize] - points[i]);
    let reach = offsets().map(DVec3::length_squared).fold(0.0, f64::max);
    // Slightly beyond the farthest: of three neighbours none is lost.
    let weight = |d: DVec3| (1.0 - d.length_squared() / (1.05 * reach)).powi(2);
    let (mut sum, mut mean) = (1.0, DVec3::ZERO);
    for d in offsets() {
        sum += weight(d);
        mean += d * weight(d);
    }
    mean /= sum;
    let outer = |d: DVec3| DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    let covariance = offsets().fold(outer(-mean), |m, d| m + outer(d - mean) * weight(d));
    symmetric3(covariance)
}
