//! A binary hierarchy over the samples that answers two questions: which trust spheres does a line meet, and which
//! samples weigh near a point. The samples are kept in the order of its leaves, so neighbours lie side by side.

use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;

use crate::geom::halves::{Halves, Halving};
use crate::geom::{Aabb, Interval, Ray};
use crate::mls::{Blocks, Neighbours};
use crate::num::lanes::LANES;

/// Samples in the order of the hierarchy.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    /// Positions.
    pub points: Vec<DVec3>,
    /// Widths h_i, which are also the radii of the trust spheres.
    pub widths: Vec<f64>,
    blocks: Blocks,
    /// For each sample here, its index in the lists that [`Hierarchy::new`] was given.
    pub original: Vec<u32>,
    nodes: Halves<Cluster>,
}

/// What holds some samples.
#[derive(Clone, Copy, Debug)]
struct Cluster {
    /// Around the positions.
    bounds: Aabb,
    /// The largest width.
    widest: f64,
}

/// Samples are known by their index, and halved across the longest side of their box.
struct Samples<'a> {
    points: &'a [DVec3],
    widths: &'a [f64],
}

impl Halving<u32> for Samples<'_> {
    type Bound = Cluster;

    fn bound(&self, samples: &[u32]) -> Cluster {
        let bounds = Aabb::of_points(samples.iter().map(|i| self.points[*i as usize]));
        let widest = samples.iter().map(|i| self.widths[*i as usize]).fold(0.0, f64::max);
        Cluster { bounds, widest }
    }

    fn axis(&self, _: &[u32], cluster: &Cluster) -> usize {
        cluster.bounds.size().max_position()
    }

    fn order(&self, axis: usize, a: &u32, b: &u32) -> Ordering {
        let (pa, pb) = (self.points[*a as usize], self.points[*b as usize]);
        pa[axis].total_cmp(&pb[axis]).then(a.cmp(b))
    }

    fn settle(&self, samples: &mut [u32]) {
        samples.sort_unstable();
    }
}

/// A leaf is a cell, one block of lanes; two, four, ... up to 2^(this less one) cells side by side are nodes too.
pub(super) const LEVELS: usize = 3;

/// A line as boxes ask it.
struct Slabs {
    origin: DVec3,
    inverse: DVec3,
}

impl Slabs {
    fn new(line: &Ray) -> Slabs {
        // A line along a slab lies in it or passes it by a finite time that is later than any.
        let inverse = |x: f64| if x == 0.0 { f64::MAX.sqrt() } else { 1.0 / x };
        Slabs { origin: line.origin, inverse: DVec3::from_array(line.dir.to_array().map(inverse)) }
    }

    /// The part in a box grown by some length: everything in it, perhaps a rounding more or less.
    #[inline(always)]
    fn clip(&self, bounds: &Aabb, grown: f64) -> Interval {
        let a = (bounds.min - grown - self.origin) * self.inverse;
        let b = (bounds.max + grown - self.origin) * self.inverse;
        Interval::new(a.min(b).max_element(), a.max(b).min_element())
    }
}

/// The part of a line near a cell: within the largest width of the box of its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellOn {
    /// Arc length range.
    pub range: Interval,
    /// Which leaf.
    pub cell: u32,
}

/// The part of a line inside one trust sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Arc length range.
    pub range: Interval,
    /// Which sphere.
    pub sample: u32,
    /// In a list in order, where it and all before it have ended.
    pub ended: f64,
}

/// Puts trust spheres in the order in which a line meets them.
pub(super) fn in_order(spheres: &mut [Reach]) {
    spheres.sort_unstable_by(|a, b| a.range.lo.total_cmp(&b.range.lo).then(a.sample.cmp(&b.sample)));
    let mut ended = f64::NEG_INFINITY;
    for reach in spheres {
        ended = ended.max(reach.range.hi);
        reach.ended = ended;
    }
}

impl Hierarchy {
    /// Builds it; `O(n log n)`, the same for any number of threads.
    pub fn new(points: &[DVec3], normals: &[DVec3], widths: &[f64]) -> Hierarchy {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let nodes = Halves::full(&mut order, LANES, LANES << (LEVELS - 1), &Samples { points, widths });
        let pick = |i: &u32| *i as usize;
        let points: Vec<DVec3> = order.iter().map(|i| points[pick(i)]).collect();
        let widths: Vec<f64> = order.iter().map(|i| widths[pick(i)]).collect();
        let blocks = Blocks::new(&points, |i| normals[pick(&order[i])], &widths);
        Hierarchy { points, widths, blocks, original: order, nodes }
    }

    /// The outward unit normal of a sample.
    #[inline]
    pub fn normal(&self, sample: usize) -> DVec3 {
        self.blocks.normal(sample)
    }

    /// All of them.
    pub fn normals(&self) -> Vec<DVec3> {
        (0..self.points.len()).map(|i| self.normal(i)).collect()
    }

    /// A box around all trust spheres.
    pub fn reach(&self) -> Aabb {
        self.nodes.root().map_or(Aabb::EMPTY, |root| root.bounds.inflated(root.widest))
    }

    /// The cells, one a leaf, that a line of unit direction comes near, in the order of storage. What is in a trust sphere of
    /// one of its samples is near a cell.
    pub fn cells_on(&self, line: &Ray, out: &mut Vec<CellOn>) {
        out.clear();
        let (met, slabs) = (Cell::new(Interval::EMPTY), Slabs::new(line));
        self.nodes.visit_leaves(
            |node| {
                let range = slabs.clip(&node.bounds, node.widest);
                met.set(range);
                range.lo <= range.hi
            },
            |leaf| out.push(CellOn { range: met.get(), cell: leaf.start / LANES as u32 }),
        );
    }

    /// Appends the trust spheres of a cell that a line of unit direction meets, with the part inside.
    pub fn spheres_of(&self, cell: usize, line: &Ray, out: &mut Vec<Reach>) {
        for i in self.of_cell(cell) {
            let (p, h) = (self.points[i], self.widths[i]);
            let middle = (p - line.origin).dot(line.dir);
            let off = (p - line.at(middle)).length_squared();
            if off < h * h {
                let half = (h * h - off).sqrt();
                let range = Interval::new(middle - half, middle + half);
                out.push(Reach { range, sample: i as u32, ended: range.hi });
            }
        }
    }

    /// The trust spheres of some cells that a line of unit direction meets, in order.
    pub fn spheres_on(&self, cells: &[CellOn], line: &Ray, out: &mut Vec<Reach>) {
        out.clear();
        cells.iter().for_each(|c| self.spheres_of(c.cell as usize, line, out));
        in_order(out);
    }

    /// The samples of a cell.
    pub fn of_cell(&self, cell: usize) -> Range<usize> {
        self.of_cells(0, cell)
    }

    /// The samples of `2^level` cells that are a node of the hierarchy; `cells` counts such.
    pub fn of_cells(&self, level: usize, cells: usize) -> Range<usize> {
        let each = LANES << level;
        each * cells..(each * (cells + 1)).min(self.points.len())
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.points.len().div_ceil(LANES)
    }

    /// The sample whose trust sphere holds a point and to which the point is nearest in that sample's own widths
    /// (ties by index).
    pub fn nearest(&self, at: DVec3) -> Option<usize> {
        self.nearest_within(at, 1.0)
    }

    /// The sample to which a point is nearest in that sample's own widths, however far.
    pub fn nearest_of_all(&self, at: DVec3) -> Option<usize> {
        self.nearest_within(at, f64::INFINITY)
    }

    /// `limit` is a squared distance in squared widths.
    fn nearest_within(&self, at: DVec3, limit: f64) -> Option<usize> {
        let best = Cell::new((limit, usize::MAX));
        self.nodes.visit(
            |node| node.bounds.distance_squared(at) <= best.get().0 * node.widest * node.widest,
            |i| {
                let h = self.widths[i as usize];
                let candidate = ((self.points[i as usize] - at).length_squared() / (h * h), i as usize);
                if candidate < best.get() {
                    best.set(candidate);
                }
            },
        );
        let (_, nearest) = best.get();
        (nearest != usize::MAX).then_some(nearest)
    }

    /// The samples in the blocks that evaluations go over: one a leaf.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// Gathers every block with a sample whose support (`support` is that of the weight, in squared widths) reaches the ball
    /// of this radius (world length) about a point.
    pub fn gather(&self, center: DVec3, reach: f64, support: f64, outward: DVec3, out: &mut Neighbours) {
        out.reset(center, reach, outward);
        let k = support.sqrt();
        self.nodes.visit_leaves(
            |node| {
                let far = reach + k * node.widest;
                node.bounds.distance_squared(center) < far * far
            },
            |leaf| out.push(leaf.start / LANES as u32),
        );
        out.settle(&self.blocks);
    }

    /// Shows every sample whose ball of `k` widths meets the ball of radius `r` (world length) about a point, in the
    /// order of storage.
    #[inline(always)]
    pub fn visit(&self, center: DVec3, r: f64, k: f64, mut show: impl FnMut(usize)) {
        self.nodes.visit(
            |node| {
                let far = r + k * node.widest;
                node.bounds.distance_squared(center) < far * far
            },
            |i| {
                let i = i as usize;
                let far = r + k * self.widths[i];
                if (self.points[i] - center).length_squared() < far * far {
                    show(i);
                }
            },
        );
    }
}
