//! Cutters that take nothing away: on no line does what is drawn change without them. Of a cutter's copies those that do so
//! for certain: their boxes do not meet that of what is cut.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::geom::Aabb;
use crate::prepare::Piece;
use crate::source::Span;

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
    let mut all: BTreeMap<Span, Diagnostic> =
        dead.into_iter().map(|(at, base)| (at, warn((at, base)))).collect();
    for (at, copies) in copies(evidence) {
        all.entry(at).or_insert_with(|| idle(at, &copies));
    }
    all.into_values().collect()
}

/// Copies of one cutter.
#[derive(Default)]
struct Copies {
    count: usize,
    /// Where those are that are apart from what is cut.
    apart: Vec<DVec3>,
}

/// Cutters that are copies of one shape, of which some are apart from what they cut.
fn copies(evidence: &Evidence) -> BTreeMap<Span, Copies> {
    let (outline, leaves) = (evidence.outline, evidence.leaves);
    let own = |piece: &Piece| piece.leaves.start as usize..piece.leaves.end as usize;
    let mut all: BTreeMap<Span, Copies> = BTreeMap::new();
    for cut in &outline.cuts {
        let Some(base) = &cut.base else { continue };
        let around = leaves[own(base)].iter().fold(Aabb::EMPTY, |sum, leaf| sum.union(leaf.bounds));
        let alike = |piece: &&Piece| outline.calls[own(piece)].iter().is_sorted_by(|a, b| a == b);
        for piece in cut.cutters.iter().filter(alike) {
            let copies = all.entry(piece.at).or_default();
            copies.count += piece.leaves.len();
            let apart = leaves[own(piece)].iter().filter(|l| around.intersection(l.bounds).is_empty());
            copies.apart.extend(apart.map(|leaf| leaf.bounds.center()));
        }
    }
    all.retain(|_, copies| !copies.apart.is_empty() && copies.apart.len() < copies.count);
    all
}

fn idle(at: Span, Copies { count, apart }: &Copies) -> Diagnostic {
    let place = short(apart[0]);
    let told = match apart.len() {
        1 => format!("one of the {count} copies of this cutter cuts nothing"),
        n => format!("{n} of the {count} copies of this cutter cut nothing"),
    };
    Diagnostic::warning(FINDING.code, told)
        .at(at, format!("the one about {place} is apart from what is cut"))
        .help("move it to where it meets what it shall cut, or leave it out")
}

/// A point in few digits.
fn short(p: DVec3) -> String {
    let digits = |x: f64| format!("{:.4e}", x).parse::<f64>().unwrap_or(x);
    format!("[{}, {}, {}]", digits(p.x), digits(p.y), digits(p.z))
}
