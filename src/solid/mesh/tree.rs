//! A binary hierarchy of boxes over triangles.

use std::cmp::Ordering;

use glam::DVec3;

use crate::geom::halves::{Halves, Halving};
use crate::geom::{Aabb, Ray, tolerance};

/// Triangles in the order of the leaves, and the boxes above them.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    nodes: Halves<Aabb>,
}

/// Triangles by their corners' places in a list, halved by their middles: a few long ones would else choose the axis.
struct Corners<'a>(&'a [DVec3]);

impl Corners<'_> {
    fn of(&self, triangle: &[u32; 3]) -> [DVec3; 3] {
        triangle.map(|i| self.0[i as usize])
    }

    /// Three times the middle.
    fn middle(&self, triangle: &[u32; 3]) -> DVec3 {
        self.of(triangle).iter().sum()
    }
}

impl Halving<[u32; 3]> for Corners<'_> {
    type Bound = Aabb;

    fn bound(&self, triangles: &[[u32; 3]]) -> Aabb {
        Aabb::of_points(triangles.iter().flat_map(|t| self.of(t)))
    }

    fn axis(&self, triangles: &[[u32; 3]], _: &Aabb) -> usize {
        Aabb::of_points(triangles.iter().map(|t| self.middle(t))).size().max_position()
    }

    fn order(&self, axis: usize, a: &[u32; 3], b: &[u32; 3]) -> Ordering {
        self.middle(a)[axis].total_cmp(&self.middle(b)[axis]).then(a.cmp(b))
    }

    fn settle(&self, triangles: &mut [[u32; 3]]) {
        triangles.sort_unstable();
    }
}

/// Triangles a leaf.
const LEAF: usize = 4;

impl Tree {
    /// Builds it by halves along the longest axis; `O(n log n)`, the same for any number of threads.
    pub fn new(points: &[DVec3], mut triangles: Vec<[u32; 3]>) -> Tree {
        let nodes = Halves::new(&mut triangles, LEAF, &Corners(points));
        Tree { triangles, nodes }
    }

    /// A box around all.
    pub fn bounds(&self) -> Aabb {
        self.nodes.root().copied().unwrap_or(Aabb::EMPTY)
    }

    /// Shows every triangle whose leaf's box the ray's line meets, at its faces and within roundings too.
    pub fn visit(&self, ray: &Ray, show: impl FnMut(u32)) {
        self.visit_near(ray, 0.0, show);
    }

    /// The same for lines that come nearer than a distance to the box, along each axis.
    pub fn visit_near(&self, ray: &Ray, distance: f64, show: impl FnMut(u32)) {
        let inverse = ray.dir.recip();
        self.nodes.visit(|bounds| meets(&bounds.inflated(distance), ray, inverse), show);
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
