//! What methods change about a leaf: holes closed, a thickness given, the boundary moved. Methods of a combination are
//! handed down to its leaves where set algebra allows it.

use std::sync::Arc;

use glam::DAffine3;

use super::build::{Builder, ScanId};
use crate::diag::Diagnostic;
use crate::geom::Placement;
use crate::scene::BooleanOp;
use crate::solid::Solid;
use crate::source::Span;

/// A change.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Change {
    /// Holes up to so wide are capped.
    Close(f64),
    /// A thickness.
    Thicken(f64),
    /// The boundary moves outward, below zero inward.
    Move(f64),
}

/// A change, where it was written, and in which frame its length is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edit {
    /// The change.
    pub change: Change,
    /// The frame of its length.
    pub frame: DAffine3,
    /// Whether an odd number of complements stands above it.
    pub turned: bool,
    /// The place of the method.
    pub at: Span,
}

/// An edit and those outside it.
pub(super) struct Edits<'a> {
    /// The innermost.
    pub edit: Edit,
    /// The rest.
    pub outer: Option<&'a Edits<'a>>,
}

/// All of them, the innermost first.
pub(super) fn edits<'a>(first: Option<&'a Edits<'a>>) -> impl Iterator<Item = &'a Edit> {
    std::iter::successors(first, |e| e.outer).map(|e| &e.edit)
}

/// What a leaf has become after some edits.
pub(super) enum Stage {
    /// Nothing to measure any more.
    Exact(Arc<dyn Solid>),
    /// A scan as it stands.
    Scan(ScanId),
    /// A scan to be closed as this edit says.
    Closed(ScanId, Closing),
}

/// A `.close` with its length in the scan's own units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closing {
    /// The widest hole, own units.
    pub max_hole: f64,
    /// Length of the frame it is written in per own unit.
    pub scale: f64,
    /// Its place.
    pub at: Span,
}

/// An edit in the frame of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    /// The change, own units.
    pub change: Change,
    /// Length of the frame it is written in per own unit.
    pub scale: f64,
    /// Its place.
    pub at: Span,
}

impl Edit {
    /// The edit in the frame of a leaf that `map` takes to its own; `turned` as for the leaf.
    pub fn in_frame(&self, map: &DAffine3, turned: bool) -> Result<Local, Diagnostic> {
        let scale = mean_scale(map);
        let change = match self.change {
            Change::Close(max_hole) => Change::Close(max_hole / scale),
            Change::Thicken(by) => Change::Thicken(by / scale),
            Change::Move(by) => Change::Move(if turned == self.turned { by } else { -by } / scale),
        };
        let keeps_lengths = Placement::new(*map).is_some_and(|p| p.condition <= SIMILAR);
        if !keeps_lengths && !matches!(self.change, Change::Close(_)) {
            let told = "no exact offset: the shape is scaled differently along different axes";
            return Err(Diagnostic::error("E0307", told)
                .at(self.at, "")
                .help("call the method before the `.scale`: `shape.inset(1mm).scale([1, 2, 5])`"));
        }
        Ok(Local { change, scale, at: self.at })
    }

    /// Whether the edit may be handed down to the operands: the points nearer to a union than d are those nearer to one
    /// of its operands, and the points farther than d from the outside of an intersection those that are so for all.
    pub fn check_through(&self, op: BooleanOp, turned: bool, at: Span) -> Result<(), Diagnostic> {
        let combination = "this is a combination of shapes";
        let grows = match self.change {
            Change::Close(_) => {
                let error = Diagnostic::error("E0304", "only a scan has holes to close").at(self.at, "");
                return Err(error.at(at, combination).help("close the scan before combining it"));
            }
            Change::Thicken(_) if op == BooleanOp::Union => return Ok(()),
            Change::Thicken(_) => return Err(self.has_inside()),
            Change::Move(by) => (0.0 < by) == (turned == self.turned),
        };
        let passes = match op {
            BooleanOp::Complement => true,
            BooleanOp::Union => grows,
            BooleanOp::Intersection | BooleanOp::Difference => !grows,
            BooleanOp::Xor => false,
        };
        if passes {
            return Ok(());
        }
        let word = self.word();
        let told =
            format!("no exact offset: `.{word}` of a combination by `{}` has another shape", op.sign());
        let error = Diagnostic::error("E0307", told).at(self.at, "").at(at, combination);
        Err(error.help(format!(
            "call `.{word}` on the operands; `.inset` passes through `&` and `-`, `.offset` through `|`"
        )))
    }

    fn has_inside(&self) -> Diagnostic {
        has_inside(self.at)
    }

    fn word(&self) -> &'static str {
        match self.change {
            Change::Close(_) => "close",
            Change::Thicken(_) => "thicken",
            Change::Move(by) if by < 0.0 => "inset",
            Change::Move(_) => "offset",
        }
    }
}

impl Builder<'_> {
    /// Carries out an edit on a leaf. Errors are located.
    pub fn edit(&mut self, stage: Stage, edit: &Local, name: &str) -> Result<Stage, Diagnostic> {
        let Local { change, scale, at } = *edit;
        match (stage, change) {
            (Stage::Scan(id), Change::Close(max_hole)) => Ok(Stage::Closed(id, Closing { max_hole, scale, at })),
            (closed @ Stage::Closed(..), Change::Close(_)) => Ok(closed),
            (Stage::Exact(_), Change::Close(_)) => Err(Diagnostic::error("E0304", "only a scan has holes to close")
                .at(at, "this is none")
                .help("remove the `.close`; an open mesh is given an inside by `.thicken(2mm)`")),
            (Stage::Scan(id), Change::Thicken(by)) => Ok(Stage::Exact(self.thickened(id, by))),
            (Stage::Closed(..), Change::Thicken(_)) => Err(has_inside(at)),
            (Stage::Exact(solid), Change::Thicken(by)) => {
                solid.thickened(by).map(Stage::Exact).ok_or_else(|| has_inside(at))
            }
            (Stage::Exact(solid), Change::Move(by)) => match solid.moved(by) {
                Ok(Some(moved)) => Ok(Stage::Exact(moved)),
                Ok(None) => Err(nothing_left(at, by * scale)),
                Err(why) => Err(Diagnostic::error("E0307", format!("no exact offset: {why}"))
                    .at(at, "")
                    .help("write the shape with other sizes, or move samples of it: `points(shape, samples: 20000).offset(1mm)`")),
            },
            (Stage::Scan(id), Change::Move(by)) => self.moved(id, None, by, scale, at, name).map(Stage::Scan),
            (Stage::Closed(id, close), Change::Move(by)) => {
                let closed = self.close(id, &close)?;
                self.moved(id, Some(closed), by, scale, at, name).map(Stage::Scan)
            }
        }
    }

    /// A scan closed, or the error that a hole is too wide.
    pub fn close(
        &mut self,
        id: ScanId,
        close: &Closing,
    ) -> Result<Arc<crate::solid::point_set::PointSet>, Diagnostic> {
        let Closing { max_hole, scale, at } = *close;
        self.closed(id, max_hole).map_err(|widest| too_wide(at, max_hole * scale, widest * scale))
    }
}

fn has_inside(at: Span) -> Diagnostic {
    Diagnostic::error("E0308", "only an open surface is given a thickness")
        .at(at, "this has an inside already")
        .help("for a hollow solid, write `solid - solid.inset(2mm)`")
}

/// The error that an inset leaves nothing.
pub(super) fn nothing_left(at: Span, by: f64) -> Diagnostic {
    Diagnostic::error("E0309", format!("nothing is left {:.3} inside the boundary", by.abs()))
        .at(at, "too large for this shape")
        .help("write a smaller length")
}

fn too_wide(at: Span, max_hole: f64, widest: f64) -> Diagnostic {
    Diagnostic::error(
        "E0303",
        format!("the scan has a hole {widest:.3} wide, wider than the {max_hole} allowed"),
    )
    .at(at, "")
    .help(format!("write `.close(max_hole: {})` if that hole shall be capped too", round_up(widest) as f32))
}

/// Two significant digits, upward.
fn round_up(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    (x / unit).ceil() * unit
}

/// A map of at most this condition keeps shapes: a composition of rotations and uniform scales.
const SIMILAR: f64 = 1.0 + 64.0 * f64::EPSILON;

/// How much a map stretches lengths: exactly so for similarities, on average for others.
fn mean_scale(map: &DAffine3) -> f64 {
    map.matrix3.determinant().abs().cbrt()
}
