//! A binary hierarchy of boxes over triangles.

use glam::DVec3;
use rayon::join;

use crate::geom::{Aabb, Ray, tolerance};

/// Triangles in the order of the leaves, and the boxes above them.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// First triangle of a leaf; of an inner node the second child (the first follows the node).
    start: u32,
    /// How many triangles; 0 for inner nodes.
    count: u32,
}

/// Triangles a leaf.
const LEAF: usize = 4;
/// Below this many triangles a task is too small to share.
const PARALLEL: usize = 4096;

impl Tree {
    /// Builds it by halves along the longest axis; `O(n log n)`, the same for any number of threads.
    pub fn new(points: &[DVec3], mut triangles: Vec<[u32; 3]>) -> Tree {
        let nodes = if triangles.is_empty() { Vec::new() } else { build(&mut triangles, 0, points) };
        Tree { triangles, nodes }
    }

    /// A box around all.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |root| root.bounds)
    }

    /// Shows every triangle whose leaf's box the ray's line meets, at its faces and within roundings too.
    pub fn visit(&self, ray: &Ray, mut show: impl FnMut(u32)) {
        let inverse = ray.dir.recip();
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while 0 < depth {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !meets(&node.bounds, ray, inverse) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index + 1;
                depth += 2;
            } else {
                (node.start..node.start + node.count).for_each(&mut show);
            }
        }
    }
}

/// Whether a line meets a box (Kay and Kajiya 1986). The ends of each slab carry three roundings, a corner that the
/// shear places on the line some more: the last comparison has room for them.
fn meets(bounds: &Aabb, ray: &Ray, inverse: DVec3) -> bool {
    let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (o, min, max) = (ray.origin[axis], bounds.min[axis], bounds.max[axis]);
        if ray.dir[axis] == 0.0 {
            if o < min || max < o {
                return false;
            }
            continue;
        }
        let (a, b) = ((min - o) * inverse[axis], (max - o) * inverse[axis]);
        lo = lo.max(a.min(b));
        hi = hi.min(a.max(b));
    }
    lo - tolerance::noise(lo.abs()) <= hi + tolerance::noise(hi.abs())
}

/// Nodes of a subtree in depth-first order; `first` is the place of its triangles in the whole order.
fn build(triangles: &mut [[u32; 3]], first: u32, points: &[DVec3]) -> Vec<Node> {
    let corners = |t: &[u32; 3]| t.map(|i| points[i as usize]);
    let bounds = Aabb::of_points(triangles.iter().flat_map(corners));
    let node = Node { bounds, start: first, count: triangles.len() as u32 };
    if triangles.len() <= LEAF {
        triangles.sort_unstable();
        return vec![node];
    }
    // By middles, or a few long triangles would choose the axis.
    let middle = |t: &[u32; 3]| corners(t).iter().sum::<DVec3>();
    let axis = Aabb::of_points(triangles.iter().map(middle)).size().max_position();
    let half = triangles.len() / 2;
    triangles.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b)));
    let (low, high) = triangles.split_at_mut(half);
    let build_low = |low: &mut [[u32; 3]]| build(low, first, points);
    let build_high = |high: &mut [[u32; 3]]| build(high, first + half as u32, points);
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
