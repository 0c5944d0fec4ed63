//! Clouds made for tests, and the scans where they are at hand.
#![allow(dead_code, missing_docs)]

use std::path::{Path, PathBuf};

use glam::DVec3;
use pss::num::hash::Stream;

/// Even points of the unit sphere, their own normals.
pub fn fibonacci_sphere(n: usize) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        let r = (1.0 - z * z).sqrt();
        let (sin, cos) = (golden * i as f64).sin_cos();
        DVec3::new(r * cos, r * sin, z)
    };
    (0..n).map(point).collect()
}

/// Random points of the unit sphere, their own normals.
pub fn random_sphere(n: usize, seed: u64) -> Vec<DVec3> {
    let mut stream = Stream::new(seed);
    (0..n).map(|_| stream.direction()).collect()
}

/// Random points, even over the torus of radii 1 and 0.4 around z, with its normals.
pub fn random_torus(n: usize, seed: u64) -> (Vec<DVec3>, Vec<DVec3>) {
    let mut stream = Stream::new(seed);
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    while points.len() < n {
        let (u, v) = (std::f64::consts::TAU * stream.unit(), std::f64::consts::TAU * stream.unit());
        if (1.0 + 0.4 * v.cos()) < 1.4 * stream.unit() {
            continue;
        }
        let normal = DVec3::new(v.cos() * u.cos(), v.cos() * u.sin(), v.sin());
        points.push(DVec3::new(u.cos(), u.sin(), 0.0) + 0.4 * normal);
        normals.push(normal);
    }
    (points, normals)
}

/// A scan, where the machine has it; says so where it has not.
pub fn scan(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scans").join(name);
    if !path.is_file() {
        println!("skipped: no {}", path.display());
        return None;
    }
    Some(path)
}
