//! Which parts of a prepared world were written where: for those who tell a user about places of the text.

use std::ops::Range;
use std::sync::Arc;

use crate::csg::{Expr, Object};
use crate::geom::Aabb;
use crate::scene::BooleanOp;
use crate::source::Span;

/// The places of a world's solids.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// A box around all that is drawn, as `.fit` takes it; unbounded where anything is.
    pub extent: Aabb,
    /// The solids drawn, in the order written; their union is the world's object.
    pub parts: Vec<Part>,
    /// Whatever takes something away, the outer before the inner.
    pub cuts: Vec<Cutting>,
    /// For each leaf of the world's object the place of the call that made it.
    pub calls: Vec<Span>,
    /// Intersections and symmetric differences of two or more, the inner before the outer.
    pub meetings: Vec<Meeting>,
    /// For each sheet of the world the place of what is drawn, and that of its call or of what it is clipped by.
    pub sheets: Vec<[Span; 2]>,
    /// The solids of `.clip`, which stand in sheets: what is clipped and what clips, each with its own places.
    pub inner: Vec<(Arc<Object>, Outline)>,
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
    /// The material that light goes through in it, where it does.
    pub clear: Option<u32>,
}

/// A difference or a complement.
#[derive(Clone, Debug)]
pub struct Cutting {
    /// What is cut; nothing for a complement.
    pub base: Option<Piece>,
    /// What is taken away.
    pub cutters: Vec<Piece>,
}

/// An intersection or a symmetric difference.
#[derive(Clone, Debug)]
pub struct Meeting {
    /// Its place.
    pub at: Span,
    /// The leaves it was made of.
    pub leaves: Range<u32>,
    /// Leaves that meet where anything of it is: those of the first operand and of the others, or all and all.
    pub sides: [Range<u32>; 2],
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
    /// That of an object which is one solid.
    pub(super) fn of_one(mut self, at: Span, expr: &Expr, bounds: Aabb) -> Outline {
        let leaves = 0..self.calls.len() as u32;
        self.parts = vec![Part { at, expr: expr.clone(), leaves, bounds, clear: None }];
        self
    }

    /// Keeps a solid of `.clip`, unless it is known from another copy.
    pub(super) fn add_inner(&mut self, object: &Arc<Object>, outline: Outline) {
        let at = |outline: &Outline| outline.parts.first().map(|part| part.at);
        if self.inner.iter().all(|(_, known)| at(known) != at(&outline)) {
            self.inner.push((object.clone(), outline));
        }
    }

    /// Makes room for what an operator takes away, before that of its operands.
    pub(super) fn begin_cut(&mut self, op: BooleanOp) -> Option<usize> {
        matches!(op, BooleanOp::Difference | BooleanOp::Complement).then(|| {
            self.cuts.push(Cutting { base: None, cutters: Vec::new() });
            self.cuts.len() - 1
        })
    }

    /// Adds what is where its operands meet, or differ: where the leaves of the first begin and end, and where those of all do.
    pub(super) fn add_meeting(&mut self, op: BooleanOp, at: Span, [first, middle, last]: [u32; 3]) {
        let (leaves, rest) = (first..last, middle..last);
        match op {
            BooleanOp::Intersection => {
                self.meetings.push(Meeting { at, leaves, sides: [first..middle, rest] })
            }
            BooleanOp::Xor => {
                let sides = [leaves.clone(), leaves.clone()];
                self.meetings.push(Meeting { at, leaves, sides })
            }
            _ => {}
        }
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
