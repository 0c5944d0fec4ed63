//! Shapes thinner than rounding can tell, by themselves or as an operator leaves them, and gaps as narrow: what they add or
//! take away is dropped by the clean-up of set algebra.

use std::collections::BTreeMap;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::source::Span;

/// The line of the table.
pub(super) const FINDING: Finding =
    Finding { code: "W0125", doc: "A shape is thinner than rounding can tell, and is dropped.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let calls = &evidence.outline.calls;
    let mut films: BTreeMap<[Span; 2], (u32, u32, bool)> = BTreeMap::new();
    for (&(a, b), film) in &evidence.seen.films {
        let (at, of) = (calls[a as usize], calls[b as usize]);
        films.entry([at.min(of), at.max(of)]).or_insert((a, b, *film)).2 |= film;
    }
    let name = |leaf: u32| &*evidence.leaves[leaf as usize].name;
    let warn = |(at, (a, b, film)): ([Span; 2], (u32, u32, bool))| match a == b {
        true => {
            let told = format!("`{}` is thinner than rounding can tell so far from the origin", name(a));
            Diagnostic::warning(FINDING.code, told)
                .at(at[0], "dropped where it is so thin")
                .help("make it thicker, or build the scene nearer to the origin")
        }
        false => between(at, [a, b].map(name), film),
    };
    films.into_iter().map(warn).collect()
}

/// What faces of two shapes, or of two copies of one, leave.
fn between(at: [Span; 2], names: [&str; 2], film: bool) -> Diagnostic {
    let (what, place, help) = match film {
        true => ("what is left", "dropped at this", "make it thicker, or let the one stand out of the other"),
        false => ("the gap", "closed at this", "make it wider, or let the one reach into the other"),
    };
    let whose = match at[0] == at[1] {
        true => format!("copies of `{}`", names[0]),
        false => format!("`{}` and `{}`", names[0], names[1]),
    };
    let told = format!("{what} between {whose} is thinner than rounding can tell");
    let warning = Diagnostic::warning(FINDING.code, told).at(at[1], place);
    let warning = if at[0] == at[1] { warning } else { warning.at(at[0], "and this") };
    warning.help(help)
}
