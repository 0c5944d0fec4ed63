//! What may be wrong with the geometry of a scene that can be rendered: faces that coincide, cutters that cut nothing,
//! shapes that come to nothing, solids drawn into each other. Found by test lines, as a picture is; nothing is rendered.
//!
//! [`lines`] chooses the lines, [`logic`] says what a line's leaves mean, [`evidence`] gathers what the lines saw; each
//! finding is one file and one line of [`FINDINGS`]. What test lines do not see is not told: a finding that says "no
//! line" is as good as the lines are many, all others are certain.

mod closer;
mod coincident;
mod dead_cutter;
mod empty;
mod endless;
mod evidence;
mod extents;
mod film;
mod flush;
mod lines;
mod logic;
mod overlap;
mod seen;
mod summit;
mod swallowed;
mod unseen;
mod witness;

use crate::diag::Diagnostic;
use crate::prepare::Outline;
use crate::shot::Shot;

pub use evidence::Evidence;

/// A kind of finding.
#[derive(Clone, Copy, Debug)]
pub struct Finding {
    /// The code of its warnings.
    pub code: &'static str,
    /// One sentence.
    pub doc: &'static str,
    /// Its warnings, in the order of the text.
    pub find: fn(&Evidence) -> Vec<Diagnostic>,
}

/// All kinds.
pub const FINDINGS: &[Finding] = &[
    coincident::FINDING,
    dead_cutter::FINDING,
    empty::FINDING,
    swallowed::FINDING,
    film::FINDING,
    overlap::FINDING,
    unseen::FINDING,
];

/// Warnings of one kind that are told; the rest is counted.
const MOST: usize = 20;

/// Looks at all solids of a shot, those of `.clip` too; warnings in the order of the table.
pub fn findings(shot: &Shot, outline: &Outline) -> Vec<Diagnostic> {
    let (world, eye) = (&shot.world, shot.camera.eye().length());
    let mut objects = vec![(world.solids(), outline, world.open())];
    let mut next = 0;
    while let Some((_, outline, _)) = objects.get(next).copied() {
        objects.extend(outline.inner.iter().map(|(object, own)| (&**object, own, &[][..])));
        next += 1;
    }
    let gather = |(object, outline, sheets)| Evidence::gather(object, outline, sheets, eye);
    let evidence: Vec<Evidence> = objects.into_iter().map(gather).collect();
    let mut all = Vec::new();
    for finding in FINDINGS {
        let mut found: Vec<Diagnostic> = evidence.iter().flat_map(finding.find).collect();
        let more = found.len().saturating_sub(MOST);
        found.truncate(MOST);
        if let (1.., Some(last)) = (more, found.last_mut()) {
            last.notes.push(format!("and {more} more of {}", finding.code));
        }
        all.append(&mut found);
    }
    all
}
