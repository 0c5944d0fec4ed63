//! The samples that an evaluation sums over, coordinate by coordinate, in units of one local width about one
//! local origin.

use glam::DVec3;

use crate::num::lanes::{F4, LANES, V4};

/// Samples near a point. Padded to whole lanes with samples too far to weigh.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// World position of the local origin.
    pub origin: DVec3,
    /// World length of the local unit.
    pub unit: f64,
    /// Every sample is here whose support reaches the ball of this radius about the origin, local units.
    pub reach: f64,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    nx: Vec<f64>,
    ny: Vec<f64>,
    nz: Vec<f64>,
    inverse_h2: Vec<f64>,
    h: Vec<f64>,
}

/// Where padding lies: far beyond any support, near enough for its square to stay finite.
const NOWHERE: f64 = 1e6;

impl Neighbours {
    /// Forgets the samples and sets the local frame. Whoever pushes the samples promises the `reach`.
    pub fn reset(&mut self, origin: DVec3, unit: f64, reach: f64) {
        self.origin = origin;
        self.unit = unit;
        self.reach = reach;
        for v in [
            &mut self.x,
            &mut self.y,
            &mut self.z,
            &mut self.nx,
            &mut self.ny,
            &mut self.nz,
            &mut self.inverse_h2,
            &mut self.h,
        ] {
            v.clear();
        }
    }

    /// Adds a sample: world position, outward unit normal, width h (world length).
    #[inline(always)]
    pub fn push(&mut self, point: DVec3, normal: DVec3, width: f64) {
        let p = (point - self.origin) / self.unit;
        let k = self.unit / width;
        self.x.push(p.x);
        self.y.push(p.y);
        self.z.push(p.z);
        self.nx.push(normal.x);
        self.ny.push(normal.y);
        self.nz.push(normal.z);
        self.inverse_h2.push(k * k);
        self.h.push(width / self.unit);
    }

    /// Pads to whole lanes; to be called once after the last [`Neighbours::push`].
    pub fn finish(&mut self) {
        while !self.x.len().is_multiple_of(LANES) {
            let at = self.origin + DVec3::splat(NOWHERE * self.unit);
            self.push(at, DVec3::ZERO, self.unit);
        }
    }

    /// How many, padding included.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// The blocks of four: positions (local), outward normals, and 1/h^2 (local units).
    #[inline(always)]
    pub fn blocks(&self) -> impl Iterator<Item = (V4, V4, F4)> + '_ {
        let n = self.x.len() / LANES * LANES;
        let (x, y, z) = (&self.x[..n], &self.y[..n], &self.z[..n]);
        let (nx, ny, nz, ih) = (&self.nx[..n], &self.ny[..n], &self.nz[..n], &self.inverse_h2[..n]);
        (0..n).step_by(LANES).map(move |i| {
            let at = |v: &[f64]| F4([v[i], v[i + 1], v[i + 2], v[i + 3]]);
            (V4 { x: at(x), y: at(y), z: at(z) }, V4 { x: at(nx), y: at(ny), z: at(nz) }, at(ih))
        })
    }

    /// Copies the samples whose support reaches the ball of this radius about a local point, in their order.
    /// The frame stays, so `out.reach` has no meaning there and is zero.
    pub fn near(&self, center: DVec3, radius: f64, support: f64, out: &mut Neighbours) {
        out.reset(self.origin, self.unit, 0.0);
        for i in 0..self.x.len() {
            let d = DVec3::new(self.x[i], self.y[i], self.z[i]) - center;
            // Within reach where |d| < radius + sqrt(support) h_i.
            let reach = radius + support.sqrt() * self.h[i];
            if d.length_squared() < reach * reach {
                out.x.push(self.x[i]);
                out.y.push(self.y[i]);
                out.z.push(self.z[i]);
                out.nx.push(self.nx[i]);
                out.ny.push(self.ny[i]);
                out.nz.push(self.nz[i]);
                out.inverse_h2.push(self.inverse_h2[i]);
                out.h.push(self.h[i]);
            }
        }
        out.finish();
    }
}
