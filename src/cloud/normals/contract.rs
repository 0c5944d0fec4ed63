//! Signs by greedy additive edge contraction.
//!
//! A spanning tree lets one edge decide how two patches of surface stand to each other, the most trusted one; where
//! noise makes a single edge lie, a whole patch is turned. Here the two ends of the most decided edge become one, and edges
//! that now run between the same two are added up, signs and all (Keuper et al. 2015, for signed graphs Levinkov et al. 2017):
//! patches meet by the vote of their whole border.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};

use crate::cloud::groups::Groups;

/// An edge: its two ends, and how much it speaks for equal signs (positive) or opposite ones.
pub(super) type Edge = (u32, u32, f64);

#[derive(Clone, Copy, PartialEq)]
struct Candidate {
    weight: f64,
    ends: [u32; 2],
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Candidate) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    /// By how decided it is, then by its ends, so that the order of edges does not matter.
    fn cmp(&self, other: &Candidate) -> Ordering {
        self.weight.abs().total_cmp(&other.weight.abs()).then(other.ends.cmp(&self.ends))
    }
}

/// Groups of connected nodes with their signs.
pub(super) fn contract(nodes: usize, edges: &[Edge]) -> Groups {
    let mut around: Vec<HashMap<u32, f64>> = vec![HashMap::new(); nodes];
    for &(a, b, w) in edges {
        *around[a as usize].entry(b).or_insert(0.0) += w;
        *around[b as usize].entry(a).or_insert(0.0) += w;
    }
    let mut heap = BinaryHeap::new();
    for (a, near) in around.iter().enumerate() {
        let a = a as u32;
        heap.extend(
            near.iter().filter(|(b, _)| a < **b).map(|(b, w)| Candidate { weight: *w, ends: [a, *b] }),
        );
    }
    let mut groups = Groups::new(nodes);
    while let Some(Candidate { weight, ends: [a, b] }) = heap.pop() {
        // An edge that has grown since has a later candidate.
        if around[a as usize].get(&b) != Some(&weight) || weight == 0.0 {
            continue;
        }
        let larger_first = around[b as usize].len() <= around[a as usize].len();
        let (into, from) = if larger_first { (a, b) } else { (b, a) };
        groups.join_signed(a as usize, b as usize, weight < 0.0);
        let moved = std::mem::take(&mut around[from as usize]);
        around[into as usize].remove(&from);
        for (other, w) in moved.into_iter().filter(|(other, _)| *other != into) {
            let w = if weight < 0.0 { -w } else { w };
            around[other as usize].remove(&from);
            let sum = around[into as usize].entry(other).or_insert(0.0);
            *sum += w;
            let sum = *sum;
            around[other as usize].insert(into, sum);
            heap.push(Candidate { weight: sum, ends: [into.min(other), into.max(other)] });
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_border_outvotes_its_loudest_edge() {
        // Two triangles, joined by one loud wrong edge and three quieter right ones.
        let mut edges: Vec<Edge> = vec![];
        for t in [0, 3] {
            edges.extend([(t, t + 1, 2.0), (t + 1, t + 2, 2.0), (t, t + 2, 2.0)]);
        }
        edges.extend([(0, 3, -1.0), (1, 4, 0.6), (2, 5, 0.6), (1, 5, 0.6)]);
        let mut groups = contract(6, &edges);
        let signs: Vec<bool> = (0..6).map(|i| groups.find(i).1).collect();
        assert!(signs.iter().all(|s| *s == signs[0]), "{signs:?}");
        edges.reverse();
        let mut again = contract(6, &edges);
        assert_eq!(
            (0..6).map(|i| again.find(i)).collect::<Vec<_>>(),
            (0..6).map(|i| groups.find(i)).collect::<Vec<_>>()
        );
    }
}
