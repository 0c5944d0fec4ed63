//! How far apart samples lie, and how wide the weight of each must be.

use glam::DVec3;
use rayon::prelude::*;

use super::neighbours::Table;

/// Neighbours that spacing is measured by.
pub const SPACING_NEIGHBOURS: usize = 6;

/// `sqrt(pi / 6)`: a disc out to the sixth neighbour holds six samples, so this times its radius is the root of
/// the area of one sample.
pub const SIXTH: f64 = 0.7236;

/// Widths per spacing: a weight then holds some twelve samples, twice what a quadratic polynomial needs.
pub const WIDTH_PER_SPACING: f64 = 2.0;

/// The spacing of each sample, world length: [`SIXTH`] times the distance to its sixth neighbour, the farthest
/// where there are fewer than six. `table` has rows of at least [`SPACING_NEIGHBOURS`] where there are so many.
pub fn spacing(points: &[DVec3], table: &Table) -> Vec<f64> {
    let sixth = |i: usize| {
        let row = table.row(i);
        row.get(SPACING_NEIGHBOURS - 1)
            .or(row.last())
            .map_or(0.0, |&j| points[i].distance(points[j as usize]))
    };
    (0..points.len()).into_par_iter().map(|i| SIXTH * sixth(i)).collect()
}

/// The width of each sample's weight, world length: [`WIDTH_PER_SPACING`] times the largest spacing among the
/// sample and its six nearest, so that no weight is narrower than a gap beside it.
pub fn widths(spacing: &[f64], table: &Table) -> Vec<f64> {
    let largest = |i: usize| {
        let near = table.row(i).iter().take(SPACING_NEIGHBOURS);
        near.fold(spacing[i], |s, &j| s.max(spacing[j as usize]))
    };
    (0..spacing.len()).map(|i| WIDTH_PER_SPACING * largest(i)).collect()
}
