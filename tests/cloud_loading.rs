//! What loading makes of duplicates, gaps in the data, tiny clouds, outliers and far places; named by their numbers in the
//! list of numerical stress cases.

mod common;

use common::{Truth, all, chord};
use glam::DVec3;
use pss::cloud::{Cloud, SampleOptions, Samples, ply};
use pss::geom::Ray;
use pss::num::hash::Stream;
use pss::solid::point_set::{Options, PointSet};
use pss::solid::{Crossing, Scratch, Solid};

fn samples(points: Vec<DVec3>) -> Samples {
    Samples::new(Cloud { points, ..Cloud::default() }, &SampleOptions::default()).unwrap()
}

fn crossings(s: &Samples, center: DVec3) -> Vec<Vec<Crossing>> {
    let set = PointSet::new(&s.points, &s.normals, &s.widths, &Options::default());
    let mut scratch = Scratch::default();
    (0..500).map(|i| all(&set, &chord(i, center, 1.4), &mut scratch)).collect()
}

fn farthest(a: &[Vec<Crossing>], b: &[Vec<Crossing>]) -> f64 {
    let mut worst: f64 = 0.0;
    for (a, b) in a.iter().zip(b) {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).for_each(|(a, b)| worst = worst.max((a.t - b.t).abs() - a.err - b.err));
    }
    worst
}

#[test]
fn f7_a_thousand_copies_of_a_point_weigh_as_one() {
    let (points, _) = Truth::Sphere.cloud(3000);
    let mut copied = points.clone();
    for p in points.iter().step_by(100) {
        copied.extend(std::iter::repeat_n(*p, 1000));
    }
    let (once, often) = (samples(points), samples(copied));
    assert_eq!(once.points, often.points);
    assert!(farthest(&crossings(&once, DVec3::ZERO), &crossings(&often, DVec3::ZERO)) <= 1e-12);
}

#[test]
fn f8_points_that_are_no_numbers_are_dropped_counted_and_change_nothing() {
    let (points, _) = Truth::Sphere.cloud(3000);
    let row = |p: &DVec3| format!("{} {} {}\n", p.x, p.y, p.z);
    let text = |bad: bool| {
        let mut rows: Vec<String> = points.iter().map(row).collect();
        if bad {
            rows.insert(700, "nan 0 0\n".to_owned());
            rows.insert(2000, "1 inf 0\n".to_owned());
        }
        let columns = ["x", "y", "z"].map(|c| format!("property double {c}\n")).concat();
        format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n{columns}end_header\n{}",
            rows.len(),
            rows.concat()
        )
    };
    let [clean, bad] = [false, true].map(|bad| ply::read(text(bad).as_bytes()).unwrap());
    assert_eq!(clean.points, bad.points);
    assert!(bad.notes.iter().any(|n| n.contains('2') && n.contains("700")), "{:?}", bad.notes);
}

#[test]
fn f9_clouds_of_one_to_ten_points_are_refused_or_defined() {
    let (points, normals) = Truth::Sphere.cloud(10);
    for n in 1..=10 {
        let cloud =
            Cloud { points: points[..n].to_vec(), normals: Some(normals[..n].to_vec()), ..Cloud::default() };
        let made = Samples::new(cloud, &SampleOptions::default());
        if n < 3 {
            assert!(made.is_err(), "{n}");
            continue;
        }
        let Ok(s) = made else { continue };
        assert!(s.widths.iter().all(|w| w.is_finite() && 0.0 < *w), "{n}");
        for hits in crossings(&s, DVec3::ZERO) {
            assert!(hits.iter().all(|c| c.t.is_finite() && c.err.is_finite()), "{n}");
        }
    }
}

#[test]
fn f10_points_on_a_line_or_nearly_are_no_surface() {
    let line = |noise: f64| -> Vec<DVec3> {
        let mut stream = Stream::new(10);
        let base = DVec3::new(-89.546, 4.03964, 450.883);
        let along = DVec3::new(0.3, 0.7, -0.2);
        (0..50).map(|i| base + along * f64::from(i) * 0.01 + noise * stream.direction()).collect()
    };
    for noise in [0.0, 1e-14] {
        let cloud = Cloud { points: line(noise), ..Cloud::default() };
        let error = Samples::new(cloud, &SampleOptions::default()).unwrap_err();
        assert!(error.message.contains("line"), "{}", error.message);
    }
}

#[test]
fn f15_outliers_about_a_ball_are_dropped() {
    let (points, _) = Truth::Sphere.cloud(10_000);
    let clean = samples(points.clone());
    for share in [0.001, 0.01] {
        let mut stream = Stream::new(15);
        let count = (share * 10_000.0) as usize;
        let stray = (0..count).map(|_| {
            // Between half and one and a half radii, off the surface by more than the samples are apart.
            let side = if stream.unit() < 0.5 { -1.0 } else { 1.0 };
            stream.direction() * (1.0 + side * (0.15 + 0.35 * stream.unit()))
        });
        let s = samples(points.iter().copied().chain(stray.collect::<Vec<_>>()).collect());
        // Their order goes by the extent of all.
        let sorted = |s: &Samples| {
            let mut keys: Vec<[u64; 3]> = s.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
            keys.sort_unstable();
            keys
        };
        assert!(sorted(&s) == sorted(&clean), "{share}: {} samples of 10,000", s.len());
        let found = crossings(&s, DVec3::ZERO);
        assert!(found.iter().all(|c| c.len() % 2 == 0));
        assert!(farthest(&found, &crossings(&clean, DVec3::ZERO)) <= 1e-6);
    }
}

/// A cloud that went through a PLY of doubles.
fn through_file(points: Vec<DVec3>, encoding: ply::Encoding) -> Cloud {
    let mut bytes = Vec::new();
    ply::write(&Cloud { points, ..Cloud::default() }, encoding, &mut bytes).unwrap();
    assert!(String::from_utf8_lossy(&bytes).contains("property double x"));
    ply::read(&bytes).unwrap()
}

#[test]
fn f23_a_far_cloud_in_a_file_of_doubles_equals_its_twin_at_the_origin() {
    let (points, _) = Truth::Torus.cloud(4000);
    let far = [[1e7, 1e7, 1e7], [1e7, -0.7e7, 0.3e7], [1e9, 1e9, 1e9], [5e5, 5e6, 100.0]];
    for (offset, encoding) in far.into_iter().zip([ply::Encoding::Binary, ply::Encoding::Text].repeat(2)) {
        let offset = DVec3::from_array(offset);
        // The twin gets the same rounding of coordinates.
        let far: Vec<DVec3> = points.iter().map(|p| *p + offset).collect();
        let near: Vec<DVec3> = far.iter().map(|p| *p - offset).collect();
        let set = |cloud: Cloud| {
            let s = Samples::new(cloud, &SampleOptions::default()).unwrap();
            assert_eq!(s.len(), points.len(), "{offset}");
            PointSet::new(&s.points, &s.normals, &s.widths, &Options::default())
        };
        let (a, b) = (set(Cloud { points: near, ..Cloud::default() }), set(through_file(far, encoding)));
        let mut scratch = Scratch::default();
        // A place on a ray is rounded so far from the origin: by 1.2e-7 at 1e9.
        let allowed = 1e-8f64.max(4.0 * f64::EPSILON * offset.abs().max_element());
        for i in 0..500 {
            let Ray { origin, dir, .. } = chord(i, DVec3::ZERO, 1.4);
            let there = Ray::new(origin + offset, dir);
            let here = Ray::new(there.origin - offset, dir);
            let (p, q) = (all(&a, &here, &mut scratch), all(&b, &there, &mut scratch));
            assert_eq!(p.len(), q.len(), "{offset}");
            for (p, q) in p.iter().zip(&q) {
                // Along the normal: a grazing line spreads it out.
                let normal = a.normal(&here, p, &mut scratch);
                let apart = (p.t - q.t).abs() * dir.dot(normal).abs();
                assert!(apart <= allowed, "{offset}: {apart:e}");
            }
        }
    }
}

#[test]
fn f22_floats_too_coarse_for_the_cloud_are_said_to_be_so() {
    // A step is 1 at 1e7: nothing of a unit ball is left.
    let (points, _) = Truth::Sphere.cloud(4000);
    let round = |p: &DVec3| (*p + 1e7).to_array().map(|x| f64::from(x as f32));
    let points = points.iter().map(|p| DVec3::from_array(round(p))).collect();
    let error = Samples::new(Cloud { points, ..Cloud::default() }, &SampleOptions::default()).unwrap_err();
    assert!(error.message.contains("apart"), "{}", error.message);
    assert!(error.help.unwrap().contains("double"));
}
