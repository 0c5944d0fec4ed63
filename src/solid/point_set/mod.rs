//! The surface of points as a solid: every crossing of a ray, straight from the samples.
//!
//! [`hierarchy`] gives the trust spheres on a line; overlapping ones merge into bands; [`roots`] isolates every root
//! of F in a band by [`certificate`]s; [`mod@line`] strings bands and gaps together to states; [`caps`] closes holes by the winding number.

mod caps;
mod certificate;
mod color;
mod field;
mod foot;
mod hierarchy;
mod line;
mod patch;
mod probe;
mod quick;
mod roots;
mod solidity;
mod thick;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DVec3};

pub use caps::Closure;
pub use field::FieldScratch;
pub use foot::Foot;
pub use hierarchy::{CellOn, Hierarchy, Reach};
pub use line::LineScratch;
use patch::Patches;
pub use solidity::Solidity;
pub use thick::{Thick, ThickLine};

use crate::cloud::neighbours::Neighbours;
use crate::cloud::winding::Winding;
use crate::cloud::{AREA_REACH, areas};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::mls::{Compact, Form, Gaussian};
use crate::num::median::median;
use crate::solid::{Answer, Body, Cost, Crossing, Scratch, Solid};

/// Which weight.
#[derive(Clone, Copy, Debug)]
pub enum Kernel {
    /// (1 - rho/8)^8.
    Compact(Compact),
    /// exp(-rho).
    Gaussian(Gaussian),
}

impl Kernel {
    /// How far the weighted mean of a sampled half-plane lies from its straight edge, in widths, for a point on
    /// the edge: past it the samples have ended. Both follow from the moments of the weight; for the Gaussian
    /// 1/sqrt(pi).
    fn edge(self) -> f64 {
        match self {
            Kernel::Compact(_) => 0.511,
            Kernel::Gaussian(_) => 0.564,
        }
    }
}

/// How a point set surface is made from samples.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// "gaussian" or "compact".
    pub gaussian: bool,
    /// Degree of the polynomial, 0 to 4.
    pub degree: usize,
    /// Whether samples weigh whichever way they face; else the sides of a thin wall are kept apart.
    pub mixed: bool,
    /// Which plane is the reference.
    pub form: Form,
    /// Relative to the diagonal of the samples.
    pub tolerance: f64,
    /// What the search for roots goes by.
    pub lead: Lead,
}

/// What the search for the roots of F goes by, where the samples allow it. The roots are the same, within the tolerance.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Lead {
    /// F alone: the certificate of its curvature everywhere.
    Search,
    /// Guides: polynomials through the samples say where to ask F.
    #[default]
    Guides,
    /// Patches too: polynomials fitted to F = 0 answer where their error is within the tolerance. It pays where many rays
    /// meet each share of the surface.
    Patches,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            gaussian: false,
            degree: 2,
            mixed: false,
            form: Form::Free,
            tolerance: tolerance::POINTS,
            lead: Lead::Guides,
        }
    }
}

/// A point set surface.
#[derive(Clone, Debug)]
pub struct PointSet {
    /// Tells the lines of different surfaces apart in a thread's scratch; no result depends on it.
    id: u64,
    samples: Arc<Hierarchy>,
    kernel: Kernel,
    degree: usize,
    mixed: bool,
    form: Form,
    /// A bound of the error along the normal, world length.
    tolerance: f64,
    /// How far two definitions of inside may disagree, world length: [`roots::WALL`] of the median width.
    grain: f64,
    /// Linear, in the order of the hierarchy; only where something reads them.
    colors: Option<Arc<Vec<[f32; 3]>>>,
    bounds: Aabb,
    body: Body,
    closure: Option<Closure>,
    winding: Arc<OnceLock<Winding>>,
    patches: Patches,
}

impl PointSet {
    /// Builds the surface as a [`Body::Sheet`]; see [`PointSet::measure`] and [`PointSet::closed`].
    /// Normals are outward and of unit length, widths world lengths; one of each a point.
    pub fn new(points: &[DVec3], normals: &[DVec3], widths: &[f64], options: &Options) -> PointSet {
        let bounds = Aabb::of_points(points.iter().copied());
        let diagonal = bounds.diagonal();
        let hierarchy = Hierarchy::new(points, normals, widths);
        let kernel = if options.gaussian {
            // In widths of the narrowest sample, for which the tolerance is loosest in its own terms.
            let widest = widths.iter().copied().fold(0.0, f64::max);
            Kernel::Gaussian(Gaussian::for_tolerance(options.tolerance * diagonal / widest))
        } else {
            Kernel::Compact(Compact)
        };
        let patches = Patches::new(hierarchy.cells(), options.lead);
        PointSet {
            id: next_id(),
            samples: Arc::new(hierarchy),
            kernel,
            degree: options.degree,
            mixed: options.mixed,
            form: options.form,
            tolerance: options.tolerance * diagonal,
            grain: roots::WALL * median(widths.to_vec()),
            bounds,
            colors: None,
            body: Body::Sheet,
            closure: None,
            winding: Arc::default(),
            patches,
        }
    }

    /// The same surface with a stated body; the samples are shared.
    pub fn with_body(&self, body: Body) -> PointSet {
        PointSet { id: next_id(), body, ..self.clone() }
    }

    /// The samples, in the order of the hierarchy.
    pub fn samples(&self) -> &Hierarchy {
        &self.samples
    }

    /// A bound of the error of a crossing along the normal, world length.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Of how many cells a guide was asked for so far, and how many have a guide and a patch.
    pub fn patch_census(&self) -> [usize; 3] {
        self.patches.census()
    }

    /// The same surface, whose rays make no patches.
    pub fn without_patches(&self) -> PointSet {
        PointSet { id: next_id(), patches: self.patches.guides_only(), ..self.clone() }
    }

    /// The winding number of the samples, built when first asked.
    fn winding(&self) -> &Winding {
        self.winding.get_or_init(|| {
            let Hierarchy { points, widths, .. } = &*self.samples;
            let normals = self.samples.normals();
            let reach: Vec<f64> = widths.iter().map(|h| AREA_REACH * h).collect();
            let areas = areas(points, &normals, &reach, &Neighbours::new(points));
            Winding::new(points, &normals, &areas, CAP_OPENING)
        })
    }

    /// Whether the samples about this one may end: only there does the surface end with them.
    fn near_rim(&self, sample: usize) -> bool {
        self.closure.as_ref().is_some_and(|c| c.rim[sample])
    }
}

/// How far the tree of the winding number is opened for caps: errors near 1e-4 (rms), ten times below what the usual
/// opening gives, so that a cap and its normal look flat.
const CAP_OPENING: f64 = 4.0;

fn next_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl Solid for PointSet {
    fn body(&self) -> Body {
        self.body
    }

    fn sheet_remedy(&self) -> &'static str {
        "close it, `scan.close(max_hole: 8mm)`, give it a thickness, `scan.thicken(2mm)`, or take more samples if its walls are thin"
    }

    fn bounds(&self) -> Aabb {
        self.samples.reach()
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        Aabb::of_points(self.samples.points.iter().map(|p| to_from.transform_point3(*p)))
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        self.line_crossings(ray, range, scratch, out)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        self.line_normal(ray, crossing, scratch)
    }

    fn color(&self, at: DVec3, scratch: &mut Scratch) -> Option<[f32; 3]> {
        self.color_at(at, scratch)
    }

    fn shift_bound(&self) -> f64 {
        self.tolerance
    }

    fn grain(&self) -> f64 {
        self.grain
    }

    fn cost(&self) -> Cost {
        Cost::Heavy
    }
}
