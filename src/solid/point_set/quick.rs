//! A band answered by patches: where every cell that the line comes near has one, what the line crosses are the patches,
//! each within its error. Whatever leaves a doubt (a near tangent, states that do not alternate) is left to the search.

use glam::DVec3;

use super::PointSet;
use super::certificate::{ROUNDING, lower_bound};
use super::hierarchy::{CellOn, Reach, in_order};
use super::patch::{Follows, Local, Patch};
use super::probe::Room;
use super::roots::{Findings, Piece, Root};
use crate::geom::{Interval, Ray};
use crate::solid::Counts;

/// Stretches shorter than this many widths are not divided any more: the line runs along the surface.
const SHORTEST: f64 = 1e-3;
/// Roots of two patches that overlap are one where they are nearer than so many of their errors.
const SAME: f64 = 4.0;
/// F at the root of a patch exceeds the error by at most this factor; more says that the patch is wrong.
const BELIEVED: f64 = 4.0;
/// |F''| is at most this over the width where there are patches: clean tori showed 0.43 at most.
const CURVATURE: f64 = 1.0;
/// A root of a patch's polynomial is good enough within this share of the patch's error.
const ENOUGH: f64 = 0.01;
/// Steps to it at most: Newton's need three or four.
const HALVINGS: usize = 40;
/// Newton's steps from a patch: one nearly always.
const STEPS: usize = 4;
/// A patch whose slopes are known to this, radians, gives normals: the surface's own are off by ten times as much.
const LEAN: f64 = 1e-4;
/// Patches overlap by more than this many widths.
const CERTAIN: f64 = 0.1;
/// A height off the plane of the nearest sample of more than this many widths tells which side a place is on.
const CLEAR: f64 = 0.25;

/// A root of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    s: f64,
    /// Of s.
    err: f64,
    entering: bool,
    cell: u32,
    /// How far from the middle of its patch.
    eccentricity: f64,
    /// Up to this `err` no other patch can be meant.
    certain: f64,
}

/// Room for one band.
#[derive(Debug, Default)]
pub(super) struct QuickRoom {
    hits: Vec<Hit>,
    /// What follows the surface near the band.
    follows: Vec<u32>,
    stack: Vec<[End; 2]>,
    /// Stretches in trust spheres of samples that nothing follows.
    pub rough: Vec<Interval>,
    spheres: Vec<Reach>,
}

/// The height over a patch and its slope at a place of the line.
#[derive(Clone, Copy, Debug)]
struct End {
    s: f64,
    g: [f64; 2],
}

/// Patches leave it open.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubt;

/// What patches say about a band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Said {
    /// Everything: pieces and roots are filled in.
    All,
    /// Everything outside the rough stretches: the roots there.
    Some,
    /// Nothing to rely on.
    Nothing,
}

impl PointSet {
    /// Fills in the roots of a band outside the trust spheres of samples that neither a patch nor a guide follows.
    pub(super) fn quick(
        &self,
        line: &Ray,
        (band, cells): (Interval, &[CellOn]),
        room: &mut Room,
        quick: &mut QuickRoom,
        found: &mut Findings,
        counts: &mut Counts,
    ) -> Said {
        let QuickRoom { hits, follows, rough, spheres, .. } = quick;
        hits.clear();
        follows.clear();
        spheres.clear();
        for cell in cells {
            let Some(Follows { patch, id }) = self.patches.get(self, cell.cell as usize, room) else {
                self.samples.spheres_of(cell.cell as usize, line, spheres);
                continue;
            };
            if follows.contains(&id) {
                continue;
            }
            follows.push(id);
            if !roots(patch, &patch.local(line), cell.cell, hits, &mut quick.stack) {
                return Said::Nothing;
            }
        }
        // What follows several cells may be crossed in another band too: each crossing is that of the band about it.
        hits.retain(|h| band.contains(h.s));
        in_order(spheres);
        stretches(spheres, rough);
        // There F is asked, and where what is followed may cross at the end of such a stretch.
        grow(rough, hits);
        hits.retain(|h| !rough.iter().any(|r| r.contains(h.s)));
        if !merge(hits, rough.is_empty()) {
            return Said::Nothing;
        }
        for hit in &*hits {
            let root = self.patches.get(self, hit.cell as usize, room);
            let root = root.and_then(|f| self.root(line, hit, f.patch, cells, room, counts));
            let Some(root) = root else {
                found.roots.clear();
                return Said::Nothing;
            };
            found.roots.push(root);
        }
        if rough.is_empty() { Said::All } else { Said::Some }
    }

    /// The one piece of a band without rough stretches, where there is one; an error where what patches say does not fit what
    /// the samples at its ends say, or these leave it open.
    ///
    /// A line that runs along the surface is off by the error over the sine of the angle, and each of two patches may believe
    /// that it crosses the other.
    pub(super) fn whole_piece(
        &self,
        line: &Ray,
        (band, cells): (Interval, &[CellOn]),
        quick: &mut QuickRoom,
        roots: &[Root],
    ) -> Result<Option<Piece>, Doubt> {
        let QuickRoom { spheres, rough, hits, .. } = quick;
        let ends = roots.first().zip(roots.last()).map(|(first, last)| [!first.entering, last.entering]);
        if let Some(inside) = ends.filter(|_| hits.iter().all(|h| h.err <= h.certain)) {
            return Ok(Some(Piece { range: band, inside, roots: [0, roots.len()] }));
        }
        self.samples.spheres_on(cells, line, spheres);
        if spheres.is_empty() {
            return if roots.is_empty() { Ok(None) } else { Err(Doubt) };
        }
        stretches(spheres, rough);
        let range = Interval::new(rough[0].lo, rough[rough.len() - 1].hi);
        let at = |s: f64| self.side(line.at(s), cells).ok_or(Doubt);
        let inside = [at(range.lo)?, at(range.hi)?];
        let agree = ends.map_or(inside[0] == inside[1], |ends| ends == inside);
        if agree { Ok(Some(Piece { range, inside, roots: [0, roots.len()] })) } else { Err(Doubt) }
    }

    /// Whether a place is inside, by the sample next to it, where that is plain.
    pub(super) fn side(&self, at: DVec3, cells: &[CellOn]) -> Option<bool> {
        let sample = self.nearest_of(at, cells)?;
        let height = (at - self.samples.points[sample]).dot(self.samples.normal(sample));
        (CLEAR * self.samples.widths[sample] < height.abs()).then_some(height < 0.0)
    }

    /// The crossing of a hit: the patch's own where its error is within the tolerance, else F's nearby.
    fn root(
        &self,
        line: &Ray,
        hit: &Hit,
        patch: &Patch,
        cells: &[CellOn],
        room: &mut Room,
        counts: &mut Counts,
    ) -> Option<Root> {
        let root = Root { s: hit.s, err: hit.err, shift: patch.error, entering: hit.entering, jump: false };
        if patch.error <= self.tolerance {
            counts.patch_hits += 1;
            return Some(root);
        }
        let m = CURVATURE / patch.width;
        let (mut s, mut trust) = (hit.s, BELIEVED * patch.error);
        for _ in 0..STEPS {
            let at = line.at(s);
            let sample = self.nearest_of(at, cells)?;
            let field = self.field_near(at, sample, room).ok()?;
            let slope = field.gradient.dot(line.dir);
            let plain = field.value.abs() <= trust && (slope < 0.0) == hit.entering;
            if !plain {
                return None;
            }
            let step = -field.value / slope;
            s += step;
            // Newton's remainder.
            let shift = 0.5 * m * step * step + ROUNDING * patch.width;
            if shift <= 0.5 * self.tolerance {
                let flattest = slope.abs() - 2.0 * m * step.abs();
                return (0.0 < flattest).then_some(Root { s, err: shift / flattest, shift, ..root });
            }
            trust = shift * BELIEVED;
        }
        None
    }

    /// The normal of a patch that a place of the line lies on, where it is as good as the gradient of F.
    pub(super) fn patch_normal(
        &self,
        line: &Ray,
        s: f64,
        cells: &[CellOn],
        room: &mut Room,
    ) -> Option<DVec3> {
        if self.patches.are_none() {
            return None;
        }
        let mut best: Option<(f64, &Patch, Local)> = None;
        for cell in cells.iter().filter(|c| c.range.contains(s)) {
            let Some(Follows { patch, .. }) = self.patches.get(self, cell.cell as usize, room) else {
                continue;
            };
            let local = patch.local(line);
            let off = patch.eccentricity(&local, s);
            let on = off <= 1.0
                && patch.lean <= LEAN
                && patch.height(&local, s)[0].abs() <= SAME * patch.local_error();
            if on && best.is_none_or(|(least, ..)| off < least) {
                best = Some((off, patch, local));
            }
        }
        best.map(|(_, patch, local)| patch.normal(&local, s))
    }

    /// The sample of some cells that a point is nearest to, in that sample's own widths (ties by index).
    pub(super) fn nearest_of(&self, at: DVec3, cells: &[CellOn]) -> Option<usize> {
        let mut best = (f64::INFINITY, usize::MAX);
        for cell in cells {
            for i in self.samples.of_cell(cell.cell as usize) {
                let (p, h) = (self.samples.points[i], self.samples.widths[i]);
                let candidate = ((p - at).length_squared() / (h * h), i);
                if candidate < best {
                    best = candidate;
                }
            }
        }
        (best.1 != usize::MAX).then_some(best.1)
    }
}

/// The roots of the height over one patch; `false` where a near tangent leaves a doubt.
fn roots(patch: &Patch, local: &Local, cell: u32, hits: &mut Vec<Hit>, stack: &mut Vec<[End; 2]>) -> bool {
    let [lo, hi] = patch.clip(local);
    if hi <= lo {
        return true;
    }
    let end = |s: f64| End { s, g: patch.height(local, s) };
    let (a, b) = (end(lo), end(hi));
    if patch.is_steeper(local) {
        if (a.g[0] < 0.0) != (b.g[0] < 0.0) {
            hits.push(refine(patch, local, cell, a, b));
        }
        return true;
    }
    let (m, error) = (patch.curvature(local), patch.local_error());
    let shortest = SHORTEST * patch.width;
    stack.clear();
    stack.push([a, b]);
    while let Some([a, b]) = stack.pop() {
        let length = b.s - a.s;
        let changes = (a.g[0] < 0.0) != (b.g[0] < 0.0);
        let falls = if b.g[0] < a.g[0] { -1.0 } else { 1.0 };
        let steady = |slope: f64| 0.5 * m * length < falls * slope;
        if steady(a.g[1]) && steady(b.g[1]) {
            if changes {
                hits.push(refine(patch, local, cell, a, b));
            }
            continue;
        }
        if !changes && error < lower_bound(length, a.g, b.g, m).0 {
            continue;
        }
        if length < shortest {
            return false;
        }
        let middle = end(0.5 * (a.s + b.s));
        stack.push([middle, b]);
        stack.push([a, middle]);
    }
    true
}

/// The one root between two ends by Newton's method within the bracket.
fn refine(patch: &Patch, local: &Local, cell: u32, mut a: End, mut b: End) -> Hit {
    let entering = b.g[0] < a.g[0];
    let mut s = a.s + (b.s - a.s) * (a.g[0] / (a.g[0] - b.g[0]));
    let mut slope = (b.g[0] - a.g[0]) / (b.s - a.s);
    let enough = ENOUGH * patch.local_error();
    for _ in 0..HALVINGS {
        let here = End { s, g: patch.height(local, s) };
        slope = here.g[1];
        if (here.g[0] < 0.0) == (a.g[0] < 0.0) {
            a = here
        } else {
            b = here
        }
        let next = s - here.g[0] / slope;
        let inside = a.s < next && next < b.s;
        if here.g[0].abs() <= enough {
            s = if inside { next } else { s };
            break;
        }
        s = if inside { next } else { 0.5 * (a.s + b.s) };
        if b.s - a.s <= f64::EPSILON * s.abs() {
            break;
        }
    }
    let err = (1.0 + 2.0 * ENOUGH) * patch.local_error() / slope.abs();
    Hit { s, err, entering, cell, eccentricity: patch.eccentricity(local, s), certain: CERTAIN * patch.width }
}

/// Stretches of overlapping trust spheres, which are in order.
fn stretches(spheres: &[Reach], out: &mut Vec<Interval>) {
    out.clear();
    out.extend(spheres.iter().map(|r| r.range));
    Interval::unite(out);
}

/// Makes stretches hold the hits at their ends with their errors, and unites those that then overlap.
fn grow(stretches: &mut Vec<Interval>, hits: &[Hit]) {
    for stretch in stretches.iter_mut() {
        // A hit may make a stretch reach the next hit.
        for _ in 0..hits.len() {
            for hit in hits {
                let (lo, hi) = (hit.s - 2.0 * hit.err, hit.s + 2.0 * hit.err);
                if stretch.lo <= hi && lo <= stretch.hi {
                    *stretch = Interval::new(stretch.lo.min(lo), stretch.hi.max(hi));
                }
            }
        }
    }
    Interval::unite(stretches);
}

/// Takes roots of overlapping patches for one, that of the patch whose middle is nearest; `false` where two that are not one
/// cannot be told apart, or what is left should alternate and does not.
fn merge(hits: &mut Vec<Hit>, alternate: bool) -> bool {
    hits.sort_unstable_by(|a, b| a.s.total_cmp(&b.s).then(a.cell.cmp(&b.cell)));
    let mut kept = 0;
    for i in 0..hits.len() {
        let hit = hits[i];
        if 0 < kept {
            let last = hits[kept - 1];
            let near = hit.s - last.s <= SAME * (hit.err + last.err);
            if near && hit.entering == last.entering {
                if (hit.eccentricity, hit.cell) < (last.eccentricity, last.cell) {
                    hits[kept - 1] = hit;
                }
                continue;
            }
            if near || (alternate && hit.entering == last.entering) {
                return false;
            }
        }
        hits[kept] = hit;
        kept += 1;
    }
    hits.truncate(kept);
    true
}
