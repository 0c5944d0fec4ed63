//! Scans as operands: clouds of known solids, written to a folder or sampled by a scene.

#![allow(dead_code)]

use std::fmt::Write;

use glam::DVec3;
use pss::csg::{Scratch, Span};
use pss::geom::Ray;
use pss::prepare::Prepared;

use crate::common::Truth;
use crate::csg_support::scene::{prepared_in, spans};

/// A folder with a cloud `a.ply` of double precision, with normals.
pub fn folder(points: &[DVec3], normals: &[DVec3]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let columns: String =
        ["x", "y", "z", "nx", "ny", "nz"].map(|c| format!("property double {c}\n")).concat();
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n{columns}end_header\n", points.len());
    for (p, n) in points.iter().zip(normals) {
        writeln!(text, "{:?} {:?} {:?} {:?} {:?} {:?}", p.x, p.y, p.z, n.x, n.y, n.z).unwrap();
    }
    std::fs::write(folder.path().join("a.ply"), text).unwrap();
    folder
}

/// A unit ball's samples where a condition holds.
pub fn ball_where(n: usize, keep: impl Fn(DVec3) -> bool) -> (Vec<DVec3>, Vec<DVec3>) {
    let (points, normals) = Truth::Sphere.cloud(n);
    points.into_iter().zip(normals).filter(|(p, _)| keep(*p)).unzip()
}

pub fn open_hemisphere() -> tempfile::TempDir {
    let (points, normals) = ball_where(10_000, |p| 0.0 < p.z);
    folder(&points, &normals)
}

pub fn prepared(text: &str) -> Prepared {
    prepared_in(text, env!("CARGO_MANIFEST_DIR").as_ref())
}

pub fn cast(scene: &Prepared, ray: &Ray) -> Vec<Span> {
    spans(&scene.shot, ray, &mut Scratch::default())
}

pub fn ends(spans: &[Span]) -> Vec<f64> {
    spans.iter().flat_map(|s| [s.interval().lo, s.interval().hi]).collect()
}

pub fn down(x: f64, y: f64) -> Ray {
    Ray::new(DVec3::new(x, y, 5.0), -DVec3::Z)
}
