//! The expression that combines leaves, as counters can follow it: n-ary unions, intersections and exclusions over
//! leaves, complements pushed down to the leaves (De Morgan), chains of one operator flattened.

use std::sync::Arc;

use crate::geom::{Aabb, Interval, Placement, Ray, tolerance};
use crate::solid::Solid;

/// A solid, placed, as an operand.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// The solid in its own frame.
    pub solid: Arc<dyn Solid>,
    /// Where it stands.
    pub place: Placement,
    /// A world box around its boundary; unbounded where the solid is.
    pub bounds: Aabb,
    /// Its name, as the scene calls it.
    pub name: Arc<str>,
    /// Its own material, an index that CSG does not interpret.
    pub material: Option<u32>,
    /// Whether it is taken away from something: its faces are cuts.
    pub cutter: bool,
    /// The source position of the call that made it: earlier calls own shared faces.
    pub rank: u64,
}

impl Leaf {
    /// Places a solid; name, material, cutter and rank are set by the caller.
    pub fn new(solid: Arc<dyn Solid>, place: Placement) -> Leaf {
        let bounds = solid.bounds().transformed(&place.world_from_local);
        Leaf { solid, place, bounds, name: "".into(), material: None, cutter: false, rank: 0 }
    }

    /// The largest length of the leaf that enters its rounding errors: its size and its distance from the world's
    /// origin.
    pub fn scale(&self) -> f64 {
        let reach = if self.bounds.is_finite() && !self.bounds.is_empty() {
            self.bounds.min.abs().max(self.bounds.max.abs()).max_element()
        } else {
            0.0
        };
        reach.max(self.place.offset())
    }

    /// The part of a ray's line that can meet the leaf. Box and crossings are rounded apart, each by as much as two
    /// faces that were one; so the box is grown by what the clean-up takes for nothing, and more where the frame
    /// is skewed.
    pub fn met(&self, ray: &Ray) -> Interval {
        let scale = self.scale().max(ray.origin.length());
        self.bounds.inflated(tolerance::cleanup(scale) * self.place.condition).clip(ray)
    }

    /// Who owns a face that several leaves share: the smallest key.
    pub fn key(&self) -> (bool, bool, u64) {
        (self.material.is_none(), self.cutter, self.rank)
    }
}

/// A set expression over leaves.
#[derive(Clone, Debug)]
pub enum Expr {
    /// A leaf, by its index.
    Leaf(u32),
    /// Points not in it.
    Not(Box<Expr>),
    /// Points in any; nothing where there are none.
    Or(Vec<Expr>),
    /// Points in all; must not be empty.
    And(Vec<Expr>),
    /// Points in an odd number.
    Xor(Vec<Expr>),
}

/// How a node combines its children.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// True where any child is.
    Or,
    /// True where all children are.
    And,
    /// True where an odd number of children are.
    Xor,
}

/// The link from a child to the node above it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Up {
    /// The node above; 0 is the root.
    pub node: u32,
    /// Whether the child counts where it is false.
    pub negated: bool,
}

/// A node: its children are known by how many they are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub kind: Kind,
    pub arity: u32,
    pub up: Option<Up>,
}

/// An object: leaves and the expression over them.
#[derive(Clone, Debug)]
pub struct Tree {
    leaves: Vec<Leaf>,
    pub(super) nodes: Vec<Node>,
    /// For each leaf the nodes it counts in.
    pub(super) ups: Vec<Vec<Up>>,
    /// For each leaf, whether it is negated on its way to the root; `None` where an exclusion or several uses
    /// leave that open.
    pub(super) negated: Vec<Option<bool>>,
}

impl Default for Tree {
    fn default() -> Tree {
        Tree::new(Vec::new(), &Expr::Or(Vec::new()))
    }
}

impl Tree {
    /// Builds the counters of an expression. The root is always a node.
    pub fn new(leaves: Vec<Leaf>, expr: &Expr) -> Tree {
        let ups = vec![Vec::new(); leaves.len()];
        let negated = vec![None; leaves.len()];
        let mut tree = Tree { leaves, nodes: Vec::new(), ups, negated };
        tree.nodes.push(Node { kind: Kind::Or, arity: 0, up: None });
        let mut used = vec![0u32; tree.leaves.len()];
        // A child still to be placed: its expression, whether it is complemented, the node above, and whether the
        // way up has a sense.
        let mut open: Vec<(&Expr, bool, u32, bool)> = vec![(expr, false, 0, true)];
        while let Some((expr, not, above, sense)) = open.pop() {
            match expr {
                Expr::Leaf(i) => {
                    let i = *i as usize;
                    tree.ups[i].push(Up { node: above, negated: not });
                    tree.nodes[above as usize].arity += 1;
                    used[i] += 1;
                    tree.negated[i] = (used[i] == 1 && sense).then_some(not);
                }
                Expr::Not(inner) => open.push((inner, !not, above, sense)),
                Expr::Or(list) | Expr::And(list) | Expr::Xor(list) => {
                    let (kind, inner_not, up_not) = match expr {
                        Expr::Xor(_) => (Kind::Xor, false, not),
                        Expr::Or(_) => (if not { Kind::And } else { Kind::Or }, not, false),
                        _ => (if not { Kind::Or } else { Kind::And }, not, false),
                    };
                    let merge = tree.nodes[above as usize].kind == kind && !up_not;
                    let node = if merge { above } else { tree.child(kind, above, up_not) };
                    let sense = sense && kind != Kind::Xor;
                    open.extend(list.iter().rev().map(|e| (e, inner_not, node, sense)));
                }
            }
        }
        tree
    }

    fn child(&mut self, kind: Kind, above: u32, negated: bool) -> u32 {
        self.nodes[above as usize].arity += 1;
        self.nodes.push(Node { kind, arity: 0, up: Some(Up { node: above, negated }) });
        self.nodes.len() as u32 - 1
    }

    /// The leaves.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }
}
