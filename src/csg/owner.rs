//! Who owns a face that survived: of all leaves whose own face is there, within the clean-up's tolerance and of the same
//! sense, and that take part in the change, the one with the smallest key (explicit material, base before cutter,
//! source position). Leaves are asked whether or not the sweep needed them, so the owner is a function of the
//! geometry alone.

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
    let mut takes_part = !change.tied || makes(sweep, change.leaf, [change.t; 2]);
    for i in 0..sweep.room.met.len() {
        let (leaf, met) = sweep.room.met[i];
        let better = !takes_part || leaves[leaf as usize].key() < leaves[best.0 as usize].key();
        if !better || leaf == best.0 || met.intersect(about).is_empty() {
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
        let between = [crossing.t.min(change.t), crossing.t.max(change.t)];
        if (crossing.t - change.t).abs() * steepest <= tau && makes(sweep, leaf, between) {
            best = (leaf, crossing, other);
            takes_part = true;
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

/// Whether a leaf makes the object's truth change from `t[0]` to `t[1]`, both included: it changes, and so does every
/// node from one of its uses up. A leaf cut away here has no part in the face, even where its own runs along.
fn makes(sweep: &mut Sweep<'_>, leaf: u32, t: [f64; 2]) -> bool {
    let before = sweep.state_at(t[0].next_down());
    sweep.state_at(t[1]).differs(&before, sweep.tree, leaf as usize)
}

/// A leaf's crossing near a change, of a sense that can make the same face: the nearest.
fn face(sweep: &mut Sweep<'_>, leaf: u32, change: &Change, about: Interval) -> Option<Crossing> {
    let negated = sweep.tree.negated[leaf as usize];
    let fits = |c: &Crossing| {
        about.contains(c.t) && negated.is_none_or(|not| (c.entering != not) == change.entering)
    };
    let apart = |c: &Crossing| (c.t - change.t).abs();
    // A crossing at the very low end of a range is before it; and a leaf may answer in pieces.
    let (mut lo, mut near) = (about.lo.next_down(), None);
    loop {
        let answer = sweep.query(leaf, Interval::new(lo, about.hi));
        let fresh = sweep.room.fresh.iter().copied().filter(fits);
        near = near.into_iter().chain(fresh).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        if about.hi <= answer.range.hi || answer.range.hi <= lo {
            return near;
        }
        lo = answer.range.hi;
    }
}

/// Of the leaves with a material that fill the point just inside, the last written.
fn filler(sweep: &mut Sweep<'_>, change: &Change, window: f64) -> Option<u32> {
    let leaves = sweep.tree.leaves();
    let inside = change.t + if change.entering { 2.0 * window } else { -2.0 * window };
    let can = |(leaf, _): &(u32, Interval)| {
        let leaf = &leaves[*leaf as usize];
        leaf.material.is_some() && !leaf.cutter
    };
    if !sweep.room.met.iter().any(can) {
        return None;
    }
    let state = sweep.state_at(inside);
    let fill = sweep.room.met.iter().filter(|m| can(m) && state.fills(sweep.tree, m.0 as usize));
    fill.map(|m| m.0).max_by_key(|leaf| leaves[*leaf as usize].rank)
}
