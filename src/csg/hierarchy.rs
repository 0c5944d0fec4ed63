//! A hierarchy of boxes over the leaves of an object, walked front to back: a leaf comes out when nothing that is left
//! can begin before it.

use crate::geom::{Aabb, Interval, Ray, tolerance};

/// Two boxes side by side, so that a ray is tried on both at once.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// For each axis the low planes of both children, then their high planes.
    planes: [[[f64; 2]; 2]; 3],
    /// A node, or with [`LEAF`] set a leaf.
    child: [u32; 2],
}

const LEAF: u32 = 1 << 31;

/// Boxes of leaves, and boxes around them.
#[derive(Clone, Debug, Default)]
pub(super) struct Hierarchy {
    nodes: Vec<Node>,
    /// Leaves that are tried one by one: those without end, or the only one.
    wide: Vec<(u32, Aabb)>,
    /// The worst condition of a frame: by so much the error of a far origin grows.
    condition: f64,
}

impl Hierarchy {
    /// Over the leaves whose box is not empty.
    pub fn new(boxes: &[Aabb], condition: f64) -> Hierarchy {
        let (mut wide, mut some) = (Vec::new(), Vec::new());
        for (i, b) in boxes.iter().enumerate().filter(|(_, b)| !b.is_empty()) {
            if b.is_finite() { &mut some } else { &mut wide }.push((i as u32, *b));
        }
        if some.len() == 1 {
            wide.append(&mut some);
        }
        let mut hierarchy = Hierarchy { nodes: Vec::with_capacity(some.len()), wide, condition };
        if !some.is_empty() {
            hierarchy.build(&mut some);
        }
        hierarchy
    }

    /// Builds the nodes over two or more leaves; every node comes before those below it.
    fn build(&mut self, all: &mut [(u32, Aabb)]) {
        let mut open = vec![(0usize, 0usize, all.len())];
        self.nodes.push(EMPTY_NODE);
        while let Some((node, from, to)) = open.pop() {
            let middle = from + split(&mut all[from..to]);
            for (side, (lo, hi)) in [(from, middle), (middle, to)].into_iter().enumerate() {
                let bounds = all[lo..hi].iter().fold(Aabb::EMPTY, |sum, b| sum.union(b.1));
                let child = if hi - lo == 1 {
                    LEAF | all[lo].0
                } else {
                    self.nodes.push(EMPTY_NODE);
                    open.push((self.nodes.len() - 1, lo, hi));
                    self.nodes.len() as u32 - 1
                };
                let node = &mut self.nodes[node];
                node.child[side] = child;
                for axis in 0..3 {
                    node.planes[axis][0][side] = bounds.min[axis];
                    node.planes[axis][1][side] = bounds.max[axis];
                }
            }
        }
    }
}

const EMPTY_NODE: Node = Node { planes: [[[0.0; 2]; 2]; 3], child: [0; 2] };

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

/// A ray made ready to be tried on boxes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Probe {
    inverse: [f64; 3],
    /// 1 where the direction is below zero: the high plane is the near one.
    back: [usize; 3],
    /// The origin moved by the growth of the boxes, as the near and as the far plane see it.
    near: [f64; 3],
    far: [f64; 3],
    range: Interval,
}

impl Probe {
    /// Boxes are grown by what a far origin adds to the errors of crossings.
    pub fn new(ray: &Ray, range: Interval, condition: f64) -> Probe {
        let grow = tolerance::cleanup(ray.origin.length()) * condition;
        let d = ray.dir.to_array();
        let back = d.map(|d| usize::from(d < 0.0));
        let o = ray.origin.to_array();
        let sign = |axis: usize| if back[axis] == 1 { -grow } else { grow };
        Probe {
            inverse: d.map(f64::recip),
            back,
            near: std::array::from_fn(|axis| o[axis] + sign(axis)),
            far: std::array::from_fn(|axis| o[axis] - sign(axis)),
            range,
        }
    }

    /// The parts of the ray inside two boxes, widened by a few ulps; `lo <= hi` where a box is met. Along an axis that
    /// the ray is square to, the products are infinite of the right sign, or, in the very plane of a face, no number,
    /// which the comparisons leave aside.
    #[inline]
    fn pair(&self, planes: &[[[f64; 2]; 2]; 3]) -> ([f64; 2], [f64; 2]) {
        let (mut lo, mut hi) = ([f64::NEG_INFINITY; 2], [f64::INFINITY; 2]);
        for axis in 0..3 {
            let (near, far) = (&planes[axis][self.back[axis]], &planes[axis][1 - self.back[axis]]);
            for side in 0..2 {
                let a = (near[side] - self.near[axis]) * self.inverse[axis];
                let b = (far[side] - self.far[axis]) * self.inverse[axis];
                lo[side] = if lo[side] < a { a } else { lo[side] };
                hi[side] = if b < hi[side] { b } else { hi[side] };
            }
        }
        // Each end carries four roundings: of the plane's offset, the inverse, the product and the box's own corner.
        const PAD: f64 = 8.0 * f64::EPSILON;
        for side in 0..2 {
            // An infinite end of a box that is missed has no ulp: `min` and `max` keep it.
            lo[side] = lo[side].min(lo[side] - PAD * lo[side].abs());
            hi[side] = hi[side].max(hi[side] + PAD * hi[side].abs());
        }
        (lo, hi)
    }

    /// The part of the ray inside a box.
    fn one(&self, b: &Aabb) -> Interval {
        let planes = std::array::from_fn(|axis| [[b.min[axis]; 2], [b.max[axis]; 2]]);
        let (lo, hi) = self.pair(&planes);
        Interval::new(lo[0], hi[0])
    }
}

/// A node still to be opened.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    node: u32,
    /// Where the ray enters it or anything below on the stack.
    least: f64,
}

/// A walk along a ray.
#[derive(Clone, Debug, Default)]
pub(super) struct Walk {
    probe: Probe,
    stack: Vec<Waiting>,
}

impl Walk {
    /// Begins: shows the leaves that are tried one by one.
    pub fn begin(
        &mut self,
        hierarchy: &Hierarchy,
        ray: &Ray,
        range: Interval,
        mut show: impl FnMut(u32, Interval),
    ) {
        self.probe = Probe::new(ray, range, hierarchy.condition);
        self.stack.clear();
        for (leaf, bounds) in &hierarchy.wide {
            let met = if *bounds == Aabb::ALL { Interval::ALL } else { self.probe.one(bounds) };
            if !met.intersect(range).is_empty() {
                show(*leaf, met);
            }
        }
        if !hierarchy.nodes.is_empty() {
            self.stack.push(Waiting { node: 0, least: f64::NEG_INFINITY });
        }
    }

    /// Nothing that has not been shown begins before this.
    #[inline]
    pub fn least(&self) -> f64 {
        self.stack.last().map_or(f64::INFINITY, |w| w.least)
    }

    /// Opens one node; shows leaves with where the ray is inside their boxes.
    #[inline]
    pub fn step(&mut self, hierarchy: &Hierarchy, mut show: impl FnMut(u32, Interval)) {
        let Some(Waiting { node, .. }) = self.stack.pop() else { return };
        let Node { planes, child } = &hierarchy.nodes[node as usize];
        let (lo, hi) = self.probe.pair(planes);
        let range = self.probe.range;
        let met = |side: usize| lo[side].max(range.lo) <= hi[side].min(range.hi);
        // The near one is opened first, so it is pushed last.
        let near = usize::from(lo[1] < lo[0]);
        for side in [1 - near, near] {
            if !met(side) {
                continue;
            }
            if child[side] & LEAF != 0 {
                show(child[side] & !LEAF, Interval::new(lo[side], hi[side]));
            } else {
                self.stack.push(Waiting { node: child[side], least: lo[side].min(self.least()) });
            }
        }
    }
}

/// For the growth of the boxes.
pub(super) fn worst_condition(conditions: impl Iterator<Item = f64>) -> f64 {
    conditions.fold(1.0, f64::max)
}
