//! Where a leaf can matter: its own box, cut down to the boxes of what it is intersected with. Outside that, the node
//! that takes the cut is false whatever the leaf says: so a cutter is met only where its base lives.

use super::tree::{Kind, Tree};
use crate::geom::{Aabb, tolerance};

/// For each leaf the box in which it can matter, grown by what rounding may move a crossing; empty where it never does.
pub(super) fn reaches(tree: &Tree) -> Vec<Aabb> {
    let grown: Vec<Aabb> = tree.leaves().iter().map(|leaf| leaf.grown()).collect();
    let bounds = bounds_of_nodes(tree, &grown);
    let contexts = contexts(tree, &bounds);
    let reach = |i: usize| {
        let ups = tree.leaf_ups.of(i).iter();
        let context = ups.map(|up| contexts[up.node as usize]).fold(Aabb::EMPTY, Aabb::union);
        grown[i].intersection(context)
    };
    (0..grown.len()).map(reach).collect()
}

/// For each node a box outside which it is false; all of space where it may be true anywhere.
pub(super) fn bounds_of_nodes(tree: &Tree, grown: &[Aabb]) -> Vec<Aabb> {
    let start = |kind| if kind == Kind::And { Aabb::ALL } else { Aabb::EMPTY };
    let mut bounds: Vec<Aabb> = tree.nodes.iter().map(|n| start(n.kind)).collect();
    let add = |bounds: &mut [Aabb], up: &super::tree::Up, child: Aabb| {
        let child = if up.negated { Aabb::ALL } else { child };
        let sum = &mut bounds[up.node as usize];
        *sum = match tree.nodes[up.node as usize].kind {
            Kind::And => sum.intersection(child),
            Kind::Or | Kind::Xor => sum.union(child),
        };
    };
    for (i, leaf) in grown.iter().enumerate() {
        // The boundary lies in the box; an unbounded leaf may be true anywhere.
        let child = if leaf.is_finite() || leaf.is_empty() { *leaf } else { Aabb::ALL };
        tree.leaf_ups.of(i).iter().for_each(|up| add(&mut bounds, up, child));
    }
    for i in 0..tree.nodes.len() {
        let child = bounds[i];
        tree.node_ups.of(i).iter().for_each(|up| add(&mut bounds, up, child));
    }
    bounds
}

/// For each node the box in which its children can matter to the root.
fn contexts(tree: &Tree, bounds: &[Aabb]) -> Vec<Aabb> {
    let mut contexts = vec![Aabb::EMPTY; tree.nodes.len()];
    let root = tree.nodes.len() - 1;
    for i in (0..=root).rev() {
        let ups = tree.node_ups.of(i).iter();
        let above = if i == root {
            Aabb::ALL
        } else {
            ups.map(|up| contexts[up.node as usize]).fold(Aabb::EMPTY, Aabb::union)
        };
        contexts[i] = above.intersection(slack(&bounds[i]));
    }
    contexts
}

/// A box with room for faces that the clean-up would take for its own: whether a leaf takes part in a face is asked as
/// far from it as that.
fn slack(bounds: &Aabb) -> Aabb {
    if bounds.is_empty() || !bounds.is_finite() {
        return *bounds;
    }
    let scale = bounds.farthest();
    bounds.inflated(4.0 * tolerance::cleanup(scale))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use super::*;
    use crate::csg::{Expr, Leaf};
    use crate::geom::Placement;
    use crate::solid::block::Block;
    use crate::solid::half_space::HalfSpace;

    fn block(lo: f64, hi: f64) -> Leaf {
        let solid = Block(Aabb { min: DVec3::splat(lo), max: DVec3::splat(hi) });
        Leaf::new(Arc::new(solid), Placement::IDENTITY)
    }

    fn half() -> Leaf {
        Leaf::new(Arc::new(HalfSpace { normal: DVec3::Z, offset: 0.0 }), Placement::IDENTITY)
    }

    #[test]
    fn a_cutter_reaches_no_farther_than_its_base() {
        let minus =
            Expr::And(vec![Expr::Leaf(0), Expr::Not(Box::new(Expr::Or(vec![Expr::Leaf(1), Expr::Leaf(2)])))]);
        let tree = Tree::new(vec![block(0.0, 2.0), block(1.0, 9.0), half()], &minus);
        let reaches = reaches(&tree);
        let near = |b: &Aabb, lo: f64, hi: f64| {
            (b.min - lo).abs().max_element() < 1e-12 && (b.max - hi).abs().max_element() < 1e-12
        };
        assert!(
            near(&reaches[0], 0.0, 2.0) && near(&reaches[1], 1.0, 2.0) && near(&reaches[2], 0.0, 2.0),
            "{reaches:?}"
        );
    }

    #[test]
    fn what_is_joined_reaches_everywhere_and_what_never_meets_nowhere() {
        let both = Expr::And(vec![Expr::Leaf(0), Expr::Leaf(1)]);
        let tree =
            Tree::new(vec![block(0.0, 1.0), block(2.0, 3.0), half()], &Expr::Or(vec![both, Expr::Leaf(2)]));
        let reaches = reaches(&tree);
        assert!(reaches[0].is_empty() && reaches[1].is_empty());
        assert_eq!(reaches[2], Aabb::ALL);
    }
}
