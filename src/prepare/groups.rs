//! Which shapes become objects of their own: those of many solids that stand in several places. Every use of such a shape is
//! one leaf of what it stands in, with its own place; its solids, their tree and hierarchy are built once.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::limits;
use crate::csg::Object;
use crate::deep;
use crate::geom::Aabb;
use crate::scene::{MaterialId, Shape, ShapeKind};

/// A shape of fewer solids is written out: asking two hierarchies costs more than one a little deeper.
const LEAST_SOLIDS: u64 = 16;
/// And so is one whose uses would save fewer than this.
const LEAST_SAVED: u64 = 1000;

/// Solids times uses.
const VAST: u64 = 1_000_000;

/// What decides, beside the node, which leaves come of a shape.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Inherited {
    pub material: Option<MaterialId>,
    pub cut: Option<MaterialId>,
    pub cutter: bool,
    pub turned: bool,
    /// Whether an inside is wanted, and of an operand of a union only.
    pub wanted: Option<bool>,
}

/// An object made of a shape.
#[derive(Clone)]
pub(super) struct Prototype {
    pub object: Object,
    /// The point of the shape's frame where the object's has its origin: its middle, so that its own lengths are no
    /// longer than its size.
    pub origin: DVec3,
}

/// The shapes of a scene that become objects of their own.
#[derive(Default)]
pub(super) struct Groups {
    /// Nodes by their addresses.
    nodes: HashMap<usize, Node>,
    /// Whether nothing becomes an object, or is shared.
    written_out: bool,
    /// `None` where a shape turned out to be no solid.
    pub made: HashMap<(usize, Inherited), Option<Prototype>>,
    /// Boxes around shapes in their own frames.
    pub extents: HashMap<usize, Aabb>,
}

#[derive(Clone, Copy, Default)]
struct Node {
    /// The solids that it comes to, every use of one counted.
    solids: u64,
    /// How many other nodes, and draws, use it.
    uses: u64,
    /// Those of them that do not place it: in one place it may stand twice.
    bare_uses: u64,
}

/// What a node is known by.
pub(super) fn address(shape: &Shape) -> usize {
    std::ptr::from_ref(&*shape.0) as usize
}

impl Groups {
    /// Of all that is drawn. With `written_out` they are counted, but none becomes an object, unless they are more than
    /// can be written out.
    pub fn of<'a>(draws: impl Iterator<Item = &'a Shape>, written_out: bool) -> Groups {
        let mut groups = Groups::default();
        let all = draws.fold(0u64, |sum, shape| sum.saturating_add(groups.see(shape, true)));
        groups.written_out = written_out && all <= limits::MAX_WRITTEN_OUT;
        groups
    }

    fn see(&mut self, shape: &Shape, bare: bool) -> u64 {
        if let ShapeKind::Leaf { .. } = shape.0.kind {
            return 1;
        }
        let key = address(shape);
        if let Some(known) = self.nodes.get_mut(&key) {
            known.uses += 1;
            known.bare_uses += u64::from(bare);
            return known.solids;
        }
        let bare_below = !matches!(shape.0.kind, ShapeKind::Transform { .. } | ShapeKind::Fit { .. });
        let below = |sum: u64, child: &Shape| sum.saturating_add(deep::step(|| self.see(child, bare_below)));
        let solids = shape.0.kind.children().fold(0, below);
        self.nodes.insert(key, Node { solids, uses: 1, bare_uses: u64::from(bare) });
        solids
    }

    fn node(&self, shape: &Shape) -> Option<&Node> {
        // What has one owner is used once; most have.
        let looked_up = !self.written_out && 1 < Arc::strong_count(&shape.0);
        looked_up.then(|| self.nodes.get(&address(shape))).flatten()
    }

    /// The solids that a shape comes to, every use of one counted.
    pub fn solids(&self, shape: &Shape) -> u64 {
        self.nodes.get(&address(shape)).map_or(1, |node| node.solids)
    }

    /// Whether a shape becomes an object of its own.
    pub fn wants(&self, shape: &Shape) -> bool {
        let Some(Node { solids, uses, .. }) = self.node(shape) else { return false };
        LEAST_SOLIDS <= *solids && LEAST_SAVED <= solids.saturating_mul(uses - 1)
    }

    /// Whether a shape may stand twice in one place.
    pub fn may_repeat(&self, shape: &Shape) -> bool {
        self.node(shape).is_some_and(|node| 1 < node.bare_uses)
    }

    /// Whether a box around the box of a shape will do for one around the shape: of so many solids each would have to be
    /// looked at for each use.
    pub fn is_vast(&self, shape: &Shape) -> bool {
        self.node(shape).is_some_and(|node| 1 < node.uses && VAST < node.solids.saturating_mul(node.uses))
    }
}
