//! Clouds with known truth, shared by the tests: the R2 sequence of the peers' measurements, so that figures can
//! be compared.
#![allow(dead_code)]

use glam::DVec3;

/// Shapes whose surface is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// Radius 1.
    Sphere,
    /// Radii 1 and 0.4 about the y axis.
    Torus,
    /// |p| = r(p / |p|), star-shaped.
    Blob,
}

impl Truth {
    pub const ALL: [Truth; 3] = [Truth::Sphere, Truth::Torus, Truth::Blob];

    fn blob_radius(d: DVec3) -> f64 {
        1.0 + 0.12 * (3.0 * d.x + 1.0).sin() * (4.0 * d.y).sin() + 0.10 * (5.0 * d.z + 2.0 * d.x).cos()
    }

    /// Zero on the surface, positive outside; a distance for sphere and torus.
    pub fn implicit(self, p: DVec3) -> f64 {
        match self {
            Truth::Sphere => p.length() - 1.0,
            Truth::Torus => (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.4,
            Truth::Blob => p.length() - Truth::blob_radius(p / p.length()),
        }
    }

    pub fn gradient(self, p: DVec3) -> DVec3 {
        let h = 1e-6;
        DVec3::AXES.map(|e| (self.implicit(p + h * e) - self.implicit(p - h * e)) / (2.0 * h)).into()
    }

    /// Distance of a point near the surface from it: to first order for the blob.
    pub fn distance(self, p: DVec3) -> f64 {
        let scale = if self == Truth::Blob { self.gradient(p).length() } else { 1.0 };
        self.implicit(p).abs() / scale
    }

    /// The diagonal of the bounds.
    pub fn diagonal(self) -> f64 {
        match self {
            Truth::Sphere => 12f64.sqrt(),
            Truth::Torus => (2.0 * 2.8f64.powi(2) + 0.8f64.powi(2)).sqrt(),
            Truth::Blob => {
                let (p, _) = self.cloud(20_000);
                pss::geom::Aabb::of_points(p).diagonal()
            }
        }
    }

    /// `n` samples with exact outward normals.
    pub fn cloud(self, n: usize) -> (Vec<DVec3>, Vec<DVec3>) {
        const G: f64 = 1.324_717_957_244_746;
        let tau = std::f64::consts::TAU;
        (1..=n)
            .map(|k| {
                let u = (0.5 + k as f64 / G).fract();
                let (sin, cos) = (tau * (0.5 + k as f64 / (G * G)).fract()).sin_cos();
                if self == Truth::Torus {
                    let mut w = tau * u;
                    for _ in 0..40 {
                        w -= (w + 0.4 * w.sin() - tau * u) / (1.0 + 0.4 * w.cos());
                    }
                    let c = 1.0 + 0.4 * w.cos();
                    let p = DVec3::new(c * cos, 0.4 * w.sin(), c * sin);
                    return (p, DVec3::new(w.cos() * cos, w.sin(), w.cos() * sin));
                }
                let z = 1.0 - 2.0 * u;
                let s = (1.0 - z * z).sqrt();
                let d = DVec3::new(s * cos, s * sin, z);
                match self {
                    Truth::Sphere => (d, d),
                    _ => {
                        let p = d * Truth::blob_radius(d);
                        (p, self.gradient(p).normalize())
                    }
                }
            })
            .unzip()
    }
}

/// A surface through samples, with the automatic widths.
pub fn surface(
    points: &[DVec3],
    normals: &[DVec3],
    options: &pss::solid::point_set::Options,
) -> pss::solid::point_set::PointSet {
    use pss::cloud::{neighbours::Neighbours, spacing};
    let table = Neighbours::new(points).table(6);
    let spacing = spacing::spacing(points, &table);
    let widths = spacing::widths(&spacing, &table);
    pss::solid::point_set::PointSet::new(points, normals, &widths, options)
}

/// The `i`-th random chord of a sphere.
pub fn chord(i: u64, center: DVec3, radius: f64) -> pss::geom::Ray {
    pss::geom::Ray::chord(&mut pss::num::hash::Stream::new(i ^ 0x5eed), center, radius)
}

/// All crossings of a line with any solid.
pub fn all_of(
    solid: &dyn pss::solid::Solid,
    ray: &pss::geom::Ray,
    scratch: &mut pss::solid::Scratch,
) -> Vec<pss::solid::Crossing> {
    let mut out = Vec::new();
    solid.crossings(ray, pss::geom::Interval::ALL, scratch, &mut out);
    out
}

/// All crossings of a line, asked for until the answers reach its end.
pub fn all(
    set: &pss::solid::point_set::PointSet,
    ray: &pss::geom::Ray,
    scratch: &mut pss::solid::Scratch,
) -> Vec<pss::solid::Crossing> {
    use pss::{geom::Interval, solid::Solid};
    let mut out = Vec::new();
    let mut lo = f64::NEG_INFINITY;
    while lo < f64::INFINITY {
        lo = set.crossings(ray, Interval::new(lo, f64::INFINITY), scratch, &mut out).range.hi;
    }
    out
}
