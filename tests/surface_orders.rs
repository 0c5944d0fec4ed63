//! How fast the surface nears the truth as samples grow denser.

mod common;

use common::{Truth, all, chord, surface};
use glam::DVec3;
use pss::num::hash::Stream;
use pss::solid::Scratch;
use pss::solid::point_set::{FieldScratch, Options, PointSet};
use rayon::prelude::*;

/// The golden spiral on the unit sphere.
fn even_sphere(n: usize) -> (Vec<DVec3>, Vec<DVec3>) {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let points: Vec<DVec3> = (0..n)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / n as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
        })
        .collect();
    (points.clone(), points)
}

/// Rings on the torus, spaced alike both ways and shifted by half a step in turn.
fn even_torus(n: usize) -> (Vec<DVec3>, Vec<DVec3>) {
    let tau = std::f64::consts::TAU;
    let spacing = (Truth::Torus.area() / n as f64).sqrt();
    let rings = (tau * 0.4 / spacing).round() as usize;
    let mut out = (Vec::new(), Vec::new());
    for i in 0..rings {
        let v = tau * i as f64 / rings as f64;
        let radius = 1.0 + 0.4 * v.cos();
        let count = (tau * radius / spacing).round() as usize;
        for j in 0..count {
            let (sin, cos) = (tau * (j as f64 + 0.5 * (i % 2) as f64) / count as f64).sin_cos();
            let normal = DVec3::new(v.cos() * cos, v.sin(), v.cos() * sin);
            out.0.push(DVec3::new(cos, 0.0, sin) + 0.4 * normal);
            out.1.push(normal);
        }
    }
    out
}

/// Uniform random samples.
fn random(truth: Truth, n: usize) -> (Vec<DVec3>, Vec<DVec3>) {
    let mut stream = Stream::new(77);
    let mut out = (Vec::new(), Vec::new());
    while out.0.len() < n {
        let (u, v) = (std::f64::consts::TAU * stream.unit(), std::f64::consts::TAU * stream.unit());
        let (p, normal) = if truth == Truth::Sphere {
            let d = stream.direction();
            (d, d)
        } else {
            if 1.0 + 0.4 * v.cos() < 1.4 * stream.unit() {
                continue;
            }
            let normal = DVec3::new(v.cos() * u.cos(), v.sin(), v.cos() * u.sin());
            (DVec3::new(u.cos(), 0.0, u.sin()) + 0.4 * normal, normal)
        };
        out.0.push(p);
        out.1.push(normal);
    }
    out
}

/// One width for all: so many spacings.
fn even_surface(
    truth: Truth,
    (points, normals): &(Vec<DVec3>, Vec<DVec3>),
    factor: f64,
    degree: usize,
) -> PointSet {
    let h = factor * (truth.area() / points.len() as f64).sqrt();
    PointSet::new(
        points,
        normals,
        &vec![h; points.len()],
        &Options { degree, tolerance: 1e-13, ..Options::default() },
    )
}

/// The root mean square distance of crossings of random chords from the truth.
fn error(truth: Truth, set: &PointSet) -> f64 {
    let parts: Vec<(f64, usize)> = (0..3000u64)
        .into_par_iter()
        .map_init(Scratch::default, |scratch, i| {
            let ray = chord(i, DVec3::ZERO, 1.5);
            let hits = all(set, &ray, scratch);
            (hits.iter().map(|c| truth.distance(ray.at(c.t)).powi(2)).sum(), hits.len())
        })
        .collect();
    let (sum, count) = parts.iter().fold((0.0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    (sum / count as f64).sqrt()
}

#[test]
fn the_error_falls_with_the_order_of_the_degree_on_even_samples() {
    for (truth, make) in [(Truth::Sphere, even_sphere as fn(usize) -> _), (Truth::Torus, even_torus)] {
        for (degree, order) in [(2, 4.0), (3, 4.0), (4, 6.0)] {
            // Wide enough that the unevenness of the lattice itself does not show.
            let errors = [10_000, 40_000].map(|n| error(truth, &even_surface(truth, &make(n), 3.0, degree)));
            let seen = (errors[0] / errors[1]).log2();
            println!(
                "{truth:?}, even, degree {degree}: {:.2e} -> {:.2e}, order {seen:.2}",
                errors[0], errors[1]
            );
            assert!((seen - order).abs() <= 0.3, "{truth:?} degree {degree}: order {seen}");
        }
    }
}

#[test]
fn the_error_falls_on_random_samples_too() {
    for truth in [Truth::Sphere, Truth::Torus] {
        for (degree, least) in [(2, 2.9), (3, 3.7), (4, 4.0)] {
            let errors = [10_000, 40_000, 160_000].map(|n| {
                let (points, normals) = random(truth, n);
                error(
                    truth,
                    &surface(&points, &normals, &Options { degree, tolerance: 1e-13, ..Options::default() }),
                )
            });
            // Over both steps: one alone wobbles with the samples.
            let seen = 0.5 * (errors[0] / errors[2]).log2();
            println!(
                "{truth:?}, random, degree {degree}: {:.2e} {:.2e} {:.2e}, order {seen:.2}",
                errors[0], errors[1], errors[2]
            );
            assert!(least <= seen, "{truth:?} degree {degree}: order {seen}");
        }
    }
}

#[test]
fn the_gradient_is_five_times_the_better_normal_at_degree_2() {
    let cloud = even_torus(6181);
    let set = even_surface(Truth::Torus, &cloud, 2.0, 2);
    let mut scratch = FieldScratch::default();
    let (mut gradient, mut polynomial, mut plane) = (0.0, 0.0, 0.0);
    for p in &cloud.0 {
        let f = set.field(*p, &mut scratch).unwrap();
        let truth = Truth::Torus.gradient(*p - f.value * f.gradient).normalize();
        let angle = |n: DVec3| n.normalize().cross(truth).length_squared();
        gradient += angle(f.gradient);
        polynomial += angle(f.fit_normal);
        plane += angle(f.plane_normal);
    }
    let rms = |sum: f64| (sum / cloud.0.len() as f64).sqrt();
    println!(
        "rms angle: plane {:.1e}, polynomial {:.1e}, gradient {:.1e}",
        rms(plane),
        rms(polynomial),
        rms(gradient)
    );
    assert!(5.0 * rms(gradient) <= rms(polynomial));
}
