//! Neighbours against looking at every point, and the merging of equal points.

mod cloud_common;

use cloud_common::random_sphere;
use glam::DVec3;
use pss::cloud::neighbours::{Near, Neighbours};
use pss::cloud::{Cloud, merge_duplicates, spacing};
use pss::num::hash::Stream;

fn brute(points: &[DVec3], x: DVec3) -> Vec<Near> {
    let near = |(p, index): (&DVec3, u32)| Near { distance_squared: (*p - x).length_squared(), index };
    let mut all: Vec<Near> = points.iter().zip(0..).map(near).collect();
    all.sort_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index)));
    all
}

/// Random points, denser by a million in the middle of them, a lattice (many equal distances), copies of few points, points on a
/// line, one, none.
fn clouds() -> Vec<Vec<DVec3>> {
    let lattice =
        (0..1000).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)));
    let copies = (0..500).map(|i| DVec3::splat(f64::from(i % 3)));
    let line = (0..300).map(|i| DVec3::new(0.0, f64::from(i) * 0.1, 0.0));
    let mut stream = Stream::new(2);
    let uneven = (0..1500).map(|_| stream.direction() * 10f64.powf(-6.0 * stream.unit())).collect();
    vec![
        random_sphere(2000, 1),
        uneven,
        lattice.collect(),
        copies.collect(),
        line.collect(),
        vec![DVec3::ONE],
        vec![],
    ]
}

#[test]
fn they_are_those_of_looking_at_every_point() {
    let mut stream = Stream::new(4);
    for points in clouds() {
        let tree = Neighbours::new(&points);
        let mut found = Vec::new();
        for round in 0..300 {
            let random = 3.0 * DVec3::new(stream.unit(), stream.unit(), stream.unit());
            let x = if round % 2 == 0 { random } else { random.round() };
            let all = brute(&points, x);
            let k = (stream.unit() * 40.0) as usize;
            tree.nearest(x, k, &mut found);
            assert_eq!(found, all[..k.min(all.len())]);
            let radius = 2.0 * stream.unit().powi(2);
            tree.within(x, radius, &mut found);
            let inside: Vec<Near> =
                all.into_iter().filter(|n| n.distance_squared <= radius * radius).collect();
            assert_eq!(found, inside);
        }
    }
}

#[test]
fn the_table_leaves_out_the_point_itself() {
    for points in clouds() {
        let table = Neighbours::new(&points).table(7);
        assert_eq!(table.k(), 7.min(points.len().saturating_sub(1)));
        for (i, p) in points.iter().enumerate() {
            let mut all = brute(&points, *p);
            all.truncate(8);
            let others: Vec<u32> =
                all.iter().map(|n| n.index).filter(|&j| j as usize != i).take(table.k()).collect();
            assert_eq!(table.row(i), others);
        }
    }
}

#[test]
fn the_spacing_of_a_random_sampling_is_the_root_of_the_area_of_a_sample() {
    let n = 20_000;
    let points = random_sphere(n, 6);
    let table = Neighbours::new(&points).table(6);
    let found = spacing::spacing(&points, &table);
    let mean = found.iter().sum::<f64>() / n as f64;
    let root = (4.0 * std::f64::consts::PI / n as f64).sqrt();
    assert!((mean / root - 1.0).abs() < 0.03, "{}", mean / root);
    let widths = spacing::widths(&found, &table);
    assert!(widths.iter().zip(&found).all(|(h, s)| 2.0 * s <= *h));
}

#[test]
fn few_points_have_a_spacing_too() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let table = Neighbours::new(&points).table(6);
    let found = spacing::spacing(&points, &table);
    assert_eq!(found[0], spacing::SIXTH);
    assert!(found[1] > found[0]);
}

#[test]
fn equal_points_become_one() {
    let normals = vec![DVec3::X, DVec3::Z, DVec3::Y, -DVec3::Z, DVec3::ZERO, DVec3::X];
    let points = vec![DVec3::ZERO, DVec3::ONE, DVec3::ZERO, DVec3::ONE, DVec3::X, DVec3::X];
    let colors = Some(vec![[1.0; 3], [0.5; 3], [0.0; 3], [0.5; 3], [0.25; 3], [0.75; 3]]);
    let merged = merge_duplicates(Cloud { points, normals: Some(normals), colors, ..Cloud::default() });
    assert_eq!(merged.points, [DVec3::ZERO, DVec3::X, DVec3::ONE]);
    let between = (DVec3::X + DVec3::Y).normalize();
    assert_eq!(merged.normals.unwrap(), [between, DVec3::X, DVec3::ZERO]);
    assert_eq!(merged.colors.unwrap(), [[0.5; 3]; 3]);
    assert_eq!(merged.notes.len(), 2);
}
