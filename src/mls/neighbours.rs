//! The blocks of samples that an evaluation may have to go over, with what was promised when they were gathered.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::DVec3;

use super::blocks::{Blocks, Near};
use crate::num::lanes::{LANES, Lanes};

/// Blocks near a point. What is computed from them does not depend on which others are listed.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// World position of the centre.
    center: DVec3,
    /// Every block with a sample whose support reaches the ball of this radius about the centre is here, world length.
    reach: f64,
    /// The outward unit normal that the samples' own are compared with.
    pub(super) outward: DVec3,
    /// The least cosine between that and a sample's normal.
    pub(super) least: f64,
    list: Vec<u32>,
    /// Those that weigh in the evaluation at hand.
    pub(super) active: Vec<u32>,
}

impl Neighbours {
    /// Forgets the blocks. Whoever pushes blocks, in ascending order, promises the `reach`.
    pub fn reset(&mut self, center: DVec3, reach: f64, outward: DVec3) {
        self.center = center;
        self.reach = reach;
        self.outward = outward;
        self.least = -1.0;
        self.list.clear();
    }

    /// Adds a block.
    #[inline(always)]
    pub fn push(&mut self, block: u32) {
        self.list.push(block);
    }

    /// Looks at the normals of what was pushed.
    pub fn settle(&mut self, blocks: &Blocks) {
        let near = Near { all: blocks, list: &self.list };
        self.least = dispatch!(Level::new(), simd => least_in(simd, near, self.outward));
    }

    /// Every block there is.
    pub fn everything(blocks: &Blocks, outward: DVec3) -> Neighbours {
        let mut all = Neighbours::default();
        all.reset(DVec3::ZERO, f64::INFINITY, outward);
        (0..blocks.len() as u32).for_each(|b| all.push(b));
        all.settle(blocks);
        all
    }

    /// Whether every sample whose support holds a world point is here.
    #[inline(always)]
    pub fn reaches(&self, point: DVec3) -> bool {
        (point - self.center).length_squared() <= self.reach * self.reach
    }

    /// Whether every sample whose support reaches a ball (world) is here.
    #[inline(always)]
    pub fn reaches_ball(&self, center: DVec3, radius: f64) -> bool {
        (center - self.center).length() + radius <= self.reach
    }

    /// How many blocks.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    #[inline(always)]
    pub(super) fn listed<'a>(&'a self, blocks: &'a Blocks) -> Near<'a> {
        Near { all: blocks, list: &self.list }
    }

    /// Whether a sample that faces like `outward` lies ahead of a point: within `reach` (world length) of it, at most 45
    /// degrees off the unit vector `ahead`, at least `clear` along it, and with a support (squared widths) that holds it.
    pub fn any_ahead(
        &self,
        blocks: &Blocks,
        from: DVec3,
        ahead: DVec3,
        outward: DVec3,
        [clear, reach]: [f64; 2],
        support: f64,
    ) -> bool {
        let per_unit = blocks.per_unit();
        let (from, clear, reach) = (from * per_unit, clear * per_unit, reach * per_unit);
        let near = self.listed(blocks);
        dispatch!(Level::new(), simd => {
            (0..near.len()).any(|b| {
                let (p, ih2) = near.block(simd, b);
                let x = p.minus(from);
                let (along, square) = (x.dot(ahead), x.length_squared());
                let rho = square * ih2;
                let faces = near.normals(simd, b).dot(outward);
                (0..LANES).any(|i| {
                    0.0 < faces[i]
                        && clear <= along[i]
                        && square[i] <= 2.0 * along[i] * along[i]
                        && square[i] <= reach * reach
                        && rho[i] <= support
                })
            })
        })
    }
}

#[inline(always)]
fn least_in<S: Simd>(simd: S, near: Near, outward: DVec3) -> f64 {
    let mut least = Lanes::splat(simd, 1.0);
    for b in 0..near.len() {
        least = least.min(near.normals(simd, b).dot(outward));
    }
    (0..LANES).map(|i| least[i]).fold(1.0, f64::min)
}
