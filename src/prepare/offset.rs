//! The boundary of a scan moved: its samples are projected to the surface and moved along its normals, those that come
//! nearer than that to another part of the surface are dropped, and what is left is a scan of its own.
//!
//! Where the boundary bends, moved samples part. Between neighbours that have parted feet are sought anew on the
//! old surface and moved in turn, so that a crease becomes a round edge that is as densely sampled as the rest. Where
//! they crowd they are thinned. The caps of a closed scan are sampled first: they are part of its boundary.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::build::{Builder, ScanId};
use super::edits::nothing_left;
use crate::cloud::neighbours::{Near, Neighbours};
use crate::cloud::{Cloud, Samples};
use crate::diag::Diagnostic;
use crate::geom::{Interval, Ray};
use crate::num::hash::Stream;
use crate::solid::point_set::{FieldScratch, PointSet, Solidity};
use crate::solid::{Body, Crossing, Scratch, Solid};
use crate::source::Span;

/// By what a moved scan was made: of which, whether it was closed, and how far.
pub(super) type Key = (ScanId, bool, f64);

/// Neighbours that part are looked for among so many.
const AROUND: usize = 8;
/// Moved neighbours farther apart than this many spacings have a place sought between them; even samplings show 1.3.
const PARTED: f64 = 1.6;
/// Neighbours farther apart than this before they were moved are none.
const NEIGHBOURS: f64 = 3.0;
/// And nearer than this, they are the two sides of a place that the surface does not resolve.
const UNRESOLVED: f64 = 1e-3;
/// Rounds of refinement: each halves what is between neighbours.
const ROUNDS: usize = 10;
/// Moved samples nearer to one another than this many spacings are thinned.
const CROWDED: f64 = 0.5;
/// A moved sample is too near to the rest of the surface if it is nearer than asked by more than this share, or this
/// many spacings: roundings of feet and the flatness of caps between their samples.
const NEARER: f64 = 1e-3;
const NEARER_SPACINGS: f64 = 0.02;
/// Places at which the thickness is measured.
const MEASURED: usize = 2000;

/// A place of the boundary: a sample on the surface, a foot between two, or a sample of a cap.
#[derive(Clone, Copy, Debug)]
struct Site {
    at: DVec3,
    normal: DVec3,
    spacing: f64,
    cap: bool,
}

/// The old boundary.
struct Boundary<'a> {
    surface: &'a PointSet,
    sites: Vec<Site>,
    /// Of the first sites, the sample in the surface's own order.
    samples: Vec<u32>,
    tree: Neighbours,
    by: f64,
}

impl Builder<'_> {
    /// A scan given a thickness, own units.
    pub fn thickened(&mut self, id: ScanId, by: f64) -> Arc<dyn Solid> {
        if let Some((_, known)) = self.thick.iter().find(|(key, _)| *key == (id, by)) {
            return known.clone();
        }
        let thick: Arc<dyn Solid> = Arc::new(self.unmeasured(id).thickened(by));
        self.thick.push(((id, by), thick.clone()));
        thick
    }

    /// A scan with its boundary moved by `by`, own units, outward above zero; `closed` is its closed surface, if it
    /// was closed before. `scale` takes lengths to those of the place `at`.
    pub fn moved(
        &mut self,
        id: ScanId,
        closed: Option<Arc<PointSet>>,
        by: f64,
        scale: f64,
        at: Span,
        name: &str,
    ) -> Result<ScanId, Diagnostic> {
        let key = (id, closed.is_some(), by);
        if let Some((_, known)) = self.moved.iter().find(|(k, _)| *k == key) {
            return Ok(*known);
        }
        let surface = closed.clone().unwrap_or_else(|| self.unmeasured(id));
        let caps = if closed.is_some() { self.cap_sites(id, &surface) } else { Vec::new() };
        let (samples, sampling, options) = self.parts(id, closed.is_some());
        let boundary = Boundary::new(&surface, &samples, caps, by);
        let (moved, dropped) = boundary.moved();
        let cloud = Cloud {
            points: moved.iter().map(|s| s.at + by * s.normal).collect(),
            normals: Some(moved.iter().map(|s| s.normal).collect()),
            ..Cloud::default()
        };
        let mut result = Samples::new(cloud, &sampling).map_err(|_| nothing_left(at, by * scale))?;
        let word = if by < 0.0 { "inset" } else { "offset" };
        let name = format!("{name}.{word}({})", (by * scale).abs() as f32);
        result.notes.push(format!("{dropped} samples nearer than that to the rest were dropped"));
        let made = self.add(&name, result, sampling, options);
        let note = boundary.thickness_error(&self.unmeasured(made), scale);
        self.note(made, note);
        self.moved.push((key, made));
        Ok(made)
    }

    /// Whether a scan was made by moving the boundary of a solid.
    pub fn bounds_a_solid(&mut self, id: ScanId) -> bool {
        let mut made = id;
        while let Some((from, closed)) =
            self.moved.iter().find(|(_, m)| *m == made).map(|((from, closed, _), _)| (*from, *closed))
        {
            if closed || self.measured(from).1.body() == Body::Solid {
                return true;
            }
            made = from;
        }
        false
    }

    /// A moved scan that is no solid by itself although it was made of one: a sharp ridge, where two sides of what is left
    /// meet, is finer than its samples tell. It is closed as a scan with holes is, and that is noted.
    pub fn mended(&mut self, id: ScanId, solidity: &Solidity) -> Arc<PointSet> {
        let known = self.was_closed(id);
        let surface = self.closed(id, f64::INFINITY).unwrap_or_else(|_| self.unmeasured(id));
        if !known {
            let share = 100.0 * solidity.odd_share();
            self.note(id, format!("its sharp edges were closed: {share:.2} % of test lines crossed it an odd number of times"));
        }
        surface
    }

    /// Samples of the caps of a closed scan: the crossings of random chords through each hole, thinned.
    fn cap_sites(&self, id: ScanId, surface: &PointSet) -> Vec<Site> {
        // Candidates for each site kept, and a bound of the work.
        const CANDIDATES: f64 = 4.0;
        const MOST: f64 = 2e6;
        const APART: f64 = 0.8;
        let samples = self.parts(id, true).0;
        let mut kept = Vec::new();
        for hole in self.closed_holes(id) {
            let spacing = hole.rim.iter().map(|i| samples.spacing[*i as usize]);
            let spacing = spacing.fold(f64::INFINITY, f64::min);
            let around = hole.bounds.inflated(spacing);
            let (center, radius) = (around.center(), 0.5 * around.diagonal());
            // A chord of a sphere of area S crosses a surface of area A 2 A / S times.
            let sphere = 4.0 * std::f64::consts::PI * radius * radius;
            let chords = (0.5 * CANDIDATES * sphere / (spacing * spacing)).min(MOST) as u64;
            let crossings = |scratch: &mut Scratch, i: u64| {
                let ray = Ray::chord(&mut Stream::new(i), center, radius);
                let range = if ray.is_valid() { around.clip(&ray) } else { Interval::EMPTY };
                let (mut lo, mut found) = (range.lo, Vec::new());
                while lo < range.hi {
                    let rest = Interval::new(lo, range.hi);
                    lo = surface.crossings(&ray, rest, scratch, &mut found).range.hi;
                }
                found.retain(|c| PointSet::is_on_cap(c) && range.contains(c.t));
                let site = |c: &Crossing| {
                    let normal = surface.normal(&ray, c, scratch);
                    Site { at: ray.at(c.t), normal, spacing, cap: true }
                };
                found.iter().map(site).collect::<Vec<_>>()
            };
            let rays = (0..chords as usize).into_par_iter().with_min_len(64);
            let found: Vec<Vec<Site>> =
                rays.map_init(Scratch::default, |s, i| crossings(s, i as u64)).collect();
            let found: Vec<Site> = found.into_iter().flatten().collect();
            kept.extend(thinned(found, |s| s.at, APART));
        }
        kept
    }
}

impl<'a> Boundary<'a> {
    fn new(surface: &'a PointSet, samples: &Samples, caps: Vec<Site>, by: f64) -> Boundary<'a> {
        let own = surface.samples();
        let foot = |scratch: &mut FieldScratch, i: usize| {
            let spacing = samples.spacing[own.original[i] as usize];
            let foot = surface.foot(own.points[i], i, scratch).ok()?;
            Some((Site { at: foot.at, normal: foot.normal, spacing, cap: false }, i as u32))
        };
        let feet: Vec<Option<(Site, u32)>> =
            (0..own.points.len()).into_par_iter().map_init(FieldScratch::default, foot).collect();
        let (mut sites, samples): (Vec<Site>, Vec<u32>) = feet.into_iter().flatten().unzip();
        sites.extend(caps);
        let tree = Neighbours::new(&sites.iter().map(|s| s.at).collect::<Vec<_>>());
        Boundary { surface, sites, samples, tree, by }
    }

    /// The sites that stay, and how many samples were dropped.
    fn moved(&self) -> (Vec<Site>, usize) {
        let mut kept = self.far_enough(self.sites.clone());
        let dropped = self.sites.len() - kept.len();
        for _ in 0..ROUNDS {
            let fresh = self.far_enough(self.between(&kept));
            let before = kept.len();
            kept.extend(fresh);
            kept = thinned(kept, |s| self.image(s), CROWDED);
            if kept.len() <= before {
                break;
            }
        }
        (kept, dropped)
    }

    fn image(&self, site: &Site) -> DVec3 {
        site.at + self.by * site.normal
    }

    /// Those whose image is no nearer to the boundary than asked.
    fn far_enough(&self, sites: Vec<Site>) -> Vec<Site> {
        let far = |(near, scratch): &mut (Vec<Near>, FieldScratch), s: Site| {
            let distance = self.distance(self.image(&s), near, scratch)?;
            let least = self.by.abs() * (1.0 - NEARER) - NEARER_SPACINGS * s.spacing;
            (least <= distance).then_some(s)
        };
        let far: Vec<Option<Site>> = sites.into_par_iter().map_init(Default::default, far).collect();
        far.into_iter().flatten().collect()
    }

    /// The distance of a point from the boundary.
    fn distance(&self, p: DVec3, near: &mut Vec<Near>, scratch: &mut FieldScratch) -> Option<f64> {
        const TRIES: usize = 4;
        self.tree.nearest(p, TRIES, near);
        near.iter().find_map(|n| {
            let site = &self.sites[n.index as usize];
            match self.samples.get(n.index as usize) {
                Some(sample) => {
                    let foot = self.surface.foot(p, *sample as usize, scratch).ok()?;
                    // Past a rim the surface has ended; its last sample is what is near.
                    let ended = self.surface.edge() < foot.drift;
                    Some(if ended { site.at.distance(p) } else { foot.distance.abs() })
                }
                None => Some((p - site.at).dot(site.normal).abs()),
            }
        })
    }

    /// Sites between neighbours whose images have parted.
    fn between(&self, sites: &[Site]) -> Vec<Site> {
        let points: Vec<DVec3> = sites.iter().map(|s| s.at).collect();
        let table = Neighbours::new(&points).table(AROUND);
        let parted = |scratch: &mut FieldScratch, i: usize| {
            let pairs = table.row(i).iter().map(|j| *j as usize);
            let pairs = pairs.filter(|j| i < *j || !table.row(*j).contains(&(i as u32)));
            pairs.filter_map(|j| self.middle(&sites[i], &sites[j], scratch)).collect::<Vec<_>>()
        };
        let found: Vec<Vec<Site>> =
            (0..sites.len()).into_par_iter().map_init(FieldScratch::default, parted).collect();
        found.into_iter().flatten().collect()
    }

    /// The site between two neighbours, if their images have parted.
    fn middle(&self, a: &Site, b: &Site, scratch: &mut FieldScratch) -> Option<Site> {
        let spacing = a.spacing.max(b.spacing);
        let apart = a.at.distance(b.at);
        let parted = PARTED * spacing < self.image(a).distance(self.image(b));
        if !parted || apart < UNRESOLVED * spacing || NEIGHBOURS * spacing < apart {
            return None;
        }
        let (at, normal) = (0.5 * (a.at + b.at), (a.normal + b.normal).try_normalize()?);
        if a.cap || b.cap {
            return Some(Site { at, normal, spacing, cap: true });
        }
        let nearest = self.surface.samples().nearest(at)?;
        let foot = self.surface.foot(at, nearest, scratch).ok()?;
        let faces = 0.0 < foot.normal.dot(normal);
        faces.then_some(Site { at: foot.at, normal: foot.normal, spacing, cap: false })
    }

    /// How far the surface that was made is from where it should be, in words; `scale` takes lengths to those written.
    fn thickness_error(&self, made: &PointSet, scale: f64) -> String {
        let own = made.samples();
        let stride = own.points.len().div_ceil(MEASURED).max(1);
        let error = |(near, scratch): &mut (Vec<Near>, FieldScratch), i: usize| {
            let foot = made.foot(own.points[i], i, scratch).ok()?;
            Some((self.distance(foot.at, near, scratch)? - self.by.abs()).abs())
        };
        let places: Vec<usize> = (0..own.points.len()).step_by(stride).collect();
        let errors: Vec<Option<f64>> = places.into_par_iter().map_init(Default::default, error).collect();
        let mut errors: Vec<f64> = errors.into_iter().flatten().collect();
        errors.sort_unstable_by(f64::total_cmp);
        let percent = |q: f64| {
            let at = (errors.len() as f64 * q) as usize;
            100.0 * errors.get(at).copied().unwrap_or(f64::NAN) / self.by.abs()
        };
        format!(
            "its distance of {:.6} from the scan is off by {:.2e} % in the median, {:.2e} % at 99 of 100 of {} places",
            self.by.abs() * scale,
            percent(0.5),
            percent(0.99),
            errors.len()
        )
    }
}

/// The sites that are left when of any two whose images are nearer than `share` of their spacing the later is dropped.
fn thinned(sites: Vec<Site>, image: impl Fn(&Site) -> DVec3, share: f64) -> Vec<Site> {
    let points: Vec<DVec3> = sites.iter().map(image).collect();
    let tree = Neighbours::new(&points);
    let mut gone = vec![false; sites.len()];
    let mut near = Vec::new();
    for (i, site) in sites.iter().enumerate() {
        if gone[i] {
            continue;
        }
        tree.within(points[i], share * site.spacing, &mut near);
        for n in near.iter().map(|n| n.index as usize).filter(|n| i < *n) {
            // The two sides of a thin wall are not neighbours.
            gone[n] |= 0.0 < sites[n].normal.dot(site.normal);
        }
    }
    sites.into_iter().zip(gone).filter(|(_, gone)| !gone).map(|(s, _)| s).collect()
}
