//! Who owns a face that survived: of all leaves whose own face is there, within the clean-up's tolerance and of the same
//! sense, and that take part in the change, the one with the smallest key (explicit material, base before cutter,
//! source position). Leaves are asked whether or not the sweep needed them, so the owner is a function of the
//! geometry alone.

use super::cleanup::Face;
use super::spans::Boundary;
use super::sweep::{Change, Sweep};
use crate::geom::{Interval, tolerance};
use crate::solid::Crossing;

/// Makes the boundary of a change; `reach` bounds the thickness within which faces are one.
pub(super) fn boundary(sweep: &mut Sweep<'_>, face: &Face, reach: f64) -> Boundary {
    let core = sweep.core;
    let leaves = core.tree.leaves();
    let Face { change, normal, slope } = face;
    let point = sweep.ray.at(change.t).length();
    let window = (reach + tolerance::cleanup(point)) / slope.max(f64::MIN_POSITIVE);
    let about = Interval::new(change.t - window, change.t + window);
    sweep.meet(about.hi);

    let mut best = (change.met, change.crossing, *normal);
    let mut takes_part = !change.tied || sweep.makes(change.met as usize, [change.t; 2]);
    for i in 0..sweep.room.met.len() {
        let met = &sweep.room.met[i];
        if i as u32 == best.0 || met.range.intersect(about).is_empty() {
            continue;
        }
        let leaf = met.leaf as usize;
        let owner = sweep.room.met[best.0 as usize].leaf as usize;
        let better = !takes_part || (leaves[leaf].key(), leaf) < (leaves[owner].key(), owner);
        if !better {
            continue;
        }
        let Some(crossing) = near(sweep, i, change, about) else { continue };
        let other = sweep.leaf_normal(i as u32, &crossing);
        let first = sweep.room.met[change.met as usize].leaf as usize;
        let scale = core.scales[first].max(core.scales[leaf]);
        let error = |l: usize, c: &Crossing| c.shift * leaves[l].place.stretch;
        let tau = tolerance::cleanup(scale.max(point).max(sweep.ray.origin.length()))
            + error(leaf, &crossing)
            + error(first, &change.crossing);
        let steepest = slope.max(sweep.ray.dir.dot(other).abs());
        let between = [crossing.t.min(change.t), crossing.t.max(change.t)];
        if (crossing.t - change.t).abs() * steepest <= tau && sweep.makes(i, between) {
            best = (i as u32, crossing, other);
            takes_part = true;
        }
    }
    let (met, crossing, normal) = best;
    let leaf = sweep.room.met[met as usize].leaf;
    let flipped = crossing.entering != change.entering;
    let filler = match leaves[leaf as usize].material {
        Some(_) => None,
        None => filler(sweep, change, window),
    };
    let normal = if flipped { -normal } else { normal };
    Boundary { t: change.t, leaf, crossing, normal, flipped, filler }
}

/// A leaf's crossing near a change, of a sense that can make the same face: the nearest.
fn near(sweep: &mut Sweep<'_>, met: usize, change: &Change, about: Interval) -> Option<Crossing> {
    let leaf = sweep.room.met[met].leaf as usize;
    let negated = sweep.core.tree.negated[leaf];
    let fits = |c: &&Crossing| {
        about.contains(c.t) && negated.is_none_or(|not| (c.entering != not) == change.entering)
    };
    let apart = |c: &Crossing| (c.t - change.t).abs();
    let nearest =
        |list: &[Crossing]| list.iter().filter(fits).min_by(|a, b| apart(a).total_cmp(&apart(b))).copied();
    if sweep.room.met[met].covers(about) {
        return nearest(sweep.room.crossings(met));
    }
    // A crossing at the very low end of a range is before it; and a leaf may answer in pieces.
    let (mut lo, mut best) = (about.lo.next_down(), None::<Crossing>);
    loop {
        let answer = sweep.query(met, Interval::new(lo, about.hi));
        let fresh = nearest(&sweep.room.fresh);
        best = best.into_iter().chain(fresh).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        if about.hi <= answer.range.hi || answer.range.hi <= lo {
            return best;
        }
        lo = answer.range.hi;
    }
}

/// Of the leaves with a material that fill the point just inside, the last written.
fn filler(sweep: &mut Sweep<'_>, change: &Change, window: f64) -> Option<u32> {
    let core = sweep.core;
    let leaves = core.tree.leaves();
    let inside = change.t + if change.entering { 2.0 * window } else { -2.0 * window };
    sweep.meet(inside);
    let can = |leaf: u32| leaves[leaf as usize].can_fill();
    if !sweep.room.met.iter().any(|m| can(m.leaf)) {
        return None;
    }
    sweep.fill(inside);
    let state = &sweep.room.here;
    let fill = sweep.room.met.iter().map(|m| m.leaf);
    let fill = fill.filter(|leaf| can(*leaf) && state.fills(&core.tree, *leaf as usize));
    fill.max_by_key(|leaf| (leaves[*leaf as usize].rank, *leaf))
}
