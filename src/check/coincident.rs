//! Pairs of faces that coincide over an area: a line that meets one meets the other, within what rounding can tell.

use std::collections::BTreeSet;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;

/// The line of the table.
pub(super) const FINDING: Finding = Finding { code: "W0121", doc: "Faces of two shapes coincide.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let calls = &evidence.outline.calls;
    let place = |(a, b): &(u32, u32)| {
        let (a, b) = (calls[*a as usize], calls[*b as usize]);
        (a.min(b), a.max(b))
    };
    let name = |at| {
        let leaf = calls.iter().position(|c| *c == at);
        leaf.map_or("", |i| &*evidence.leaves[i].name)
    };
    // Faces that leave a film have a finding of their own.
    let seen = &evidence.seen;
    let shared = seen.shared.iter().filter(|(_, near)| near.is_area()).map(|(pair, _)| pair);
    let shared = shared.filter(|pair| !seen.films.contains_key(pair));
    let pairs: BTreeSet<_> = shared.map(place).collect();
    let tell = |(a, b)| match a == b {
        true => Diagnostic::remark(FINDING.code, format!("faces of copies of `{}` coincide", name(a)))
            .at(a, "these")
            .help(
                "copies that touch are one solid; a copy that shall cut through another must stand out of it",
            ),
        false => Diagnostic::remark(
            FINDING.code,
            format!("faces of `{}` and `{}` coincide", name(a), name(b)),
        )
        .at(b, "this one")
        .at(a, "and this one")
        .help(
            "nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts",
        ),
    };
    pairs.into_iter().map(tell).collect()
}
