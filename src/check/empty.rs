//! What is drawn and is nothing: no line is ever inside the solid, or meets the sheet.

use super::swallowed::swallowed;
use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::source::Span;

/// The line of the table.
pub(super) const FINDING: Finding = Finding { code: "W0123", doc: "What is drawn is nothing.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let seen = &evidence.seen;
    let parts = evidence.outline.parts.iter().zip(0..);
    // A difference whose cutters take all has a finding of its own.
    let told: Vec<u32> = swallowed(evidence).map(|(base, _)| base.leaves.start).collect();
    let empty = parts.filter(|(part, i)| {
        seen.looked_at_parts.contains(i) && !seen.parts.contains(i) && !told.contains(&part.leaves.start)
    });
    let mut places: Vec<Span> = empty.map(|(part, _)| part.at).collect();
    let sheets = &evidence.outline.sheets;
    let is_left =
        |at: &Span| sheets.iter().zip(0..).any(|(s, i)| s == at && !evidence.seen.gone.contains(&i));
    let mut open: Vec<Span> = evidence.seen.gone.iter().map(|i| sheets[*i as usize]).collect();
    open.dedup();
    places.extend(open.into_iter().filter(|at| !is_left(at)));
    let warn = |at: Span| {
        Diagnostic::warning(FINDING.code, "nothing is left of what is drawn here")
            .at(at, "no test line finds anything")
            .help("look at the sizes and places of its parts: do they meet, does a cutter take all?")
    };
    places.into_iter().map(warn).collect()
}
