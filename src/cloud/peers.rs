//! Samples among those of like spacing: whether far denser ones lie near, and which others are no denser.

use glam::DVec3;

use super::neighbours::{Near, Neighbours, keep};
use super::tree::Tree;

/// Samples and their spacing, ready to be asked.
pub struct Peers<'a> {
    tree: &'a Tree,
    /// In the order of the tree.
    points: &'a [DVec3],
    spacing: Vec<f64>,
    /// Least and largest spacing below each node.
    ranges: Vec<[f64; 2]>,
}

impl Peers<'_> {
    /// Of all points of a search, with the spacing of each.
    pub fn new<'a>(near: &'a Neighbours, spacing: &[f64]) -> Peers<'a> {
        let (tree, points) = (near.tree(), near.in_order());
        let spacing: Vec<f64> = tree.order.iter().map(|&i| spacing[i as usize]).collect();
        let mut ranges = vec![[f64::INFINITY, 0.0]; tree.nodes.len()];
        // Children come after their parents.
        for (at, node) in tree.nodes.iter().enumerate().rev() {
            let join = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.max(d)];
            ranges[at] = if tree.is_leaf(at) {
                spacing[node.places()].iter().fold(ranges[at], |range, s| join(range, [*s, *s]))
            } else {
                let [a, b] = tree.children(at).map(|child| ranges[child]);
                join(a, b)
            };
        }
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
            let near =
                |at: &usize| self.spacing[*at] < below && self.points[*at].distance_squared(x) <= limit;
            if may {
                found += at.places().filter(near).count();
            }
            if count <= found {
                return true;
            }
            node = at.skip as usize;
        }
        false
    }

    /// The `k` samples nearest to sample `own`, which is at `x` and not among them, of a spacing of at least `least`, nearest
    /// first.
    pub fn nearest(&self, (own, x): (u32, DVec3), least: f64, k: usize, out: &mut Vec<Near>) {
        out.clear();
        self.tree.walk_near(
            x,
            out,
            |out, distance, node| {
                least <= self.ranges[node][1] && !(out.len() == k && out[k - 1].distance_squared < distance)
            },
            |out, node| {
                for at in self.tree.nodes[node].places() {
                    let index = self.tree.order[at];
                    if index != own && least <= self.spacing[at] {
                        keep(out, k, Near { distance_squared: self.points[at].distance_squared(x), index });
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
        let tree = Neighbours::new(&points);
        let peers = Peers::new(&tree, &spacing);
        let mut near = Vec::new();
        for own in 0..500u32 {
            let (p, least) = (points[own as usize], 0.1 + stream.unit());
            let mut all: Vec<u32> = (0..500).filter(|&i| i != own && least <= spacing[i as usize]).collect();
            all.sort_by(|&a, &b| {
                p.distance(points[a as usize]).total_cmp(&p.distance(points[b as usize])).then(a.cmp(&b))
            });
            peers.nearest((own, p), least, 7, &mut near);
            let found: Vec<u32> = near.iter().map(|n| n.index).collect();
            assert_eq!(found, all[..7.min(all.len())]);
            let denser = (0..500).filter(|&i| spacing[i] < 0.3 && p.distance(points[i]) <= 0.3).count();
            assert_eq!(peers.are_denser(p, 0.3, 0.3, 3), 3 <= denser);
        }
    }
}
