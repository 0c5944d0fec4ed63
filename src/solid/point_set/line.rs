//! One line through a point set surface: bands, gaps, and the states between.
//!
//! Whether a place is inside is a function of the place alone: the sign of F where F is defined; elsewhere, in a
//! gap, the state that both its ends agree on, or, in a gap that meets a hole or whose ends disagree, whether the
//! winding number exceeds one half. What is found never depends on the range asked: bands are searched whole.

use glam::DVec3;

use super::PointSet;
use super::caps::Cap;
use super::hierarchy::Reach;
use super::probe::Room;
use super::roots::{Findings, Piece, Search, Stretch, WALL};
use crate::geom::{Interval, Ray};
use crate::solid::{Answer, Body, Counts, Crossing, Scratch};

/// Numbers of the parts of the boundary.
pub(super) mod part {
    /// F = 0.
    pub const SURFACE: u32 = 0;
    /// A cap: winding number one half.
    pub const CAP: u32 = 1;
    /// A wall where two definitions of inside meet and disagree.
    pub const WALL: u32 = 2;
}

/// A band: a stretch of the line inside overlapping trust spheres.
#[derive(Clone, Copy, Debug)]
struct Band {
    range: Interval,
    /// Its spheres are this range of the sorted list.
    spheres: [usize; 2],
    searched: bool,
}

/// What is known of one line through one surface.
#[derive(Debug, Default)]
pub struct LineScratch {
    id: Option<u64>,
    ray: Option<Ray>,
    /// The same line, of unit direction, its origin near the samples so that no digits are lost.
    line: Option<Ray>,
    /// t = t0 + s * per_s for arc length s.
    t0: f64,
    per_s: f64,
    reaches: Vec<Reach>,
    bands: Vec<Band>,
    found: Vec<Findings>,
    room: Room,
    stack: Vec<Stretch>,
    caps: Vec<Cap>,
}

impl LineScratch {
    fn t(&self, s: f64) -> f64 {
        self.t0 + s * self.per_s
    }
}

/// The trust spheres of the band at or after arc length `s`.
fn spheres_at<'a>(bands: &[Band], reaches: &'a [Reach], s: f64) -> &'a [Reach] {
    let band = bands.partition_point(|b| b.range.hi < s).min(bands.len().max(1) - 1);
    bands.get(band).map_or(&[][..], |b| &reaches[b.spheres[0]..b.spheres[1]])
}

/// Where a walk along the line stands.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Next band to look at.
    band: usize,
    /// Next piece of that band.
    piece: usize,
    /// Arc length up to which everything is done.
    s: f64,
    /// Whether that is inside.
    inside: bool,
}

impl PointSet {
    pub(super) fn line_crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        let Scratch { counts, lines, .. } = scratch;
        let line = self.line_in(lines, ray);
        let (mut place, inside) = self.enter(line, range.lo, counts);
        let first = out.len();
        let mut state = inside;
        loop {
            let done = self.advance(line, &mut place, counts, &mut |c| {
                if range.lo < c.t {
                    out.push(c);
                } else if self.body == Body::Solid {
                    state = c.entering;
                }
            });
            // A wall may stand where the gap after this piece begins: the answer ends just before.
            let until = if done { f64::INFINITY } else { line.t(place.s).next_down() };
            let found = first < out.len() && out.last().is_some_and(|c| c.t <= until);
            if done || range.hi <= until || (found && range.lo < until) {
                return Answer { inside: state, range: Interval::new(range.lo, until) };
            }
        }
    }

    /// Every root and every disagreement of the line: whether it is odd.
    pub(super) fn chord_is_odd(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        let Scratch { counts, lines, .. } = scratch;
        let line = self.line_in(lines, ray);
        let mut state = false;
        for band in 0..line.bands.len() {
            self.search(line, band, counts);
            for piece in &line.found[band].pieces {
                if piece.inside[0] != state {
                    return true;
                }
                state = piece.inside[1];
            }
        }
        state
    }

    pub(super) fn line_normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        let Scratch { counts, lines, .. } = scratch;
        let line = self.line_in(lines, ray);
        let unit = line.line.unwrap_or(*ray);
        let facing = if crossing.entering { -unit.dir } else { unit.dir };
        let s = (crossing.t - line.t0) / line.per_s;
        let at = unit.at(s);
        if crossing.part == part::CAP {
            let (_, gradient) = self.winding().value_and_gradient(at);
            return (-gradient).try_normalize().unwrap_or(facing);
        }
        if crossing.part == part::WALL {
            // A wall stands where definitions disagree: the nearest sample tells best how the surface lies.
            let nearest = self.nearest_sample(&unit, s, spheres_at(&line.bands, &line.reaches, s));
            let normal = self.samples.normals[nearest];
            return if 0.0 < normal.dot(facing) { normal } else { facing };
        }
        let before = (line.room.projections, line.room.falls);
        let spheres = spheres_at(&line.bands, &line.reaches, s);
        let gradient = self.gradient_at(&unit, s, spheres, &mut line.room);
        counts.projections += line.room.projections - before.0;
        counts.degree_falls += line.room.falls - before.1;
        gradient.and_then(DVec3::try_normalize).unwrap_or(facing)
    }

    /// The width of the sample nearest to arc length `s`.
    fn width_near(&self, unit: &Ray, s: f64, line: &LineScratch) -> f64 {
        self.samples.widths[self.nearest_sample(unit, s, spheres_at(&line.bands, &line.reaches, s))]
    }

    /// This thread's knowledge of the line, begun afresh where the line is another.
    fn line_in<'a>(&self, lines: &'a mut Vec<LineScratch>, ray: &Ray) -> &'a mut LineScratch {
        let index = lines.iter().position(|l| l.id == Some(self.id)).unwrap_or_else(|| {
            lines.push(LineScratch { id: Some(self.id), ..LineScratch::default() });
            lines.len() - 1
        });
        let line = &mut lines[index];
        if line.ray != Some(*ray) {
            self.begin(line, ray);
        }
        line
    }

    /// Finds the bands of a new line.
    fn begin(&self, line: &mut LineScratch, ray: &Ray) {
        let length = ray.dir.length();
        let t0 = (self.bounds.center() - ray.origin).dot(ray.dir) / (length * length);
        let unit = Ray::new(ray.at(t0), ray.dir / length);
        line.ray = Some(*ray);
        line.line = Some(unit);
        line.t0 = t0;
        line.per_s = 1.0 / length;
        line.room.forget();
        line.bands.clear();
        self.samples.spheres_on(&unit, &mut line.reaches);
        line.reaches.sort_unstable_by(|a, b| a.range.lo.total_cmp(&b.range.lo).then(a.sample.cmp(&b.sample)));
        for (i, reach) in line.reaches.iter().enumerate() {
            match line.bands.last_mut() {
                Some(band) if reach.range.lo <= band.range.hi => {
                    band.range.hi = band.range.hi.max(reach.range.hi);
                    band.spheres[1] = i + 1;
                }
                _ => line.bands.push(Band { range: reach.range, spheres: [i, i + 1], searched: false }),
            }
        }
        if line.found.len() < line.bands.len() {
            line.found.resize_with(line.bands.len(), Findings::default);
        }
    }

    /// Isolates the roots of a band, once a line.
    fn search(&self, line: &mut LineScratch, index: usize, counts: &mut Counts) {
        let band = line.bands[index];
        if band.searched {
            return;
        }
        line.bands[index].searched = true;
        let found = &mut line.found[index];
        found.clear();
        // Bands may be searched in any order and must not feel each other's gathering.
        line.room.forget();
        let before = (line.room.projections, line.room.falls);
        let unit = line.line.unwrap_or(Ray::new(DVec3::ZERO, DVec3::Z));
        Search {
            set: self,
            line: &unit,
            spheres: &line.reaches[band.spheres[0]..band.spheres[1]],
            room: &mut line.room,
            out: found,
            stack: &mut line.stack,
        }
        .run(band.range);
        counts.projections += line.room.projections - before.0;
        counts.degree_falls += line.room.falls - before.1;
        counts.crossings += found.roots.len() as u64;
        counts.certificate_failures += found.failures;
        counts.parity_repairs += found.roots.iter().filter(|r| r.jump).count() as u64;
    }

    /// A place before `lo` from which to walk, and the state there.
    fn enter(&self, line: &mut LineScratch, lo: f64, counts: &mut Counts) -> (Place, bool) {
        let first = line.bands.partition_point(|b| line.t0 + b.range.hi * line.per_s < lo);
        let outside = Place { band: first, piece: 0, s: f64::NEG_INFINITY, inside: false };
        if self.body == Body::Sheet {
            return (outside, false);
        }
        if first < line.bands.len() {
            self.search(line, first, counts);
            let pieces = &line.found[first].pieces;
            let begun = pieces.iter().rposition(|p| line.t0 + p.range.lo * line.per_s <= lo);
            if let Some(piece) = begun {
                let Piece { range, inside, .. } = pieces[piece];
                let place = Place { band: first, piece, s: range.lo, inside: inside[0] };
                return (place, inside[0]);
            }
        }
        // In a gap: its state comes from the piece before it.
        for band in (0..first).rev() {
            self.search(line, band, counts);
            if let Some(last) = line.found[band].pieces.last() {
                let inside = last.inside[1];
                let piece = line.found[band].pieces.len();
                return (Place { band, piece, s: last.range.hi, inside }, inside);
            }
        }
        (Place { band: 0, ..outside }, false)
    }

    /// Walks to the end of the next piece, reporting the crossings of the gap before it and its own. Returns
    /// whether the line has ended.
    fn advance(
        &self,
        line: &mut LineScratch,
        place: &mut Place,
        counts: &mut Counts,
        report: &mut impl FnMut(Crossing),
    ) -> bool {
        while place.band < line.bands.len() {
            self.search(line, place.band, counts);
            if place.piece < line.found[place.band].pieces.len() {
                let piece = line.found[place.band].pieces[place.piece];
                if self.body == Body::Solid && place.s < piece.range.lo {
                    let gap = Interval::new(place.s, piece.range.lo);
                    self.gap(line, gap, [place.inside, piece.inside[0]], counts, report);
                }
                for root in &line.found[place.band].roots[piece.roots[0]..piece.roots[1]] {
                    report(Crossing {
                        t: line.t(root.s),
                        err: root.err * line.per_s,
                        shift: root.shift,
                        entering: root.entering,
                        part: if root.jump { part::WALL } else { part::SURFACE },
                        cap: false,
                    });
                }
                place.piece += 1;
                place.s = piece.range.hi;
                place.inside = piece.inside[1];
                return false;
            }
            place.band += 1;
            place.piece = 0;
        }
        if self.body == Body::Solid {
            let gap = Interval::new(place.s, f64::INFINITY);
            self.gap(line, gap, [place.inside, false], counts, report);
        }
        true
    }

    /// Reports the caps of a gap.
    fn gap(
        &self,
        line: &mut LineScratch,
        gap: Interval,
        ends: [bool; 2],
        counts: &mut Counts,
        report: &mut impl FnMut(Crossing),
    ) {
        let Some(unit) = line.line else { return };
        line.caps.clear();
        let blind = line.bands.iter().map(|b| b.range);
        self.caps(&unit, gap, ends, blind, &mut line.caps);
        for cap in &line.caps {
            counts.caps += 1;
            counts.parity_repairs += u64::from(cap.repair);
            let err = if cap.repair { WALL * self.width_near(&unit, cap.s, line) } else { cap.err };
            report(Crossing {
                t: line.t(cap.s),
                err: err * line.per_s,
                shift: cap.err,
                entering: cap.entering,
                part: if cap.repair { part::WALL } else { part::CAP },
                cap: true,
            });
        }
    }
}
