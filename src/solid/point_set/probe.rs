//! F along a line: what the search for roots asks at one place of it.

use glam::DVec3;

use super::hierarchy::{Hierarchy, Reach};
use super::{Kernel, PointSet};
use crate::geom::Ray;
use crate::mls::{AnyWay, Compact, Evaluator, Facing, Guess, Neighbours, SameWay, Sample, Stray, Weight};
use crate::solid::{Body, Counts};

/// F at a place of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Probe {
    /// Arc length from the line's origin.
    pub s: f64,
    /// The width that scales things here: that of the nearest sample, in its own widths.
    pub width: f64,
    /// F and dF/ds; `None` where F is undefined or the samples have ended.
    pub f: Option<[f64; 2]>,
    /// Whether it is undefined because the projection failed.
    pub stray: bool,
}

/// Room for evaluations.
#[derive(Debug, Default)]
pub(super) struct Room {
    near: Neighbours,
    /// Whose samples `near` lists.
    of: Option<u64>,
    /// Work so far.
    pub work: Work,
}

/// Counts of work.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    /// Solves of plane and polynomial.
    pub projections: u64,
    /// How many of them lost a degree.
    pub falls: u64,
    /// Guides made.
    pub guides: u64,
    /// Patches made.
    pub patches: u64,
    /// Projections for making them.
    pub building: u64,
}

impl Room {
    /// Charges the work done since `before`.
    pub fn charge(&self, before: Work, counts: &mut Counts) {
        counts.projections += self.work.projections - before.projections;
        counts.degree_falls += self.work.falls - before.falls;
        counts.guides += self.work.guides - before.guides;
        counts.patches += self.work.patches - before.patches;
        counts.building += self.work.building - before.building;
    }
}

/// How much farther than to a point and its foot the first gathering reaches, in widths there: q is seldom farther, and what
/// is gathered serves the next places too.
const REACH: f64 = 0.4;
/// And the second, where the first did not suffice.
const FAR_REACH: f64 = 2.5;

impl PointSet {
    /// F at arc length `s` of a line of unit direction; `spheres` are the trust spheres of the band around it.
    pub(super) fn probe(&self, line: &Ray, s: f64, spheres: &[Reach], room: &mut Room) -> Probe {
        let at = line.at(s);
        let sample = nearest(&self.samples, at, s, spheres);
        let width = self.samples.widths[sample];
        let field = self.field_near(at, sample, room);
        let stray = field.is_err();
        let f = field.ok().filter(|f| !self.has_ended(sample, f, room));
        let f = f.map(|f| [f.value, f.gradient.dot(line.dir)]);
        Probe { s, width, f, stray }
    }

    /// Whether the samples have ended at a point, the last one asked about: there the polynomial only extrapolates. So it is
    /// beyond the rim of a hole that is capped, beyond the edge of a wall so thin and sharp that its far side was left out,
    /// and beyond the edge of a sheet, where no sample lies ahead that the surface could go on to.
    pub(super) fn has_ended(&self, sample: usize, field: &Sample, room: &Room) -> bool {
        // Where less than this share of the weight faces another way nothing has been left out.
        const WHOLE: f64 = 0.99;
        if field.drift <= self.kernel.edge() {
            return false;
        }
        field.kept < WHOLE
            || self.near_rim(sample)
            || (self.body == Body::Sheet && self.nothing_ahead(sample, field, room))
    }

    /// Whether no sample lies beyond an edge: gaps narrower than a weight's support are spanned.
    fn nothing_ahead(&self, sample: usize, field: &Sample, room: &Room) -> bool {
        // Samples of the edge itself may stand out by so many widths.
        const CLEAR: f64 = 0.25;
        let h = self.samples.widths[sample];
        let support = Compact.support();
        let (outward, reach) = (field.plane_normal, h * support.sqrt());
        !room.near.any_ahead(
            self.samples.blocks(),
            field.foot,
            field.away,
            outward,
            [CLEAR * h, reach],
            support,
        )
    }

    /// F at a point for which a sample is known whose trust sphere holds it.
    pub(super) fn field_near(&self, at: DVec3, sample: usize, room: &mut Room) -> Result<Sample, Stray> {
        match self.kernel {
            Kernel::Compact(weight) => self.field_facing(weight, at, sample, room),
            Kernel::Gaussian(weight) => self.field_facing(weight, at, sample, room),
        }
    }

    fn field_facing<W: Weight>(
        &self,
        weight: W,
        at: DVec3,
        sample: usize,
        room: &mut Room,
    ) -> Result<Sample, Stray> {
        let (degree, form) = (self.degree, self.form);
        if self.mixed {
            self.field_by(&Evaluator { weight, facing: AnyWay, degree, form }, at, sample, room)
        } else {
            self.field_by(&Evaluator { weight, facing: SameWay, degree, form }, at, sample, room)
        }
    }

    fn field_by<W: Weight, A: Facing>(
        &self,
        evaluator: &Evaluator<W, A>,
        at: DVec3,
        sample: usize,
        room: &mut Room,
    ) -> Result<Sample, Stray> {
        // The foot on the plane of the nearest sample: a function of the point alone.
        let (p, outward) = (self.samples.points[sample], self.samples.normal(sample));
        let width = self.samples.widths[sample];
        let guess = Guess { foot: at - outward * outward.dot(at - p), outward, width };
        let answer = self.gathered(evaluator, at, &guess, room);
        room.work.projections += 1;
        room.work.falls += u64::from(answer.is_ok_and(|f| f.degree < evaluator.degree));
        answer
    }

    /// F from the samples gathered last where they suffice, else gathers anew: the same either way.
    fn gathered<W: Weight, A: Facing>(
        &self,
        evaluator: &Evaluator<W, A>,
        at: DVec3,
        guess: &Guess,
        room: &mut Room,
    ) -> Result<Sample, Stray> {
        let support = evaluator.weight.support();
        let blocks = self.samples.blocks();
        if room.of == Some(self.id) {
            // Why there is none may depend on what was gathered; what there is does not.
            let answer = evaluator.sample(blocks, &mut room.near, at, guess);
            if answer.is_ok() {
                return answer;
            }
        }
        room.of = Some(self.id);
        let (center, half) = (0.5 * (at + guess.foot), 0.5 * (at - guess.foot).length());
        for more in [REACH, FAR_REACH] {
            let reach = half + more * guess.width;
            self.samples.gather(center, reach, support, guess.outward, &mut room.near);
            let answer = evaluator.sample(blocks, &mut room.near, at, guess);
            if answer != Err(Stray::OutOfReach) {
                return answer;
            }
        }
        Err(Stray::Outside)
    }
}

/// The sample that a point is nearest to, in that sample's own widths (ties by index). A function of the point
/// alone where the list, in order, holds all spheres about it.
fn nearest(samples: &Hierarchy, at: DVec3, s: f64, spheres: &[Reach]) -> usize {
    let ratio =
        |i: usize| (samples.points[i] - at).length_squared() / (samples.widths[i] * samples.widths[i]);
    let mut best = (f64::INFINITY, usize::MAX);
    let begun = spheres.partition_point(|r| r.range.lo <= s);
    let about = spheres[..begun].iter().rev().take_while(|r| s <= r.ended);
    for reach in about.filter(|r| s <= r.range.hi) {
        let candidate = (ratio(reach.sample as usize), reach.sample as usize);
        if candidate < best {
            best = candidate;
        }
    }
    if best.1 != usize::MAX {
        return best.1;
    }
    // Rounding has put the place a hair outside every sphere of its band: the nearest end serves.
    let off = |r: &Reach| (r.range.lo - s).max(s - r.range.hi);
    let end = spheres.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    end.map_or(0, |r| r.sample as usize)
}
