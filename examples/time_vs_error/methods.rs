//! Ways to meet a cloud of points with a ray: each gives the first crossing of a line from outside, or none.

use glam::DVec3;
use pss::geom::{Interval, Ray};
use pss::mesh::Mesh;
use pss::mls::{Sample, Weight};
use pss::solid::mesh::TriangleMesh;
use pss::solid::point_set::{FieldScratch, PointSet};
use pss::solid::{Crossing, Scratch, Solid};

/// A way to meet a cloud.
pub trait Method {
    /// Arc length along a line of unit direction to the first crossing.
    fn first(&mut self, line: &Ray) -> Option<f64>;

    /// Solves of plane and polynomial so far.
    fn projections(&self) -> u64 {
        0
    }
}

/// This project's: every root certified, the first one reported.
pub struct Surface {
    set: PointSet,
    scratch: Scratch,
    found: Vec<Crossing>,
}

impl Surface {
    /// Of a surface.
    pub fn new(set: &PointSet) -> Surface {
        Surface { set: set.clone(), scratch: Scratch::default(), found: Vec::new() }
    }
}

impl Method for Surface {
    fn first(&mut self, line: &Ray) -> Option<f64> {
        let mut lo = 0.0;
        while lo < f64::INFINITY {
            self.found.clear();
            let range = Interval::new(lo, f64::INFINITY);
            lo = self.set.crossings(line, range, &mut self.scratch, &mut self.found).range.hi;
            if let Some(first) = self.found.first() {
                return Some(first.t);
            }
        }
        None
    }

    fn projections(&self) -> u64 {
        self.scratch.counts.projections
    }
}

/// Trust spheres on a line as stretches of it, front to back.
fn stretches(set: &PointSet, line: &Ray) -> Vec<(Interval, usize)> {
    let samples = set.samples();
    let (mut cells, mut reaches) = (Vec::new(), Vec::new());
    samples.cells_on(line, &mut cells);
    cells.iter().for_each(|c| samples.spheres_of(c.cell as usize, line, &mut reaches));
    let mut all: Vec<_> = reaches.into_iter().map(|r| (r.range, r.sample as usize)).collect();
    all.sort_by(|a, b| a.0.lo.total_cmp(&b.0.lo).then(a.1.cmp(&b.1)));
    all
}

/// The iteration of Adamson and Alexa 2003 alone: in each sphere, front to back, the point next to its centre is projected,
/// the line meets the polynomial's tangent there, and so on until it rests within the sphere or leaves it.
pub struct Iteration {
    /// The surface whose projection is used.
    pub set: PointSet,
    /// When it rests, world length.
    pub tolerance: f64,
    /// Room for projections.
    pub scratch: FieldScratch,
}

/// More rounds than this do not come to rest.
const ROUNDS: usize = 20;

/// Where places of a stretch of the line, each the `next` of the one before, come to rest; none where they leave it.
fn rest(
    stretch: Interval,
    tolerance: f64,
    mut s: f64,
    mut next: impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    for _ in 0..ROUNDS {
        let after = next(s).filter(|after| stretch.contains(*after))?;
        if (after - s).abs() <= tolerance {
            return Some(after);
        }
        s = after;
    }
    None
}

impl Method for Iteration {
    fn first(&mut self, line: &Ray) -> Option<f64> {
        let Iteration { set, tolerance, scratch } = self;
        stretches(set, line).into_iter().find_map(|(range, sample)| {
            // The centre of the sphere first, which need not lie on the line.
            let center = set.samples().points[sample];
            let mut begin = Some(center);
            rest(range, *tolerance, (center - line.origin).dot(line.dir), |s| {
                let at = begin.take().unwrap_or_else(|| line.at(s));
                let Sample { value, plane_normal, fit_normal, .. } = set.field(at, scratch).ok()?;
                let on = at - value * plane_normal;
                Some((on - line.origin).dot(fit_normal) / line.dir.dot(fit_normal))
            })
        })
    }

    fn projections(&self) -> u64 {
        self.scratch.projections()
    }
}

/// Steps of so many widths along the line, and halving where F changes its sign: what is thinner than a step is missed.
pub struct Marching {
    /// The surface whose F is asked.
    pub set: PointSet,
    /// Step, widths.
    pub step: f64,
    /// Where halving ends, world length.
    pub tolerance: f64,
    /// Room for projections.
    pub scratch: FieldScratch,
}

impl Method for Marching {
    fn first(&mut self, line: &Ray) -> Option<f64> {
        let mut done = f64::NEG_INFINITY;
        let mut before: Option<(f64, f64)> = None;
        for (range, sample) in stretches(&self.set, line) {
            let step = self.step * self.set.samples().widths[sample];
            let mut s = range.lo.max(done);
            while s <= range.hi {
                done = s;
                let value = self.set.field(line.at(s), &mut self.scratch).ok().map(|f| f.value);
                if let (Some((a, fa)), Some(f)) = (before, value)
                    && (fa < 0.0) != (f < 0.0)
                {
                    return Some(self.halve(line, a, s, fa));
                }
                before = value.map(|f| (s, f));
                s += step;
            }
        }
        None
    }

    fn projections(&self) -> u64 {
        self.scratch.projections()
    }
}

impl Marching {
    fn halve(&mut self, line: &Ray, mut a: f64, mut b: f64, fa: f64) -> f64 {
        while self.tolerance < b - a {
            let s = 0.5 * (a + b);
            let Ok(f) = self.set.field(line.at(s), &mut self.scratch) else { break };
            if (f.value < 0.0) == (fa < 0.0) { a = s } else { b = s }
        }
        0.5 * (a + b)
    }
}

/// The simpler implicit surface of Adamson and Alexa 2003, n(x) . (x - a(x)) = 0 with weighted means of normals and
/// positions: the line meets the plane (a, n), and so on.
pub struct Means {
    /// Whose samples and widths are used.
    pub set: PointSet,
    /// When it rests, world length.
    pub tolerance: f64,
    /// The weight.
    pub weight: pss::mls::Compact,
}

impl Means {
    fn plane(&self, at: DVec3) -> Option<(DVec3, DVec3)> {
        let samples = self.set.samples();
        let (mut total, mut a, mut n) = (0.0, DVec3::ZERO, DVec3::ZERO);
        samples.visit(at, 0.0, self.weight.support().sqrt(), |i| {
            let d = samples.points[i] - at;
            let w = (1.0 - d.length_squared() / (8.0 * samples.widths[i].powi(2))).max(0.0).powi(8);
            total += w;
            a += w * d;
            n += w * samples.normal(i);
        });
        Some((at + a / total, n.try_normalize()?)).filter(|_| 1e-6 < total)
    }
}

impl Method for Means {
    fn first(&mut self, line: &Ray) -> Option<f64> {
        stretches(&self.set, line).into_iter().find_map(|(range, sample)| {
            let from = (self.set.samples().points[sample] - line.origin).dot(line.dir);
            rest(range, self.tolerance, from, |s| {
                let (a, n) = self.plane(line.at(s))?;
                Some((a - line.origin).dot(n) / line.dir.dot(n))
            })
        })
    }
}

/// The cylinder average of Schaufler and Jensen 2000: around the first sample that a cylinder about the line holds, those
/// within it, each a disc across its normal, met by the line at depths that are averaged.
pub struct Cylinder {
    /// Whose samples are used.
    pub set: PointSet,
    /// Radius of the cylinder, widths.
    pub radius: f64,
}

impl Method for Cylinder {
    fn first(&mut self, line: &Ray) -> Option<f64> {
        let samples = self.set.samples();
        let mut cells = Vec::new();
        samples.cells_on(line, &mut cells);
        let mut inside: Vec<(f64, usize, f64)> = Vec::new();
        for i in cells.iter().flat_map(|c| samples.of_cell(c.cell as usize)) {
            let s = (samples.points[i] - line.origin).dot(line.dir);
            let off = (samples.points[i] - line.at(s)).length() / (self.radius * samples.widths[i]);
            // Discs that face the eye.
            if off < 1.0 && samples.normal(i).dot(line.dir) < -0.05 {
                inside.push((s, i, off));
            }
        }
        let (nearest, first, _) = *inside.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let depth = 2.0 * self.radius * samples.widths[first];
        let (mut total, mut sum) = (0.0, 0.0);
        for (s, i, off) in inside.into_iter().filter(|x| x.0 <= nearest + depth) {
            let n = samples.normal(i);
            let met = (samples.points[i] - line.origin).dot(n) / line.dir.dot(n);
            let w = 1.0 - off;
            // A disc seen from its edge is met nowhere near.
            if (met - s).abs() <= depth {
                total += w;
                sum += w * met;
            }
        }
        (0.0 < total).then(|| sum / total)
    }
}

/// Triangles between the samples themselves in a hierarchy.
pub struct Triangles {
    mesh: TriangleMesh,
    scratch: Scratch,
    found: Vec<Crossing>,
}

impl Triangles {
    /// Of a star-shaped cloud about the origin: Delaunay triangles of the directions, by stereographic projection.
    pub fn new(points: &[DVec3]) -> Triangles {
        // From the direction of the last sample.
        let last = points.len() - 1;
        let pole = points[last].normalize();
        let (e1, e2) = pole.any_orthonormal_pair();
        let flat: Vec<delaunator::Point> = points[..last]
            .iter()
            .map(|p| {
                let d = p.normalize();
                let scale = 1.0 / (1.0 - d.dot(pole));
                delaunator::Point { x: scale * d.dot(e1), y: scale * d.dot(e2) }
            })
            .collect();
        let made = delaunator::triangulate(&flat);
        let mut triangles: Vec<[u32; 3]> =
            made.triangles.chunks_exact(3).map(|t| [t[0] as u32, t[1] as u32, t[2] as u32]).collect();
        let hull = &made.hull;
        triangles.extend(
            (0..hull.len()).map(|i| [hull[i] as u32, hull[(i + 1) % hull.len()] as u32, last as u32]),
        );
        let mesh = Mesh { points: points.to_vec(), triangles, notes: Vec::new() };
        Triangles { mesh: TriangleMesh::new(mesh), scratch: Scratch::default(), found: Vec::new() }
    }
}

impl Method for Triangles {
    fn first(&mut self, line: &Ray) -> Option<f64> {
        self.found.clear();
        self.mesh.crossings(line, Interval::AHEAD, &mut self.scratch, &mut self.found);
        self.found.first().map(|c| c.t)
    }
}
