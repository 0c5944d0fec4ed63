//! Who owns a face that survived: of all leaves whose own face is there, within the clean-up's tolerance and of the same
//! sense, the one with the smallest key (explicit material, base before cutter, source position). Leaves are
//! asked whether or not the sweep needed them, so the owner is a function of the geometry alone.

use super::spans::Boundary;
use super::sweep::{Change, Sweep};
use crate::geom::{Interval, tolerance};
use crate::solid::Crossing;

/// Makes the boundary of a change; `reach` bounds the thickness within which faces are one.
pub(super) fn boundary(sweep: &mut Sweep<'_>, change: &Change, reach: f64) -> Boundary {
    let leaves = sweep.tree.leaves();
    let normal = sweep.leaf_normal(change.leaf, &change.crossing);
    let slope = sweep.ray.dir.dot(normal).abs();
    let point = sweep.ray.at(change.t).length();
    let window = (reach + tolerance::cleanup(point)) / slope.max(f64::MIN_POSITIVE);
    let about = Interval::new(change.t - window, change.t + window);

    let mut best = (change.leaf, change.crossing, normal);
    for i in 0..sweep.room.met.len() {
        let (leaf, met) = sweep.room.met[i];
        let better = leaves[leaf as usize].key() < leaves[best.0 as usize].key();
        if !better || met.intersect(about).is_empty() {
            continue;
        }
        let Some(crossing) = face(sweep, leaf, change, about) else { continue };
        let other = sweep.leaf_normal(leaf, &crossing);
        let scale = leaves[change.leaf as usize].scale().max(leaves[leaf as usize].scale());
        let error = |l: u32, c: &Crossing| c.shift * leaves[l as usize].place.stretch;
        let tau = tolerance::cleanup(scale.max(point).max(sweep.ray.origin.length()))
            + error(leaf, &crossing)
            + error(change.leaf, &change.crossing);
        let steepest = slope.max(sweep.ray.dir.dot(other).abs());
        if (crossing.t - change.t).abs() * steepest <= tau {
            best = (leaf, crossing, other);
        }
    }
    let (leaf, crossing, normal) = best;
    let flipped = crossing.entering != change.entering;
    let filler = match leaves[leaf as usize].material {
        Some(_) => None,
        None => filler(sweep, change, window),
    };
    let normal = if flipped { -normal } else { normal };
    Boundary { t: change.t, leaf, crossing, normal, flipped, filler }
}

/// A leaf's crossing near a change, of a sense that can make the same face: the nearest.
fn face(sweep: &mut Sweep<'_>, leaf: u32, change: &Change, about: Interval) -> Option<Crossing> {
    sweep.query(leaf, about);
    let negated = sweep.tree.negated[leaf as usize];
    let fits = |c: &&Crossing| {
        about.contains(c.t) && negated.is_none_or(|not| (c.entering != not) == change.entering)
    };
    let apart = |c: &Crossing| (c.t - change.t).abs();
    let near = sweep.room.fresh.iter().filter(fits).min_by(|a, b| apart(a).total_cmp(&apart(b)));
    near.copied()
}

/// Of the leaves with a material that hold the point just inside, the last written.
fn filler(sweep: &mut Sweep<'_>, change: &Change, window: f64) -> Option<u32> {
    let leaves = sweep.tree.leaves();
    let inside = change.t + if change.entering { 2.0 * window } else { -2.0 * window };
    let mut best: Option<u32> = None;
    for i in 0..sweep.room.met.len() {
        let (leaf, met) = sweep.room.met[i];
        let candidate = &leaves[leaf as usize];
        let later = best.is_none_or(|b| leaves[b as usize].rank < candidate.rank);
        if candidate.material.is_none() || candidate.cutter || !later || !met.contains(inside) {
            continue;
        }
        let answer = sweep.query(leaf, Interval::new(inside, inside));
        let state = sweep.room.fresh.iter().filter(|c| c.t <= inside).next_back();
        if state.map_or(answer.inside, |c| c.entering) {
            best = Some(leaf);
        }
    }
    best
}
