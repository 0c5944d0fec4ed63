//! F and grad F against finite differences and closed forms.

mod common;

use common::Truth;
use glam::DVec3;
use pss::mls::{
    AnyWay, Blocks, Compact, Evaluator, Facing, Form, Gaussian, Guess, Neighbours, SameWay, Sample, Stray,
    Weight,
};
use pss::num::hash::Stream;

/// All samples, no tree, no cut.
struct Brute(Blocks, Neighbours);

fn brute(points: &[DVec3], normals: &[DVec3], h: impl Fn(DVec3) -> f64) -> Brute {
    let widths: Vec<f64> = points.iter().map(|p| h(*p)).collect();
    let blocks = Blocks::new(points, |i| normals[i], &widths);
    let all = Neighbours::everything(&blocks, DVec3::Z);
    Brute(blocks, all)
}

impl Brute {
    fn sample<W: Weight, A: Facing>(
        &self,
        evaluator: &Evaluator<W, A>,
        at: DVec3,
        guess: &Guess,
    ) -> Result<Sample, Stray> {
        evaluator.sample(&self.0, &mut self.1.clone(), at, guess)
    }
}

fn probes(truth: Truth, count: usize, within: f64) -> Vec<DVec3> {
    let (points, normals) = truth.cloud(40_000);
    let mut stream = Stream::new(7);
    (0..count)
        .map(|_| {
            let i = (stream.unit() * points.len() as f64) as usize;
            points[i] + normals[i] * within * (2.0 * stream.unit() - 1.0)
        })
        .collect()
}

fn check_gradient(weight: impl Weight, facing: impl Facing, degree: usize, form: Form) {
    let (points, normals) = Truth::Torus.cloud(1500);
    let h = 2.0 * (4.0 * 0.4 * std::f64::consts::PI.powi(2) / 1500.0).sqrt();
    // Widths that differ from sample to sample: the derivative must use each sample's own.
    let near = brute(&points, &normals, |p| h * (1.0 + 0.2 * p.x));
    let evaluator = Evaluator { weight, facing, degree, form };
    for p in probes(Truth::Torus, 200, 0.5 * h) {
        let guess = Guess { foot: p, outward: Truth::Torus.gradient(p), width: h };
        let at = |p: DVec3| -> Result<Sample, Stray> { near.sample(&evaluator, p, &guess) };
        let sample = at(p).unwrap();
        let d = 2e-5 * h;
        let difference: DVec3 = DVec3::AXES
            .map(|e| (at(p + d * e).unwrap().value - at(p - d * e).unwrap().value) / (2.0 * d))
            .into();
        let error = (difference - sample.gradient).length();
        assert!(error < 1e-6, "degree {degree} at {p}: {error:e}");
    }
}

#[test]
fn the_gradient_agrees_with_differences_for_every_weight_and_degree() {
    for degree in 0..=4 {
        for form in [Form::Free, Form::Levin] {
            check_gradient(Compact, AnyWay, degree, form);
            check_gradient(Compact, SameWay, degree, form);
            check_gradient(Gaussian::for_tolerance(1e-12), AnyWay, degree, form);
            check_gradient(Gaussian::for_tolerance(1e-12), SameWay, degree, form);
        }
    }
}

/// r - t n - g n projected again, in widths: zero for a projection.
fn defect(form: Form, r: DVec3, h: f64, near: &Brute) -> f64 {
    let evaluator = Evaluator { weight: Compact, facing: AnyWay, degree: 2, form };
    let project = |r: DVec3| {
        let guess = Guess { foot: r, outward: Truth::Torus.gradient(r), width: h };
        let f = near.sample(&evaluator, r, &guess).unwrap();
        r - f.value * f.plane_normal
    };
    let once = project(r);
    (project(once) - once).length() / h
}

#[test]
fn levins_plane_makes_a_projection_and_the_free_one_nearly() {
    let n = 6000;
    let (points, normals) = Truth::Torus.cloud(n);
    let h = 2.0 * (Truth::Torus.area() / n as f64).sqrt();
    let near = brute(&points, &normals, |_| h);
    let worst = |form: Form| {
        probes(Truth::Torus, 120, 0.4 * h).into_iter().map(|r| defect(form, r, h, &near)).fold(0.0, f64::max)
    };
    let (free, levin) = (worst(Form::Free), worst(Form::Levin));
    println!("projected twice: free {free:.1e} h, Levin {levin:.1e} h");
    assert!(levin < 1e-10, "{levin:e}");
    assert!(free < 1e-4 && 100.0 * levin < free, "{free:e}");
}

/// Where samples are so few that the polynomial loses a degree, F goes over smoothly: its gradient agrees with
/// differences, and no step of a walk jumps.
#[test]
fn f_stays_continuous_where_the_degree_falls() {
    let (points, normals) = Truth::Torus.cloud(1500);
    let spacing = (4.0 * 0.4 * std::f64::consts::PI.powi(2) / 1500.0).sqrt();
    for (degree, factor) in [(1, 0.85), (2, 1.13), (3, 1.45), (4, 1.8)] {
        let h = factor * spacing;
        let near = brute(&points, &normals, |_| h);
        let evaluator = Evaluator { weight: Compact, facing: SameWay, degree, form: Form::Free };
        let (mut full, mut fallen) = (0, 0);
        let mut worst: f64 = 0.0;
        for (i, p) in probes(Truth::Torus, 300, 0.3 * h).into_iter().enumerate() {
            let guess = |p: DVec3| Guess { foot: p, outward: Truth::Torus.gradient(p), width: h };
            let at = |p: DVec3| near.sample(&evaluator, p, &guess(p));
            let along = normals[i].any_orthonormal_vector();
            // A walk of a tenth of a width in 200 steps.
            let step = 0.1 * h / 200.0;
            let walk: Vec<Sample> =
                (0..200).filter_map(|k| at(p + along * (f64::from(k) * step)).ok()).collect();
            for pair in walk.windows(2) {
                full += usize::from(pair[0].degree == degree);
                fallen += usize::from(pair[0].degree < degree);
                let mean = 0.5 * (pair[0].gradient + pair[1].gradient).dot(along);
                let jump = (pair[1].value - pair[0].value - mean * step).abs() / h;
                worst = worst.max(jump);
            }
        }
        println!(
            "degree {degree}: {full} full, {fallen} fallen, largest step beside the gradient {worst:.1e} h"
        );
        assert!(100 < full && 100 < fallen, "degree {degree} is not tried");
        // The trapezium's own error: a third derivative of some hundred over h^2 times step^3 / 12.
        assert!(worst < 1e-6, "degree {degree}: {worst:e}");
    }
}
