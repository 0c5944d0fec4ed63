//! Colours of the points on their surface.

mod common;

use common::{Truth, all, chord, surface};
use glam::DVec3;
use pss::cloud::{SampleOptions, Samples, ply};
use pss::geom::Ray;
use pss::solid::point_set::{Options, PointSet};
use pss::solid::{Scratch, Solid};

/// A colour that changes linearly over space.
fn linear(p: DVec3) -> [f32; 3] {
    [0.5 + 0.2 * p.x, 0.5 + 0.1 * p.y - 0.1 * p.x, 0.4 + 0.15 * p.z].map(|c| c as f32)
}

fn ball(n: usize, color: impl Fn(DVec3) -> [f32; 3], options: &Options) -> PointSet {
    let (points, normals) = Truth::Sphere.cloud(n);
    let colors: Vec<[f32; 3]> = points.iter().map(|p| color(*p)).collect();
    surface(&points, &normals, options).with_colors(&colors)
}

/// The largest difference of the colours at crossings from a function of the place.
fn worst(set: &PointSet, truth: impl Fn(DVec3) -> [f32; 3]) -> f32 {
    let mut scratch = Scratch::default();
    let mut worst: f32 = 0.0;
    for i in 0..600 {
        let ray = chord(i, DVec3::ZERO, 1.5);
        for hit in all(set, &ray, &mut scratch) {
            let at = ray.at(hit.t);
            let color = set.color(at, &mut scratch).unwrap();
            for (c, t) in color.into_iter().zip(truth(at)) {
                worst = worst.max((c - t).abs());
            }
        }
    }
    worst
}

#[test]
fn one_colour_stays_that_colour_and_a_linear_one_is_met_as_the_widths_shrink() {
    for gaussian in [false, true] {
        let options = Options { gaussian, ..Options::default() };
        let same = worst(&ball(4000, |_| [0.25, 0.5, 0.125], &options), |_| [0.25, 0.5, 0.125]);
        assert!(same <= f32::EPSILON, "{same}");
        let (few, many) =
            (worst(&ball(4000, linear, &options), linear), worst(&ball(64_000, linear, &options), linear));
        println!("gaussian {gaussian}: {few:.1e} -> {many:.1e}");
        // The widths fall to a quarter; a mean of uneven samples is off by a share of the width.
        assert!(few < 0.02 && many < few / 4.0, "{few} {many}");
    }
}

#[test]
fn the_two_sides_of_a_thin_wall_keep_their_colours() {
    // Faces two widths apart: a paper that weighs all samples would mix them.
    let (points, normals) = Truth::Slab.cloud(4000);
    let side = |n: &DVec3| if 0.0 < n.z { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let colors: Vec<[f32; 3]> = normals.iter().map(side).collect();
    let set = surface(&points, &normals, &Options::default()).with_colors(&colors);
    let mut scratch = Scratch::default();
    for i in 0..200 {
        let (x, y) = (f64::from(i % 20) * 0.06 - 0.57, f64::from(i / 20) * 0.12 - 0.54);
        let ray = Ray::new(DVec3::new(x, y, 1.0), -DVec3::Z);
        let hits = all(&set, &ray, &mut scratch);
        assert_eq!(hits.len(), 2);
        assert_eq!(set.color(ray.at(hits[0].t), &mut scratch), Some([1.0, 0.0, 0.0]));
        assert_eq!(set.color(ray.at(hits[1].t), &mut scratch), Some([0.0, 0.0, 1.0]));
    }
}

#[test]
fn a_surface_without_colours_has_none() {
    let (points, normals) = Truth::Sphere.cloud(500);
    let set = surface(&points, &normals, &Options::default());
    assert_eq!(set.color(DVec3::X, &mut Scratch::default()), None);
}

#[test]
fn coloured_scans_have_their_colours_everywhere() {
    for name in ["lion", "pump"] {
        let path = format!("../shared/scans/{name}.ply");
        let Ok(cloud) = ply::read_path(path.as_ref()) else {
            println!("skipped: {path} is missing");
            continue;
        };
        let range = cloud.colors.iter().flatten().fold([f32::INFINITY, 0.0], |[lo, hi], c| {
            [lo.min(c[0].min(c[1]).min(c[2])), hi.max(c[0].max(c[1]).max(c[2]))]
        });
        let samples = Samples::new(cloud, &SampleOptions::default()).unwrap();
        let set = PointSet::new(&samples.points, &samples.normals, &samples.widths, &Options::default())
            .with_colors(samples.colors.as_deref().unwrap());
        let (bounds, mut scratch, mut seen) = (samples.bounds(), Scratch::default(), 0);
        for i in 0..300 {
            let ray = chord(i, bounds.center(), 0.5 * bounds.diagonal());
            for hit in all(&set, &ray, &mut scratch) {
                let color = set.color(ray.at(hit.t), &mut scratch).unwrap();
                assert!(color.iter().all(|c| range[0] <= *c && *c <= range[1]), "{name}: {color:?}");
                seen += 1;
            }
        }
        assert!(20 < seen, "{name}: {seen}");
    }
}
