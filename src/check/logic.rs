//! The expression of everything drawn as a table: which nodes hold for given leaves, and which of them tell.
//!
//! A node tells where the solid drawn that it belongs to would change with it: in an intersection
//! where all others do, among what is taken away together where nothing else holds, else always.

use std::collections::HashMap;

use crate::csg::Expr;
use crate::prepare::{Meeting, Outline, Piece};

/// How a node combines those below it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Leaf(u32),
    Not,
    Or,
    And,
    Xor,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub kind: Kind,
    /// The node above; its own index at the top of a solid drawn.
    pub above: u32,
    below: u32,
    /// First leaf, and one past the last.
    leaves: (u32, u32),
    /// Whether it is the first below its parent.
    first: bool,
}

/// A difference or a complement by its nodes; a part without leaves has none.
#[derive(Clone, Debug)]
pub(super) struct CutNodes {
    pub base: Option<u32>,
    pub cutters: Vec<Option<u32>>,
    /// The nodes of shapes that cutters are unions of, each with its cutter.
    pub shapes: Vec<(u32, usize)>,
}

/// The table.
#[derive(Debug)]
pub(super) struct Logic {
    /// Each after the one above it.
    pub nodes: Vec<Node>,
    /// The top node of each solid drawn.
    pub parts: Vec<u32>,
    /// As in the outline.
    pub cuts: Vec<CutNodes>,
    /// As in the outline.
    pub meetings: Vec<Option<u32>>,
}

/// What holds, and what tells, for some leaves.
#[derive(Debug, Default)]
pub(super) struct State {
    count: Vec<u32>,
    /// For each node whether it holds.
    pub holds: Vec<bool>,
    /// For each node whether it tells.
    pub tells: Vec<bool>,
}

impl Logic {
    /// Reads the expressions; iterative, as they may be deep.
    pub fn new(outline: &Outline) -> Logic {
        let mut nodes: Vec<Node> = Vec::new();
        let mut parts = Vec::new();
        for part in &outline.parts {
            parts.push(nodes.len() as u32);
            let mut open: Vec<(&Expr, u32, bool)> = vec![(&part.expr, nodes.len() as u32, true)];
            while let Some((expr, above, first)) = open.pop() {
                let at = nodes.len() as u32;
                let (kind, below): (Kind, &[Expr]) = match expr {
                    Expr::Leaf(i) => (Kind::Leaf(*i), &[]),
                    Expr::Shared(inner) => (Kind::Or, std::slice::from_ref(&**inner)),
                    Expr::Not(inner) => (Kind::Not, std::slice::from_ref(&**inner)),
                    Expr::Or(list) => (Kind::Or, list),
                    Expr::And(list) => (Kind::And, list),
                    Expr::Xor(list) => (Kind::Xor, list),
                };
                nodes.push(Node { kind, above, below: below.len() as u32, leaves: (u32::MAX, 0), first });
                open.extend(below.iter().enumerate().rev().map(|(i, e)| (e, at, i == 0)));
            }
        }
        for i in (0..nodes.len()).rev() {
            if let Kind::Leaf(leaf) = nodes[i].kind {
                nodes[i].leaves = (leaf, leaf + 1);
            }
            let (own, above) = (nodes[i].leaves, nodes[i].above as usize);
            let sum = &mut nodes[above].leaves;
            *sum = (sum.0.min(own.0), sum.1.max(own.1));
        }
        let mut logic = Logic { nodes, parts, cuts: Vec::new(), meetings: Vec::new() };
        logic.find_cuts(outline);
        logic.find_meetings(outline);
        logic
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Finds the operands of the outline by their leaves: bases are the first below an intersection, cutters stand in a
    /// union under a complement. Several with the same leaves are nested, and come in the same order here and there.
    fn find_cuts(&mut self, outline: &Outline) {
        let (mut bases, mut cutters) = (HashMap::new(), HashMap::new());
        for (i, node) in self.nodes.iter().enumerate().filter(|(i, n)| n.above as usize != *i) {
            let above = self.nodes[node.above as usize];
            let list: &mut HashMap<(u32, u32), Vec<u32>> = match above.kind {
                Kind::And if node.first => &mut bases,
                Kind::Or if self.nodes[above.above as usize].kind == Kind::Not => &mut cutters,
                _ => continue,
            };
            list.entry(node.leaves).or_default().push(i as u32);
        }
        for list in bases.values_mut().chain(cutters.values_mut()) {
            list.reverse();
        }
        let take = |from: &mut HashMap<(u32, u32), Vec<u32>>, piece: &Piece| {
            from.get_mut(&(piece.leaves.start, piece.leaves.end)).and_then(Vec::pop)
        };
        for cut in &outline.cuts {
            let base = cut.base.as_ref().and_then(|b| take(&mut bases, b));
            let cutters = cut.cutters.iter().map(|c| take(&mut cutters, c)).collect();
            self.cuts.push(CutNodes { base, cutters, shapes: Vec::new() });
        }
        self.find_shapes();
    }

    /// Finds the shapes that cutters are unions of: leaves with nothing but unions above them up to the cutter.
    fn find_shapes(&mut self) {
        let cutters = self.cuts.iter().enumerate().flat_map(|(k, cut)| {
            cut.cutters.iter().enumerate().filter_map(move |(j, node)| Some(((*node)?, (k, j))))
        });
        let mut cutter_of: HashMap<u32, (usize, usize)> = cutters.collect();
        // Each node stands after the one above it.
        for (i, node) in (0..).zip(&self.nodes) {
            if let (Kind::Or, Some(cutter)) =
                (self.nodes[node.above as usize].kind, cutter_of.get(&node.above))
            {
                let cutter = *cutter;
                cutter_of.entry(i).or_insert(cutter);
            }
            if let (Kind::Leaf(_), Some((cut, cutter))) = (node.kind, cutter_of.get(&i)) {
                self.cuts[*cut].shapes.push((i, *cutter));
            }
        }
    }

    /// The leaf of a node that is one.
    pub fn leaf(&self, node: u32) -> u32 {
        self.nodes[node as usize].leaves.0
    }

    /// Finds intersections and symmetric differences by their leaves: of several nodes with the same leaves each holds where
    /// the others do, one operand of one being the whole other.
    fn find_meetings(&mut self, outline: &Outline) {
        let met = self.nodes.iter().zip(0..).filter(|(n, _)| matches!(n.kind, Kind::And | Kind::Xor));
        let known: HashMap<(u32, u32), u32> = met.map(|(node, i)| (node.leaves, i)).collect();
        let node = |m: &Meeting| known.get(&(m.leaves.start, m.leaves.end)).copied();
        self.meetings = outline.meetings.iter().map(node).collect();
    }

    /// Whether a union is what a difference or a complement takes away.
    fn is_taken_away(&self, union: usize) -> bool {
        let above = self.nodes[union].above as usize;
        above != union && self.nodes[above].kind == Kind::Not
    }

    /// Says what holds and what tells where these leaves are inside.
    pub fn evaluate(&self, inside: &[bool], state: &mut State) {
        let State { count, holds, tells } = state;
        count.clear();
        count.resize(self.nodes.len(), 0);
        holds.resize(self.nodes.len(), false);
        tells.resize(self.nodes.len(), false);
        for (i, node) in self.nodes.iter().enumerate().rev() {
            holds[i] = match node.kind {
                Kind::Leaf(leaf) => inside[leaf as usize],
                Kind::Not => count[i] == 0,
                Kind::Or => 0 < count[i],
                Kind::And => count[i] == node.below,
                Kind::Xor => count[i] % 2 == 1,
            };
            if node.above as usize != i {
                count[node.above as usize] += u32::from(holds[i]);
            }
        }
        for (i, node) in self.nodes.iter().enumerate() {
            let above = node.above as usize;
            let others = count[above] - u32::from(above != i && holds[i]);
            tells[i] = above == i
                || tells[above]
                    && match self.nodes[above].kind {
                        // Of operands of a union each tells for itself: a part may be cut so that another fills it.
                        Kind::Or => others == 0 || !self.is_taken_away(above),
                        Kind::And => others + 1 == self.nodes[above].below,
                        _ => true,
                    };
        }
    }
}
