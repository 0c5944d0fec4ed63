//! Who owns a face that survived: of all leaves whose own face is there, within the clean-up's tolerance and of the same
//! sense, and that take part in the change, the one with the smallest key (explicit material, base before cutter,
//! source position). Leaves are asked whether or not the sweep needed them, so the owner is a function of the
//! geometry alone. A group is asked for the owner of its own face.

use super::cleanup::Face;
use super::leaf::Key;
use super::spans::Boundary;
use super::sweep::{Change, Sweep};
use crate::geom::{Interval, Ray, tolerance};
use crate::solid::Crossing;
use glam::DVec3;

/// What a leaf has to say for owning a change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Claim {
    /// The leaf, as boundaries name it.
    pub index: u32,
    pub key: Key,
    pub material: Option<u32>,
    /// Its own crossing, its own frame.
    pub crossing: Crossing,
    /// The unit normal out of what changes, its frame.
    pub normal: DVec3,
    /// Whether the leaf's own normal points into what changes.
    pub turned: bool,
}

/// How far about a face others are looked for, in multiples of the ray's direction; `reach` bounds the thickness within
/// which faces are one near where the ray begins.
pub(super) fn window(reach: f64, ray: &Ray, t: f64, slope: f64) -> f64 {
    (reach + tolerance::cleanup(ray.at(t).length())) / slope.max(f64::MIN_POSITIVE)
}

/// Makes the boundary of a change.
pub(super) fn boundary(sweep: &mut Sweep<'_>, face: &Face, reach: f64) -> Boundary {
    let Claim { index, material, crossing, normal, turned, .. } = claim(sweep, face, reach);
    let t = face.change.t;
    let filler = match material {
        Some(_) => None,
        None => {
            let inward = if face.change.entering { 2.0 } else { -2.0 };
            filling(sweep, t + inward * window(reach, sweep.ray, t, face.slope))
        }
    };
    Boundary { t, leaf: index, crossing, normal, flipped: turned, filler: filler.map(|(_, index)| index) }
}

/// Who owns a change.
pub(super) fn claim(sweep: &mut Sweep<'_>, face: &Face, reach: f64) -> Claim {
    let core = sweep.core;
    let leaves = core.tree.leaves();
    let Face { change, normal, slope } = face;
    let point = sweep.ray.at(change.t).length();
    let window = window(reach, sweep.ray, change.t, *slope);
    let about = Interval::new(change.t - window, change.t + window);
    sweep.meet(about.hi);
    // What fills is asked two windows away, and what takes part a rounding before. Nothing that is asked about here is dropped.
    let since = (change.t - 4.0 * window).next_down().next_down();
    sweep.room.near.drop_before(since, &sweep.room.met);

    let mut best = claim_of(sweep, change.met, &change.crossing, *normal, change);
    let mut takes_part = !change.tied || sweep.makes(change.met as usize, [change.t; 2]);
    for which in 0..sweep.room.count_since(about.lo) {
        let i = sweep.room.near_by(which);
        let met = &sweep.room.met[i];
        if i as u32 == change.met || met.range.intersect(about).is_empty() {
            continue;
        }
        let leaf = met.leaf as usize;
        let least = (leaves[leaf].least_key(), core.first(met.leaf));
        if takes_part && (best.key, best.index) < least {
            continue;
        }
        let Some(crossing) = near(sweep, i, change, about) else { continue };
        let other = sweep.leaf_normal(i as u32, &crossing);
        let first = sweep.room.met[change.met as usize].leaf as usize;
        let scale = core.scale_at(first, &change.crossing).max(core.scale_at(leaf, &crossing));
        let error = |l: usize, c: &Crossing| c.shift * leaves[l].place.stretch;
        let tau = tolerance::cleanup(scale.max(point).max(sweep.ray.origin.length()))
            + error(leaf, &crossing)
            + error(first, &change.crossing);
        let steepest = slope.max(sweep.ray.dir.dot(other).abs());
        let between = [crossing.t.min(change.t), crossing.t.max(change.t)];
        if (crossing.t - change.t).abs() * steepest > tau || !sweep.makes(i, between) {
            continue;
        }
        let claim = claim_of(sweep, i as u32, &crossing, other, change);
        if !takes_part || (claim.key, claim.index) < (best.key, best.index) {
            (best, takes_part) = (claim, true);
        }
    }
    best
}

/// The claim of a leaf, or of the owner of its face, to a change; the normal is that of the leaf.
fn claim_of(sweep: &mut Sweep<'_>, met: u32, crossing: &Crossing, normal: DVec3, change: &Change) -> Claim {
    let core = sweep.core;
    let index = sweep.room.met[met as usize].leaf;
    let leaf = &core.tree.leaves()[index as usize];
    let turned = crossing.entering != change.entering;
    let (index, outward) = (core.first(index), |normal: DVec3| if turned { -normal } else { normal });
    let Some(group) = &leaf.group else {
        let (key, material) = (leaf.key(), leaf.material);
        return Claim { index, key, material, crossing: *crossing, normal: outward(normal), turned };
    };
    let local = sweep.local(met as usize);
    let own = leaf.ask_group(group, sweep.scratch, |group, scratch| group.owner(&local, crossing, scratch));
    let normal = outward(leaf.place.normal_to_world(own.normal));
    Claim { index: index + own.index, normal, turned: own.turned != turned, ..own }
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

/// Of the leaves with a material that fill a point of the ray, the last written: its rank and its index.
pub(super) fn filling(sweep: &mut Sweep<'_>, t: f64) -> Option<(u64, u32)> {
    let core = sweep.core;
    let leaves = core.tree.leaves();
    sweep.meet(t);
    let count = sweep.room.count_since(t);
    let can = |which: usize| leaves[sweep.room.met[sweep.room.near_by(which)].leaf as usize].can_fill();
    if !(0..count).any(can) {
        return None;
    }
    sweep.fill(t);
    let mut last = None;
    for which in 0..count {
        let met = sweep.room.near_by(which);
        let index = sweep.room.met[met].leaf;
        let leaf = &leaves[index as usize];
        if !leaf.can_fill() || !sweep.room.here.fills(&core.tree, index as usize) {
            continue;
        }
        let own = match &leaf.group {
            None => Some((core.tree.last[index as usize], 0)),
            Some(group) => {
                let local = sweep.local(met);
                leaf.ask_group(group, sweep.scratch, |group, scratch| group.filler(&local, t, scratch))
            }
        };
        last = last.max(own.map(|(rank, inner)| (rank, core.first(index) + inner)));
    }
    last
}
