//! How many solids a scene may come to. A shape named once and used twice is stored once but, unless it is an object of its
//! own ([`super::groups`]), traced twice, so the number can outgrow any memory; it is counted before anything is built.

use std::collections::HashMap;

use super::groups::{Groups, address};
use crate::deep;
use crate::diag::Diagnostic;
use crate::scene::{Shape, ShapeKind};

/// The most solids that one `draw` may have built, a kilobyte each.
pub(super) const MAX_BUILT: u64 = 1_000_000;
/// The most that is written out where each use shall be told apart: beyond, what stands in many places is shared as in a
/// picture.
pub(super) const MAX_WRITTEN_OUT: u64 = 200_000;
/// The most it may come to, every use of a shape counted: what a boundary can tell apart.
const MAX_SOLIDS: u64 = u32::MAX as u64;

/// Refuses a shape of too many solids.
pub(super) fn check_count(shape: &Shape, groups: &Groups) -> Result<(), Diagnostic> {
    let solids = groups.solids(shape);
    let built = built(shape, groups, &mut HashMap::new());
    let (count, most, sort) = match () {
        () if MAX_SOLIDS < solids => (solids, MAX_SOLIDS, "solids"),
        () if MAX_BUILT < built => (built, MAX_BUILT, "solids of their own"),
        () => return Ok(()),
    };
    let told = format!("this comes to more than {most} {sort}");
    let told = if count == u64::MAX { told } else { format!("{told}: {count}") };
    Err(Diagnostic::error("E0703", told).at(shape.0.at, "too many").help("make fewer copies"))
}

/// The leaves built for a draw or an object: those of objects in it once.
fn built(shape: &Shape, groups: &Groups, known: &mut HashMap<usize, u64>) -> u64 {
    match &shape.0.kind {
        ShapeKind::Leaf { .. } => return 1,
        // Below these everything is written out.
        ShapeKind::Close { .. }
        | ShapeKind::Thicken { .. }
        | ShapeKind::Offset { .. }
        | ShapeKind::Clip { .. } => {
            return groups.solids(shape);
        }
        _ => {}
    }
    let (key, apart) = (address(shape), groups.wants(shape));
    if let Some(count) = known.get(&key) {
        // One leaf for another use.
        return if apart { 1 } else { *count };
    }
    let sum = |sum: u64, child: &Shape| sum.saturating_add(deep::step(|| built(child, groups, known)));
    let count = shape.0.kind.children().fold(u64::from(apart), sum);
    known.insert(key, count);
    count
}
