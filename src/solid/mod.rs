//! Solids: things that know, for every ray, each interval in which the ray is inside them. One file a
//! primitive, one line of [`table::PRIMITIVES`] for each; scenes, materials and CSG are not known here.

pub mod block;
pub mod capsule;
mod chord;
pub mod cone;
mod crossing;
pub mod cylinder;
pub mod extrude;
pub mod half_space;
pub mod heightfield;
pub mod implicit;
pub mod mesh;
pub mod outline;
pub mod parity;
pub mod plane;
pub mod point_set;
pub mod points;
pub mod quadric;
pub mod revolve;
pub mod rounded_box;
pub mod shaft;
pub mod sphere;
pub mod superellipsoid;
pub mod table;
pub mod torus;
pub mod tube;

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

pub use chord::Chord;
pub use crossing::{Answer, Crossing};

use crate::geom::{Aabb, Interval, Lean, Ray};

/// What a thing's crossings mean.
#[derive(Clone, Copy, PartialEq, Eq, Debug, serde::Serialize)]
pub enum Body {
    /// It has an inside; crossings alternate between entries and exits.
    Solid,
    /// An open surface: crossings only, no inside.
    Sheet,
}

/// What asking a solid costs.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Cost {
    /// Some tens of nanoseconds, less than finding out whether the answer is needed: one closed form, for the whole line
    /// at once.
    Closed,
    /// Several closed forms, roots of polynomials, a hierarchy.
    Search,
    /// Much more: scans, formulas.
    Heavy,
}

/// What a solid measures in closed form, own units.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Exact {
    /// The volume.
    pub volume: f64,
    /// The area of the boundary, where that is a closed form too.
    pub area: Option<f64>,
}

impl Exact {
    fn new(volume: f64, area: f64) -> Option<Exact> {
        Some(Exact { volume, area: Some(area) })
    }
}

/// What to say of a sheet of which no more is known.
pub const SHEET: &str = "a Sheet: an open surface";

/// A solid or a sheet in its own frame.
///
/// Methods take `&self`; what a query needs beside the answer is lent as [`Scratch`]. Rays are finite and
/// have a direction ([`Ray::is_valid`]); their `dir` has any length.
pub trait Solid: Send + Sync + Debug {
    /// Whether it has an inside.
    fn body(&self) -> Body {
        Body::Solid
    }

    /// A box around the boundary; unbounded for unbounded solids.
    fn bounds(&self) -> Aabb;

    /// A box around the image of the solid, as tight as the solid knows: what `bounds` and `.fit` of the language
    /// mean. For a scan that of its samples.
    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.bounds().transformed(to_from)
    }

    /// A box around the solid and one around all that is outside of it, each side unbounded where there is none: for views
    /// and warnings, no crossing depends on it.
    fn limits(&self) -> [Aabb; 2] {
        [self.bounds(), Aabb::ALL]
    }

    /// Appends the crossings of the ray's line to `out`, ascending in `t`, and says for which range they are
    /// complete and whether the ray is inside where that range begins. The range of the answer contains the
    /// low end of the range asked and may end early (a lazy solid stops after what it has found) or reach
    /// beyond it; what is reported never depends on the range asked.
    ///
    /// A crossing at the very low end of the range is before the range, one at the high end inside it.
    ///
    /// A solid has this or [`Solid::chord`], which is then asked.
    fn crossings(&self, ray: &Ray, _: Interval, scratch: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        self.chord(ray, &scratch.lean).unwrap_or(Chord::NONE).answer(out)
    }

    /// The part of the ray's line that is inside, of a convex solid of one closed form ([`Cost::Closed`]); `None` of others.
    fn chord(&self, _ray: &Ray, _lean: &Lean) -> Option<Chord> {
        None
    }

    /// The outward unit normal at a crossing that [`Solid::crossings`] gave for this ray.
    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3;

    /// The linear colour at a point of the boundary, own frame, where the solid itself has colours.
    fn color(&self, _at: DVec3, _scratch: &mut Scratch) -> Option<[f32; 3]> {
        None
    }

    /// The bound that [`Crossing::shift`] keeps, length of the solid's own frame.
    fn shift_bound(&self) -> f64 {
        0.0
    }

    /// Its volume and area, where they are closed forms.
    fn exact(&self) -> Option<Exact> {
        None
    }

    /// A length of the solid's own frame below which its boundary is not resolved: a ray that leaves the boundary and
    /// seems to be inside for no longer than this is outside. Zero for closed forms.
    fn grain(&self) -> f64 {
        0.0
    }

    /// The solid with its boundary moved along the normals: outward by `by` where that is above zero, inward below
    /// (own units): the points nearer to it than `by`, and those farther than that from its outside. `Ok(None)` where
    /// nothing is left, an error in words where that is no solid of the same kind.
    fn moved(&self, _by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        Err("its moved boundary is no solid that is known in closed form")
    }

    /// A sheet with a thickness, `by` / 2 to each side (own units); `None` where it has an inside already.
    fn thickened(&self, _by: f64) -> Option<Arc<dyn Solid>> {
        None
    }

    /// What to say of a sheet where an inside is wanted.
    fn sheet_words(&self) -> String {
        SHEET.into()
    }

    /// What to do about it then.
    fn sheet_remedy(&self) -> &'static str {
        "give it a thickness, `surface.thicken(2mm)`, or put a solid in its place, such as `half_space(z < 0)` for a floor"
    }

    /// What asking costs: the cheap are asked before the dear.
    fn cost(&self) -> Cost {
        Cost::Search
    }
}

/// What queries need beside their arguments, one for each thread; it holds no answers from ray to ray.
#[derive(Default, Debug)]
pub struct Scratch {
    /// Counts of work.
    pub counts: Counts,
    /// How the ray leans, in the frame of the solid that is asked.
    pub lean: Lean,
    /// How the ray leans in the frame that the solid's place is given in, where that is not the world's.
    pub frame: Option<Lean>,
    /// Room of a solid that is made of others, whatever it keeps; of each depth of nesting within that of the one above.
    pub inner: Option<Box<dyn Any + Send>>,
    /// What is known of the line being asked about, for each point set surface.
    pub lines: Vec<point_set::LineScratch>,
    /// Room for asking a point set surface about points.
    pub field: point_set::FieldScratch,
    /// The same for each thickened surface.
    pub thick: Vec<point_set::ThickLine>,
    /// Room for evaluating formulas.
    pub implicit: implicit::Room,
}

/// Counts of work. Sums of them do not depend on the order of work.
#[derive(Clone, Copy, Default, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Counts {
    /// Solves of plane and polynomial, whatever for.
    pub projections: u64,
    /// Of those, how many found too few samples for the degree asked, or samples that do not determine it.
    pub degree_falls: u64,
    /// Crossings of point set surfaces found.
    pub crossings: u64,
    /// Cells of a ray that the curvature certificate, or interval arithmetic on a formula, could not decide.
    pub certificate_failures: u64,
    /// Gaps whose ends disagreed and were mended by a cap.
    pub parity_repairs: u64,
    /// Chords with an odd number of roots before caps and repairs, or a gap whose ends disagree.
    pub odd_chords: u64,
    /// Crossings of caps.
    pub caps: u64,
    /// Crossings answered by a patch alone.
    pub patch_hits: u64,
    /// Polynomials fitted to samples, which say where to ask F.
    pub guides: u64,
    /// Polynomials fitted to F = 0.
    pub patches: u64,
    /// Of all projections, those that fitted them: each is made once, by whichever ray comes first.
    pub building: u64,
    /// Questions to leaves.
    pub leaf_queries: u64,
    /// Leaves whose box a ray met and that were never asked.
    pub leaves_skipped: u64,
    /// Groups of several crossings at one `t`.
    pub ties: u64,
    /// Spans dropped and gaps filled by the clean-up.
    pub cleaned: u64,
    /// Rays without a direction or not finite: they meet nothing.
    pub invalid_rays: u64,
    /// Answers of leaves that are none ([`Answer::is_sound`]): the leaf is nowhere on that ray.
    pub bad_leaves: u64,
}

impl Counts {
    /// What was counted since an earlier state of the same counts.
    pub fn since(&self, before: &Counts) -> Counts {
        let mut since = *self;
        since.each(before, |now, before| *now -= before);
        since
    }

    /// Adds another thread's counts.
    pub fn add(&mut self, other: &Counts) {
        self.each(other, |sum, other| *sum += other);
    }

    fn each(&mut self, other: &Counts, f: impl Fn(&mut u64, u64)) {
        // Taken apart, so that none is left out.
        let Counts {
            projections,
            degree_falls,
            crossings,
            certificate_failures,
            parity_repairs,
            odd_chords,
            caps,
            patch_hits,
            guides,
            patches,
            building,
            leaf_queries,
            leaves_skipped,
            ties,
            cleaned,
            invalid_rays,
            bad_leaves,
        } = self;
        f(projections, other.projections);
        f(degree_falls, other.degree_falls);
        f(crossings, other.crossings);
        f(certificate_failures, other.certificate_failures);
        f(parity_repairs, other.parity_repairs);
        f(odd_chords, other.odd_chords);
        f(caps, other.caps);
        f(patch_hits, other.patch_hits);
        f(guides, other.guides);
        f(patches, other.patches);
        f(building, other.building);
        f(leaf_queries, other.leaf_queries);
        f(leaves_skipped, other.leaves_skipped);
        f(ties, other.ties);
        f(cleaned, other.cleaned);
        f(invalid_rays, other.invalid_rays);
        f(bad_leaves, other.bad_leaves);
    }
}
