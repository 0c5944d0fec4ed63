//! Shapes that are nothing: of thousands of lines through their own bounds none is ever inside them.

use std::collections::BTreeMap;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;

/// The line of the table.
pub(super) const FINDING: Finding =
    Finding { code: "W0127", doc: "A shape is nothing: no line meets it.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let seen = &evidence.seen;
    let mut unseen = BTreeMap::new();
    for (at, leaf) in evidence.outline.calls.iter().zip(0..) {
        // A shape too thin to tell has a finding of its own, one whose size is zero a warning of the language.
        let told = seen.films.contains_key(&(leaf, leaf))
            || evidence.leaves[leaf as usize].bounds.size().min_element() == 0.0;
        let met = told || !seen.nothing.contains(&leaf);
        let known = unseen.entry(*at).or_insert((false, leaf));
        known.0 |= met;
    }
    let unseen = unseen.into_iter().filter(|(_, (met, _))| !met);
    let warn = |(at, (_, leaf)): (_, (bool, u32))| {
        let name = &evidence.leaves[leaf as usize].name;
        Diagnostic::warning(FINDING.code, format!("`{name}` is nothing: no test line is inside it"))
            .at(at, "never met")
            .help(if &**name == "implicit" {
                "look at its sizes; a formula may hold nowhere in its bounds"
            } else {
                "look at its sizes"
            })
    };
    unseen.map(warn).collect()
}
