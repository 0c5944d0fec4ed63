//! Every crossing, and no other: what the certificate finds against a dense scan of F along the line.
//!
//! The scan knows nothing of certificates. It walks in steps of h/50 (h/10 where |F| exceeds 0.3 h: to miss a root there
//! F would have to change three times faster than a distance does), minimises every local minimum of |F|, and bisects
//! every change of sign to the last bit.

mod common;

use common::{Truth, all, chord, surface};
use glam::DVec3;
use pss::geom::Ray;
use pss::num::hash::Stream;
use pss::solid::point_set::{FieldScratch, Options, PointSet};
use pss::solid::{Crossing, Scratch};
use rayon::prelude::*;

/// Steps per width of the dense scan, near the surface and away from it.
const NEAR: f64 = 50.0;
const FAR: f64 = 10.0;

/// F and dF/ds at arc length `s`, where defined.
fn at(set: &PointSet, line: &Ray, s: f64, scratch: &mut FieldScratch) -> Option<[f64; 2]> {
    let f = set.field(line.at(s), scratch).ok()?;
    Some([f.value, f.gradient.dot(line.dir)])
}

/// A root, to the last bit of s, and whether the line goes in.
#[derive(Clone, Copy, Debug)]
struct Found {
    s: f64,
    entering: bool,
}

/// The change of sign between two places, or `None` where F jumps instead of vanishing.
fn bisect(
    set: &PointSet,
    line: &Ray,
    mut a: f64,
    mut b: f64,
    inside: bool,
    scratch: &mut FieldScratch,
) -> Option<Found> {
    let mut least = f64::INFINITY;
    loop {
        let m = 0.5 * (a + b);
        if m <= a || b <= m {
            break;
        }
        let f = at(set, line, m, scratch)?[0];
        least = least.min(f.abs());
        if (f < 0.0) == inside { a = m } else { b = m }
    }
    (least < 1e-6).then_some(Found { s: 0.5 * (a + b), entering: !inside })
}

/// The lowest |F| between two places whose slopes lean towards each other.
fn lowest(
    set: &PointSet,
    line: &Ray,
    mut a: f64,
    mut b: f64,
    sign: f64,
    scratch: &mut FieldScratch,
) -> Option<(f64, f64)> {
    let mut best = (f64::INFINITY, a);
    for _ in 0..60 {
        let m = 0.5 * (a + b);
        let [f, slope] = at(set, line, m, scratch)?;
        if sign * f < best.0 {
            best = (sign * f, m);
        }
        if best.0 <= 0.0 {
            break;
        }
        if sign * slope < 0.0 { a = m } else { b = m }
    }
    Some(best)
}

#[derive(Debug, Default)]
struct Scan {
    roots: Vec<Found>,
    /// The least |F| at a minimum without a root.
    closest: f64,
    /// Changes of sign without a root between: jumps of F.
    jumps: usize,
}

/// Every root on the line between two arc lengths.
fn scan(set: &PointSet, line: &Ray, from: f64, to: f64, finest: f64, scratch: &mut FieldScratch) -> Scan {
    let mut out = Scan { closest: f64::INFINITY, ..Scan::default() };
    let mut s = from;
    let mut last: Option<(f64, [f64; 2])> = None;
    while s < to {
        let here = at(set, line, s, scratch);
        let width = set.width_at(line.at(s)).unwrap_or(finest);
        if let (Some((p, fp)), Some(f)) = (last, here) {
            let inside = fp[0] < 0.0;
            let sign = if inside { -1.0 } else { 1.0 };
            if inside != (f[0] < 0.0) {
                match bisect(set, line, p, s, inside, scratch) {
                    Some(root) => out.roots.push(root),
                    None => out.jumps += 1,
                }
            } else if sign * fp[1] < 0.0
                && 0.0 < sign * f[1]
                && fp[0].abs().min(f[0].abs()) < 0.1 * width
                && let Some((value, m)) = lowest(set, line, p, s, sign, scratch)
            {
                if value <= 0.0 {
                    out.roots.extend(bisect(set, line, p, m, inside, scratch));
                    out.roots.extend(bisect(set, line, m, s, !inside, scratch));
                } else {
                    out.closest = out.closest.min(value);
                }
            }
        }
        last = here.map(|f| (s, f));
        let step = match here {
            Some(f) if 0.3 * width < f[0].abs() => width / FAR,
            Some(_) => width / NEAR,
            None => finest / FAR,
        };
        s += step;
    }
    out
}

/// What chords of one cloud showed.
#[derive(Debug, Default, Clone, Copy)]
struct Tally {
    chords: u64,
    crossings: u64,
    missed: u64,
    extra: u64,
    finer: u64,
    odd: u64,
    beyond: u64,
    loose: u64,
    failures: u64,
    jumps: u64,
    ambiguous: u64,
    projections: u64,
}

impl Tally {
    fn plus(mut self, o: Tally) -> Tally {
        self.chords += o.chords;
        self.crossings += o.crossings;
        self.missed += o.missed;
        self.extra += o.extra;
        self.finer += o.finer;
        self.odd += o.odd;
        self.beyond += o.beyond;
        self.loose += o.loose;
        self.failures += o.failures;
        self.jumps += o.jumps;
        self.ambiguous += o.ambiguous;
        self.projections += o.projections;
        self
    }
}

/// Whether F between the crossings has the signs that they say.
fn alternates(set: &PointSet, line: &Ray, length: f64, found: &[Crossing], field: &mut FieldScratch) -> bool {
    found.windows(2).all(|pair| {
        let middle = 0.5 * (pair[0].t + pair[1].t) * length;
        let agrees = at(set, line, middle, field).is_none_or(|f| (f[0] < 0.0) == pair[0].entering);
        pair[0].entering != pair[1].entering && agrees
    })
}

/// One line, crossings against the scan.
fn compare(set: &PointSet, ray: &Ray, finest: f64, field: &mut FieldScratch, scratch: &mut Scratch) -> Tally {
    scratch.counts = Default::default();
    let found: Vec<Crossing> = all(set, ray, scratch);
    let length = ray.dir.length();
    let line = Ray::new(ray.origin, ray.dir / length);
    // The line goes on beyond the chord.
    let dense = scan(set, &line, -length, 2.0 * length, finest, field);
    let mut tally = Tally {
        chords: 1,
        crossings: found.len() as u64,
        odd: (found.len() % 2) as u64,
        failures: scratch.counts.certificate_failures,
        jumps: dense.jumps as u64,
        projections: scratch.counts.projections,
        ..Tally::default()
    };
    if 0 < tally.failures && std::env::var_os("PSS_SHOW").is_some() {
        println!("{ray:?}\n  {} undecided", tally.failures);
    }
    // A minimum of |F| so near zero that rounding says whether there is a root belongs to neither.
    if dense.closest < 1e-13 * finest {
        tally.ambiguous = 1;
        return tally;
    }
    if dense.roots.len() < found.len() && alternates(set, &line, length, &found, field) {
        // The scan stepped over a pair; F has the signs that the crossings say.
        tally.finer = (found.len() - dense.roots.len()) as u64;
        return tally;
    }
    if found.len() != dense.roots.len() {
        tally.missed = dense.roots.len().saturating_sub(found.len()) as u64;
        tally.extra = found.len().saturating_sub(dense.roots.len()) as u64;
        if std::env::var_os("PSS_SHOW").is_some() {
            println!("{ray:?}\n  found {found:?}\n  dense {dense:?}");
        }
        return tally;
    }
    for (c, d) in found.iter().zip(&dense.roots) {
        let apart = (c.t * length - d.s).abs();
        // Rounding of the two ways to write the same place.
        let slack = 8.0 * f64::EPSILON * length.max(1.0);
        if c.err * length + slack < apart || c.entering != d.entering {
            tally.beyond += 1;
            if std::env::var_os("PSS_SHOW").is_some() {
                println!("{ray:?}\n  beyond: {c:?} {d:?} apart {apart:e} err {:e}", c.err * length);
            }
        }
        tally.loose += u64::from(set.tolerance() < c.shift);
    }
    tally
}

/// A line that nearly touches the surface: through a point a little off it, along its tangent plane.
fn near_tangent(set: &PointSet, i: u64, center: DVec3, radius: f64, scratch: &mut Scratch) -> Option<Ray> {
    let mut stream = Stream::new(i ^ 0x7a9);
    // Most chords miss.
    let tries = (0..64).map(|k| chord(i << 8 | k, center, radius));
    let point = tries.into_iter().find_map(|ray| all(set, &ray, scratch).first().map(|c| ray.at(c.t)))?;
    let mut field = FieldScratch::default();
    let normal = set.field(point, &mut field).ok()?.gradient.try_normalize()?;
    let width = set.width_at(point)?;
    let (e1, e2) = normal.any_orthonormal_pair();
    let (sin, cos) = (std::f64::consts::TAU * stream.unit()).sin_cos();
    let dir = e1 * cos + e2 * sin;
    let depth = width * 10f64.powf(-1.0 - 8.0 * stream.unit()) * if stream.unit() < 0.5 { -1.0 } else { 1.0 };
    let start = point + normal * depth - dir * radius * (0.8 + 0.4 * stream.unit());
    Some(Ray::new(start, dir * 2.0 * radius))
}

/// Noise of so many spacings on every coordinate.
fn shaken(points: &[DVec3], spacing: f64, seed: u64) -> Vec<DVec3> {
    let mut stream = Stream::new(seed);
    points
        .iter()
        .map(|p| *p + spacing * DVec3::new(stream.normal(), stream.normal(), stream.normal()))
        .collect()
}

fn clouds() -> Vec<(String, PointSet)> {
    let mut out = Vec::new();
    for truth in Truth::CLOSED {
        let (points, normals) = truth.cloud(10_000);
        let spacing = (truth.area() / 10_000.0).sqrt();
        for noise in [0.0, 0.3] {
            let points = if noise == 0.0 { points.clone() } else { shaken(&points, noise * spacing, 5) };
            out.push((format!("{truth:?}, noise {noise}"), surface(&points, &normals, &Options::default())));
        }
    }
    out
}

#[test]
fn the_crossings_are_those_of_a_dense_scan() {
    // The whole measurement takes an hour.
    let long = std::env::var_os("PSS_LONG").is_some();
    let (random, grazing) = if long { (125_000, 12_500) } else { (600, 200) };
    let mut whole = Tally::default();
    for (name, set) in clouds() {
        let bounds = pss::geom::Aabb::of_points(set.samples().points.iter().copied());
        let (center, radius) = (bounds.center(), 0.5 * bounds.diagonal());
        let finest = set.samples().widths.iter().copied().fold(f64::INFINITY, f64::min);
        let run = |count: u64, tangent: bool| {
            (0..count)
                .into_par_iter()
                .map_init(
                    || (FieldScratch::default(), Scratch::default()),
                    |(field, scratch), i| {
                        let ray = if tangent {
                            near_tangent(&set, i, center, radius, scratch)
                        } else {
                            Some(chord(i, center, radius))
                        };
                        ray.map_or(Tally::default(), |r| compare(&set, &r, finest, field, scratch))
                    },
                )
                .reduce(Tally::default, Tally::plus)
        };
        for (kind, tally) in [("random", run(random, false)), ("near-tangent", run(grazing, true))] {
            println!("{name}, {kind}: {tally:?}");
            whole = whole.plus(tally);
        }
    }
    println!("all: {whole:?}");
    assert_eq!((whole.missed, whole.extra, whole.odd, whole.beyond, whole.jumps), (0, 0, 0, 0, 0));
    // Pairs of crossings that the scan steps over lie nearer to each other than h/50.
    assert!(whole.finer * 1000 <= whole.crossings);
    assert!(whole.loose * 100_000 <= whole.crossings);
}
