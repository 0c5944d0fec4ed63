//! How far apart samples lie, and how wide the weight of each must be.

use glam::DVec3;
use rayon::prelude::*;

use super::neighbours::{Near, Neighbours, Table};
use super::peers::Peers;

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

/// A weight of usual width holds twelve samples. Where a thin sheet runs into a dense one, those of its samples near the dense one would have
/// weights that hold thousands of it: each place would cost as much more, and nothing of the dense sheet's shape were left there.
const MOST_DENSE: usize = 64;

/// Samples of so much less spacing than half a width are those of another, denser sheet.
const DENSER: f64 = 4.0;

/// Widths such that the ball of no width holds more than [`MOST_DENSE`] samples four times as dense as its own: a width that does
/// ends at as many samples. Where the density changes smoothly by 10,000 to 1
/// no weight holds so many, and all are left alone. `tree` is that of the points.
pub fn capped(points: &[DVec3], spacing: &[f64], mut widths: Vec<f64>, tree: &Neighbours) -> Vec<f64> {
    let (least, most) = widths.iter().fold((f64::INFINITY, 0.0f64), |(a, b), w| (w.min(a), w.max(b)));
    if most <= DENSER * least {
        return widths;
    }
    let peers = Peers::new(tree, spacing);
    let cap = |near: &mut Vec<Near>, (p, width): (&DVec3, &mut f64)| {
        let denser = *width / (WIDTH_PER_SPACING * DENSER);
        if denser <= least / WIDTH_PER_SPACING || !peers.are_denser(*p, *width, denser, MOST_DENSE) {
            return;
        }
        // The sample itself is among them.
        tree.nearest(*p, MOST_DENSE + 1, near);
        *width = width.min(near.last().map_or(*width, |n| n.distance_squared.sqrt()));
    };
    points.par_iter().zip(&mut widths).for_each_init(Vec::new, cap);
    widths
}
