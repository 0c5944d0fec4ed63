//! Cutters that take nothing away: on no line does what is drawn change without them. Of shapes that a cutter is the union
//! of, its copies too, those that no line was inside together with what is cut.

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
    for (place, shapes) in shapes(evidence).into_iter().filter(|(_, shapes)| !shapes.idle.is_empty()) {
        all.entry(place.told_at()).or_insert_with(|| idle(place, &shapes));
    }
    all.into_values().collect()
}

/// Where a shape of a cutter was written.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    cutter: Span,
    call: Span,
    base: Option<Span>,
    /// Whether the cutter is of nothing else.
    alone: bool,
}

impl Place {
    /// The cutter where it is no more than copies of the shape, else the shape.
    fn told_at(&self) -> Span {
        if self.alone { self.cutter } else { self.call }
    }
}

/// Shapes that cutters are unions of, of one place in the text.
#[derive(Default)]
struct Shapes {
    count: usize,
    /// Where those are that are nowhere inside what is cut.
    idle: Vec<DVec3>,
}

/// The shapes that cutters which cut something are unions of.
fn shapes(evidence: &Evidence) -> BTreeMap<Place, Shapes> {
    let Evidence { outline, seen, logic, leaves } = evidence;
    let own = |piece: &Piece| piece.leaves.start as usize..piece.leaves.end as usize;
    let mut all: BTreeMap<Place, Shapes> = BTreeMap::new();
    for (cut, nodes) in outline.cuts.iter().zip(&logic.cuts) {
        let base = cut.base.as_ref().map(|b| b.at);
        if base.is_some_and(|b| !seen.left.contains(&b)) {
            continue;
        }
        let is_alone = |piece: &Piece| outline.calls[own(piece)].iter().is_sorted_by(|a, b| a == b);
        let alone: Vec<bool> = cut.cutters.iter().map(is_alone).collect();
        for (node, cutter) in &nodes.shapes {
            let (leaf, piece) = (logic.leaf(*node), &cut.cutters[*cutter]);
            if !seen.cutting.contains(&piece.at) {
                continue;
            }
            let call = outline.calls[leaf as usize];
            let place = Place { cutter: piece.at, call, base, alone: alone[*cutter] };
            let shapes = all.entry(place).or_default();
            shapes.count += 1;
            if seen.looked_at_leaves.contains(&leaf) && !seen.biting.contains(&leaf) {
                let leaf = &leaves[leaf as usize];
                let bounds = Some(leaf.bounds).filter(Aabb::is_finite);
                let at = bounds.map_or(leaf.place.world_from_local.translation, |b| b.center());
                shapes.idle.push(at);
            }
        }
    }
    all
}

fn idle(place: Place, Shapes { count, idle }: &Shapes) -> Diagnostic {
    let what = if place.alone { "this cutter" } else { "this part of a cutter" };
    let told = match (*count, idle.len()) {
        (1, _) => format!("{what} cuts nothing"),
        (count, 1) => format!("one of the {count} copies of {what} cuts nothing"),
        (count, n) if n == count => format!("the {n} copies of {what} cut nothing"),
        (count, n) => format!("{n} of the {count} copies of {what} cut nothing"),
    };
    let all = idle.len() == *count;
    let label = match all {
        true => "takes nothing away".into(),
        false => format!("the one about {} takes nothing away", short(idle[0])),
    };
    let warning = Diagnostic::warning(FINDING.code, told).at(place.told_at(), label);
    let warning = match place.base.filter(|_| all) {
        Some(base) => warning.at(base, "from this"),
        None => warning,
    };
    warning.help("move it to where it meets what it shall cut, or leave it out")
}

/// A point in few digits.
fn short(p: DVec3) -> String {
    let digits = |x: f64| format!("{:.4e}", x).parse::<f64>().unwrap_or(x);
    format!("[{}, {}, {}]", digits(p.x), digits(p.y), digits(p.z))
}
