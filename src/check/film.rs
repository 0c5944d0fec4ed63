//! Shapes thinner than rounding can tell: what they add or take away is dropped by the clean-up of set algebra.

use std::collections::BTreeSet;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;

/// The line of the table.
pub(super) const FINDING: Finding =
    Finding { code: "W0125", doc: "A shape is thinner than rounding can tell, and is dropped.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let place = |leaf: &u32| (evidence.outline.calls[*leaf as usize], *leaf);
    let mut told = BTreeSet::new();
    let films: BTreeSet<_> = evidence.seen.films.iter().map(place).collect();
    let films = films.into_iter().filter(|(at, _)| told.insert(*at));
    let warn = |(at, leaf): (_, u32)| {
        let name = &evidence.leaves[leaf as usize].name;
        let told = format!("`{name}` is thinner than rounding can tell so far from the origin");
        Diagnostic::warning(FINDING.code, told)
            .at(at, "dropped where it is so thin")
            .help("make it thicker, or build the scene nearer to the origin")
    };
    films.map(warn).collect()
}
