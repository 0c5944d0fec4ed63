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
    /// All points [`SLAB`] away from a disc of radius 1: two parallel faces, three widths of 10,000 samples apart,
    /// with a round rim.
    Slab,
    /// The same with [`PLATE`], three widths of 2,000 samples.
    Plate,
}

/// Half the thickness of the slab.
pub const SLAB: f64 = 0.105;
/// Half the thickness of the plate.
pub const PLATE: f64 = 0.25;

impl Truth {
    pub const ALL: [Truth; 3] = [Truth::Sphere, Truth::Torus, Truth::Blob];
    pub const CLOSED: [Truth; 4] = [Truth::Sphere, Truth::Torus, Truth::Slab, Truth::Blob];

    /// Of the surface; the blob's to a percent.
    pub fn area(self) -> f64 {
        use std::f64::consts::PI;
        match self {
            Truth::Sphere => 4.0 * PI,
            Truth::Torus => 1.6 * PI * PI,
            Truth::Blob => 14.1,
            Truth::Slab | Truth::Plate => {
                let a = self.half();
                2.0 * PI + 2.0 * PI * PI * a + 4.0 * PI * a * a
            }
        }
    }

    fn blob_radius(d: DVec3) -> f64 {
        1.0 + 0.12 * (3.0 * d.x + 1.0).sin() * (4.0 * d.y).sin() + 0.10 * (5.0 * d.z + 2.0 * d.x).cos()
    }

    /// The place at a share `u` of the area, from the middle of the lower face over the rim to that of the upper.
    fn slab_sample(self, u: f64, (cos, sin): (f64, f64)) -> (DVec3, DVec3) {
        use std::f64::consts::PI;
        let area = u * self.area();
        let top = self.area() - PI;
        let (radius, normal) = if area < PI {
            ((area / PI).sqrt(), [0.0, -1.0])
        } else if top < area {
            (((self.area() - area) / PI).sqrt(), [0.0, 1.0])
        } else {
            // The rim's area up to latitude w is 2 pi a (w + pi / 2 + a (sin w + 1)) for minor radius a.
            let part = (area - PI) / (2.0 * PI * self.half());
            let mut w = 0.0;
            for _ in 0..60 {
                w -= (w + 0.5 * PI + self.half() * (f64::sin(w) + 1.0) - part)
                    / (1.0 + self.half() * f64::cos(w));
            }
            (1.0, [w.cos(), w.sin()])
        };
        let n = DVec3::new(normal[0] * cos, normal[0] * sin, normal[1]);
        (DVec3::new(radius * cos, radius * sin, 0.0) + self.half() * n, n)
    }

    /// Half the thickness of a slab.
    fn half(self) -> f64 {
        if self == Truth::Plate { PLATE } else { SLAB }
    }

    /// Zero on the surface, positive outside; a distance for sphere and torus.
    pub fn implicit(self, p: DVec3) -> f64 {
        match self {
            Truth::Sphere => p.length() - 1.0,
            Truth::Torus => (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.4,
            Truth::Blob => p.length() - Truth::blob_radius(p / p.length()),
            Truth::Slab | Truth::Plate => (p.x.hypot(p.y) - 1.0).max(0.0).hypot(p.z) - self.half(),
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
            Truth::Slab | Truth::Plate => {
                let a = self.half();
                ((2.0 + 2.0 * a).powi(2) * 2.0 + (2.0 * a).powi(2)).sqrt()
            }
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
                if matches!(self, Truth::Slab | Truth::Plate) {
                    return self.slab_sample(u, (cos, sin));
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

/// So many rays each way of the eye of the peers' measurements, of unit direction, row by row from the top left.
pub fn rays_of_eye(side: usize) -> Vec<pss::geom::Ray> {
    let eye = DVec3::new(2.2, 1.8, 2.8);
    let ahead = -eye.normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let up = right.cross(ahead);
    let half = 18f64.to_radians().tan();
    let at = |i: usize| (2.0 * (i as f64 + 0.5) / side as f64 - 1.0) * half;
    let dir = |k: usize| (ahead + at(k % side) * right - at(k / side) * up).normalize();
    (0..side * side).map(|k| pss::geom::Ray::new(eye, dir(k))).collect()
}

/// Where a function first falls below zero on the way from `from` to `to`, by so many steps and halving; what dips between
/// two steps is passed over.
pub fn first_below(f: impl Fn(f64) -> f64, from: f64, to: f64, steps: usize) -> Option<f64> {
    let at = |i: usize| from + (to - from) * i as f64 / steps as f64;
    let i = (0..steps).find(|&i| f(at(i + 1)) < 0.0)?;
    let (mut a, mut b) = (at(i), at(i + 1));
    for _ in 0..60 {
        let t = 0.5 * (a + b);
        if f(t) < 0.0 { b = t } else { a = t }
    }
    Some(b)
}

/// The automatic widths of samples, times a factor.
pub fn widths(points: &[DVec3], smoothing: f64) -> Vec<f64> {
    use pss::cloud::{neighbours::Neighbours, spacing};
    let table = Neighbours::new(points).table(6);
    let spacing = spacing::spacing(points, &table);
    spacing::widths(&spacing, &table).into_iter().map(|h| smoothing * h).collect()
}

/// A surface through samples, with the automatic widths.
pub fn surface(
    points: &[DVec3],
    normals: &[DVec3],
    options: &pss::solid::point_set::Options,
) -> pss::solid::point_set::PointSet {
    pss::solid::point_set::PointSet::new(points, normals, &widths(points, 1.0), options)
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
