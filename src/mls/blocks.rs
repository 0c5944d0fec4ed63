//! The samples as sums go over them: in blocks of lanes, in the order of storage. A sample has its lane for good, and one
//! that does not weigh adds an exact zero, so a sum is the same to the last bit whichever other blocks it goes over.

use fearless_simd::{Simd, prelude::*};
use glam::DVec3;

use crate::num::lanes::{LANES, Lanes, Lanes3};
use crate::num::median::median;

/// Samples in blocks. Positions are kept in a unit that is a power of two near the median width: converted without
/// rounding, and far from overflow at any scale.
#[derive(Clone, Debug, Default)]
pub struct Blocks {
    blocks: Vec<Block>,
    unit: f64,
    per_unit: f64,
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

/// Padding lies so many units beside the last sample: where nobody asks, yet near enough for powers to stay finite.
const ASIDE: f64 = 1e6;
/// And were it asked, its width is so many units.
const THIN: f64 = 1e-6;

impl Blocks {
    /// Positions and widths are world lengths, normals outward and of unit length; one of each a sample.
    pub fn new(points: &[DVec3], normal_of: impl Fn(usize) -> DVec3, widths: &[f64]) -> Blocks {
        let unit = power_of_two(median(widths.to_vec()));
        let per_unit = 1.0 / unit;
        let count = points.len();
        let block = |b: usize| {
            let lane = |i: usize| (LANES * b + i).min(count - 1);
            let there = |i: usize| LANES * b + i < count;
            let axis = |axis: usize| {
                let at = |i: usize| points[lane(i)][axis] * per_unit;
                std::array::from_fn(|i| if there(i) { at(i) } else { at(i) + ASIDE })
            };
            // Padding looks the last sample's way, so that it does not disturb the range of directions.
            let normal = |axis: usize| std::array::from_fn(|i| normal_of(lane(i))[axis]);
            let inverse = |i: usize| {
                let k = if there(i) { unit / widths[lane(i)] } else { 1.0 / THIN };
                k * k
            };
            Block {
                x: axis(0),
                y: axis(1),
                z: axis(2),
                inverse_h2: std::array::from_fn(inverse),
                nx: normal(0),
                ny: normal(1),
                nz: normal(2),
            }
        };
        Blocks { blocks: (0..count.div_ceil(LANES)).map(block).collect(), unit, per_unit }
    }

    /// World length of the unit.
    #[inline(always)]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// A world position or length in units.
    #[inline(always)]
    pub fn per_unit(&self) -> f64 {
        self.per_unit
    }

    /// The normal of a sample.
    #[inline]
    pub fn normal(&self, sample: usize) -> DVec3 {
        let (block, lane) = (&self.blocks[sample / LANES], sample % LANES);
        DVec3::new(block.nx[lane], block.ny[lane], block.nz[lane])
    }

    /// How many blocks.
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }
}

/// Some of the blocks, in ascending order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near<'a> {
    pub all: &'a Blocks,
    pub list: &'a [u32],
}

impl Near<'_> {
    /// How many.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Positions (units), and 1/h^2 (units).
    #[inline(always)]
    pub fn block<S: Simd>(&self, simd: S, i: usize) -> (Lanes3<S>, Lanes<S>) {
        let b = &self.all.blocks[self.list[i] as usize];
        let at = |v: &[f64; LANES]| Lanes::from_slice(simd, v);
        (Lanes3 { x: at(&b.x), y: at(&b.y), z: at(&b.z) }, at(&b.inverse_h2))
    }

    /// Outward unit normals.
    #[inline(always)]
    pub fn normals<S: Simd>(&self, simd: S, i: usize) -> Lanes3<S> {
        let b = &self.all.blocks[self.list[i] as usize];
        let at = |v: &[f64; LANES]| Lanes::from_slice(simd, v);
        Lanes3 { x: at(&b.nx), y: at(&b.ny), z: at(&b.nz) }
    }
}

/// The largest power of two that is not above a number; one where there is none.
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    if power.is_normal() { power } else { 1.0 }
}
