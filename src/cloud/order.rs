//! The order of samples in memory: along Morton's curve, so that neighbours in space are near in memory.

use glam::DVec3;
use rayon::prelude::*;

use super::Cloud;
use crate::geom::Aabb;

/// Bits for each axis: three of them fill a 64-bit key.
const BITS: u32 = 21;

/// The points in Morton order (Morton 1966) within the cube around them: keys and indices, those of one cell by index.
pub fn morton(points: &[DVec3]) -> Vec<(u64, u32)> {
    let bounds = Aabb::of_points(points.iter().copied());
    let side = bounds.size().max_element();
    let cells = f64::from((1u32 << BITS) - 1);
    let key = |p: DVec3| {
        let cell = ((p - bounds.min) / side).clamp(DVec3::ZERO, DVec3::ONE) * cells;
        spread(cell.x as u64) | spread(cell.y as u64) << 1 | spread(cell.z as u64) << 2
    };
    let mut order: Vec<(u64, u32)> = points.iter().zip(0u32..).map(|(p, i)| (key(*p), i)).collect();
    order.par_sort_unstable();
    order
}

/// The points of the given indices, in that order.
pub fn select(cloud: Cloud, order: &[u32]) -> Cloud {
    fn pick<T: Copy>(from: &[T], order: &[u32]) -> Vec<T> {
        order.iter().map(|&i| from[i as usize]).collect()
    }
    Cloud {
        points: pick(&cloud.points, order),
        normals: cloud.normals.map(|n| pick(&n, order)),
        colors: cloud.colors.map(|c| pick(&c, order)),
        dropped: cloud.dropped,
        notes: cloud.notes,
    }
}

/// The low 21 bits of `x`, two zeros between each.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
