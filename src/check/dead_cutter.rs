//! Cutters that take nothing away: on no line does what is drawn change without them.

use std::collections::BTreeMap;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;

/// The line of the table.
pub(super) const FINDING: Finding = Finding { code: "W0122", doc: "A cutter cuts nothing.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let mut dead = BTreeMap::new();
    for cut in &evidence.outline.cuts {
        // A base that is nothing, or of which nothing is left: those are other findings.
        let base = cut.base.as_ref().map(|b| b.at);
        if base.is_some_and(|b| !evidence.seen.left.contains(&b)) {
            continue;
        }
        let seen = &evidence.seen;
        let idle =
            cut.cutters.iter().filter(|c| !seen.cutting.contains(&c.at) && seen.looked_at.contains(&c.at));
        dead.extend(idle.map(|c| (c.at, base)));
    }
    // Where several cut the same, each could be left out, but not all: the first stays.
    for alike in &evidence.seen.alike {
        if alike.iter().all(|at| dead.contains_key(at)) {
            dead.remove(&alike[0]);
        }
    }
    let warn = |(at, base)| {
        let warning =
            Diagnostic::warning(FINDING.code, "this cutter cuts nothing").at(at, "takes nothing away");
        let warning = match base {
            Some(base) => warning.at(base, "from this"),
            None => warning,
        };
        warning.help("move it to where it meets what it shall cut, or leave it out")
    };
    dead.into_iter().map(warn).collect()
}
