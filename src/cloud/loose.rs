//! Samples that belong to no surface by the look of their neighbours: lone ones off a smooth sheet, and thinly strewn
//! ones that fill space beside a dense body.
//!
//! *Lone*: the plane of least squares through the 16 nearest others, the two farthest off it left out and the plane
//! fitted again, has a root mean square distance e from them; the sample lies d off it. On a smooth surface the plane
//! of its neighbours is as far from a sample as from its neighbours: d / e is at most 1.7 for even samples (the mean of a
//! quadratic height over a disc against its deviation), was seen up to 4 on random ones, on edges and corners of cubes (under Gaussian noise three of
//! a thousand samples exceed six); so a sample is lone where `6 e < d`, and where d is also a quarter of the spacing of its neighbours: nearer ones
//! hardly move the surface. It must stand over them, not beside: there the plane only extrapolates. (A
//! sample of a thin sheet that is nearer to a dense sheet than to its own kind is lone too: where the two meet at an edge, some of a row.)
//!
//! *Strewn*: within four of its own spacings lie sixteen samples three times as dense, and those no denser than that, its peers, are
//! fewer than six, or fill space with it: the least eigenvalue of their weighted covariance is more than a tenth of the
//! trace. A density that changes smoothly keeps all its samples, for there the peers lie on the surface too (0.02 was the most seen for
//! densities of 10,000 to 1); so does a sparse sheet beside a dense one, and a crease of it (0.085 at a right angle).

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::neighbours::{Near, Neighbours, Table};
use super::normals::NORMAL_NEIGHBOURS;
use super::peers::Peers;
use crate::num::eigen::symmetric3;

/// See the module.
const LONE: f64 = 6.0;
/// Shares of the neighbours' spacing that a lone sample is off at least.
const OFF: f64 = 0.25;
/// So many of the neighbours may be strays themselves.
const TRIMMED: usize = 2;
/// Fewer neighbours than this do not tell a sheet.
const FEWEST: usize = 12;

/// Samples so many times as dense are of another kind.
const DENSER: f64 = 3.0;
/// And these near, in own spacings.
const REACH: f64 = 4.0;
/// Fewer peers make no surface: what spacing is measured by.
const LEAST_PEERS: usize = 6;
/// Points that fill space have 0.2 among 16 neighbours, noisy scans below 0.05.
const FILLS: f64 = 0.1;

/// Whether each sample is lone or strewn. `tree` is that of the points, `table` has rows of at least [`NORMAL_NEIGHBOURS`] where
/// there are so many.
pub fn loose(points: &[DVec3], spacing: &[f64], table: &Table, tree: &Neighbours) -> Vec<bool> {
    let peers = Peers::new(tree, spacing);
    let is_loose = |near: &mut Vec<Near>, i: usize| {
        is_lone(points, spacing, table.row(i), points[i]) || is_strewn(&peers, points, spacing, i, near)
    };
    (0..points.len()).into_par_iter().map_init(Vec::new, is_loose).collect()
}

fn is_lone(points: &[DVec3], spacing: &[f64], row: &[u32], p: DVec3) -> bool {
    let row = &row[..row.len().min(NORMAL_NEIGHBOURS)];
    if row.len() < FEWEST {
        return false;
    }
    let (mut own, mut near) = ([0.0; NORMAL_NEIGHBOURS], [DVec3::ZERO; NORMAL_NEIGHBOURS]);
    let (own, near) = (&mut own[..row.len()], &mut near[..row.len()]);
    for (&j, (own, near)) in row.iter().zip(own.iter_mut().zip(near.iter_mut())) {
        (*own, *near) = (spacing[j as usize], points[j as usize] - p);
    }
    let unit = *own.select_nth_unstable_by(row.len() / 2, f64::total_cmp).1;
    let Plane { center, normal, .. } = Plane::of(near);
    // Two strays among sixteen tilt the plane, but not so much that the sample comes this close.
    if normal.dot(center).abs() <= 0.5 * OFF * unit {
        return false;
    }
    let distance = |d: &DVec3| normal.dot(*d - center).abs();
    near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Plane { center, normal, deviation, radius } = Plane::of(&near[..row.len() - TRIMMED]);
    let off = normal.dot(center).abs();
    let beside = (center - normal * normal.dot(center)).length();
    OFF * unit < off && LONE * deviation < off && beside < radius
}

/// A plane of least squares.
struct Plane {
    center: DVec3,
    normal: DVec3,
    /// Root mean square distance from it.
    deviation: f64,
    /// Root mean square distance from the centre within it.
    radius: f64,
}

impl Plane {
    fn of(near: &[DVec3]) -> Plane {
        let count = near.len() as f64;
        let center = near.iter().sum::<DVec3>() / count;
        let spread = near.iter().fold(DMat3::ZERO, |m, d| m + outer(*d - center));
        let ([a, b, c], axes) = symmetric3(spread);
        let (deviation, radius) = ((a.max(0.0) / count).sqrt(), ((b + c) / count).sqrt());
        Plane { center, normal: axes.x_axis, deviation, radius }
    }
}

fn outer(d: DVec3) -> DMat3 {
    DMat3::from_cols(d * d.x, d * d.y, d * d.z)
}

fn is_strewn(peers: &Peers<'_>, points: &[DVec3], spacing: &[f64], i: usize, near: &mut Vec<Near>) -> bool {
    let (p, own) = (points[i], spacing[i]);
    let reach = REACH * own;
    if !peers.are_denser(p, reach, own / DENSER, NORMAL_NEIGHBOURS) {
        return false;
    }
    peers.nearest((i as u32, p), own / DENSER, NORMAL_NEIGHBOURS, near);
    if near.iter().filter(|n| n.distance_squared <= reach * reach).count() < LEAST_PEERS {
        return true;
    }
    // Slightly beyond the farthest, so that none is lost.
    let farthest = 1.05 * near.last().map_or(0.0, |n| n.distance_squared);
    let offset = |n: &Near| (points[n.index as usize] - p, (1.0 - n.distance_squared / farthest).powi(2));
    let (sum, total) = near.iter().map(offset).fold((DVec3::ZERO, 1.0), |(s, t), (d, w)| (s + d * w, t + w));
    let mean = sum / total;
    let spread = near.iter().map(offset).fold(outer(-mean), |m, (d, w)| m + outer(d - mean) * w);
    let [a, b, c] = symmetric3(spread).0;
    FILLS * (a + b + c) < a
}
