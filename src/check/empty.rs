//! What is drawn and is nothing: no line is ever inside the solid, or meets the sheet.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::Range;

use super::swallowed::swallowed;
use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::prepare::Meeting;
use crate::source::Span;

/// The line of the table.
pub(super) const FINDING: Finding = Finding { code: "W0123", doc: "What is drawn is nothing.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let solids = drawn(evidence).into_iter().chain(sheets(evidence)).map(|at| {
        Diagnostic::warning(FINDING.code, "nothing is left of what is drawn here")
            .at(at, "no test line finds anything")
            .help("look at the sizes and places of its parts: do they meet, does a cutter take all?")
    });
    let meetings = unmet(evidence).into_iter().map(|at| {
        Diagnostic::warning(FINDING.code, "nothing is left of this part of what is drawn")
            .at(at, "no test line finds anything of it")
            .help("look at the sizes and places of its operands: do they meet, are they the same?")
    });
    let clips = clips(evidence).into_iter().map(|at| {
        Diagnostic::warning(FINDING.code, "nothing of what is clipped is inside what clips it")
            .at(at, "no test line finds anything of it")
            .help("move the one to where it meets the other, or leave the clip out")
    });
    solids.chain(meetings).chain(clips).collect()
}

/// Solids drawn that are nothing.
fn drawn(evidence: &Evidence) -> Vec<Span> {
    let seen = &evidence.seen;
    // A difference whose cutters take all has a finding of its own.
    let told: Vec<u32> = swallowed(evidence).map(|(base, _)| base.leaves.start).collect();
    let parts = evidence.outline.parts.iter().zip(0..);
    let empty = parts.filter(|(part, i)| {
        seen.looked_at_parts.contains(i) && !seen.parts.contains(i) && !told.contains(&part.leaves.start)
    });
    empty.map(|(part, _)| part.at).collect()
}

/// Draws of sheets of which none is left.
fn sheets(evidence: &Evidence) -> BTreeSet<Span> {
    let (gone, left) = divided(evidence);
    let left: BTreeSet<Span> = left.into_iter().map(|[drawn, _]| drawn).collect();
    gone.into_iter().map(|[drawn, _]| drawn).filter(|drawn| !left.contains(drawn)).collect()
}

/// Clips that leave nothing of what is drawn with other sheets.
fn clips(evidence: &Evidence) -> BTreeSet<Span> {
    let (gone, left) = divided(evidence);
    let drawn: BTreeSet<Span> = left.iter().map(|[drawn, _]| *drawn).collect();
    let whole: BTreeSet<Span> = left.iter().map(|[_, own]| *own).collect();
    let gone = gone.into_iter().filter(|[at, own]| drawn.contains(at) && !whole.contains(own));
    gone.map(|[_, own]| own).collect()
}

/// The places of sheets of which nothing, and of which something is left.
fn divided(evidence: &Evidence) -> (Vec<[Span; 2]>, Vec<[Span; 2]>) {
    let sheets = evidence.outline.sheets.iter().copied().zip(0..);
    let (gone, left): (Vec<_>, Vec<_>) = sheets.partition(|(_, i)| evidence.seen.gone.contains(i));
    let places = |list: Vec<([Span; 2], u32)>| list.into_iter().map(|(at, _)| at).collect();
    (places(gone), places(left))
}

/// Intersections and symmetric differences that are nothing, the innermost alone; those that stand where another finding
/// says so already are left out: in what is drawn and is nothing, as a cutter, around a base or a shape that is nothing.
fn unmet(evidence: &Evidence) -> BTreeSet<Span> {
    let (seen, outline) = (&evidence.seen, evidence.outline);
    let is_empty = |m: &&Meeting| seen.looked_at.contains(&m.at) && !seen.meetings.contains(&m.at);
    // One of the copies of each.
    let empty: BTreeMap<Span, &Range<u32>> =
        outline.meetings.iter().filter(is_empty).map(|m| (m.at, &m.leaves)).collect();
    let holds = |outer: &Range<u32>, inner: &Range<u32>| outer.start <= inner.start && inner.end <= outer.end;
    let parts = outline.parts.iter().zip(0..).filter(|(_, i)| !seen.parts.contains(i));
    let parts: Vec<&Range<u32>> = parts.map(|(part, _)| &part.leaves).collect();
    let cutters = outline.cuts.iter().flat_map(|cut| &cut.cutters);
    let cutters: HashSet<&Range<u32>> = cutters.map(|cutter| &cutter.leaves).collect();
    let gone: Vec<&Range<u32>> = swallowed(evidence).map(|(base, _)| &base.leaves).collect();
    let is_new = |leaves: &Range<u32>| {
        !cutters.contains(leaves)
            && !parts.iter().any(|part| holds(part, leaves))
            && !gone.iter().any(|base| holds(leaves, base))
            && !empty.values().any(|inner| *inner != leaves && holds(leaves, inner))
            && seen.nothing.range(leaves.clone()).next().is_none()
    };
    empty.iter().filter(|(_, leaves)| is_new(leaves)).map(|(at, _)| *at).collect()
}
