//! Which parts of a prepared world were written where: for those who tell a user about places of the text.

use std::ops::Range;

use crate::csg::Expr;
use crate::geom::Aabb;
use crate::scene::BooleanOp;
use crate::source::Span;

/// The places of a world's solids.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// The solids drawn, in the order written; their union is the world's object.
    pub parts: Vec<Part>,
    /// Whatever takes something away, the outer before the inner.
    pub cuts: Vec<Cutting>,
    /// For each leaf of the world's object the place of the call that made it.
    pub calls: Vec<Span>,
    /// For each sheet of the world the place of what is drawn.
    pub sheets: Vec<Span>,
}

/// A solid drawn.
#[derive(Clone, Debug)]
pub struct Part {
    /// The place of what is drawn.
    pub at: Span,
    /// Its expression over the leaves of the world's object.
    pub expr: Expr,
    /// The leaves it was made of.
    pub leaves: Range<u32>,
    /// A box around it; unbounded where it is.
    pub bounds: Aabb,
}

/// A difference or a complement.
#[derive(Clone, Debug)]
pub struct Cutting {
    /// What is cut; nothing for a complement.
    pub base: Option<Piece>,
    /// What is taken away.
    pub cutters: Vec<Piece>,
}

/// An operand.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its place in the expression that combines it.
    pub at: Span,
    /// The leaves it was made of.
    pub leaves: Range<u32>,
}

impl Outline {
    /// Makes room for what an operator takes away, before that of its operands.
    pub(super) fn begin_cut(&mut self, op: BooleanOp) -> Option<usize> {
        matches!(op, BooleanOp::Difference | BooleanOp::Complement).then(|| {
            self.cuts.push(Cutting { base: None, cutters: Vec::new() });
            self.cuts.len() - 1
        })
    }

    /// Adds an operand.
    pub(super) fn add_to_cut(&mut self, cut: usize, taken: bool, at: Span, leaves: Range<u32>) {
        let (cut, piece) = (&mut self.cuts[cut], Piece { at, leaves });
        match taken {
            true => cut.cutters.push(piece),
            false => cut.base = Some(piece),
        }
    }
}
