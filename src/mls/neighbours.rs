//! The samples that an evaluation sums over, in blocks of lanes, in units of one local width about one local origin.

use fearless_simd::{Simd, prelude::*};
use glam::DVec3;

use crate::num::lanes::{LANES, Lanes, Lanes3};

/// Samples near a point. The last block is padded with samples too far to weigh.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// World position of the local origin.
    pub origin: DVec3,
    /// World length of the local unit.
    pub unit: f64,
    /// Every sample is here whose support reaches the ball of this radius about the origin, local units.
    pub reach: f64,
    /// The outward unit normal that the samples' own are compared with.
    pub outward: DVec3,
    /// The least cosine between that and a sample's normal.
    pub least: f64,
    per_unit: f64,
    blocks: Vec<Block>,
    count: usize,
}

/// So many samples side by side.
#[derive(Clone, Copy, Debug)]
struct Block {
    x: [f64; LANES],
    y: [f64; LANES],
    z: [f64; LANES],
    inverse_h2: [f64; LANES],
    nx: [f64; LANES],
    ny: [f64; LANES],
    nz: [f64; LANES],
}

/// Where padding lies: far beyond any support, near enough for its square to stay finite.
const NOWHERE: f64 = 1e6;

/// A block of padding.
const PADDING: Block = Block {
    x: [NOWHERE; LANES],
    y: [NOWHERE; LANES],
    z: [NOWHERE; LANES],
    inverse_h2: [1.0; LANES],
    nx: [0.0; LANES],
    ny: [0.0; LANES],
    nz: [0.0; LANES],
};

impl Neighbours {
    /// Forgets the samples and sets the local frame. Whoever pushes the samples promises the `reach`.
    pub fn reset(&mut self, origin: DVec3, unit: f64, reach: f64, outward: DVec3) {
        self.outward = outward;
        self.least = 1.0;
        self.origin = origin;
        self.unit = unit;
        self.per_unit = 1.0 / unit;
        self.reach = reach;
        self.blocks.clear();
        self.count = 0;
    }

    /// Adds a sample: world position, outward unit normal, and the inverse of its width (world length).
    #[inline(always)]
    pub fn push(&mut self, point: DVec3, normal: DVec3, inverse_width: f64) {
        let lane = self.count % LANES;
        if lane == 0 {
            self.blocks.push(PADDING);
        }
        self.count += 1;
        let p = (point - self.origin) * self.per_unit;
        let k = self.unit * inverse_width;
        self.least = self.least.min(normal.dot(self.outward));
        if let Some(block) = self.blocks.last_mut() {
            block.x[lane] = p.x;
            block.y[lane] = p.y;
            block.z[lane] = p.z;
            block.inverse_h2[lane] = k * k;
            block.nx[lane] = normal.x;
            block.ny[lane] = normal.y;
            block.nz[lane] = normal.z;
        }
    }

    /// Whether a sample that faces like `outward` lies ahead of a point: within `reach` (world length) of it, at most 45
    /// degrees off the unit vector `ahead`, and at least `clear` along it.
    pub fn any_ahead(&self, from: DVec3, ahead: DVec3, outward: DVec3, clear: f64, reach: f64) -> bool {
        let from = (from - self.origin) * self.per_unit;
        let (clear, reach) = (clear * self.per_unit, reach * self.per_unit);
        self.blocks.iter().any(|b| {
            (0..LANES).any(|i| {
                let x = DVec3::new(b.x[i], b.y[i], b.z[i]) - from;
                let along = x.dot(ahead);
                let square = x.length_squared();
                let faces = 0.0 < outward.dot(DVec3::new(b.nx[i], b.ny[i], b.nz[i]));
                faces && clear <= along && square <= 2.0 * along * along && square <= reach * reach
            })
        })
    }

    /// How many samples.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How many blocks.
    #[inline(always)]
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// A block: positions (local), and 1/h^2 (local units).
    #[inline(always)]
    pub fn block<S: Simd>(&self, simd: S, block: usize) -> (Lanes3<S>, Lanes<S>) {
        let b = &self.blocks[block];
        let at = |v: &[f64; LANES]| Lanes::from_slice(simd, v);
        (Lanes3 { x: at(&b.x), y: at(&b.y), z: at(&b.z) }, at(&b.inverse_h2))
    }

    /// Outward unit normals of a block.
    #[inline(always)]
    pub fn normals<S: Simd>(&self, simd: S, block: usize) -> Lanes3<S> {
        let b = &self.blocks[block];
        let at = |v: &[f64; LANES]| Lanes::from_slice(simd, v);
        Lanes3 { x: at(&b.nx), y: at(&b.ny), z: at(&b.nz) }
    }
}
