//! Caps: where a scan has holes, its inside ends at winding number one half.
//!
//! Across a round hole that level is exactly the flat disc of its chord. The winding number is asked only in gaps,
//! at least a width away from every sample, where it is smooth; and only in gaps that meet the box of a hole, or
//! whose ends disagree.

use super::PointSet;
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::Body;

/// What `.close` adds to a surface.
#[derive(Clone, Debug)]
pub struct Closure {
    /// A box around each capped hole, grown by the reach of the samples on its rim.
    pub boxes: Vec<Aabb>,
    /// For each sample in the order of the hierarchy: whether it lies near a rim.
    pub rim: Vec<bool>,
}

/// A crossing of a cap.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Cap {
    /// Arc length.
    pub s: f64,
    /// Half the width of an interval that holds it.
    pub err: f64,
    /// Whether the line goes in.
    pub entering: bool,
    /// Whether it mends ends that disagree instead of lying at the level one half.
    pub repair: bool,
}

/// The level that a cap lies at.
const LEVEL: f64 = 0.5;

impl PointSet {
    /// The surface with its holes capped: a [`Body::Solid`]. A hole is given by the samples on its rim, as indices
    /// into the lists that the surface was made from. The samples are shared.
    pub fn closed(&self, rims: &[Vec<u32>]) -> PointSet {
        let mut place = vec![0u32; self.samples.points.len()];
        for (i, original) in self.samples.original.iter().enumerate() {
            place[*original as usize] = i as u32;
        }
        let grown = |rim: &Vec<u32>| {
            let at = |i: &u32| place[*i as usize] as usize;
            let widest = rim.iter().map(|i| self.samples.widths[at(i)]).fold(0.0, f64::max);
            // The caps of a rim lie between its samples, up to a width beyond where the surface ends.
            Aabb::of_points(rim.iter().map(|i| self.samples.points[at(i)])).inflated(2.0 * widest)
        };
        let boxes: Vec<Aabb> = rims.iter().map(grown).collect();
        let rim = self.samples.points.iter().map(|p| boxes.iter().any(|b| b.contains(*p))).collect();
        PointSet { closure: Some(Closure { boxes, rim }), ..self.with_body(Body::Solid) }
    }

    /// Appends the caps of a gap, ascending; `ends` are the states at its two ends, `blind` the stretches of bands in
    /// which F is undefined.
    pub(super) fn caps(
        &self,
        line: &Ray,
        gap: Interval,
        ends: [bool; 2],
        blind: impl Iterator<Item = Interval>,
        out: &mut Vec<Cap>,
    ) {
        let boxes = self.closure.as_ref().map_or(&[][..], |c| &c.boxes);
        let in_holes = |s: f64| boxes.iter().any(|b| b.contains(line.at(s)));
        let stretches = boxes.iter().map(|b| b.clip(line)).chain(blind);
        for stretch in merged(stretches.map(|s| s.intersect(gap)).filter(|s| s.lo < s.hi)) {
            self.scan(line, stretch, out);
        }
        // Away from holes the level one half only stands in for a surface that F fails to give.
        out.iter_mut().for_each(|cap| cap.repair = !in_holes(cap.s));
        if out.is_empty() && ends[0] == ends[1] {
            return;
        }
        if out.is_empty() {
            let all = self.samples.reach().clip(line).intersect(gap);
            if !all.is_empty() {
                self.scan(line, all, out);
            }
            out.iter_mut().for_each(|cap| cap.repair = true);
        }
        mend(gap, ends, || 0.0 <= self.level(line, 0.5 * (gap.lo + gap.hi)).value, out);
    }

    /// Appends every place of a stretch where the winding number passes one half.
    fn scan(&self, line: &Ray, stretch: Interval, out: &mut Vec<Cap>) {
        let mut levels = places(stretch).map(|s| self.level(line, s));
        let Some(mut a) = levels.next() else { return };
        for b in levels {
            self.scan_cell(line, a, b, 0, out);
            a = b;
        }
    }

    fn scan_cell(&self, line: &Ray, a: Level, b: Level, depth: usize, out: &mut Vec<Cap>) {
        // Two crossings nearer than a cell's 2^-6 are those of a line that grazes the cap.
        const DEPTH: usize = 6;
        if (a.value < 0.0) != (b.value < 0.0) {
            out.push(self.refine_cap(line, a, b));
            return;
        }
        // Both ends lean towards the level: it may be passed twice between.
        let sign = if a.value < 0.0 { -1.0 } else { 1.0 };
        let leaning = sign * a.slope < 0.0 && 0.0 < sign * b.slope;
        let length = b.s - a.s;
        let near = a.value.abs().min(b.value.abs()) < length * a.slope.abs().max(b.slope.abs());
        if leaning && near && depth < DEPTH {
            let share = (a.slope / (a.slope - b.slope)).clamp(0.1, 0.9);
            let middle = self.level(line, a.s + share * length);
            self.scan_cell(line, a, middle, depth + 1, out);
            self.scan_cell(line, middle, b, depth + 1, out);
        }
    }

    fn refine_cap(&self, line: &Ray, mut a: Level, mut b: Level) -> Cap {
        let entering = a.value < 0.0;
        let mut last = if a.value.abs() < b.value.abs() { a } else { b };
        // Halving alone would need fewer than 60 steps from a cell to the last bit.
        for step in 0..60 {
            let newton = last.s - last.value / last.slope;
            let inside = a.s < newton && newton < b.s && step % 4 != 3;
            let s = if inside { newton } else { 0.5 * (a.s + b.s) };
            let close = (s - last.s).abs();
            last = self.level(line, s);
            if (last.value < 0.0) == (a.value < 0.0) {
                a = last
            } else {
                b = last
            }
            if close.min(b.s - a.s) <= 0.25 * self.tolerance || last.value == 0.0 {
                break;
            }
        }
        Cap { s: last.s, err: self.tolerance.min(b.s - a.s), entering, repair: false }
    }

    /// How far the winding number exceeds one half, and its slope along the line.
    fn level(&self, line: &Ray, s: f64) -> Level {
        let (w, gradient) = self.winding().value_and_gradient(line.at(s));
        Level { s, value: w - LEVEL, slope: gradient.dot(line.dir) }
    }
}

/// Where a stretch is looked at. Harmonic and away from the samples, the winding number varies on the scale of the hole itself;
/// a shorter swing would show in the slopes.
pub(super) fn places(stretch: Interval) -> impl Iterator<Item = f64> {
    const CELLS: usize = 12;
    (0..=CELLS).map(move |i| stretch.lo + stretch.length() * i as f64 / CELLS as f64)
}

#[derive(Clone, Copy, Debug)]
struct Level {
    s: f64,
    value: f64,
    slope: f64,
}

/// Disjoint stretches in ascending order.
fn merged(stretches: impl Iterator<Item = Interval>) -> Vec<Interval> {
    let mut all: Vec<Interval> = stretches.filter(|s| !s.is_empty()).collect();
    all.sort_by(|a, b| a.lo.total_cmp(&b.lo));
    Interval::unite(&mut all);
    all
}

/// Makes the states alternate from one end of the gap to the other. Between its ends the winding number decides, at its
/// ends F does: where they disagree a wall stands, at that end, whichever way the line runs. `between` tells the state
/// in the middle of a finite gap; it is asked only where no crossing tells.
fn mend(gap: Interval, [before, after]: [bool; 2], between: impl FnOnce() -> bool, caps: &mut Vec<Cap>) {
    let wall = |s: f64, entering: bool| Cap { s, err: 0.0, entering, repair: true };
    if caps.is_empty() && before != after {
        // Past the samples there is no inside.
        let inside = gap.lo.is_finite() && gap.hi.is_finite() && between();
        let near =
            if gap.lo.is_finite() && gap.hi.is_finite() { inside != before } else { gap.lo.is_finite() };
        caps.push(wall(if near { gap.lo } else { gap.hi }, after));
        return;
    }
    let mut state = before;
    let mut out = Vec::with_capacity(caps.len() + 2);
    for cap in caps.iter() {
        if cap.entering == state {
            if !out.is_empty() || !gap.lo.is_finite() {
                continue; // Two crossings of one sense: the later adds nothing.
            }
            out.push(wall(gap.lo, !state));
        }
        out.push(*cap);
        state = cap.entering;
    }
    if state != after {
        if gap.hi.is_finite() {
            out.push(wall(gap.hi, after));
        } else {
            out.pop(); // An entry from which nothing comes out again.
        }
    }
    *caps = out;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cap(s: f64, entering: bool) -> Cap {
        Cap { s, err: 0.0, entering, repair: false }
    }

    fn cases() -> [(Interval, [bool; 2], Vec<Cap>); 5] {
        [
            (Interval::new(0.0, 1.0), [true, false], vec![]),
            (Interval::new(0.0, 1.0), [false, false], vec![cap(0.5, false)]),
            (Interval::new(f64::NEG_INFINITY, 1.0), [false, true], vec![cap(0.5, true)]),
            (Interval::new(0.0, f64::INFINITY), [true, false], vec![]),
            (Interval::new(0.0, f64::INFINITY), [false, false], vec![cap(0.2, true)]),
        ]
    }

    #[test]
    fn states_alternate_after_mending() {
        for (gap, ends, mut caps) in cases() {
            mend(gap, ends, || true, &mut caps);
            let mut state = ends[0];
            for c in &caps {
                assert_ne!(c.entering, state);
                assert!(gap.contains(c.s));
                state = c.entering;
            }
            assert_eq!(state, ends[1], "{gap:?}");
        }
    }

    #[test]
    fn a_line_and_its_reverse_are_mended_alike() {
        for (gap, ends, caps) in cases() {
            for inside in [false, true] {
                let mut forth = caps.clone();
                mend(gap, ends, || inside, &mut forth);
                let turn = |c: &Cap| Cap { s: 0.0 - c.s, entering: !c.entering, ..*c };
                let mut back: Vec<Cap> = caps.iter().rev().map(turn).collect();
                mend(Interval::new(-gap.hi, -gap.lo), [ends[1], ends[0]], || inside, &mut back);
                let back: Vec<Cap> = back.iter().rev().map(turn).collect();
                assert_eq!(forth, back, "{gap:?} {ends:?}");
            }
        }
    }
}
