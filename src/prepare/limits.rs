//! How many solids a scene may come to. A shape named once and used twice is stored once but traced twice, so the
//! number can outgrow any memory; it is counted before anything is built.

use std::collections::HashMap;

use crate::deep;
use crate::diag::Diagnostic;
use crate::scene::{Shape, ShapeKind};

/// The most solids that one `draw` may come to.
const MAX_SOLIDS: u64 = 1_000_000;

/// Refuses a shape of too many solids.
pub(super) fn check_count(shape: &Shape) -> Result<(), Diagnostic> {
    let mut known = HashMap::new();
    let count = count(shape, &mut known);
    if count <= MAX_SOLIDS {
        return Ok(());
    }
    let told = format!("this comes to more than {MAX_SOLIDS} solids");
    let told = if count == u64::MAX { told } else { format!("{told}: {count}") };
    Err(Diagnostic::error("E0703", told).at(shape.0.at, "too many").help("make fewer copies"))
}

/// The primitives a shape is traced as, each use counted; by the address of the node.
fn count(shape: &Shape, known: &mut HashMap<usize, u64>) -> u64 {
    let key = std::ptr::from_ref(&*shape.0) as usize;
    if let Some(count) = known.get(&key) {
        return *count;
    }
    if let ShapeKind::Leaf { .. } = shape.0.kind {
        return 1;
    }
    let children = shape.0.kind.children();
    let found = children.fold(0u64, |sum, child| sum.saturating_add(deep::step(|| count(child, known))));
    known.insert(key, found);
    found
}
