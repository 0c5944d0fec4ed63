//! A k-d tree over points, in the order of its traversal, for neighbours and for the winding number.

use std::ops::Range;

use glam::DVec3;

use crate::geom::Aabb;

/// A box of points. The nodes of a subtree follow its root: the first child is the next node, the second
/// begins where the first is skipped.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Around the points, tight.
    pub bounds: Aabb,
    /// The first point of the node, in the order of the tree.
    pub start: u32,
    /// One after the last point.
    pub end: u32,
    /// The first node that is not of this subtree.
    pub skip: u32,
}

impl Node {
    /// Its points, by their places in the tree.
    pub fn places(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// Deeper than any tree of 2^32 points halved at each level.
const STACK: usize = 64;

/// The nodes, and the points' order.
#[derive(Clone, Debug)]
pub struct Tree {
    /// In the order of traversal, the root first; none without points.
    pub nodes: Vec<Node>,
    /// For each place in the tree, the index of the point that stands there.
    pub order: Vec<u32>,
}

impl Tree {
    /// Splits at the median of the widest side until at most `leaf` points are left, or all are equal. Points
    /// of equal coordinates are told apart by index, so the tree is a function of the points' order alone.
    ///
    /// Returns the points in the order of the tree with it.
    pub fn new(points: &[DVec3], leaf: usize) -> (Tree, Vec<DVec3>) {
        // Moved along with their indices: a split goes through memory once, from one end to the other.
        let mut sorted: Vec<(DVec3, u32)> = points.iter().copied().zip(0..).collect();
        let mut tree = Tree { nodes: Vec::new(), order: Vec::new() };
        // Halving: at most 2^32 points make a stack of 33.
        let mut open: Vec<(usize, usize)> = Vec::new();
        if !points.is_empty() {
            open.push((0, points.len()));
        }
        while let Some((start, end)) = open.pop() {
            let part = &mut sorted[start..end];
            let bounds = Aabb::of_points(part.iter().map(|p| p.0));
            tree.nodes.push(Node { bounds, start: start as u32, end: end as u32, skip: 0 });
            let size = bounds.size();
            if part.len() <= leaf || size.max_element() == 0.0 {
                continue;
            }
            let axis = size.max_position();
            let half = part.len() / 2;
            part.select_nth_unstable_by(half, |(a, i), (b, j)| a[axis].total_cmp(&b[axis]).then(i.cmp(j)));
            open.push((start + half, end));
            open.push((start, start + half));
        }
        tree.link();
        tree.nodes.shrink_to_fit();
        tree.order = sorted.iter().map(|p| p.1).collect();
        // In the same memory, of which a quarter is given back.
        let mut points: Vec<DVec3> = sorted.into_iter().map(|p| p.0).collect();
        points.shrink_to_fit();
        (tree, points)
    }

    /// Sets `skip`: the next node that begins at or after the end of this one.
    fn link(&mut self) {
        let mut next_at = Vec::new();
        for at in (0..self.nodes.len()).rev() {
            // Starts of later nodes, the nearest last; those inside this node's subtree are done.
            while next_at.last().is_some_and(|&later: &usize| self.nodes[later].start < self.nodes[at].end) {
                next_at.pop();
            }
            self.nodes[at].skip = next_at.last().map_or(self.nodes.len(), |&later| later) as u32;
            next_at.push(at);
        }
    }

    /// Whether a node has no children.
    pub fn is_leaf(&self, node: usize) -> bool {
        self.nodes[node].skip as usize == node + 1
    }

    /// The children of a node that is no leaf.
    pub fn children(&self, node: usize) -> [usize; 2] {
        [node + 1, self.nodes[node + 1].skip as usize]
    }

    /// Walks to the leaves, the nearer child first. `worth` is told the squared distance of a node's box from `x`, and says
    /// whether to look into it; both see what the walk gathers.
    pub fn walk_near<S>(
        &self,
        x: DVec3,
        gathered: &mut S,
        worth: impl Fn(&S, f64, usize) -> bool,
        mut leaf: impl FnMut(&mut S, usize),
    ) {
        let mut stack = [(0.0, 0usize); STACK];
        let mut depth = usize::from(!self.nodes.is_empty());
        while 0 < depth {
            depth -= 1;
            let (distance, node) = stack[depth];
            if !worth(gathered, distance, node) {
                continue;
            }
            if self.is_leaf(node) {
                leaf(gathered, node);
                continue;
            }
            let mut children = self.children(node).map(|c| (self.nodes[c].bounds.distance_squared(x), c));
            if children[0].0 < children[1].0 {
                children.swap(0, 1);
            }
            stack[depth..depth + 2].copy_from_slice(&children);
            depth += 2;
        }
    }
}
