//! Shapes thinner than rounding can tell, by themselves or as an operator leaves them, and gaps as narrow: what they add or
//! take away is dropped by the clean-up of set algebra. What is left by it and is thinner than anybody builds, a skin, is
//! told as well: it shows in a picture.

use std::collections::BTreeMap;

use super::seen::Near;
use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::source::Span;

/// The line of the table.
pub(super) const FINDING: Finding =
    Finding { code: "W0125", doc: "What is left, or open, between shapes is too thin to be meant.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let films = over_areas(evidence, &evidence.seen.films);
    let name = |leaf: u32| &*evidence.leaves[leaf as usize].name;
    let kept = over_areas(evidence, &evidence.seen.skins);
    let kept = kept.into_iter().filter(|(at, _)| !films.contains_key(at));
    let kept: Vec<Diagnostic> =
        kept.map(|(at, (a, b, film))| between(at, [a, b].map(name), film, &KEPT)).collect();
    let warn = |(at, (a, b, film)): ([Span; 2], (u32, u32, bool))| match a == b {
        true => {
            let told = format!("`{}` is thinner than rounding can tell so far from the origin", name(a));
            Diagnostic::warning(FINDING.code, told)
                .at(at[0], "dropped where it is so thin")
                .help("make it thicker, or build the scene nearer to the origin")
        }
        false => between(at, [a, b].map(name), film, &DROPPED),
    };
    films.into_iter().map(warn).chain(kept).collect()
}

/// By the places of two calls the leaves that were seen, and whether it is a film.
type Pairs = BTreeMap<[Span; 2], (u32, u32, bool)>;

/// What is thin over an area.
fn over_areas(evidence: &Evidence, seen: &BTreeMap<(u32, u32), Near>) -> Pairs {
    let calls = &evidence.outline.calls;
    let mut pairs = Pairs::new();
    for (&(a, b), near) in seen.iter().filter(|(_, near)| near.is_area()) {
        let (at, of) = (calls[a as usize], calls[b as usize]);
        pairs.entry([at.min(of), at.max(of)]).or_insert((a, b, near.film)).2 |= near.film;
    }
    pairs
}

/// What is said of thin things: how thin they are, and what becomes of a film and of a gap.
struct Words {
    thin: &'static str,
    film: &'static str,
    gap: &'static str,
}

const DROPPED: Words =
    Words { thin: "is thinner than rounding can tell", film: "dropped at this", gap: "closed at this" };
const KEPT: Words =
    Words { thin: "is thinner than a billionth of their size", film: "left at this", gap: "open at this" };

/// What faces of two shapes, or of two copies of one, leave.
fn between(at: [Span; 2], names: [&str; 2], film: bool, words: &Words) -> Diagnostic {
    let (what, place, help) = match film {
        true => ("what is left", words.film, "make it thicker, or let the one stand out of the other"),
        false => ("the gap", words.gap, "make it wider, or let the one reach into the other"),
    };
    let whose = match at[0] == at[1] {
        true => format!("copies of `{}`", names[0]),
        false => format!("`{}` and `{}`", names[0], names[1]),
    };
    let told = format!("{what} between {whose} {}", words.thin);
    let warning = Diagnostic::warning(FINDING.code, told).at(at[1], place);
    let warning = if at[0] == at[1] { warning } else { warning.at(at[0], "and this") };
    warning.help(help)
}
