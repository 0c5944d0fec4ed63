//! How the guide and the patch of a cell are made.

use std::ops::Range;

use glam::{DMat2, DVec2, DVec3};

use super::poly::{self, COEFFICIENTS, DEGREE, FITTED, GUIDE_DEGREE, Jet, NODES, Placed};
use super::{GUIDING, MARGINS, Patch, ROUGH};
use crate::solid::point_set::PointSet;
use crate::solid::point_set::probe::Room;

/// Samples within so many widths of the domain matter: what is farther weighs a tenth at most.
const REACH: f64 = 1.25;
/// Another sheet that faces this one is at least so many widths away.
const APART: f64 = 0.75;
/// Samples of one sheet face this much the same way as the patch, at least: within 60 degrees.
const FACING: f64 = 0.5;
/// And lie no farther off the plane of the patch than this share of their distance along it, and so many widths.
const SLOPE: f64 = 0.8;
const THICK: f64 = 0.3;
/// The samples lean to one side by less than this many widths: a rim is not near.
const LEANING: f64 = 0.3;
/// What is left of F after a step of Newton's method is its square over the width, times something between these.
const STEP: f64 = 1.0;
const LEAST_STEP: f64 = 0.02;
/// It is measured at the middle from so many widths away, and this many times as much is allowed for elsewhere.
const PROBE: f64 = 0.05;
const MARGIN: f64 = 4.0;
/// Samples this far from the middle, in half widths of the domain, still shape a guide.
const BESIDE: f64 = 1.1;
/// The surface lies within so many times the root mean square of what samples miss the guide by, and is not known better
/// than so many widths: it passes between samples.
const SPREAD: f64 = 2.0;
const LEAST: f64 = 5e-3;
/// The share of the tolerance that may be left.
const SHARE: f64 = 0.25;
/// Steps at a node.
const STEPS: usize = 4;
/// The error may be this many times what was measured.
const SAFETY: f64 = 4.0;
/// Distances to the nearest sample are asked for at places so many widths apart: one is within 0.71 of that.
const FINE: f64 = 0.25;

/// The frame of a cell.
struct Frame {
    origin: DVec3,
    axes: [DVec3; 3],
    half: [f64; 2],
    width: f64,
}

/// The guide of some samples: the polynomial of degree 3 nearest to its samples and those beside it.
pub(super) fn guide(set: &PointSet, of: Range<usize>) -> Option<Patch> {
    // The narrowest margin that covers: a polynomial errs the more the farther it reaches.
    let mut tried = MARGINS.into_iter().map(|margin| (margin, frame(set, &of, margin)));
    let (frame, near) = loop {
        let (margin, frame) = tried.next()?;
        let frame = frame?;
        let near = sheet(set, &frame)?;
        if is_covered(set, &frame, margin, &near) {
            break (frame, near);
        }
    };
    let jets: Vec<Placed> = near.iter().filter_map(|i| placed(set, &frame, *i)).collect();
    let (c, rms) = poly::fit_anywhere(&jets)?;
    let error = (SPREAD * rms * frame.half[0]).max(LEAST * frame.width);
    (error <= GUIDING * frame.width).then(|| made(frame, c, GUIDE_DEGREE, error, f64::INFINITY))
}

/// A sample in the units of the frame, where it is over the domain or just beside: its height, and the slopes that its normal
/// means.
fn placed(set: &PointSet, frame: &Frame, i: u32) -> Option<Placed> {
    let [e1, e2, n] = frame.axes;
    let [a, b] = frame.half;
    let (p, m) = (set.samples.points[i as usize] - frame.origin, set.samples.normal(i as usize));
    let (x, y) = (p.dot(e1) / a, p.dot(e2) / b);
    let up = m.dot(n);
    let over = x.abs() <= BESIDE && y.abs() <= BESIDE;
    over.then(|| Placed { at: [x, y], jet: [p.dot(n) / a, -m.dot(e1) / up, -m.dot(e2) / up * (b / a)] })
}

/// The patch over the domain of a guide.
pub(super) fn patch(set: &PointSet, guide: &Patch, room: &mut Room) -> Option<Patch> {
    let Patch { origin, axes, half, width, .. } = *guide;
    let frame = Frame { origin, axes, half, width };
    let jets = jets(set, &frame, guide, room)?;
    let c = poly::fit(&jets);
    let (mut error, mut lean) = (0.0f64, 0.0f64);
    for (i, jet) in jets.iter().enumerate() {
        let [x, y] = poly::node(i);
        let [z, zx, zy] = poly::evaluate(&c, DEGREE, x, y);
        error = error.max((z - jet[0]).abs());
        lean = lean.max((zx - jet[1]).abs()).max((zy - jet[2]).abs());
    }
    let unit = frame.half[0];
    let world = SAFETY * error * unit;
    if world.is_nan() || guide.error.min(ROUGH * width) < world {
        return None;
    }
    // Terms that cannot be told from the tolerance are not worth their time.
    let spare = 0.25 * (set.tolerance - world).max(0.0);
    let degree = (3..DEGREE).find(|d| poly::tail(&c, *d) * unit <= spare).unwrap_or(DEGREE);
    let error = world + poly::tail(&c, degree) * unit;
    Some(made(frame, c, degree, error, SAFETY * lean))
}

fn made(frame: Frame, c: [f64; COEFFICIENTS], degree: usize, error: f64, lean: f64) -> Patch {
    let Frame { origin, axes, half, width } = frame;
    let ([high, sx, sy], bend) = poly::bounds(&c);
    let e = error / half[0];
    let z = [c[0] - high - e, c[0] + high + e];
    Patch { origin, axes, half, degree, z, steepest: [sx, sy], bend, c, error, lean, width }
}

/// A frame along the longer side of the cell's samples.
fn frame(set: &PointSet, range: &Range<usize>, margin: f64) -> Option<Frame> {
    let samples = &set.samples;
    let count = range.len() as f64;
    let middle = samples.points[range.clone()].iter().sum::<DVec3>() / count;
    let normal = range.clone().map(|i| samples.normal(i)).sum::<DVec3>() / count;
    let n = normal.try_normalize()?;
    let width = samples.widths[range.clone()].iter().copied().fold(f64::INFINITY, f64::min);
    let widest = samples.widths[range.clone()].iter().copied().fold(0.0, f64::max);
    let (b1, b2) = n.any_orthonormal_pair();
    let flat = |i: usize| {
        let d = samples.points[i] - middle;
        DVec2::new(d.dot(b1), d.dot(b2))
    };
    let spread = range.clone().map(flat).fold(DMat2::ZERO, |m, d| m + DMat2::from_cols(d * d.x, d * d.y));
    // The direction of the larger eigenvalue of a symmetric 2 x 2 matrix.
    let (p, q) = (spread.x_axis.x - spread.y_axis.y, 2.0 * spread.x_axis.y);
    let long = p.hypot(q);
    let (c, s) = if 0.0 < long {
        let c = (0.5 * (1.0 + p / long)).max(0.0).sqrt();
        (c, if q < 0.0 { -1.0 } else { 1.0 } * (1.0 - c * c).max(0.0).sqrt())
    } else {
        (1.0, 0.0)
    };
    let (e1, e2) = (c * b1 + s * b2, c * b2 - s * b1);
    let reach = |e: DVec3| {
        let along = range.clone().map(|i| (samples.points[i] - middle).dot(e));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)])
    };
    let ([a0, a1], [b0, b1]) = (reach(e1), reach(e2));
    let origin = middle + 0.5 * ((a0 + a1) * e1 + (b0 + b1) * e2);
    let half = [0.5 * (a1 - a0), 0.5 * (b1 - b0)].map(|h| h + margin * widest);
    Some(Frame { origin, axes: [e1, e2, n], half, width })
}

/// The samples about the domain, where they are one sheet: another may face it from at least [`APART`] widths.
fn sheet(set: &PointSet, frame: &Frame) -> Option<Vec<u32>> {
    let Frame { origin, axes: [e1, e2, n], half, width } = frame;
    let samples = &set.samples;
    let across = half[0].hypot(half[1]);
    let mut near = Vec::new();
    let mut one = true;
    samples.visit(*origin, across, REACH, |i| {
        let d = samples.points[i] - origin;
        let z = d.dot(*n);
        let h = samples.widths[i];
        let beside = (d.dot(*e1).abs() - half[0]).max(d.dot(*e2).abs() - half[1]).max(0.0);
        if REACH * h < beside.hypot((z.abs() - h).max(0.0)) {
            return;
        }
        let facing = samples.normal(i).dot(*n);
        let along = (d - z * n).length();
        let same = FACING <= facing && z.abs() <= SLOPE * along + THICK * h;
        one &= same || (facing <= -FACING && APART * width <= z.abs());
        if same {
            near.push(i as u32);
        }
    });
    one.then_some(near)
}

/// Whether samples stand near every place of the domain: nearer than the margin less what lies between places asked about.
///
/// Then every point of the surface is in the domain of the cell of its nearest sample: else the segment to that sample, all
/// of whose points have the same nearest one, leaves the domain as far from it as the margin.
fn is_covered(set: &PointSet, frame: &Frame, margin: f64, near: &[u32]) -> bool {
    let [e1, e2, _] = frame.axes;
    let [a, b] = frame.half;
    let limit = (margin - 0.71 * FINE) * frame.width;
    let flat = near.iter().map(|i| set.samples.points[*i as usize] - frame.origin);
    let flat = flat.map(|p| DVec2::new(p.dot(e1), p.dot(e2)));
    let flat = flat.filter(|p| p.x.abs() < a + limit && p.y.abs() < b + limit);
    let [across, along] = [a, b].map(|half| (half / (FINE * frame.width)).ceil());
    let [columns, rows] = [across, along].map(|steps| 2 * steps as usize + 1);
    let place = |half: f64, steps: f64, i: usize| half * (i as f64 / steps - 1.0);
    // The places that may be near a coordinate, and one more on either side.
    let about = |half: f64, steps: f64, at: f64| {
        let [from, to] = [at - limit, at + limit].map(|x| (x / half + 1.0) * steps);
        (from.floor().max(0.0) as usize)..(to.ceil().clamp(-1.0, 2.0 * steps) + 1.0) as usize
    };
    let mut near = vec![false; columns * rows];
    for q in flat {
        for i in about(a, across, q.x) {
            for j in about(b, along, q.y) {
                let at = DVec2::new(place(a, across, i), place(b, along, j));
                near[i * rows + j] |= at.distance_squared(q) <= limit * limit;
            }
        }
    }
    near.into_iter().all(|near| near)
}

/// Height and slopes of the surface at all nodes, in the units of the patch.
fn jets(set: &PointSet, frame: &Frame, guide: &Patch, room: &mut Room) -> Option<[Jet; NODES]> {
    let mut jets = [[0.0; 3]; NODES];
    let mut column = Column { set, frame, room, remainder: STEP };
    // The middle first, in two steps at least: it says how much a step leaves.
    let middle = column.middle(guide.c[0] * frame.half[0])?;
    let mut fitted: Option<[f64; COEFFICIENTS]> = None;
    for i in 0..NODES {
        let [x, y] = poly::node(i);
        if i == FITTED {
            fitted = Some(poly::fit(&jets));
        }
        let (c, degree) = fitted.as_ref().map_or((&guide.c, guide.degree), |c| (c, DEGREE));
        let from = poly::evaluate(c, degree, x, y)[0] * frame.half[0];
        jets[i] = if x == 0.0 && y == 0.0 { middle } else { column.jet([x, y], from)? };
    }
    Some(jets)
}

/// Solves F = 0 along lines across the patch.
struct Column<'a> {
    set: &'a PointSet,
    frame: &'a Frame,
    room: &'a mut Room,
    /// What is left of F after a step of Newton's method is at most this times its square over the width.
    remainder: f64,
}

impl Column<'_> {
    fn foot(&self, [x, y]: [f64; 2]) -> DVec3 {
        let Frame { origin, axes: [e1, e2, _], half, .. } = self.frame;
        origin + x * half[0] * e1 + y * half[1] * e2
    }

    /// The step to F = 0 from a height, and the slopes of the surface there.
    fn step(&mut self, place: [f64; 2], z: f64) -> Option<[f64; 3]> {
        let [e1, e2, n] = self.frame.axes;
        let at = self.foot(place) + z * n;
        let sample = self.set.samples.nearest(at)?;
        let field = self.set.field_near(at, sample, self.room).ok()?;
        let [u, v, up] = [e1, e2, n].map(|e| field.gradient.dot(e));
        if field.degree < self.set.degree || LEANING < field.drift || up < FACING {
            return None;
        }
        let step = -field.value / up;
        (step.abs() <= THICK * self.frame.width).then_some([step, -u / up, -v / up])
    }

    fn middle(&mut self, guess: f64) -> Option<Jet> {
        let from = guess + PROBE * self.frame.width;
        let [first, ..] = self.step([0.0, 0.0], from)?;
        let [left, ..] = self.step([0.0, 0.0], from + first)?;
        self.remainder = (MARGIN * left.abs() * self.frame.width / (first * first)).clamp(LEAST_STEP, STEP);
        self.jet([0.0, 0.0], from + first + left)
    }

    /// Height and slopes at a node.
    fn jet(&mut self, place: [f64; 2], mut z: f64) -> Option<Jet> {
        let Frame { half, width, .. } = self.frame;
        for _ in 0..STEPS {
            let [step, u, v] = self.step(place, z)?;
            z += step;
            // The slopes are those where F was asked.
            if self.remainder * step * step / width <= SHARE * self.set.tolerance {
                return Some([z / half[0], u, v * (half[1] / half[0])]);
            }
        }
        None
    }
}
