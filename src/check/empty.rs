//! Solids drawn that are nothing: no line is ever inside them.

use super::swallowed::swallowed;
use super::{Evidence, Finding};
use crate::diag::Diagnostic;

/// The line of the table.
pub(super) const FINDING: Finding = Finding { code: "W0123", doc: "What is drawn is nothing.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let parts = evidence.outline.parts.iter().zip(0..);
    // A difference whose cutters take all has a finding of its own.
    let told: Vec<u32> = swallowed(evidence).map(|(base, _)| base.leaves.start).collect();
    let empty =
        parts.filter(|(part, i)| !evidence.seen.parts.contains(i) && !told.contains(&part.leaves.start));
    let warn = |(part, _): (&crate::prepare::Part, u32)| {
        Diagnostic::warning(FINDING.code, "nothing is left of what is drawn here")
            .at(part.at, "no test line finds anything")
            .help("look at the sizes and places of its parts: do they meet, does a cutter take all?")
    };
    empty.map(warn).collect()
}
