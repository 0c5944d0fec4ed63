//! Bases of which nothing is left: cutters hold wherever the base does.

use std::collections::BTreeMap;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::prepare::{Cutting, Piece};

/// The line of the table.
pub(super) const FINDING: Finding =
    Finding { code: "W0124", doc: "The base of a difference lies wholly inside its cutters.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let mut gone = BTreeMap::new();
    for (base, cut) in swallowed(evidence) {
        let whole = cut.cutters.iter().find(|c| !evidence.seen.uncovering.contains(&c.at));
        gone.insert(base.at, whole.map(|c| c.at));
    }
    let warn = |(base, cutter)| {
        let warning = Diagnostic::warning(FINDING.code, "nothing is left of the base of this difference");
        match cutter {
            Some(cutter) => warning
                .at(base, "lies wholly inside the cutter")
                .at(cutter, "this one")
                .help("make the cutter smaller or move it; what both hold is written `a & b`"),
            None => warning
                .at(base, "lies wholly inside the cutters together")
                .help("make the cutters smaller or move them; what all hold is written `a & b`"),
        }
    };
    gone.into_iter().map(warn).collect()
}

/// Bases of which nothing is left, and what cuts them.
pub(super) fn swallowed<'a>(evidence: &'a Evidence) -> impl Iterator<Item = (&'a Piece, &'a Cutting)> {
    let seen = &evidence.seen;
    let cuts = evidence.outline.cuts.iter();
    let bases = cuts.filter_map(|cut| Some((cut.base.as_ref()?, cut)));
    let told = |base: &Piece| seen.looked_at.contains(&base.at) && !seen.left.contains(&base.at);
    bases.filter(move |(base, _)| seen.bases.contains(&base.at) && told(base))
}
