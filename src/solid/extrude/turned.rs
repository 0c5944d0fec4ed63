//! Extrusions that turn, or shrink along one axis more than along the other: walls are ruled surfaces, and every root
//! of every wall is isolated.

use glam::{DVec2, Vec3Swizzles as _};

use super::{Extrusion, Frame, WALLS, back};
use crate::geom::{Interval, Ray, tolerance};
use crate::solid::{Crossing, parity};

/// The function of one wall at some t, with its slope and what it is made of.
///
/// With (X, Y) the ray's point turned back, m its scales, n the edge's unit normal and c = n . a:
/// F = n_x m_y X + n_y m_x Y - c m_x m_y, zero on the plane of the edge. X' = w' Y + .., Y' = -w' X + .. (w' radians per
/// t), m' is constant; so F'' has the bound of `bend` in `roots`.
#[derive(Clone, Copy)]
struct Local {
    xy: DVec2,
    slope: DVec2,
    m: DVec2,
}

/// Bounds over an interval of t.
#[derive(Clone, Copy)]
struct Reach {
    half: f64,
    /// Of |p|, |p'|, |p''| (turned back), of both scales and their slopes.
    radius: f64,
    speed: f64,
    turn: f64,
    scale: f64,
    fall: f64,
}

/// What is known of a wall's roots in an interval.
enum Roots {
    None,
    One,
    Open,
}

/// An interval is halved at most so often: below it neighbouring numbers are told apart no more.
const DEEPEST: u32 = 60;
/// Intervals for one ray; more come only of walls that keep touching the ray within roundings.
const MOST: usize = 1 << 14;

struct Walk<'a> {
    solid: &'a Extrusion,
    /// From a point of the ray near the solid.
    ray: Ray,
    /// Radians and scale per t.
    turn: f64,
    fall: DVec2,
}

impl Extrusion {
    /// The crossings of a ray that is not level. Candidates are the ends of the slab and all roots of the walls; which
    /// of them count is decided by the outline in the middle of the gaps between them.
    pub(super) fn turned(
        &self,
        ray: &Ray,
        near: Interval,
        slab: Interval,
        ends: [u32; 2],
        out: &mut Vec<Crossing>,
    ) {
        let start = out.len();
        let from = 0.5 * (near.lo + near.hi);
        let slab = Interval::new(slab.lo - from, slab.hi - from);
        let range = Interval::new(near.lo - from, near.hi - from).intersect(slab);
        let own = Ray { origin: ray.at(from), dir: ray.dir };
        let walk = Walk { solid: self, ray: own, turn: self.w * ray.dir.z, fall: -self.k * ray.dir.z };
        out.push(Crossing::exact(slab.lo, true, ends[0]));
        out.push(Crossing::exact(slab.hi, true, ends[1]));
        walk.isolate(range, out);
        // Beyond the ends nothing counts.
        out.retain(|c| slab.contains(c.t) || c.part < WALLS);
        parity::where_it_changes(out, start, |t| slab.contains(t) && self.contains(own.at(t)));
        parity::shift(out, start, from);
    }
}

impl Walk<'_> {
    fn local(&self, t: f64) -> Local {
        let Frame { xy, m, turn } = self.solid.frame(self.ray.at(t));
        let d = back(turn).rotate(self.ray.dir.xy());
        Local { xy, slope: self.turn * DVec2::new(xy.y, -xy.x) + d, m }
    }

    fn reach(&self, at: &Local, half: f64) -> Reach {
        let across = self.ray.dir.xy().length();
        let radius = at.xy.length() + half * across;
        let turn = self.turn.abs();
        Reach {
            half,
            radius,
            speed: turn * radius + across,
            turn: turn * turn * radius + 2.0 * turn * across,
            scale: at.m.max_element() + half * self.fall.abs().max_element(),
            fall: self.fall.abs().max_element(),
        }
    }

    /// Finds a candidate for every root in a range, by halving it until each wall is known to have none or one.
    fn isolate(&self, range: Interval, out: &mut Vec<Crossing>) {
        let mut open = vec![(range, 0)];
        let mut met = Vec::new();
        let mut asked = 0;
        while let Some((range, depth)) = open.pop() {
            let middle = 0.5 * (range.lo + range.hi);
            let half = 0.5 * range.length();
            if half.is_nan() || half < 0.0 {
                continue;
            }
            asked += 1;
            let at = self.local(middle);
            let reach = self.reach(&at, half);
            met.clear();
            self.solid.outline.visit(|min, max| meets(&at, &reach, self.fall, min, max), |i| met.push(i));
            let known: Vec<Roots> = met.iter().map(|i| self.roots(*i, &at, &reach)).collect();
            let last = depth == DEEPEST || MOST < asked;
            if !last && known.iter().any(|k| matches!(k, Roots::Open)) {
                open.push((Interval::new(middle, range.hi), depth + 1));
                open.push((Interval::new(range.lo, middle), depth + 1));
                continue;
            }
            for (edge, known) in met.iter().zip(known) {
                let root = match known {
                    Roots::None => None,
                    Roots::One => self.root(*edge, range),
                    Roots::Open => Some(middle),
                };
                out.extend(root.map(|t| Crossing::exact(t, true, WALLS + edge)));
            }
        }
    }

    /// F and F'.
    fn wall(&self, edge: u32, at: &Local) -> [f64; 2] {
        let [a, b] = self.solid.outline.edges()[edge as usize];
        let n = (b - a).perp().normalize_or_zero();
        let (c, fall) = (n.dot(a), self.fall);
        let Local { xy, slope, m } = *at;
        let value = n.x * m.y * xy.x + n.y * m.x * xy.y - c * m.x * m.y;
        let change = n.x * (fall.y * xy.x + m.y * slope.x) + n.y * (fall.x * xy.y + m.x * slope.y)
            - c * (fall.x * m.y + fall.y * m.x);
        [value, change]
    }

    /// How many roots a wall has around `at`: none where |F| exceeds what F can change, one at most where F' keeps its
    /// sign (Taylor with the bound of F''), each with room for roundings. A wall that the ray runs in has none.
    fn roots(&self, edge: u32, at: &Local, reach: &Reach) -> Roots {
        let [a, _] = self.solid.outline.edges()[edge as usize];
        let [value, change] = self.wall(edge, at);
        let far = a.length();
        let Reach { half, radius, speed, turn, scale, fall } = *reach;
        // |n_x u| + |n_y v| <= sqrt(2) |(u, v)| <= 2 |(u, v)|.
        let bend = 2.0 * (scale * turn + 2.0 * fall * speed + far * fall * fall);
        let noise = tolerance::noise(scale * (radius + far * scale));
        let swing = half * change.abs() + 0.5 * half * half * bend;
        if swing + noise < value.abs() || swing + value.abs() <= noise {
            return Roots::None;
        }
        let steep = tolerance::noise(scale * speed + fall * (radius + far * scale));
        if half * bend + steep < change.abs() { Roots::One } else { Roots::Open }
    }

    /// The root in an interval in which F is monotone, if its ends have different signs and it lies on the edge or
    /// close to it: by bisection, which cannot leave the interval, with Newton's steps where they stay inside.
    fn root(&self, edge: u32, range: Interval) -> Option<f64> {
        let value = |t: f64| self.wall(edge, &self.local(t));
        let (mut lo, mut hi) = (range.lo, range.hi);
        let (first, last) = (value(lo)[0], value(hi)[0]);
        if first == 0.0 || last == 0.0 {
            return Some(if first == 0.0 { lo } else { hi });
        }
        if (first < 0.0) == (last < 0.0) {
            return None;
        }
        let mut t = 0.5 * (lo + hi);
        for _ in 0..100 {
            let [f, slope] = value(t);
            if f == 0.0 {
                break;
            }
            if (f < 0.0) == (first < 0.0) {
                lo = t
            } else {
                hi = t
            }
            let step = t - f / slope;
            let next = if lo < step && step < hi { step } else { 0.5 * (lo + hi) };
            if next <= lo || hi <= next || next == t {
                break;
            }
            t = next;
        }
        self.on_edge(edge, t).then_some(t)
    }

    /// Whether a point of the wall's plane lies on the edge or within [`tolerance::JOINT`] of it.
    fn on_edge(&self, edge: u32, t: f64) -> bool {
        let [a, b] = self.solid.outline.edges()[edge as usize];
        let Local { xy, m, .. } = self.local(t);
        if m.min_element() <= 0.0 {
            return true;
        }
        let share = (xy / m - a).dot(b - a) / (b - a).length_squared();
        (-tolerance::JOINT..=1.0 + tolerance::JOINT).contains(&share) || share.is_nan()
    }
}

/// Whether the ray can be over a box of the outline's plane within an interval: X in m [min, max] for both axes.
fn meets(at: &Local, reach: &Reach, fall: DVec2, min: DVec2, max: DVec2) -> bool {
    let Reach { half, radius, turn, scale, .. } = *reach;
    let noise = tolerance::noise(radius + scale * min.abs().max(max.abs()).max_element());
    (0..2).all(|i| {
        let swing = half * at.slope[i].abs() + 0.5 * half * half * turn + noise;
        let m = [(at.m[i] - half * fall[i].abs()).max(0.0), at.m[i] + half * fall[i].abs()];
        let low = (m[0] * min[i]).min(m[1] * min[i]);
        let high = (m[0] * max[i]).max(m[1] * max[i]);
        low <= at.xy[i] + swing && at.xy[i] - swing <= high
    })
}
