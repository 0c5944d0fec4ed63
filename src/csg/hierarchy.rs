//! A hierarchy of boxes over the leaves of an object, four to a node, in single precision: they only cull, with room for
//! all roundings ([`super::walk`]), and take half the room and time that they would in double.

use glam::{DVec3, Vec4};

use crate::geom::{Aabb, tolerance};

/// Four boxes side by side, so that a ray is tried on all at once; in the frame of [`Grid`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// For each axis the low planes, then the high planes.
    pub planes: [[Vec4; 2]; 3],
    /// A node, or with [`LEAF`] set a leaf.
    pub child: [u32; WIDTH],
}

/// Set in what is a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// How many boxes a node has.
pub(super) const WIDTH: usize = 4;

/// More than the rounding of a plane.
const GRAIN: f64 = f32::EPSILON as f64;

/// What a box of a node is around.
#[derive(Clone, Copy, Debug)]
pub(super) enum Child {
    Node(u32),
    Leaf(u32),
}

/// Of no box at all: outside of all boxes that are, its high planes below its low ones.
const NONE: Node = Node { planes: [[Vec4::splat(64.0), Vec4::splat(-64.0)]; 3], child: [0; WIDTH] };

/// The frame in which all boxes with an end lie between -1 and 1: a point p is there at (p - center) * scale.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Grid {
    /// The box around all.
    pub bounds: Aabb,
    pub center: DVec3,
    pub scale: f64,
}

impl Grid {
    fn around(bounds: Aabb) -> Grid {
        // Halved first: the sum and the difference of the largest numbers have no room.
        let center = 0.5 * bounds.min + 0.5 * bounds.max;
        let half = (0.5 * bounds.max - 0.5 * bounds.min).max_element();
        Grid { bounds, center, scale: half.max(f64::MIN_POSITIVE).recip().min(f64::MAX) }
    }

    fn place(&self, p: DVec3) -> [f32; 3] {
        ((p - self.center) * self.scale).as_vec3().to_array()
    }
}

/// Boxes of leaves, and boxes around them.
#[derive(Clone, Debug, Default)]
pub(super) struct Hierarchy {
    pub nodes: Vec<Node>,
    pub grid: Grid,
    /// Leaves that are tried one by one: those without end, or the only one.
    pub wide: Vec<u32>,
    /// The box of each leaf.
    pub boxes: Vec<Aabb>,
    /// The worst condition of a frame: by so much the error of a far origin grows.
    pub condition: f64,
}

impl Hierarchy {
    /// Over the leaves whose box is not empty.
    pub fn new(boxes: Vec<Aabb>, condition: f64) -> Hierarchy {
        let (mut wide, mut some) = (Vec::new(), Vec::new());
        for (i, b) in (0u32..).zip(&boxes).filter(|(_, b)| !b.is_empty()) {
            if b.is_finite() { some.push((i, *b)) } else { wide.push(i) }
        }
        if some.len() == 1 {
            wide.extend(some.pop().map(|b| b.0));
        }
        let grid = Grid::around(union(&some));
        let mut hierarchy =
            Hierarchy { nodes: Vec::with_capacity(some.len() / 2), grid, wide, boxes, condition };
        if !some.is_empty() {
            hierarchy.build(&mut some);
        }
        hierarchy
    }

    /// By so much boxes are grown for rays that start so far off: what a far origin adds to the errors of crossings.
    pub fn grow(&self, origin: f64) -> f64 {
        tolerance::cleanup(origin) * self.condition
    }

    /// What is below a node, each with a box around it.
    pub fn children(&self, node: u32) -> impl Iterator<Item = (Child, Aabb)> {
        let Node { planes, child } = &self.nodes[node as usize];
        let corner = |slot: usize, side: usize| {
            let place = DVec3::from_array(std::array::from_fn(|axis| f64::from(planes[axis][side][slot])));
            // The planes are rounded to the nearest; a box of none stays one of none.
            let out = if side == 0 { -GRAIN } else { GRAIN };
            self.grid.center + (place + out) / self.grid.scale
        };
        let one = move |slot: usize| {
            let kind = if child[slot] & LEAF != 0 {
                Child::Leaf(child[slot] & !LEAF)
            } else {
                Child::Node(child[slot])
            };
            (kind, Aabb { min: corner(slot, 0), max: corner(slot, 1) })
        };
        (0..WIDTH).map(one).filter(|(_, bounds)| !bounds.is_empty())
    }

    /// Builds the nodes over two or more leaves; every node comes before those below it.
    fn build(&mut self, all: &mut [(u32, Aabb)]) {
        let mut open = vec![(0usize, 0usize, all.len())];
        self.nodes.push(NONE);
        while let Some((at, from, to)) = open.pop() {
            let (parts, count) = parts(all, from, to);
            let mut node = NONE;
            for (slot, [lo, hi]) in parts[..count].iter().copied().enumerate() {
                node.child[slot] = if hi - lo == 1 {
                    LEAF | all[lo].0
                } else {
                    self.nodes.push(NONE);
                    open.push((self.nodes.len() - 1, lo, hi));
                    self.nodes.len() as u32 - 1
                };
                let bounds = union(&all[lo..hi]);
                let (min, max) = (self.grid.place(bounds.min), self.grid.place(bounds.max));
                for axis in 0..3 {
                    node.planes[axis][0][slot] = min[axis];
                    node.planes[axis][1][slot] = max[axis];
                }
            }
            self.nodes[at] = node;
        }
    }
}

fn union(all: &[(u32, Aabb)]) -> Aabb {
    all.iter().fold(Aabb::EMPTY, |sum, b| sum.union(b.1))
}

fn area(all: &[(u32, Aabb)]) -> f64 {
    if all.is_empty() { 0.0 } else { union(all).surface() }
}

/// Parts of a range of two or more boxes, each half-open, and how many: the largest is split until there are enough.
fn parts(all: &mut [(u32, Aabb)], from: usize, to: usize) -> ([[usize; 2]; WIDTH], usize) {
    let (mut parts, mut count) = ([[from, to]; WIDTH], 1);
    while count < WIDTH {
        let size = |at: &usize| area(&all[parts[*at][0]..parts[*at][1]]);
        let many = (0..count).filter(|at| 1 < parts[*at][1] - parts[*at][0]);
        let Some(at) = many.max_by(|a, b| size(a).total_cmp(&size(b)).then(b.cmp(a))) else { break };
        let [lo, hi] = parts[at];
        let middle = lo + split(&mut all[lo..hi]);
        parts[at] = [lo, middle];
        parts[count] = [middle, hi];
        count += 1;
    }
    (parts, count)
}

/// Parts boxes in two by the surface area heuristic over sixteen bins of their centres along the longest axis (Wald
/// 2007, "On fast construction of SAH-based bounding volume hierarchies"); where that parts nothing, in halves.
fn split(all: &mut [(u32, Aabb)]) -> usize {
    const BINS: usize = 16;
    let half = all.len() / 2;
    let centers = Aabb::of_points(all.iter().map(|b| b.1.center()));
    let axis = centers.size().max_position();
    let (lo, size) = (centers.min[axis], centers.size()[axis]);
    let bin = |b: &Aabb| (((b.center()[axis] - lo) / size * BINS as f64) as usize).min(BINS - 1);
    if size == 0.0 || !size.is_finite() || all.len() < 4 {
        return halves(all, axis, half);
    }
    let mut bins = [(Aabb::EMPTY, 0usize); BINS];
    for (_, b) in all.iter() {
        let bin = &mut bins[bin(b)];
        *bin = (bin.0.union(*b), bin.1 + 1);
    }
    let cost = |bins: &[(Aabb, usize)]| {
        let (bounds, count) = bins.iter().fold((Aabb::EMPTY, 0), |s, b| (s.0.union(b.0), s.1 + b.1));
        let s = bounds.size();
        if count == 0 { 0.0 } else { count as f64 * (s.x * s.y + s.y * s.z + s.z * s.x) }
    };
    let costs = (1..BINS).map(|at| (at, cost(&bins[..at]) + cost(&bins[at..])));
    let best = costs.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(BINS / 2, |c| c.0);
    // In place, and the same whatever the order of equal costs: leaves keep their order on either side.
    all.sort_by_key(|b| best <= bin(&b.1));
    let left = all.partition_point(|b| bin(&b.1) < best);
    if left == 0 || left == all.len() { halves(all, axis, half) } else { left }
}

fn halves(all: &mut [(u32, Aabb)], axis: usize, half: usize) -> usize {
    all.sort_by(|a, b| a.1.center()[axis].total_cmp(&b.1.center()[axis]).then(a.0.cmp(&b.0)));
    half
}

/// For the growth of the boxes.
pub(super) fn worst_condition(conditions: impl Iterator<Item = f64>) -> f64 {
    conditions.fold(1.0, f64::max)
}
