//! The nearest points and the points within a radius, in one order: by distance, then by index.

use glam::DVec3;
use rayon::prelude::*;

use super::tree::{Node, Tree};

/// Points of a leaf: few enough to look at each, enough that boxes cost less than points.
const LEAF: usize = 16;

/// Points that look for their neighbours together: those of a node of the tree with at most so many. What lies around them is
/// then not much more than each of them needs.
const CROWD: usize = 32;

/// How far all of a crowd look, over what one of them needs: those that need more ask for themselves.
const SPARE: f64 = 1.2;

/// Crowds a thread takes at a time, at least.
const CROWDS: usize = 32;
/// Crowds whose answers are held before they are put in their places.
const BATCH: usize = 4096;

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

    /// By distance, then by index, as one number: squares are no less than +0, and ordered as their bits are.
    #[inline]
    fn key(&self) -> u128 {
        u128::from(self.distance_squared.to_bits()) << 32 | u128::from(self.index)
    }
}

/// What is around a crowd, and what is nearest to one of it.
#[derive(Debug, Default)]
struct Room {
    /// Squared distance up to which all points are in `around`.
    limit: f64,
    /// With their places in the tree.
    around: Vec<(DVec3, usize)>,
    squares: Vec<f64>,
    near: Vec<Near>,
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
        let (tree, points) = Tree::new(points, LEAF);
        Neighbours { tree, points }
    }

    /// The tree.
    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The points in the order of the tree.
    pub(super) fn in_order(&self) -> &[DVec3] {
        &self.points
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
        out.sort_unstable_by_key(Near::key);
    }

    /// The `k` nearest other points of each point (fewer where there are not so many), in parallel.
    pub fn table(&self, k: usize) -> Table {
        let k = k.min(self.points.len().saturating_sub(1));
        let mut ids = vec![0; self.points.len() * k];
        let row = |_, near: &[Near], row: &mut Vec<u32>| row.extend(near.iter().map(|n| n.index));
        self.by_crowds(k, row, |owners, rows| {
            for (&i, row) in owners.iter().zip(rows.chunks_exact(k.max(1))) {
                ids[i as usize * k..][..k].copy_from_slice(row);
            }
        });
        Table { k, ids }
    }

    /// Something of each point, told its index and its `k` nearest others (fewer where there are not so many), nearest first;
    /// in parallel.
    pub fn map<T: Send + Copy + Default>(&self, k: usize, of: impl Fn(u32, &[Near]) -> T + Sync) -> Vec<T> {
        let k = k.min(self.points.len().saturating_sub(1));
        let mut all = vec![T::default(); self.points.len()];
        let one = |own, near: &[Near], out: &mut Vec<T>| out.push(of(own, near));
        self.by_crowds(k, one, |owners, values| {
            owners.iter().zip(values).for_each(|(&i, value)| all[i as usize] = value);
        });
        all
    }

    /// Goes through the crowds, each with a list of its own to append to, and gives that with the points of the crowd to `put`.
    fn by_crowds<T: Send>(
        &self,
        k: usize,
        of: impl Fn(u32, &[Near], &mut Vec<T>) + Sync,
        mut put: impl FnMut(&[u32], Vec<T>),
    ) {
        let visit = |room: &mut Room, crowd: &Node| {
            let mut out = Vec::new();
            self.look_around(crowd, k, room);
            for at in crowd.places() {
                self.nearest_around(at, k, room);
                of(self.tree.order[at], &room.near, &mut out);
            }
            out
        };
        for crowds in self.crowds().chunks(BATCH) {
            let lists: Vec<Vec<T>> =
                crowds.par_iter().with_min_len(CROWDS).map_init(Room::default, &visit).collect();
            for (crowd, list) in crowds.iter().zip(lists) {
                put(&self.tree.order[crowd.places()], list);
            }
        }
    }

    /// The largest nodes with at most [`CROWD`] points, and leaves with more: points that are all equal.
    fn crowds(&self) -> Vec<Node> {
        let (mut crowds, mut at) = (Vec::new(), 0);
        while let Some(node) = self.tree.nodes.get(at) {
            if node.end - node.start <= CROWD as u32 || self.tree.is_leaf(at) {
                crowds.push(*node);
                at = node.skip as usize;
            } else {
                at += 1;
            }
        }
        crowds
    }

    /// Gathers all points that may be among the `k` nearest of a crowd's, by what one of them needs.
    fn look_around(&self, crowd: &Node, k: usize, room: &mut Room) {
        let middle = (crowd.start + crowd.end) as usize / 2;
        self.nearest(self.points[middle], k + 1, &mut room.near);
        room.limit = SPARE * SPARE * room.near.last().map_or(0.0, |n| n.distance_squared);
        room.around.clear();
        let mut at = 0;
        while let Some(node) = self.tree.nodes.get(at) {
            let near = node.bounds.gap_squared(&crowd.bounds) <= room.limit;
            if near && !self.tree.is_leaf(at) {
                at += 1;
                continue;
            }
            if near {
                let points = self.points[node.places()].iter().copied().zip(node.places());
                room.around.extend(points.filter(|p| crowd.bounds.distance_squared(p.0) <= room.limit));
            }
            at = node.skip as usize;
        }
    }

    /// Of the point at a place in the tree the `k` nearest others, into `room.near`, given what is around its crowd.
    fn nearest_around(&self, at: usize, k: usize, room: &mut Room) {
        let (x, own) = (self.points[at], self.tree.order[at]);
        room.near.clear();
        room.squares.clear();
        room.squares.extend(room.around.iter().map(|p| (p.0 - x).length_squared()));
        for (&distance_squared, &(_, place)) in room.squares.iter().zip(&room.around) {
            if distance_squared <= room.limit {
                room.near.push(Near { distance_squared, index: self.tree.order[place] });
            }
        }
        if k < room.near.len() {
            room.near.sort_unstable_by_key(Near::key);
        } else {
            // There are others beyond what was looked at.
            self.nearest(x, k + 1, &mut room.near);
        }
        // Among many equal points the own one may be beyond the last: then the last goes.
        if let Some(place) = room.near.iter().take(k + 1).position(|n| n.index == own) {
            room.near.remove(place);
        }
        room.near.truncate(k);
    }

    fn visit_leaf(&self, node: usize, x: DVec3, mut visit: impl FnMut(Near)) {
        let places = self.tree.nodes[node].places();
        for (p, &index) in self.points[places.clone()].iter().zip(&self.tree.order[places]) {
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
