//! Lowest and highest heights of blocks of cells, each level with blocks twice as wide: a ray looks only into blocks
//! whose heights it passes between.

use glam::DVec2;

use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::heights::Heights;

/// The levels.
#[derive(Clone, Debug)]
pub struct Pyramid {
    /// From single cells up to one block. Rows from low y up.
    levels: Vec<Level>,
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    depth: usize,
    /// Lowest and highest height of each block, as the image has them.
    blocks: Vec<[f32; 2]>,
}

/// Where the cells lie.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// The low corner of the first cell.
    pub low: DVec2,
    /// Extent of a cell.
    pub cell: DVec2,
    /// Height of 1.
    pub tall: f64,
}

impl Pyramid {
    /// Builds all levels.
    pub fn new(heights: &Heights) -> Pyramid {
        let (width, depth) = (heights.width - 1, heights.depth - 1);
        let at = |i: usize, j: usize| heights.values[(depth - j) * heights.width + i];
        let cell = |i: usize, j: usize| {
            around([at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)].map(|h| [h, h]))
        };
        let blocks =
            (0..depth).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| cell(i, j)).collect();
        let mut levels = vec![Level { width, depth, blocks }];
        while let Some(below) = levels.last().filter(|l| 1 < l.width.max(l.depth)) {
            let (width, depth) = (below.width.div_ceil(2), below.depth.div_ceil(2));
            let child = |i: usize, j: usize| {
                below.blocks[j.min(below.depth - 1) * below.width + i.min(below.width - 1)]
            };
            let block = |i: usize, j: usize| {
                around([child(i, j), child(i + 1, j), child(i, j + 1), child(i + 1, j + 1)])
            };
            let all = (0..depth).flat_map(|j| (0..width).map(move |i| (2 * i, 2 * j)));
            let blocks = all.map(|(i, j)| block(i, j)).collect();
            levels.push(Level { width, depth, blocks });
        }
        Pyramid { levels }
    }

    /// Shows every cell where the ray passes between its lowest and highest height, with the t that it spends over
    /// the cell, and a little more: a root on a border must not be lost by a rounding on both sides of it.
    pub fn cells_on(
        &self,
        ray: &Ray,
        at: &Block,
        bounds: &Aabb,
        mut show: impl FnMut(usize, usize, Interval),
    ) {
        let size = bounds.farthest();
        let slack = tolerance::noise(size);
        let mut open = vec![(self.levels.len() - 1, 0usize, 0usize)];
        while let Some((level, i, j)) = open.pop() {
            let Level { width, depth, blocks } = &self.levels[level];
            let [low, high] = blocks[j * width + i].map(|h| at.tall * f64::from(h));
            let wide = (1usize << level) as f64;
            let corner = at.low + at.cell * wide * DVec2::new(i as f64, j as f64);
            let column = Aabb {
                min: corner.extend(low),
                max: (corner + wide * at.cell).min(bounds.max.truncate()).extend(high),
            };
            let range = column.inflated(slack).clip(ray);
            if range.is_empty() {
                continue;
            }
            if level == 0 {
                show(i, j, range);
                continue;
            }
            let below = &self.levels[level - 1];
            debug_assert!(i < *width && j < *depth);
            for (i, j) in [(2 * i, 2 * j), (2 * i + 1, 2 * j), (2 * i, 2 * j + 1), (2 * i + 1, 2 * j + 1)] {
                if i < below.width && j < below.depth {
                    open.push((level - 1, i, j));
                }
            }
        }
    }
}

/// The lowest and the highest of four.
fn around(four: [[f32; 2]; 4]) -> [f32; 2] {
    four.into_iter().fold([f32::INFINITY, 0.0], |[lo, hi], [a, b]| [lo.min(a), hi.max(b)])
}
