//! The nearest points and the points within a radius, in one order: by distance, then by index.

use glam::DVec3;
use rayon::prelude::*;

use super::tree::Tree;

/// Points of a leaf: few enough to look at each, enough that boxes cost less than points.
const LEAF: usize = 8;

/// Rows a thread takes at a time.
const CHUNK: usize = 1024;

/// A point near a place.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Near {
    /// Squared distance from the place.
    pub distance_squared: f64,
    /// Index of the point.
    pub index: u32,
}

impl Near {
    fn before(&self, other: &Near) -> bool {
        (self.distance_squared, self.index) < (other.distance_squared, other.index)
    }
}

/// Finite points, ready to be asked for neighbours. Any points: equal ones, on a lattice, on a line.
#[derive(Clone, Debug)]
pub struct Neighbours {
    tree: Tree,
    /// In the order of the tree.
    points: Vec<DVec3>,
}

/// The nearest points of each point, row by row, itself not among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    k: usize,
    ids: Vec<u32>,
}

impl Table {
    /// Points in each row.
    pub fn k(&self) -> usize {
        self.k
    }

    /// The nearest points of point `i`, nearest first.
    pub fn row(&self, i: usize) -> &[u32] {
        &self.ids[i * self.k..(i + 1) * self.k]
    }
}

impl Neighbours {
    /// Builds the tree, O(n log n).
    pub fn new(points: &[DVec3]) -> Neighbours {
        let tree = Tree::new(points, LEAF);
        let points = tree.order.iter().map(|&i| points[i as usize]).collect();
        Neighbours { tree, points }
    }

    /// The `k` points nearest to `x` (all where there are fewer), into `out`; of several at the distance of the
    /// last, those of smallest index.
    pub fn nearest(&self, x: DVec3, k: usize, out: &mut Vec<Near>) {
        out.clear();
        if k == 0 || self.points.is_empty() {
            return;
        }
        self.tree.walk_near(
            x,
            out,
            // At equal distance a smaller index may still come.
            |out, distance, _| !(out.len() == k && out[k - 1].distance_squared < distance),
            |out, node| self.visit_leaf(node, x, |near| keep(out, k, near)),
        );
    }

    /// The points at most `radius` from `x`, into `out`.
    pub fn within(&self, x: DVec3, radius: f64, out: &mut Vec<Near>) {
        out.clear();
        let limit = radius * radius;
        let mut node = 0;
        while node < self.tree.nodes.len() {
            let inside = self.tree.nodes[node].bounds.distance_squared(x) <= limit;
            if inside && !self.tree.is_leaf(node) {
                node += 1;
                continue;
            }
            if inside {
                self.visit_leaf(node, x, |near| {
                    if near.distance_squared <= limit {
                        out.push(near);
                    }
                });
            }
            node = self.tree.nodes[node].skip as usize;
        }
        out.sort_unstable_by(|a, b| {
            a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index))
        });
    }

    /// The `k` nearest other points of each point (fewer where there are not so many), in parallel.
    pub fn table(&self, k: usize) -> Table {
        let n = self.points.len();
        let k = k.min(n.saturating_sub(1));
        // In the order of the tree, neighbours are asked for one after the other; then put in their rows.
        let rows: Vec<Vec<u32>> = (0..n.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| self.rows(chunk * CHUNK..((chunk + 1) * CHUNK).min(n), k))
            .collect();
        let mut ids = vec![0; n * k];
        if 0 < k {
            let in_tree = rows.iter().flat_map(|rows| rows.chunks_exact(k));
            for (row, &i) in in_tree.zip(&self.tree.order) {
                ids[i as usize * k..][..k].copy_from_slice(row);
            }
        }
        Table { k, ids }
    }

    fn rows(&self, places: std::ops::Range<usize>, k: usize) -> Vec<u32> {
        let mut near = Vec::with_capacity(k + 2);
        let mut rows = Vec::with_capacity(places.len() * k);
        for at in places {
            self.nearest(self.points[at], k + 1, &mut near);
            let own = self.tree.order[at];
            // Among many equal points the own one may be beyond the last: then the last goes.
            rows.extend(near.iter().map(|n| n.index).filter(|&i| i != own).take(k));
        }
        rows
    }

    fn visit_leaf(&self, node: usize, x: DVec3, mut visit: impl FnMut(Near)) {
        let (start, end) = (self.tree.nodes[node].start as usize, self.tree.nodes[node].end as usize);
        for (p, &index) in self.points[start..end].iter().zip(&self.tree.order[start..end]) {
            visit(Near { distance_squared: (*p - x).length_squared(), index });
        }
    }
}

/// Inserts into the `k` best so far, which stay sorted.
pub(super) fn keep(best: &mut Vec<Near>, k: usize, near: Near) {
    if best.len() == k {
        if !near.before(&best[k - 1]) {
            return;
        }
        best.pop();
    }
    let at = best.iter().rposition(|b| b.before(&near)).map_or(0, |at| at + 1);
    best.insert(at, near);
}
