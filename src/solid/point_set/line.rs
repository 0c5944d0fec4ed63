//! One line through a point set surface: bands, gaps, and the states between.
//!
//! Whether a place is inside is a function of the place alone: the sign of F where F is defined; elsewhere, in a
//! gap, the state that both its ends agree on, or, in a gap that meets a hole or whose ends disagree, whether the
//! winding number exceeds one half. What is found never depends on the range asked: bands are searched whole.

use glam::DVec3;

use super::PointSet;
use super::caps::{Cap, places};
use super::hierarchy::{CellOn, Reach};
use super::probe::Room;
use super::quick::{QuickRoom, Said};
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

/// A band: a stretch of the line near cells that overlap.
#[derive(Clone, Copy, Debug)]
struct Band {
    range: Interval,
    /// Its cells are this range of the sorted list.
    cells: [usize; 2],
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
    cells: Vec<CellOn>,
    bands: Vec<Band>,
    /// Trust spheres of the band searched last, sorted.
    reaches: Vec<Reach>,
    /// Stretches inside overlapping trust spheres, of the bands that were searched for roots of F.
    spheres: Vec<Interval>,
    found: Vec<Findings>,
    room: Room,
    quick: QuickRoom,
    searched: Findings,
    states: Vec<(f64, bool, bool)>,
    stack: Vec<Stretch>,
    caps: Vec<Cap>,
}

impl LineScratch {
    fn t(&self, s: f64) -> f64 {
        self.t0 + s * self.per_s
    }
}

/// The cells of the band at or after arc length `s`.
fn cells_at<'a>(bands: &[Band], cells: &'a [CellOn], s: f64) -> &'a [CellOn] {
    let band = bands.partition_point(|b| b.range.hi < s).min(bands.len().max(1) - 1);
    bands.get(band).map_or(&[][..], |b| &cells[b.cells[0]..b.cells[1]])
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
        let cells = cells_at(&line.bands, &line.cells, s);
        if crossing.part == part::WALL {
            // A wall stands where definitions disagree: the nearest sample tells best how the surface lies.
            let normal = self.nearest_of(at, cells).map_or(facing, |nearest| self.samples.normal(nearest));
            return if 0.0 < normal.dot(facing) { normal } else { facing };
        }
        let before = line.room.work;
        let normal = self.patch_normal(&unit, s, cells, &mut line.room).or_else(|| {
            let sample = self.nearest_of(at, cells)?;
            self.field_near(at, sample, &mut line.room).ok()?.gradient.try_normalize()
        });
        line.room.charge(before, counts);
        normal.unwrap_or(facing)
    }

    /// The width of the sample nearest to arc length `s`.
    fn width_near(&self, unit: &Ray, s: f64, line: &LineScratch) -> f64 {
        let nearest = self.nearest_of(unit.at(s), cells_at(&line.bands, &line.cells, s));
        nearest.map_or(0.0, |i| self.samples.widths[i])
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
        line.bands.clear();
        line.spheres.clear();
        self.samples.cells_on(&unit, &mut line.cells);
        line.cells.sort_unstable_by(|a, b| a.range.lo.total_cmp(&b.range.lo).then(a.cell.cmp(&b.cell)));
        for (i, cell) in line.cells.iter().enumerate() {
            match line.bands.last_mut() {
                Some(band) if cell.range.lo <= band.range.hi => {
                    band.range.hi = band.range.hi.max(cell.range.hi);
                    band.cells[1] = i + 1;
                }
                _ => line.bands.push(Band { range: cell.range, cells: [i, i + 1], searched: false }),
            }
        }
        if line.found.len() < line.bands.len() {
            line.found.resize_with(line.bands.len(), Findings::default);
        }
    }

    /// Finds the roots of a band, once a line: those of its patches where they decide it, else those of F.
    fn search(&self, line: &mut LineScratch, index: usize, counts: &mut Counts) {
        if line.bands[index].searched {
            return;
        }
        line.bands[index].searched = true;
        let band = line.bands[index];
        let before = line.room.work;
        line.found[index].clear();
        if !self.by_patches(line, index, counts) {
            line.found[index].clear();
            self.by_search(line, band, index);
        }
        line.room.charge(before, counts);
        let found = &line.found[index];
        counts.crossings += found.roots.len() as u64;
        counts.certificate_failures += found.failures;
        counts.parity_repairs += found.roots.iter().filter(|r| r.jump).count() as u64;
    }

    /// Finds the roots of a band by its patches and guides, and those of F only where nothing follows the surface; `false` where
    /// what comes out does not fit together, and nothing is filled in then.
    fn by_patches(&self, line: &mut LineScratch, index: usize, counts: &mut Counts) -> bool {
        let Some(unit) = line.line.filter(|_| !self.patches.are_none()) else { return false };
        let Band { range, cells, .. } = line.bands[index];
        let near = &line.cells[cells[0]..cells[1]];
        let said =
            self.quick(&unit, (range, near), &mut line.room, &mut line.quick, &mut line.found[index], counts);
        match said {
            Said::Nothing => false,
            Said::All => {
                let found = &mut line.found[index];
                let piece = self.whole_piece(&unit, (range, near), &mut line.quick, &found.roots);
                piece.is_ok_and(|piece| {
                    found.pieces.extend(piece);
                    true
                })
            }
            Said::Some => self.around_rough(line, index, &unit),
        }
    }

    /// Searches the rough stretches of a band for roots of F, and puts them between those of patches; `false` where these do
    /// not fit together, or not to what the samples at the ends of the band say.
    fn around_rough(&self, line: &mut LineScratch, index: usize, unit: &Ray) -> bool {
        let Band { cells, .. } = line.bands[index];
        self.samples.spheres_on(&line.cells[cells[0]..cells[1]], unit, &mut line.reaches);
        let LineScratch { reaches, found, room, quick, stack, searched, states, .. } = line;
        let found = &mut found[index];
        searched.clear();
        for rough in &quick.rough {
            // Spheres of all samples near, as F is that of the nearest one.
            let from = reaches.partition_point(|r| r.range.lo <= rough.hi);
            Search { set: self, line: unit, spheres: &reaches[..from], room, out: searched, stack }
                .run(*rough);
        }
        let whole = searched.pieces.len() == quick.rough.len()
            && searched.pieces.iter().zip(&quick.rough).all(|(piece, rough)| piece.range == *rough);
        let pieces = searched.pieces.iter();
        // Where each begins, and the states before and after it.
        states.clear();
        states.extend(pieces.map(|p| (p.range.lo, p.inside[0], p.inside[1])));
        states.extend(found.roots.iter().map(|r| (r.s, !r.entering, r.entering)));
        states.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(first), Some(last)) = (states.first(), states.last()) else { return false };
        let inside = [first.1, last.2];
        let hi = reaches.iter().map(|r| r.range.hi).fold(f64::NEG_INFINITY, f64::max);
        let range = Interval::new(reaches[0].range.lo.min(first.0), hi.max(last.0));
        let near = &line.cells[cells[0]..cells[1]];
        let side = |s: f64| self.side(unit.at(s), near);
        let fits = whole
            && states.windows(2).all(|w| w[0].2 == w[1].1)
            && [side(range.lo), side(range.hi)] == inside.map(Some);
        if fits {
            found.roots.extend(searched.roots.iter().copied());
            found.roots.sort_unstable_by(|a, b| a.s.total_cmp(&b.s));
            found.failures += searched.failures;
            found.pieces.push(Piece { range, inside, roots: [0, found.roots.len()] });
        }
        fits
    }

    /// Isolates the roots of F in a band, in each stretch of overlapping trust spheres.
    fn by_search(&self, line: &mut LineScratch, band: Band, index: usize) {
        let unit = line.line.unwrap_or(Ray::new(DVec3::ZERO, DVec3::Z));
        self.samples.spheres_on(&line.cells[band.cells[0]..band.cells[1]], &unit, &mut line.reaches);
        let mut from = 0;
        while from < line.reaches.len() {
            let mut range = line.reaches[from].range;
            let more = line.reaches[from..].iter().take_while(|r| {
                let overlaps = r.range.lo <= range.hi;
                range.hi = if overlaps { range.hi.max(r.range.hi) } else { range.hi };
                overlaps
            });
            let until = from + more.count();
            line.spheres.push(range);
            Search {
                set: self,
                line: &unit,
                spheres: &line.reaches[from..until],
                room: &mut line.room,
                out: &mut line.found[index],
                stack: &mut line.stack,
            }
            .run(range);
            from = until;
        }
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

    /// Whether the samples beside a stretch in which F is undefined say that the line stays on the side that both ends of its gap
    /// are on: then the winding number need not be asked.
    fn stays(&self, unit: &Ray, stretch: Interval, [before, after]: [bool; 2], line: &LineScratch) -> bool {
        let side = |s: f64| self.side(unit.at(s), cells_at(&line.bands, &line.cells, s));
        before == after && places(stretch).all(|s| side(s) == Some(before))
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
        let mut caps = std::mem::take(&mut line.caps);
        caps.clear();
        let blind = line.spheres.iter().map(|s| s.intersect(gap));
        let blind = blind.filter(|s| s.lo < s.hi && !self.stays(&unit, *s, ends, line));
        self.caps(&unit, gap, ends, blind, &mut caps);
        for cap in &caps {
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
        line.caps = caps;
    }
}
