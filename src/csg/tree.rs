//! The expression as counters can follow it: n-ary unions, intersections and exclusions over leaves, complements
//! pushed down to the leaves (De Morgan), chains of one operator flattened, what is shared standing once.

use std::collections::HashMap;
use std::sync::Arc;

use super::expr::Expr;
use super::leaf::Leaf;
use super::same::{first_of_same, keep_owners};
use super::stem::Stems;

/// How a node combines its children.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// True where any child is.
    Or,
    /// True where all children are.
    And,
    /// True where an odd number of children are.
    Xor,
}

impl Kind {
    /// Whether one is a union and the other an intersection.
    pub fn is_other(self, kind: Kind) -> bool {
        matches!((self, kind), (Kind::Or, Kind::And) | (Kind::And, Kind::Or))
    }
}

/// The link from a child to a node above it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Up {
    /// The node above.
    pub node: u32,
    /// Whether the child counts where it is false.
    pub negated: bool,
}

impl Up {
    /// There is no node above.
    pub const NONE: Up = Up { node: u32::MAX, negated: false };
    /// There are several.
    const SEVERAL: Up = Up { node: u32::MAX - 1, negated: false };

    /// The only one of some links, if it is.
    fn only(ups: &[Up]) -> Up {
        match ups {
            [] => Up::NONE,
            [one] => *one,
            _ => Up::SEVERAL,
        }
    }

    /// Whether it leads to a node.
    #[inline]
    pub fn is_one(self) -> bool {
        self.node < Up::SEVERAL.node
    }
}

/// A node: its children are known by how many they are, the one on the level below of its stem left out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub kind: Kind,
    pub arity: u32,
}

/// For each of many things a short list, all in one array.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists<T> {
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Clone> Lists<T> {
    /// Of `count` things; each item says which it belongs to, in any order; within one thing the order stays.
    fn new(count: usize, mut items: Vec<(u32, T)>) -> Lists<T> {
        items.sort_by_key(|i| i.0);
        let mut starts = vec![0; count + 1];
        items.iter().for_each(|i| starts[i.0 as usize + 1] += 1);
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        Lists { starts, items: items.into_iter().map(|i| i.1).collect() }
    }

    /// The list of a thing.
    pub fn of(&self, i: usize) -> &[T] {
        &self.items[self.starts[i] as usize..self.starts[i + 1] as usize]
    }
}

/// An object's leaves and the expression over them.
#[derive(Clone, Debug)]
pub struct Tree {
    leaves: Arc<[Leaf]>,
    /// Children before those above them; the root is the last.
    pub(super) nodes: Vec<Node>,
    /// For each node the nodes it counts in.
    pub(super) node_ups: Lists<Up>,
    /// For each leaf the nodes it counts in.
    pub(super) leaf_ups: Lists<Up>,
    /// For each node and each leaf the one node it counts in, where it is one.
    pub(super) node_up: Vec<Up>,
    pub(super) leaf_up: Vec<Up>,
    pub(super) stems: Stems,
    /// For each leaf, whether it is negated on its way to the root; `None` where an exclusion or uses of both kinds
    /// leave that open.
    pub(super) negated: Vec<Option<bool>>,
    /// For each leaf the rank by which it fills ([`keep_owners`]).
    pub(super) last: Vec<u64>,
}

impl Default for Tree {
    fn default() -> Tree {
        Tree::new(Vec::new(), &Expr::Or(Vec::new()))
    }
}

impl Tree {
    /// Builds the counters of an expression. The root is always a node. Of leaves that are the same only the first counts
    /// anywhere.
    pub fn new(leaves: Vec<Leaf>, expr: &Expr) -> Tree {
        let same = first_of_same(&leaves);
        let draft = Draft::new(expr, &same, &leaves);
        let order = draft.order();
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(i, n)| place[*n as usize] = i as u32);
        let (mut node_ups, mut leaf_ups) = (Vec::new(), Vec::new());
        for (i, node) in order.iter().enumerate() {
            for (child, negated) in &draft.nodes[*node as usize].children {
                let up = Up { node: i as u32, negated: *negated };
                match child {
                    Child::Leaf(leaf) => leaf_ups.push((*leaf, up)),
                    Child::Node(node) => node_ups.push((place[*node as usize], up)),
                }
            }
        }
        let node = |n: &u32| {
            let node = &draft.nodes[*n as usize];
            Node { kind: node.kind, arity: node.children.len() as u32 }
        };
        let nodes: Vec<Node> = order.iter().map(node).collect();
        let mut tree = Tree {
            node_ups: Lists::new(nodes.len(), node_ups),
            leaf_ups: Lists::new(leaves.len(), leaf_ups),
            negated: Vec::new(),
            last: draft.last,
            node_up: Vec::new(),
            leaf_up: Vec::new(),
            stems: Stems::default(),
            nodes,
            leaves: leaves.into(),
        };
        tree.node_up = (0..tree.nodes.len()).map(|i| Up::only(tree.node_ups.of(i))).collect();
        tree.leaf_up = (0..tree.leaves.len()).map(|i| Up::only(tree.leaf_ups.of(i))).collect();
        tree.stems = Stems::new(&mut tree.nodes, &tree.node_up);
        tree.negated = tree.senses();
        tree
    }

    /// The leaves.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }

    /// The top of a node's stem.
    #[inline]
    pub(super) fn top(&self, node: usize) -> usize {
        self.stems.of(node).map_or(node, |(stem, _)| stem.top as usize)
    }

    /// For each leaf whether it is negated on its way up.
    fn senses(&self) -> Vec<Option<bool>> {
        // Which senses some way up has: plain, negated, or neither can be told.
        let mut of_nodes = vec![Senses::default(); self.nodes.len()];
        let through = |of_nodes: &[Senses], ups: &[Up]| {
            let way = |up: &Up| match self.nodes[up.node as usize].kind {
                Kind::Xor => Senses { unclear: true, ..Senses::default() },
                _ => of_nodes[up.node as usize].turned(up.negated),
            };
            ups.iter().map(way).fold(Senses::default(), Senses::or)
        };
        if let Some(root) = of_nodes.last_mut() {
            root.plain = true;
        }
        for i in (0..self.nodes.len().saturating_sub(1)).rev() {
            of_nodes[i] = through(&of_nodes, self.node_ups.of(i));
        }
        (0..self.leaves.len()).map(|i| through(&of_nodes, self.leaf_ups.of(i)).clear()).collect()
    }
}

#[derive(Clone, Copy, Default)]
struct Senses {
    plain: bool,
    negated: bool,
    unclear: bool,
}

impl Senses {
    fn turned(self, negated: bool) -> Senses {
        if negated { Senses { plain: self.negated, negated: self.plain, ..self } } else { self }
    }

    fn or(self, o: Senses) -> Senses {
        Senses {
            plain: self.plain || o.plain,
            negated: self.negated || o.negated,
            unclear: self.unclear || o.unclear,
        }
    }

    fn clear(self) -> Option<bool> {
        (!self.unclear && self.plain != self.negated).then_some(self.negated)
    }
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Child {
    Leaf(u32),
    Node(u32),
}

struct Sketch {
    kind: Kind,
    children: Vec<(Child, bool)>,
}

/// Nodes with lists of their children; the root is the first.
struct Draft<'e> {
    nodes: Vec<Sketch>,
    /// What is shared: its node and whether that is its complement.
    shared: HashMap<*const Expr, (u32, bool)>,
    /// Children still to be placed: the expression, whether it is complemented, the node above.
    open: Vec<(&'e Expr, bool, u32)>,
    /// For each leaf the first that is the same.
    same: &'e [u32],
    /// For each leaf the rank by which it fills.
    last: Vec<u64>,
}

impl<'e> Draft<'e> {
    fn new(expr: &'e Expr, same: &'e [u32], leaves: &[Leaf]) -> Draft<'e> {
        let root = Sketch { kind: Kind::Or, children: Vec::new() };
        let (nodes, open) = (vec![root], vec![(expr, false, 0)]);
        let last = leaves.iter().map(|leaf| leaf.rank).collect();
        let mut draft = Draft { nodes, shared: HashMap::new(), open, same, last };
        while let Some((expr, not, above)) = draft.open.pop() {
            draft.place(expr, not, above);
        }
        // A child that stands twice in a union or an intersection counts once.
        for node in draft.nodes.iter_mut().filter(|n| n.kind != Kind::Xor) {
            node.children.sort_unstable();
            node.children.dedup();
        }
        draft.keep_owners(leaves);
        draft
    }

    /// Of leaves alike that stand side by side one is kept.
    fn keep_owners(&mut self, leaves: &[Leaf]) {
        let mut uses = vec![0u32; leaves.len()];
        let children = self.nodes.iter().flat_map(|node| &node.children);
        children.for_each(|(child, _)| {
            if let Child::Leaf(leaf) = child {
                uses[*leaf as usize] += 1;
            }
        });
        for node in self.nodes.iter_mut().filter(|n| n.kind != Kind::Xor) {
            for sense in [false, true] {
                let leaf = |(child, not): &(Child, bool)| match child {
                    Child::Leaf(leaf) if *not == sense && uses[*leaf as usize] == 1 => Some(*leaf),
                    _ => None,
                };
                let mut own: Vec<u32> = node.children.iter().filter_map(leaf).collect();
                keep_owners(leaves, &mut own, &mut self.last);
                let mut kept = own.into_iter().peekable();
                node.children.retain(|child| leaf(child).is_none_or(|l| kept.next_if_eq(&l).is_some()));
            }
        }
    }

    fn place(&mut self, expr: &'e Expr, not: bool, above: u32) {
        match expr {
            Expr::Leaf(i) => {
                self.nodes[above as usize].children.push((Child::Leaf(self.same[*i as usize]), not));
            }
            Expr::Not(inner) => self.open.push((inner, !not, above)),
            Expr::Shared(inner) if 1 < Arc::strong_count(inner) => self.place_shared(inner, not, above),
            Expr::Shared(inner) => self.open.push((inner, not, above)),
            Expr::Or(list) | Expr::And(list) | Expr::Xor(list) => {
                let (kind, inner_not, up_not) = match expr {
                    Expr::Xor(_) => (Kind::Xor, false, not),
                    Expr::Or(_) => (if not { Kind::And } else { Kind::Or }, not, false),
                    _ => (if not { Kind::Or } else { Kind::And }, not, false),
                };
                let merge = self.nodes[above as usize].kind == kind && !up_not;
                let node = if merge { above } else { self.child(kind, above, up_not) };
                self.open.extend(list.iter().rev().map(|e| (e, inner_not, node)));
            }
        }
    }

    /// What is shared has a node of its own, in the sense in which it is written.
    fn place_shared(&mut self, shared: &'e Expr, not: bool, above: u32) {
        if let Some((node, turned)) = self.shared.get(&std::ptr::from_ref(shared)) {
            self.nodes[above as usize].children.push((Child::Node(*node), not != *turned));
            return;
        }
        let (mut expr, mut turned) = (shared, false);
        loop {
            match expr {
                Expr::Not(inner) => (expr, turned) = (&**inner, !turned),
                Expr::Shared(inner) => expr = &**inner,
                _ => break,
            }
        }
        let (kind, list) = match expr {
            Expr::Or(list) => (Kind::Or, list),
            Expr::And(list) => (Kind::And, list),
            Expr::Xor(list) => (Kind::Xor, list),
            // A leaf stands once anyway.
            other => return self.open.push((other, not != turned, above)),
        };
        let node = self.child(kind, above, not != turned);
        self.shared.insert(shared, (node, turned));
        self.open.extend(list.iter().rev().map(|e| (e, false, node)));
    }

    fn child(&mut self, kind: Kind, above: u32, negated: bool) -> u32 {
        self.nodes.push(Sketch { kind, children: Vec::new() });
        let node = self.nodes.len() as u32 - 1;
        self.nodes[above as usize].children.push((Child::Node(node), negated));
        node
    }

    /// All nodes, children first.
    fn order(&self) -> Vec<u32> {
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut known = vec![false; self.nodes.len()];
        // A node and how many of its children have been looked at.
        let mut open = vec![(0u32, 0usize)];
        known[0] = true;
        while let Some((node, next)) = open.pop() {
            let children = &self.nodes[node as usize].children;
            let inner = |c: &(Child, bool)| matches!(c.0, Child::Node(_));
            match children[next..].iter().position(inner) {
                None => order.push(node),
                Some(skip) => {
                    open.push((node, next + skip + 1));
                    if let Child::Node(child) = children[next + skip].0
                        && !std::mem::replace(&mut known[child as usize], true)
                    {
                        open.push((child, 0));
                    }
                }
            }
        }
        order
    }
}
