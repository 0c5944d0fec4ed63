//! Guides and patches: polynomials that follow the surface over the share of it that belongs to some samples.
//!
//! The samples of one leaf of the hierarchy are a cell. A guide is a polynomial of degree 3 fitted to the samples
//! themselves: it says where F may vanish, and where F then is asked. A patch is one of degree up to 6, fitted to F = 0 at
//! the nodes of a grid with an error bound that is measured there; where that is within the tolerance, F need not be asked
//! at all. Both are made when a ray first comes near, from samples and tolerance alone, so they do not depend on which ray
//! that was; whether patches are made is a setting.
//!
//! A cell has neither, and rays near it are searched with F alone, unless over its domain
//!
//! - all samples about face within 60 degrees of it and lie near it: one sheet, on which F behaves like a signed distance,
//!   so that what the polynomial crosses is all there is;
//! - samples are near every place, so that the cells together cover the surface;
//! - the error measured is small ([`GUIDING`], [`ROUGH`]);
//! - for patches, every projection succeeds, keeps its degree, and the samples do not end there.

mod build;
pub mod poly;

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use self::poly::{COEFFICIENTS, Jet, evaluate};
use super::hierarchy::LEVELS;
use super::probe::Room;
use super::{Lead, PointSet};
use crate::geom::Ray;

/// A patch's domain reaches so many widths past the outermost of its samples: the least of these that suffices.
const MARGINS: [f64; 3] = [0.6, 0.8, 1.0];
/// An error above this many widths says that the samples are not what a guide can follow.
const GUIDING: f64 = 0.15;
/// And that F = 0 is not what a patch can.
const ROUGH: f64 = 1e-2;

/// The surface over a rectangle: height z = `c`(x, y) over x, y in [-1, 1].
#[derive(Clone, Debug)]
pub(super) struct Patch {
    /// World position of the middle of the rectangle.
    origin: DVec3,
    /// Unit directions of x, y and z; z is outward.
    axes: [DVec3; 3],
    /// World lengths of one unit of x and of y; z has that of x.
    half: [f64; 2],
    degree: usize,
    c: [f64; COEFFICIENTS],
    /// The lowest and the highest z, the error included.
    z: [f64; 2],
    /// Bounds of the slopes.
    steepest: [f64; 2],
    /// A bound of the second derivatives along a unit step in x and y.
    bend: f64,
    /// How far the surface may lie from the patch along z, world length.
    pub error: f64,
    /// How far its slopes may be from those of the patch.
    pub lean: f64,
    /// A width there, world length.
    pub width: f64,
}

/// A ray in the frame of a patch: position and direction per world length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    at: DVec3,
    dir: DVec3,
}

impl Patch {
    /// A line of unit direction in the patch's units.
    #[inline]
    pub fn local(&self, line: &Ray) -> Local {
        let [e1, e2, n] = self.axes;
        let from = line.origin - self.origin;
        let (ix, iy) = (1.0 / self.half[0], 1.0 / self.half[1]);
        Local {
            at: DVec3::new(from.dot(e1) * ix, from.dot(e2) * iy, from.dot(n) * ix),
            dir: DVec3::new(line.dir.dot(e1) * ix, line.dir.dot(e2) * iy, line.dir.dot(n) * ix),
        }
    }

    /// Height of the line over the patch at arc length `s`, in units of z, and its slope along the line.
    #[inline]
    pub fn height(&self, local: &Local, s: f64) -> [f64; 2] {
        let p = local.at + s * local.dir;
        let [z, zx, zy] = evaluate(&self.c, self.degree, p.x, p.y);
        [p.z - z, local.dir.z - zx * local.dir.x - zy * local.dir.y]
    }

    /// The part of the line over the rectangle and between the lowest and the highest z.
    #[inline]
    pub fn clip(&self, local: &Local) -> [f64; 2] {
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        let mut slab = |at: f64, dir: f64, lo: f64, hi: f64| {
            let per = 1.0 / dir;
            let (a, b) = ((lo - at) * per, (hi - at) * per);
            // A line along the slab: all or nothing of it (0 / 0 never, as bounds are not met exactly).
            range = [range[0].max(a.min(b)), range[1].min(a.max(b))];
        };
        slab(local.at.z, local.dir.z, self.z[0], self.z[1]);
        slab(local.at.x, local.dir.x, -1.0, 1.0);
        slab(local.at.y, local.dir.y, -1.0, 1.0);
        range
    }

    /// The error in units of z.
    #[inline]
    pub fn local_error(&self) -> f64 {
        self.error / self.half[0]
    }

    /// Whether the line's height over the patch has one slope throughout.
    #[inline]
    pub fn is_steeper(&self, local: &Local) -> bool {
        let along = self.steepest[0] * local.dir.x.abs() + self.steepest[1] * local.dir.y.abs();
        along < local.dir.z.abs()
    }

    /// A bound of the second derivative of the height along the line.
    #[inline]
    pub fn curvature(&self, local: &Local) -> f64 {
        self.bend * local.dir.x.abs().max(local.dir.y.abs()).powi(2)
    }

    /// How far from the middle of the rectangle: 1 at its sides.
    #[inline]
    pub fn eccentricity(&self, local: &Local, s: f64) -> f64 {
        let p = local.at + s * local.dir;
        p.x.abs().max(p.y.abs())
    }

    /// The outward unit normal over a point of the line.
    pub fn normal(&self, local: &Local, s: f64) -> DVec3 {
        let p = local.at + s * local.dir;
        let [_, zx, zy]: Jet = evaluate(&self.c, self.degree, p.x, p.y);
        let [e1, e2, n] = self.axes;
        (n - zx * e1 - zy * (self.half[0] / self.half[1]) * e2).normalize()
    }
}

/// One of each cell, or of each node of so many cells, made when first asked for.
type Cells = Vec<OnceLock<Option<Box<Patch>>>>;

/// The same for each level of the hierarchy.
type Levels = [Cells; LEVELS];

fn unmade(cells: usize) -> Arc<Levels> {
    let of = |level: usize| (0..cells.div_ceil(1 << level)).map(|_| OnceLock::new()).collect();
    Arc::new(std::array::from_fn(of))
}

/// The guides of a surface, and its patches where they are made at all.
#[derive(Clone, Debug)]
pub(super) struct Patches {
    lead: Lead,
    guides: Arc<Levels>,
    exact: Arc<Levels>,
}

/// Halving a domain divides the error of a polynomial of degree 6 by 2^(7/2), more or less: a patch whose error is more times
/// the tolerance than this, is not made finer.
const FINER: f64 = 10.0;

/// What follows the surface over a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Follows<'a> {
    /// A patch or a guide.
    pub patch: &'a Patch,
    /// Tells it from those of other cells.
    pub id: u32,
}

impl Patches {
    /// None made yet, of so many cells.
    pub fn new(cells: usize, lead: Lead) -> Patches {
        let of = |made: bool| unmade(if made { cells } else { 0 });
        Patches { lead, guides: of(lead != Lead::Search), exact: of(lead == Lead::Patches) }
    }

    /// The same guides without patches.
    pub fn guides_only(&self) -> Patches {
        let lead = if self.lead == Lead::Patches { Lead::Guides } else { self.lead };
        Patches { lead, ..self.clone() }
    }

    /// Whether there are none to be had.
    pub fn are_none(&self) -> bool {
        self.lead == Lead::Search
    }

    /// What there is of a cell: of the largest node about it that has a guide, or of a smaller one where that brings the error
    /// below the tolerance.
    #[inline]
    pub fn get(&self, set: &PointSet, cell: usize, room: &mut Room) -> Option<Follows<'_>> {
        let mut coarse = None;
        for level in (0..LEVELS).rev() {
            let Some(found) = self.at(set, level, cell >> level, room) else { continue };
            let over = found.patch.error / set.tolerance;
            if self.lead != Lead::Patches || over <= 1.0 || FINER < over || level == 0 {
                return Some(found);
            }
            coarse = coarse.or(Some(found));
        }
        coarse
    }

    fn at(&self, set: &PointSet, level: usize, node: usize, room: &mut Room) -> Option<Follows<'_>> {
        let make = || {
            let made = build::guide(set, set.samples.of_cells(level, node)).map(Box::new);
            room.work.guides += u64::from(made.is_some());
            made
        };
        let guide = self.guides[level][node].get_or_init(make).as_deref()?;
        let id = ((node as u32) << LEVELS) | level as u32;
        if self.lead != Lead::Patches {
            return Some(Follows { patch: guide, id });
        }
        let make = || {
            let before = room.work.projections;
            let made = build::patch(set, guide, room).map(Box::new);
            room.work.building += room.work.projections - before;
            room.work.patches += u64::from(made.is_some());
            made
        };
        let patch = self.exact[level][node].get_or_init(make).as_deref().unwrap_or(guide);
        Some(Follows { patch, id })
    }

    /// Of how many cells a guide was asked for, and how many guides and patches there are.
    pub fn census(&self) -> [usize; 3] {
        let made =
            |levels: &Levels| levels.iter().flatten().filter(|p| matches!(p.get(), Some(Some(_)))).count();
        let asked = self.guides[LEVELS - 1].iter().filter(|p| p.get().is_some()).count();
        [asked, made(&self.guides), made(&self.exact)]
    }
}
