//! Which samples are strays: too few, or too thinly strewn, to carry a surface.

use glam::DVec3;

use super::groups::Groups;
use super::loose::loose;
use super::neighbours::{Neighbours, Table};
use super::normals::{NORMAL_NEIGHBOURS, roughness};

/// Groups of fewer samples are strays: twice the six coefficients of a quadratic polynomial, which is
/// how many samples a weight of ordinary width holds.
const LEAST_GROUP: usize = 12;

/// Thin groups of fewer samples beside a body are strays however they lie: a handful of twenty among hundreds strewn in space
/// was seen to lie flat by chance.
const LEAST_SHEET: usize = 64;

/// Groups with at least this share of all samples are the body, and never strays.
const BODY: f64 = 0.05;

/// A group is thin where its spacing is this many times that of the body beside it: the body's own spacing was
/// not seen to change so much between neighbouring groups of a scan.
const THIN: f64 = 3.0;

/// Samples farther apart than this many of the smaller of their widths, three spacings, do not belong together: thinly
/// strewn ones have wide weights and would else tie themselves to any surface in their midst.
const REACH: f64 = 1.5;

/// Points that fill space have a roughness near 0.2 among 16 neighbours, noisy scans below 0.05.
const ROUGH: f64 = 0.1;

/// Whether each sample is a stray: [`loose`] by itself, or of a stray group. Two samples belong together if one is among the
/// other's nearest and no farther than the geometric mean of their widths: a lone sample more than some 3.5 spacings off
/// a surface is not of it. A group is stray if it has fewer than [`LEAST_GROUP`] samples (in clouds of more),
/// or if it is no part of the body and its median sample is thinly strewn for its place, and either not on a surface or one of fewer than
/// [`LEAST_SHEET`]:
/// such as what is left inside a body of which only the skin was wanted.
///
/// All rules are relative, so a cloud of uneven density keeps its sparse parts as long as they are smooth. What is left may
/// have strays that others hid: ask again. `tree` is that of the points.
pub fn strays(
    points: &[DVec3],
    spacing: &[f64],
    widths: &[f64],
    table: &Table,
    tree: &Neighbours,
) -> Vec<bool> {
    let mut strays = loose(points, spacing, table, tree);
    of_groups(points, spacing, widths, table, &mut strays);
    strays
}

/// Marks the groups that are stray.
fn of_groups(points: &[DVec3], spacing: &[f64], widths: &[f64], table: &Table, strays: &mut [bool]) {
    let labels = labels(points, widths, table);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (labels[i as usize], i));
    let groups: Vec<&[u32]> = order.chunk_by(|&i, &j| labels[i as usize] == labels[j as usize]).collect();
    let largest = groups.iter().map(|group| group.len()).max().unwrap_or(0);
    let is_body = |group: &&&[u32]| BODY * points.len() as f64 <= group.len() as f64;
    if groups.iter().all(|group| is_body(&group)) {
        return;
    }
    let body: Vec<u32> = groups.iter().filter(is_body).flat_map(|group| group.iter().copied()).collect();
    let body_points: Vec<DVec3> = body.iter().map(|&i| points[i as usize]).collect();
    let tree = Neighbours::new(&body_points);
    let mut near = Vec::new();
    let mut thinness = |i: u32| {
        tree.nearest(points[i as usize], 1, &mut near);
        near.first().map_or(0.0, |n| spacing[i as usize] / spacing[body[n.index as usize] as usize])
    };
    for group in groups.iter().filter(|group| !is_body(group)) {
        let is_stray = group.len() < LEAST_GROUP.min(largest)
            || THIN < median(group, &mut thinness)
                && (group.len() < LEAST_SHEET || ROUGH < roughness_of(points, group));
        group.iter().for_each(|&i| strays[i as usize] |= is_stray);
    }
}

fn labels(points: &[DVec3], widths: &[f64], table: &Table) -> Vec<u32> {
    let mut groups = Groups::new(points.len());
    for (i, p) in points.iter().enumerate() {
        for &j in table.row(i) {
            let j = j as usize;
            let narrow = REACH * widths[i].min(widths[j]);
            if p.distance_squared(points[j]) <= (widths[i] * widths[j]).min(narrow * narrow) {
                groups.join(i, j);
            }
        }
    }
    groups.labels()
}

/// The median roughness of a group by itself: a body beside it would pass for its neighbourhood.
fn roughness_of(points: &[DVec3], group: &[u32]) -> f64 {
    let own: Vec<DVec3> = group.iter().map(|&i| points[i as usize]).collect();
    let table = Neighbours::new(&own).table(NORMAL_NEIGHBOURS);
    let all: Vec<u32> = (0..own.len() as u32).collect();
    median(&all, &mut |i| roughness(&own, i as usize, NORMAL_NEIGHBOURS, &table))
}

fn median(group: &[u32], value: &mut impl FnMut(u32) -> f64) -> f64 {
    let mut values: Vec<f64> = group.iter().map(|&i| value(i)).collect();
    let half = values.len() / 2;
    *values.select_nth_unstable_by(half, f64::total_cmp).1
}
