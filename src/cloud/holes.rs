//! Rims of the holes in a cloud. How a hole is closed is left to the surface.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::areas::tangents;
use super::groups::Groups;
use super::neighbours::{Near, Neighbours};
use super::{Known, Samples};
use crate::geom::{Aabb, Ray};
use crate::num::eigen::symmetric3;

/// Radius of an empty disc that makes a hole, per spacing: one width. The weights of both sides of anything
/// narrower span it; and in a random sampling (Poisson) a disc of this size is empty with probability
/// `exp(-4 pi)`, 3.5e-6.
const DISC: f64 = 2.0;

/// A sample this many spacings from one that faces the other way lies on a sharp crease, where the surface goes on round
/// the edge: no rim of a hole. Neighbours of an even sampling lie 1.07 spacings apart, across an edge up to twice that.
const CREASE: f64 = 2.0;

/// Samples whose spacings are asked for the local one: at a rim the own spacing is 1.4 times too large.
const AROUND: usize = 16;

/// So many nearest samples are asked first, then as many more: usually they leave no gap.
const FEW: usize = 8;

/// Rims of fewer samples are chance: an empty disc in a random sampling touches three to five, a round hole of
/// twice its size has two dozen around it.
const LEAST_RIM: usize = 10;

/// Lines through each hole that are tried.
const TRIED: usize = 16;
/// They lean from the normal of the rim's plane by up to so much: no scanner's grid lies along them.
const LEAN: f64 = 0.1;

/// A hole, or the outer rim of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Its samples, ascending.
    pub rim: Vec<u32>,
    /// Around them.
    pub bounds: Aabb,
    /// The largest extent of the rim along an axis, world length.
    pub width: f64,
}

/// The holes of a cloud, in the order of their first samples: groups of at least ten samples,
/// each touched by an empty disc of two spacings' radius in its tangent plane (the rim of the alpha shape,
/// Edelsbrunner and Muecke 1994), linked where one disc may touch both.
pub fn holes(samples: &Samples) -> Vec<Hole> {
    holes_by(samples, &Known::of(&samples.points))
}

/// The same, given what is known of the samples' neighbours.
pub fn holes_by(samples: &Samples, Known { tree, table }: &Known) -> Vec<Hole> {
    let may = |i: usize, near: &[u32]| may_be_open(samples, i, near, disc_radius(samples, i, near));
    let some: Option<Vec<bool>> = match table {
        Some(table) if table.k() < AROUND => None,
        Some(table) => {
            let may = |i| may(i, &table.row(i)[..AROUND]);
            Some((0..samples.len()).into_par_iter().map(may).collect())
        }
        // A table of very many samples would be the most memory that is ever held.
        None if samples.len() <= AROUND => None,
        None => Some(tree.map(AROUND, |i, near| {
            let ids: [u32; AROUND] = std::array::from_fn(|k| near[k].index);
            may(i as usize, &ids)
        })),
    };
    let touch = |(near, arcs): &mut (Vec<Near>, Vec<[f64; 2]>), i: u32| {
        let i = i as usize;
        tree.nearest(samples.points[i], AROUND + 1, near);
        near.retain(|n| n.index as usize != i);
        let nearest: Vec<u32> = near.iter().take(AROUND).map(|n| n.index).collect();
        let radius = disc_radius(samples, i, &nearest);
        tree.within(samples.points[i], 2.0 * radius, near);
        is_open(samples, i, near, radius, arcs).then_some((i as u32, radius))
    };
    let all = 0..samples.len() as u32;
    let asked: Vec<u32> = match some {
        Some(may) => all.filter(|i| may[*i as usize]).collect(),
        None => all.collect(),
    };
    let open: Vec<Option<(u32, f64)>> = asked.into_par_iter().map_init(Default::default, touch).collect();
    let rim: Vec<(u32, f64)> = open.into_iter().flatten().collect();
    let labels = linked(samples, &rim).labels();
    let mut order: Vec<usize> = (0..rim.len()).collect();
    order.sort_unstable_by_key(|&at| (labels[at], at));
    let pieces = order.chunk_by(|&a, &b| labels[a] == labels[b]);
    pieces.filter_map(|piece| hole(samples, piece.iter().map(|&at| rim[at]).collect())).collect()
}

impl Hole {
    /// Lines through the middle of the hole, across the plane of its rim: each halfway between a sample of the rim and that
    /// farthest from it, as long as `length` to both sides.
    pub fn lines(&self, points: &[DVec3], length: f64) -> Vec<Ray> {
        let rim: Vec<DVec3> = self.rim.iter().map(|i| points[*i as usize]).collect();
        let mean = rim.iter().sum::<DVec3>() / rim.len() as f64;
        let outer = |d: DVec3| DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let spread = rim.iter().map(|p| outer(*p - mean)).fold(DMat3::ZERO, |a, b| a + b);
        let axes = symmetric3(spread).1;
        let line = |k: usize| {
            let p = rim[k * rim.len() / TRIED];
            let farthest = rim
                .iter()
                .copied()
                .max_by(|a, b| (*a - p).length_squared().total_cmp(&(*b - p).length_squared()));
            let middle = 0.5 * (p + farthest.unwrap_or(p));
            let (sin, cos) = (TAU * k as f64 / TRIED as f64).sin_cos();
            let dir = (axes.x_axis + LEAN * (cos * axes.y_axis + sin * axes.z_axis)).normalize();
            Ray::new(middle - length * dir, 2.0 * length * dir)
        };
        (0..TRIED).map(line).collect()
    }
}

/// Groups of rim samples at most a disc's diameter apart.
fn linked(samples: &Samples, rim: &[(u32, f64)]) -> Groups {
    let points: Vec<DVec3> = rim.iter().map(|r| samples.points[r.0 as usize]).collect();
    let tree = Neighbours::new(&points);
    let mut groups = Groups::new(rim.len());
    let mut near = Vec::new();
    for (at, p) in points.iter().enumerate() {
        tree.within(*p, 2.0 * rim[at].1, &mut near);
        for Near { distance_squared, index } in &near {
            if *distance_squared <= 4.0 * rim[*index as usize].1.powi(2) {
                groups.join(at, *index as usize);
            }
        }
    }
    groups
}

fn hole(samples: &Samples, rim: Vec<(u32, f64)>) -> Option<Hole> {
    let bounds = Aabb::of_points(rim.iter().map(|r| samples.points[r.0 as usize]));
    let width = bounds.size().max_element();
    let mut radii: Vec<f64> = rim.iter().map(|r| r.1).collect();
    radii.sort_unstable_by(f64::total_cmp);
    let is_wide = 2.0 * radii[radii.len() / 2] <= width;
    let rim: Vec<u32> = rim.into_iter().map(|r| r.0).collect();
    (LEAST_RIM <= rim.len() && is_wide).then_some(Hole { rim, bounds, width })
}

/// [`DISC`] times the median spacing of a sample and those around it.
fn disc_radius(samples: &Samples, i: usize, near: &[u32]) -> f64 {
    let mut around = [samples.spacing[i]; AROUND + 1];
    near.iter().zip(&mut around).for_each(|(n, s)| *s = samples.spacing[*n as usize]);
    let around = &mut around[..near.len() + 1];
    DISC * *around.select_nth_unstable_by(near.len() / 2, f64::total_cmp).1
}

/// Whether a few near samples leave a gap, and so more may.
fn may_be_open(samples: &Samples, i: usize, near: &[u32], radius: f64) -> bool {
    let frame = tangents(samples.normals[i]);
    let (mut arcs, mut len) = ([[0.0; 2]; AROUND], 0);
    for few in near.chunks(FEW) {
        for arc in few.iter().filter_map(|n| arc(samples, i, *n as usize, radius, frame)) {
            arcs[len] = arc;
            len += 1;
        }
        if !leave_gap(&mut arcs[..len]) {
            return false;
        }
    }
    true
}

/// Whether some disc of `radius` in the tangent plane of sample `i`, its edge on the sample, holds none of the
/// samples of its side of the surface. One at `d` is in the discs whose centre is seen within `acos(|d| / 2 radius)`
/// of its direction: the question is whether these arcs leave a gap.
fn is_open(samples: &Samples, i: usize, near: &[Near], radius: f64, arcs: &mut Vec<[f64; 2]>) -> bool {
    let normal = samples.normals[i];
    let faces_away = |n: &Near| samples.normals[n.index as usize].dot(normal) <= 0.0;
    let crease = (CREASE * radius / DISC).powi(2);
    if near.iter().any(|n| n.distance_squared <= crease && faces_away(n)) {
        return false;
    }
    let frame = tangents(normal);
    arcs.clear();
    arcs.extend(near.iter().filter_map(|n| arc(samples, i, n.index as usize, radius, frame)));
    leave_gap(arcs)
}

/// The arc of the directions in which discs of sample `i` hold sample `n`, if any, by [`along_square`].
fn arc(samples: &Samples, i: usize, n: usize, radius: f64, (u, v): (DVec3, DVec3)) -> Option<[f64; 2]> {
    if n == i || samples.normals[n].dot(samples.normals[i]) <= 0.0 {
        return None;
    }
    let d = samples.points[n] - samples.points[i];
    let d = DVec2::new(d.dot(u), d.dot(v));
    let length = d.length();
    // Straight above or below it is in all discs to one side; any.
    let to = if 0.0 < length { d / length } else { DVec2::X };
    let cos = length / (2.0 * radius);
    if 1.0 <= cos {
        return None;
    }
    let half = DVec2::new(cos, (1.0 - cos * cos).sqrt());
    let [from, end] = [DVec2::new(half.x, -half.y), half].map(|half| along_square(half.rotate(to)));
    Some([from, if end < from { end + FULL } else { end }])
}

/// How far along the square with its corners on the axes a direction points, counted from x to y: it grows with the angle, and
/// takes a quotient where that takes an arc tangent.
fn along_square(d: DVec2) -> f64 {
    let across = d.x / (d.x.abs() + d.y.abs());
    if d.y < 0.0 { 3.0 + across } else { 1.0 - across }
}

/// All the way round, by [`along_square`].
const FULL: f64 = 4.0;

/// Whether arcs leave a direction out.
fn leave_gap(arcs: &mut [[f64; 2]]) -> bool {
    arcs.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    // What the last arcs cover beyond the end of the circle.
    let mut covered = arcs.iter().map(|arc| arc[1] - FULL).fold(0.0, f64::max);
    for arc in arcs.iter() {
        if covered < arc[0] {
            return true;
        }
        covered = covered.max(arc[1]);
    }
    covered < FULL
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_along_a_square_grows_with_the_angle() {
        let all: Vec<f64> =
            (0..1000).map(|k| along_square(DVec2::from_angle(TAU * f64::from(k) / 1000.0))).collect();
        assert!(all.is_sorted_by(|a, b| a < b) && 0.0 <= all[0] && all[999] < FULL);
    }

    #[test]
    fn arcs_leave_a_gap_unless_they_go_all_the_way_round() {
        assert!(leave_gap(&mut []));
        assert!(leave_gap(&mut [[0.0, 3.0]]));
        assert!(!leave_gap(&mut [[3.0, 5.0], [0.5, 3.5]]));
        assert!(leave_gap(&mut [[3.0, 4.5], [0.6, 3.5]]));
    }
}
