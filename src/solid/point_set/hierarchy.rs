//! A binary hierarchy over the samples that answers two questions: which trust spheres does a line meet, and which
//! samples weigh near a point. The samples are kept in the order of its leaves, so neighbours lie side by side.

use std::cell::Cell;
use std::cmp::Ordering;

use glam::DVec3;

use crate::geom::halves::{Halves, Halving};
use crate::geom::{Aabb, Interval, Ray};
use crate::mls::{Guess, Neighbours};

/// Samples in the order of the hierarchy.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    /// Positions.
    pub points: Vec<DVec3>,
    /// Outward unit normals.
    pub normals: Vec<DVec3>,
    /// Widths h_i, which are also the radii of the trust spheres.
    pub widths: Vec<f64>,
    inverse_widths: Vec<f64>,
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

/// The part of a line inside one trust sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Arc length range.
    pub range: Interval,
    /// Which sphere.
    pub sample: u32,
}

/// Samples a leaf: small enough that a ball wastes little, large enough that the nodes stay few.
const LEAF: usize = 8;

impl Hierarchy {
    /// Builds it; `O(n log n)`, the same for any number of threads.
    pub fn new(points: &[DVec3], normals: &[DVec3], widths: &[f64]) -> Hierarchy {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let nodes = Halves::new(&mut order, LEAF, &Samples { points, widths });
        let pick = |i: &u32| *i as usize;
        Hierarchy {
            points: order.iter().map(|i| points[pick(i)]).collect(),
            normals: order.iter().map(|i| normals[pick(i)]).collect(),
            widths: order.iter().map(|i| widths[pick(i)]).collect(),
            inverse_widths: order.iter().map(|i| 1.0 / widths[pick(i)]).collect(),
            original: order,
            nodes,
        }
    }

    /// A box around all trust spheres.
    pub fn reach(&self) -> Aabb {
        self.nodes.root().map_or(Aabb::EMPTY, |root| root.bounds.inflated(root.widest))
    }

    /// All trust spheres that a line of unit direction meets, with the part inside, in the order of storage.
    pub fn spheres_on(&self, line: &Ray, out: &mut Vec<Reach>) {
        out.clear();
        self.nodes.visit(
            |node| !node.bounds.inflated(node.widest).clip(line).is_empty(),
            |i| {
                let (p, h) = (self.points[i as usize], self.widths[i as usize]);
                let middle = (p - line.origin).dot(line.dir);
                let off = (p - line.at(middle)).length_squared();
                if off < h * h {
                    let half = (h * h - off).sqrt();
                    out.push(Reach { range: Interval::new(middle - half, middle + half), sample: i });
                }
            },
        );
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

    /// Gathers every sample whose support (`support` is that of the weight, in squared widths) reaches the ball of
    /// `reach` widths about the foot of a guess, in the order of storage.
    pub fn gather(&self, guess: &Guess, reach: f64, support: f64, out: &mut Neighbours) {
        let Guess { foot: center, outward, width: unit } = *guess;
        out.reset(center, unit, reach, outward);
        self.visit(center, reach * unit, support.sqrt(), |i| {
            out.push(self.points[i], self.normals[i], self.inverse_widths[i]);
        });
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
