//! Open surfaces end where their samples end.

mod common;

use common::{all, surface};
use glam::DVec3;
use pss::geom::Ray;
use pss::num::hash::Stream;
use pss::solid::Scratch;
use pss::solid::point_set::{Options, PointSet};

/// Samples of the square from 0 to 1 at z = 0 that `keep` keeps: a grid, each shaken by so many spacings.
fn sheet(side: usize, shake: f64, keep: impl Fn(DVec3) -> bool) -> PointSet {
    let mut stream = Stream::new(11);
    let step = 1.0 / (side - 1) as f64;
    let mut shaken = || shake * step * (2.0 * stream.unit() - 1.0);
    let grid = (0..side * side).map(|i| DVec3::new((i % side) as f64 * step, (i / side) as f64 * step, 0.0));
    let points: Vec<DVec3> =
        grid.map(|p| p + DVec3::new(shaken(), shaken(), 0.0)).filter(|p| keep(*p)).collect();
    surface(&points, &vec![DVec3::Z; points.len()], &Options::default())
}

fn hits(set: &PointSet, x: f64, y: f64, scratch: &mut Scratch) -> usize {
    all(set, &Ray::new(DVec3::new(x, y, 1.0), DVec3::new(0.01, 0.02, -1.0)), scratch).len()
}

/// How far beyond x = 1 the sheet goes on, along a line of constant y, in widths.
fn edge(set: &PointSet, y: f64, scratch: &mut Scratch) -> f64 {
    let h = set.samples().widths[0];
    let (mut lo, mut hi) = (0.5, 1.0 + 3.0 * h);
    // The ray meets z = 0 beside its origin.
    while 1e-4 * h < hi - lo {
        let x = 0.5 * (lo + hi);
        if hits(set, x - 0.01, y - 0.02, scratch) == 1 { lo = x } else { hi = x }
    }
    (lo - 1.0) / h
}

/// Every sample stands for a cell of one spacing squared, so that n^2 of them cover n^2 cells: the samples end half a spacing
/// beyond the last row, a sixth of these widths, and there the mean of the samples in the weight is as far away as that of a
/// continuous half-plane from its rim. From the last row itself the edge lies within that sixth and a tenth.
#[test]
fn f6_the_edge_of_a_grid_lies_within_a_tenth_of_a_width_of_where_its_cells_end() {
    let step = 0.01;
    let points: Vec<DVec3> =
        (0..101 * 101).map(|i| DVec3::new(f64::from(i % 101), f64::from(i / 101), 0.0) * step).collect();
    let (normals, widths) = (vec![DVec3::Z; points.len()], vec![3.0 * step; points.len()]);
    for gaussian in [false, true] {
        let set = PointSet::new(&points, &normals, &widths, &Options { gaussian, ..Options::default() });
        let mut scratch = Scratch::default();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for i in 0..40 {
            let beyond = edge(&set, 0.2 + 0.6 * f64::from(i) / 40.0, &mut scratch);
            range = [range[0].min(beyond), range[1].max(beyond)];
        }
        println!("gaussian {gaussian}: {:.3} to {:.3} widths beyond the last row", range[0], range[1]);
        let cells = 0.5 / 3.0;
        assert!(cells - 0.1 <= range[0] && range[1] <= cells + 0.1, "{range:?}");
        let ray = Ray::new(DVec3::new(0.503, 0.517, 1.0), DVec3::new(0.01, 0.02, -1.0));
        assert!((all(&set, &ray, &mut scratch)[0].t - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_edge_of_uneven_samples_lies_within_half_a_width() {
    let set = sheet(81, 0.4, |_| true);
    let mut scratch = Scratch::default();
    for i in 0..200 {
        let off = edge(&set, 0.2 + 0.6 * f64::from(i) / 200.0, &mut scratch);
        assert!(off.abs() <= 0.5, "{off} widths beyond");
    }
}

#[test]
fn uneven_samples_leave_no_pinholes_and_a_lost_sample_none_either() {
    let lost = DVec3::new(0.5, 0.5, 0.0);
    let set = sheet(81, 0.45, |p| 0.015 < p.distance(lost));
    let mut scratch = Scratch::default();
    let mut stream = Stream::new(3);
    for _ in 0..20_000 {
        let (x, y) = (0.05 + 0.9 * stream.unit(), 0.05 + 0.9 * stream.unit());
        assert_eq!(hits(&set, x, y, &mut scratch), 1, "{x} {y}");
    }
    assert_eq!(hits(&set, 0.49, 0.48, &mut scratch), 1);
}

#[test]
fn a_hole_wider_than_the_support_stays_a_hole() {
    let middle = DVec3::new(0.5, 0.5, 0.0);
    let set = sheet(81, 0.0, |p| 0.15 < p.distance(middle));
    let h = set.samples().widths[0];
    let mut scratch = Scratch::default();
    let mut stream = Stream::new(4);
    for _ in 0..5000 {
        let (x, y) = (0.3 + 0.4 * stream.unit(), 0.3 + 0.4 * stream.unit());
        let from = DVec3::new(x + 0.01, y + 0.02, 0.0).distance(middle) - 0.15;
        if 0.5 * h < from.abs() {
            assert_eq!(
                hits(&set, x, y, &mut scratch),
                usize::from(0.0 < from),
                "{} widths from the rim",
                from / h
            );
        }
    }
}
