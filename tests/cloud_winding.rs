//! The winding number against the plain sum, closed forms and differences.

mod cloud_common;

use cloud_common::{fibonacci_sphere, random_torus};
use glam::DVec3;
use pss::cloud::neighbours::Neighbours;
use pss::cloud::winding::Winding;
use pss::cloud::{areas, spacing};
use pss::num::hash::Stream;

fn oriented(points: &[DVec3], normals: &[DVec3], opening: f64) -> Winding {
    let tree = Neighbours::new(points);
    let table = tree.table(spacing::SPACING_NEIGHBOURS);
    let widths = spacing::widths(&spacing::spacing(points, &table), &table);
    Winding::new(points, normals, &areas(points, normals, &widths, &tree), opening)
}

#[test]
fn it_agrees_with_the_plain_sum() {
    let (points, normals) = random_torus(8000, 3);
    let plain = oriented(&points, &normals, f64::INFINITY);
    let mut stream = Stream::new(5);
    // The bound falls with the fourth power of the opening.
    for (opening, bound) in [(2.0, 1.5e-2), (3.0, 3e-3), (4.0, 1e-3), (8.0, 4e-5)] {
        let fast = oriented(&points, &normals, opening);
        let (mut worst, mut squares) = ([0.0f64; 2], 0.0);
        for _ in 0..400 {
            let x = 3.0 * (DVec3::new(stream.unit(), stream.unit(), stream.unit()) - 0.5);
            let (w, g) = fast.value_and_gradient(x);
            let (w0, g0) = plain.value_and_gradient(x);
            assert_eq!(w.to_bits(), fast.value(x).to_bits());
            squares += (w - w0).powi(2);
            worst = [worst[0].max((w - w0).abs()), worst[1].max((g - g0).length() / (1.0 + g0.length()))];
        }
        let rms = (squares / 400.0f64).sqrt();
        println!("opening {opening}: value {:.1e} (rms {rms:.1e}), gradient {:.1e}", worst[0], worst[1]);
        assert!(worst[0] < bound && worst[1] < 10.0 * bound, "opening {opening}: {worst:?}");
    }
}

#[test]
fn the_first_term_left_out_is_the_third() {
    let mut stream = Stream::new(17);
    let points: Vec<DVec3> = (0..300).map(|_| stream.direction() * stream.unit()).collect();
    let normals: Vec<DVec3> = points.iter().map(|_| stream.direction()).collect();
    let areas = vec![1.0; 300];
    let [fast, plain] = [1.0, f64::INFINITY].map(|opening| Winding::new(&points, &normals, &areas, opening));
    for direction in [DVec3::X, DVec3::ONE.normalize(), DVec3::new(0.3, -0.9, 0.2)] {
        let error = |r: f64| {
            let (x, y) = (fast.value_and_gradient(direction * r), plain.value_and_gradient(direction * r));
            [(x.0 - y.0).abs(), (x.1 - y.1).length()]
        };
        // The term falls as r^-5, its gradient as r^-6, both the faster the nearer.
        for (order, [far, near]) in [5, 6].into_iter().zip([0, 1].map(|k| [error(40.0)[k], error(10.0)[k]])) {
            let ratio = near / far / 4f64.powi(order);
            assert!((0.5..3.0).contains(&ratio), "order {order}: {near:e} / {far:e}, {ratio}");
        }
    }
}

#[test]
fn the_gradient_is_the_derivative() {
    let (points, normals) = random_torus(3000, 9);
    let winding = oriented(&points, &normals, 3.0);
    for x in [DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.0, 0.0, 0.2), DVec3::new(9.0, -8.0, 1.0)] {
        let (_, gradient) = winding.value_and_gradient(x);
        let step = 1e-5;
        for axis in 0..3 {
            let d = DVec3::AXES[axis] * step;
            let slope = (winding.value(x + d) - winding.value(x - d)) / (2.0 * step);
            assert!((slope - gradient[axis]).abs() < 1e-8, "{slope} {gradient}");
        }
    }
}

#[test]
fn a_sphere_is_one_inside_and_zero_outside() {
    let points = fibonacci_sphere(5000);
    let winding = oriented(&points, &points, 2.0);
    let spacing = (4.0 * std::f64::consts::PI / 5000.0f64).sqrt();
    let mut stream = Stream::new(1);
    for _ in 0..2000 {
        let r = stream.unit() * 2.0;
        let w = winding.value(r * stream.direction());
        if r < 1.0 - 2.0 * spacing {
            assert!((w - 1.0).abs() < 0.02, "{r}: {w}");
        } else if 1.0 + 2.0 * spacing < r {
            assert!(w.abs() < 0.02, "{r}: {w}");
        }
    }
}

#[test]
fn one_half_across_a_round_hole_is_the_flat_disc() {
    let n = 40_000;
    let cut = 0.8;
    let points: Vec<DVec3> = fibonacci_sphere(n).into_iter().filter(|p| p.z < cut).collect();
    let winding = oriented(&points, &points, 3.0);
    let radius = (1.0 - cut * cut).sqrt();
    for r in [0.0, 0.3, 0.6, 0.8] {
        let x = |z: f64| DVec3::new(r * radius, 0.0, z);
        let (mut lo, mut hi) = (0.5, 0.99);
        for _ in 0..40 {
            let z = 0.5 * (lo + hi);
            if 0.5 < winding.value(x(z)) { lo = z } else { hi = z }
        }
        // The rim is known to a spacing, 0.018.
        assert!((lo - cut).abs() < 0.018, "at {r}: {lo}");
    }
}

#[test]
fn samples_at_the_place_asked_add_nothing() {
    let winding = Winding::new(&[DVec3::ZERO], &[DVec3::X], &[1.0], 2.0);
    assert_eq!(winding.value(DVec3::ZERO), 0.0);
    assert_eq!(Winding::new(&[], &[], &[], 2.0).value(DVec3::ONE), 0.0);
}
