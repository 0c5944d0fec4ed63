//! An open surface given a thickness.
//!
//! A point p is inside where its foot x on the surface is nearer than half the thickness and the samples about x have
//! not ended: |s| < d/2 and e < 0, with s the signed distance of p from x and e the drift of the samples about x less
//! that of a straight edge. So both faces are true offsets of F = 0 (a plane's are planes, a sphere's spheres, to
//! rounding) and the rim is the ruled surface of the normals along the line where the samples end: no fringe and no
//! rounding. This fits every d: the band in which F is defined, some width to either side, bounds only where feet are,
//! not how far from them a point may lie. (Roots of F -+ d/2 end with the band; moving the samples by d/2 to both sides
//! needs a round rim of new samples, denser than d/4, and errs by what those fail to resolve.)
//!
//! Inside is a function of the point alone, false far off, so crossings alternate and are even in number on every line.
//! All changes of it are found by two certificates. Signed distance has slope at most one, and so has, nearly, the
//! drift in widths: a cell shorter than what its ends are away from any change has none. And s is as smooth as the
//! surface: it stays within M L^2 / 8 of the straight line between its ends in a cell of length L, with M as for F.
//! Cells too small to go on with, and undecided, are counted.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::probe::Room;
use super::{PointSet, next_id};
use crate::cloud::neighbours::{Near, Neighbours};
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::{Answer, Cost, Counts, Crossing, Scratch, Solid};

/// Numbers of the parts of the boundary.
mod part {
    /// The face that the surface's normals point out of.
    pub const FRONT: u32 = 0;
    /// The other face.
    pub const BACK: u32 = 1;
    /// Along the line where the samples end.
    pub const RIM: u32 = 2;
}

/// A surface of points with a thickness.
#[derive(Clone, Debug)]
pub struct Thick {
    id: u64,
    surface: Arc<PointSet>,
    half: f64,
    widest: f64,
    /// The samples, by true distance.
    near: Arc<Neighbours>,
    /// The drift at each sample.
    drifts: Arc<Vec<f64>>,
}

/// What is known of one line through one thickened surface.
#[derive(Debug, Default)]
pub struct ThickLine {
    id: Option<u64>,
    ray: Option<Ray>,
    found: Vec<Crossing>,
    room: Room,
    near: Vec<Near>,
}

/// What is known about a place of a line.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Arc length.
    s: f64,
    /// Signed distance from the surface and its slope along the line; e in widths. `None` where there is no foot.
    foot: Option<[f64; 3]>,
    /// No change of state is nearer than this.
    clear: f64,
    width: f64,
    inside: bool,
}

/// A sample whose drift exceeds this lies near where the samples end: even samplings show some 0.05 away from it.
const NEAR_RIM: f64 = 0.2;
/// The drift of a straight edge grows by at most 1 per width outward (far off it is the distance itself), by at most
/// 0.64 inward of the edge; corners and uneven samplings are allowed for.
const OUTWARD: f64 = 0.7;
const INWARD: f64 = 1.2;
/// A point beside a rim and this many widths off the normal of its nearest sample is past the edge: that lies within a
/// spacing, half a width, of the last sample.
const PAST: f64 = 1.0;
const EDGE_WITHIN: f64 = 0.6;
/// Undecided cells are left at this share of the width or of half the thickness: what fits between is thinner than 1e-6
/// of it, a chord beside a point where the line touches.
const SHORTEST: f64 = 1e-3;
/// Next to places without a foot, in the same unit.
const BLIND: f64 = 0.05;
/// Cells in which one change is sought, in the same unit.
const SINGLE: f64 = 0.25;
/// |s''| is at most this over the width on all but rough clouds (as for F), and this times what slopes show.
const CURVATURE: f64 = 1.0;
const MARGIN: f64 = 2.0;

impl PointSet {
    /// The surface with a thickness, `thickness` / 2 to each side; world length, above zero.
    pub fn thickened(&self, thickness: f64) -> Thick {
        let samples = &self.samples;
        let drift =
            |room: &mut Room, i: usize| self.field_near(samples.points[i], i, room).map_or(0.0, |f| f.drift);
        let all = (0..samples.points.len()).into_par_iter();
        Thick {
            id: next_id(),
            half: 0.5 * thickness,
            widest: samples.widths.iter().copied().fold(0.0, f64::max),
            near: Arc::new(Neighbours::new(&samples.points)),
            drifts: Arc::new(all.map_init(Room::default, drift).collect()),
            surface: Arc::new(self.clone()),
        }
    }
}

impl Thick {
    fn place(&self, line: &Ray, s: f64, room: &mut Room, near: &mut Vec<Near>) -> Place {
        let p = line.at(s);
        let samples = &self.surface.samples;
        self.near.nearest(p, TRIES, near);
        let first = near[0].index as usize;
        let width = samples.widths[first];
        let away = near[0].distance_squared.sqrt() - self.half;
        let outside = |clear: f64| Place { s, foot: None, clear: clear.max(0.0), width, inside: false };
        if self.widest <= away {
            return outside(away - 0.99 * self.widest);
        }
        if NEAR_RIM < self.drifts[first] {
            let off = p - samples.points[first];
            let lateral = off.reject_from_normalized(samples.normal(first)).length() / width;
            if PAST < lateral {
                return outside((OUTWARD * (lateral - EDGE_WITHIN) * width).max(away - self.widest));
            }
        }
        // F may fail at a sample of a rough cloud: the next one serves.
        let foot = near.iter().find_map(|n| self.surface.foot_from(p, n.index as usize, room).ok());
        let Some(foot) = foot else { return outside(away - self.widest) };
        let e = foot.drift - self.surface.edge();
        let beyond = foot.distance.abs() - self.half;
        let inside = beyond < 0.0 && e < 0.0;
        let clear = if inside {
            (-beyond).min(-e / INWARD * foot.width)
        } else {
            beyond.max(OUTWARD * e * foot.width)
        };
        let slope = foot.normal.dot(line.dir);
        Place { s, foot: Some([foot.distance, slope, e]), clear, width: foot.width, inside }
    }

    /// Every crossing of a line, as arc lengths.
    fn search(&self, line: &Ray, room: &mut Room, near: &mut Vec<Near>, counts: &mut Counts) -> Vec<Found> {
        let range = self.bounds().clip(line);
        let mut found = Vec::new();
        if range.is_empty() || range.length() == 0.0 {
            return found;
        }
        let mut place = |s: f64| self.place(line, s, room, near);
        let mut stack = vec![(place(range.lo), place(range.hi))];
        while let Some((a, b)) = stack.pop() {
            let length = b.s - a.s;
            let unit = a.width.min(b.width).min(self.half);
            let blind = a.foot.is_none() || b.foot.is_none();
            let short = length <= if blind { BLIND } else { SHORTEST } * unit;
            if a.inside != b.inside {
                if self.is_single(&a, &b) || length <= SHORTEST * unit {
                    found.push(self.refine(a, b, &mut place));
                    continue;
                }
            } else if length < a.clear + b.clear || self.is_steady(&a, &b) {
                continue;
            } else if short {
                counts.certificate_failures += u64::from(!blind);
                continue;
            }
            let middle = place(0.5 * (a.s + b.s));
            stack.push((middle, b));
            stack.push((a, middle));
        }
        found
    }

    fn curvature(a: &Place, b: &Place, slopes: [f64; 2]) -> f64 {
        (CURVATURE / a.width.min(b.width)).max(MARGIN * (slopes[1] - slopes[0]).abs() / (b.s - a.s))
    }

    /// Whether the smoothness of s proves that a cell with like ends holds no change.
    fn is_steady(&self, a: &Place, b: &Place) -> bool {
        let (Some([sa, da, ea]), Some([sb, db, eb])) = (a.foot, b.foot) else { return false };
        let length = b.s - a.s;
        let far_from_rim = length < (-ea / INWARD) * a.width + (-eb / INWARD) * b.width;
        if !far_from_rim || 2.0 * a.width.min(b.width) < length {
            return false;
        }
        let slack = Thick::curvature(a, b, [da, db]) * length * length / 8.0;
        if a.inside {
            return slack < self.half - sa.abs().max(sb.abs());
        }
        let (least, most) = (sa.min(sb), sa.max(sb));
        self.half + slack < least || most < -self.half - slack
    }

    /// Whether a cell with unlike ends holds one change: that of s at one of the faces.
    fn is_single(&self, a: &Place, b: &Place) -> bool {
        let (Some([sa, da, ea]), Some([sb, db, eb])) = (a.foot, b.foot) else { return false };
        let length = b.s - a.s;
        let unit = a.width.min(b.width).min(self.half);
        let far_from_rim = length < (-ea / INWARD) * a.width + (-eb / INWARD) * b.width;
        if ea < 0.0 && eb < 0.0 && far_from_rim {
            let bend = 0.5 * Thick::curvature(a, b, [da, db]) * length;
            let steady = bend < da.abs() && bend < db.abs() && (da < 0.0) == (db < 0.0);
            return steady && length < 2.0 * a.width.min(b.width) && 0.0 < sa * sb;
        }
        // The rim: a drift that changes sign within so little does so once.
        let within = sa.abs().max(sb.abs()) < self.half - length;
        within && length <= SINGLE * unit
    }

    /// The change of state between two places, to the tolerance: Newton's method on s within the bracket, halving or
    /// false position elsewhere.
    fn refine(&self, mut a: Place, mut b: Place, place: &mut impl FnMut(f64) -> Place) -> Found {
        let entering = b.inside;
        let tolerance = self.surface.tolerance();
        // What changes sign at the boundary, positive outside, where it is known.
        let value = |p: &Place| p.foot.map(|[s, _, e]| (s.abs() - self.half).max(e * p.width));
        for step in 0..MAX_STEPS {
            if b.s - a.s <= 0.5 * tolerance {
                break;
            }
            let middle = 0.5 * (a.s + b.s);
            let guess = match (value(&a), value(&b)) {
                // Each third step halves, so that a flat end cannot hold the other.
                (Some(fa), Some(fb)) if step % 3 != 2 => {
                    let newton = self.newton(if fa.abs() < fb.abs() { &a } else { &b });
                    let secant = a.s + (b.s - a.s) * fa / (fa - fb);
                    newton.filter(|s| a.s < *s && *s < b.s).unwrap_or(secant)
                }
                _ => middle,
            };
            // A guess beside the root would leave the far end where it is: overshoot by half the tolerance.
            let guess = guess + 0.25 * tolerance * if guess < middle { 1.0 } else { -1.0 };
            let guess = if a.s < guess && guess < b.s { guess } else { middle };
            let next = place(guess);
            if next.inside == a.inside { a = next } else { b = next }
        }
        let inner = if entering { b } else { a };
        let outer = if entering { a } else { b };
        let part = match (outer.foot, inner.foot) {
            (Some([s, _, e]), _) if e < 0.0 => {
                if s < 0.0 {
                    part::BACK
                } else {
                    part::FRONT
                }
            }
            _ => part::RIM,
        };
        Found { s: 0.5 * (a.s + b.s), err: 0.5 * (b.s - a.s), entering, part }
    }

    /// Newton's step towards the face that a place is next to.
    fn newton(&self, p: &Place) -> Option<f64> {
        let [s, slope, e] = p.foot?;
        let beyond = s.abs() - self.half;
        (e * p.width < beyond && slope != 0.0).then(|| p.s - beyond / (slope * s.signum()))
    }

    fn line<'a>(&self, ray: &Ray, scratch: &'a mut Scratch) -> &'a mut ThickLine {
        let Scratch { counts, thick, .. } = scratch;
        let index = thick.iter().position(|l| l.id == Some(self.id)).unwrap_or_else(|| {
            thick.push(ThickLine { id: Some(self.id), ..ThickLine::default() });
            thick.len() - 1
        });
        let line = &mut thick[index];
        if line.ray != Some(*ray) {
            line.ray = Some(*ray);
            let (unit, t0, per_s) = self.unit(ray);
            let before = line.room.work.projections;
            let found = self.search(&unit, &mut line.room, &mut line.near, counts);
            counts.projections += line.room.work.projections - before;
            counts.crossings += found.len() as u64;
            line.found = found
                .iter()
                .map(|f| Crossing {
                    t: t0 + f.s * per_s,
                    err: f.err * per_s,
                    shift: f.err.min(self.surface.tolerance()),
                    entering: f.entering,
                    part: f.part,
                    cap: false,
                })
                .collect();
        }
        line
    }

    /// The line of a ray with unit direction, its origin near the samples; t of that origin and t per arc length.
    fn unit(&self, ray: &Ray) -> (Ray, f64, f64) {
        let length = ray.dir.length();
        let t0 = (self.bounds().center() - ray.origin).dot(ray.dir) / (length * length);
        (Ray::new(ray.at(t0), ray.dir / length), t0, 1.0 / length)
    }

    /// The gradient of the drift at a point, by differences over a hundredth of a width.
    fn outward_of_rim(&self, line: &Ray, s: f64, scratch: &mut ThickLine) -> Option<DVec3> {
        let width = self.place(line, s, &mut scratch.room, &mut scratch.near).width;
        let mut drift = |by: DVec3| {
            let moved = Ray::new(line.at(s) + 0.01 * width * by, line.dir);
            self.place(&moved, 0.0, &mut scratch.room, &mut scratch.near).foot.map(|f| f[2])
        };
        let [x, y, z] = DVec3::AXES.map(|axis| Some(drift(axis)? - drift(-axis)?));
        DVec3::new(x?, y?, z?).try_normalize()
    }
}

/// Samples from which a foot is sought.
const TRIES: usize = 4;
/// Steps of a refinement: halving alone takes fewer from a width to the last bit.
const MAX_STEPS: usize = 80;

/// A change of state on a line.
#[derive(Clone, Copy, Debug)]
struct Found {
    s: f64,
    err: f64,
    entering: bool,
    part: u32,
}

impl Solid for Thick {
    fn bounds(&self) -> Aabb {
        // Feet lie within a width of their samples.
        self.extent_under(&DAffine3::IDENTITY).inflated(self.widest)
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        let Aabb { min, max } = self.surface.extent_under(to_from);
        // The image of a ball reaches the length of the map's row along each axis.
        let rows = to_from.matrix3.transpose();
        let reach = self.half * DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        Aabb { min: min - reach, max: max + reach }
    }

    fn crossings(&self, ray: &Ray, _: Interval, scratch: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        out.extend_from_slice(&self.line(ray, scratch).found);
        Answer::whole_line(false)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        let line = self.line(ray, scratch);
        let (unit, t0, per_s) = self.unit(ray);
        let s = (crossing.t - t0) / per_s;
        let facing = if crossing.entering { -unit.dir } else { unit.dir };
        if crossing.part == part::RIM {
            return self.outward_of_rim(&unit, s, line).unwrap_or(facing);
        }
        self.near.nearest(unit.at(s), TRIES, &mut line.near);
        let foots = line.near.iter().map(|n| n.index as usize);
        let foot = foots.into_iter().find_map(|i| self.surface.foot_from(unit.at(s), i, &mut line.room).ok());
        let sign = if crossing.part == part::FRONT { 1.0 } else { -1.0 };
        foot.map_or(facing, |f| sign * f.normal)
    }

    fn shift_bound(&self) -> f64 {
        self.surface.tolerance()
    }

    fn cost(&self) -> Cost {
        Cost::Heavy
    }
}
