//! A binary hierarchy over the samples that answers two questions: which trust spheres does a line meet, and which
//! samples weigh near a point. The samples are kept in the order of its leaves, so neighbours lie side by side.

use glam::DVec3;
use rayon::join;

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
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// Around the positions.
    bounds: Aabb,
    /// The largest width below.
    widest: f64,
    /// First sample of a leaf; of an inner node the second child (the first follows the node).
    start: u32,
    /// How many samples; 0 for inner nodes.
    count: u32,
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
/// Below this many samples a task is too small to share.
const PARALLEL: usize = 4096;

impl Hierarchy {
    /// Builds it; `O(n log n)`, the same for any number of threads.
    pub fn new(points: &[DVec3], normals: &[DVec3], widths: &[f64]) -> Hierarchy {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let nodes = if points.is_empty() { Vec::new() } else { build(&mut order, 0, points, widths) };
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
        self.nodes.first().map_or(Aabb::EMPTY, |root| root.bounds.inflated(root.widest))
    }

    /// All trust spheres that a line of unit direction meets, with the part inside, in the order of storage.
    pub fn spheres_on(&self, line: &Ray, out: &mut Vec<Reach>) {
        out.clear();
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while 0 < depth {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if node.bounds.inflated(node.widest).clip(line).is_empty() {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index as u32 + 1;
                depth += 2;
                continue;
            }
            for i in node.start..node.start + node.count {
                let (p, h) = (self.points[i as usize], self.widths[i as usize]);
                let middle = (p - line.origin).dot(line.dir);
                let off = (p - line.at(middle)).length_squared();
                if off < h * h {
                    let half = (h * h - off).sqrt();
                    out.push(Reach { range: Interval::new(middle - half, middle + half), sample: i });
                }
            }
        }
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
        let mut best = (limit, usize::MAX);
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while 0 < depth {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if best.0 * node.widest * node.widest < node.bounds.distance_squared(at) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index as u32 + 1;
                depth += 2;
                continue;
            }
            for i in node.start as usize..(node.start + node.count) as usize {
                let h = self.widths[i];
                let candidate = ((self.points[i] - at).length_squared() / (h * h), i);
                if candidate < best {
                    best = candidate;
                }
            }
        }
        (best.1 != usize::MAX).then_some(best.1)
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
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while 0 < depth {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            let far = r + k * node.widest;
            if far * far <= node.bounds.distance_squared(center) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index as u32 + 1;
                depth += 2;
                continue;
            }
            for i in node.start as usize..(node.start + node.count) as usize {
                let far = r + k * self.widths[i];
                if (self.points[i] - center).length_squared() < far * far {
                    show(i);
                }
            }
        }
    }
}

/// Nodes of a subtree in depth-first order; `first` is the place of its samples in the whole order.
fn build(order: &mut [u32], first: u32, points: &[DVec3], widths: &[f64]) -> Vec<Node> {
    let bounds = Aabb::of_points(order.iter().map(|i| points[*i as usize]));
    let widest = order.iter().map(|i| widths[*i as usize]).fold(0.0, f64::max);
    let node = Node { bounds, widest, start: first, count: order.len() as u32 };
    if order.len() <= LEAF {
        // Within a leaf by index, so that the order does not depend on how the median was selected.
        order.sort_unstable();
        return vec![node];
    }
    let axis = bounds.size().max_position();
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |a, b| {
        let (pa, pb) = (points[*a as usize], points[*b as usize]);
        pa[axis].total_cmp(&pb[axis]).then(a.cmp(b))
    });
    let (low, high) = order.split_at_mut(middle);
    let build_low = |low: &mut [u32]| build(low, first, points, widths);
    let build_high = |high: &mut [u32]| build(high, first + middle as u32, points, widths);
    let (left, right) = if PARALLEL < low.len() {
        join(|| build_low(low), || build_high(high))
    } else {
        (build_low(low), build_high(high))
    };
    let second = 1 + left.len() as u32;
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Node { start: second, count: 0, ..node });
    nodes.extend(left.into_iter().map(|n| shifted(n, 1)));
    nodes.extend(right.into_iter().map(|n| shifted(n, second)));
    nodes
}

/// A node of a subtree that begins `by` places later; only inner nodes point at nodes.
fn shifted(node: Node, by: u32) -> Node {
    if node.count == 0 { Node { start: node.start + by, ..node } } else { node }
}
