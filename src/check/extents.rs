//! Boxes around what the nodes of an expression hold: tighter than those of their leaves together, and known for unbounded
//! leaves whose intersection has an end.

use super::logic::{Kind, Logic};
use crate::csg::Leaf;
use crate::geom::Aabb;

/// For each node a box around where it holds, and one around where it does not; sides may be unbounded.
#[derive(Debug)]
pub(super) struct Extents(Vec<[Aabb; 2]>);

impl Extents {
    /// A box around where a node holds; a part without leaves has none, and is nothing.
    pub fn of(&self, node: Option<u32>) -> Aabb {
        node.map_or(Aabb::EMPTY, |node| self.0[node as usize][0])
    }
}

/// Those of an expression over leaves.
pub(super) fn extents(logic: &Logic, leaves: &[Leaf]) -> Extents {
    let start = |kind: Kind| match kind {
        Kind::Leaf(i) => {
            let leaf = &leaves[i as usize];
            let limits =
                leaf.solid.limits().map(|limit| limit.transformed_sides(&leaf.place.world_from_local));
            [if leaf.bounds.is_finite() { leaf.bounds } else { limits[0] }, limits[1]]
        }
        Kind::And => [Aabb::ALL, Aabb::EMPTY],
        Kind::Or => [Aabb::EMPTY, Aabb::ALL],
        Kind::Not | Kind::Xor => [Aabb::EMPTY, Aabb::ALL],
    };
    let mut all: Vec<[Aabb; 2]> = logic.nodes.iter().map(|node| start(node.kind)).collect();
    // Each node stands before those below it.
    for i in (0..all.len()).rev() {
        let ([holds, fails], above) = (all[i], logic.nodes[i].above as usize);
        if above == i {
            continue;
        }
        let sum = &mut all[above];
        match logic.nodes[above].kind {
            Kind::And => *sum = [sum[0].intersection(holds), sum[1].union(fails)],
            Kind::Or => *sum = [sum[0].union(holds), sum[1].intersection(fails)],
            Kind::Xor => *sum = [sum[0].union(holds), Aabb::ALL],
            Kind::Not | Kind::Leaf(_) => *sum = [fails, holds],
        }
    }
    Extents(all)
}
