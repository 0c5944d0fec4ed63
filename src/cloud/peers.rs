//! Samples among those of like spacing: whether far denser ones lie near, and which others are no denser.

use glam::DVec3;

use super::neighbours::{Near, keep};
use super::tree::Tree;

/// Samples of a leaf.
const LEAF: usize = 8;

/// Samples and their spacing, ready to be asked.
pub struct Peers<'a> {
    tree: Tree,
    points: &'a [DVec3],
    spacing: &'a [f64],
    /// Least and largest spacing below each node.
    ranges: Vec<[f64; 2]>,
}

impl Peers<'_> {
    /// Builds the tree, O(n log n).
    pub fn new<'a>(points: &'a [DVec3], spacing: &'a [f64]) -> Peers<'a> {
        let tree = Tree::new(points, LEAF);
        let range = |node: &super::tree::Node| {
            let ids = &tree.order[node.start as usize..node.end as usize];
            let all = ids.iter().map(|&i| spacing[i as usize]);
            all.fold([f64::INFINITY, 0.0], |[a, b], s| [s.min(a), s.max(b)])
        };
        let ranges = tree.nodes.iter().map(range).collect();
        Peers { tree, points, spacing, ranges }
    }

    /// Whether at least `count` samples of a spacing below `below` lie within `radius` of a place.
    pub fn are_denser(&self, x: DVec3, radius: f64, below: f64, count: usize) -> bool {
        let limit = radius * radius;
        let mut found = 0;
        let mut node = 0;
        while node < self.tree.nodes.len() {
            let at = &self.tree.nodes[node];
            let may = self.ranges[node][0] < below && at.bounds.distance_squared(x) <= limit;
            if may && !self.tree.is_leaf(node) {
                node += 1;
                continue;
            }
            let near = |i: &&u32| {
                self.spacing[**i as usize] < below && self.points[**i as usize].distance_squared(x) <= limit
            };
            if may {
                found += self.tree.order[at.start as usize..at.end as usize].iter().filter(near).count();
            }
            if count <= found {
                return true;
            }
            node = at.skip as usize;
        }
        false
    }

    /// The `k` samples nearest to sample `own`, itself not among them, of a spacing of at least `least`, nearest first.
    pub fn nearest(&self, own: u32, least: f64, k: usize, out: &mut Vec<Near>) {
        out.clear();
        let x = self.points[own as usize];
        self.tree.walk_near(
            x,
            out,
            |out, distance, node| {
                least <= self.ranges[node][1] && !(out.len() == k && out[k - 1].distance_squared < distance)
            },
            |out, node| {
                let at = &self.tree.nodes[node];
                for &index in &self.tree.order[at.start as usize..at.end as usize] {
                    if index != own && least <= self.spacing[index as usize] {
                        let distance_squared = self.points[index as usize].distance_squared(x);
                        keep(out, k, Near { distance_squared, index });
                    }
                }
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    #[test]
    fn peers_are_those_of_a_search_through_all() {
        let mut stream = Stream::new(5);
        let points: Vec<DVec3> = (0..500).map(|_| stream.direction() * stream.unit()).collect();
        let spacing: Vec<f64> = (0..500).map(|_| 0.1 + stream.unit()).collect();
        let peers = Peers::new(&points, &spacing);
        let mut near = Vec::new();
        for own in 0..500u32 {
            let (p, least) = (points[own as usize], 0.1 + stream.unit());
            let mut all: Vec<u32> = (0..500).filter(|&i| i != own && least <= spacing[i as usize]).collect();
            all.sort_by(|&a, &b| {
                p.distance(points[a as usize]).total_cmp(&p.distance(points[b as usize])).then(a.cmp(&b))
            });
            peers.nearest(own, least, 7, &mut near);
            let found: Vec<u32> = near.iter().map(|n| n.index).collect();
            assert_eq!(found, all[..7.min(all.len())]);
            let denser = (0..500).filter(|&i| spacing[i] < 0.3 && p.distance(points[i]) <= 0.3).count();
            assert_eq!(peers.are_denser(p, 0.3, 0.3, 3), 3 <= denser);
        }
    }
}
