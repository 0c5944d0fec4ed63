//! Solids drawn into each other: lines are inside both. Light tells clear bodies from what they hold, so these may overlap: what
//! is poured too full, or cast in amber.

use super::{Evidence, Finding};
use crate::diag::Diagnostic;
use crate::geom::Aabb;

/// The line of the table.
pub(super) const FINDING: Finding =
    Finding { code: "W0126", doc: "The insides of two solids drawn overlap.", find };

fn find(evidence: &Evidence) -> Vec<Diagnostic> {
    let parts = &evidence.outline.parts;
    let warn = |((a, b), place): (&(u32, u32), &Aabb)| {
        let (a, b) = (&parts[*a as usize], &parts[*b as usize]);
        let warning = Diagnostic::warning(FINDING.code, "the insides of two solids drawn overlap")
            .at(b.at, "this one")
            .at(a.at, "reaches into this one")
            .note(extent(place));
        warning.help("move one of them, or draw them as one: `draw a | b`")
    };
    let is_alike = |(a, b): &(u32, u32)| parts[*a as usize].clear == parts[*b as usize].clear;
    evidence.seen.overlaps.iter().filter(|(pair, _)| is_alike(pair)).map(warn).collect()
}

/// How deep and where, to two digits: lines find an overlap's size from below.
fn extent(place: &Aabb) -> String {
    let depth = place.size().min_element();
    if !depth.is_finite() || !place.is_finite() || depth <= 0.0 {
        return "the overlap has no end".to_owned();
    }
    let digits = 1 - depth.log10().floor() as i32;
    let unit = 10f64.powi(-digits);
    let decimals = digits.clamp(0, 17) as usize;
    let round = |x: f64| format!("{:.*}", decimals, (x / unit).round() * unit + 0.0);
    let center = place.center().to_array().map(round).join(", ");
    format!("by about {}, around [{center}]", round(depth))
}
