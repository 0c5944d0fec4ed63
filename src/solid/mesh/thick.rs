//! An open mesh with a thickness: all points nearer to one of its triangles than half of it, so that rims and creases are
//! round.
//!
//! What is nearer to a triangle than r is the union of a plate, the triangle moved along its normal to both sides, and of three
//! capsules around its edges. It is convex, so where a line meets more than one of these the parts hang together, and the lowest
//! beginning and the highest end are its own. Triangles that meet share the capsule of the edge between them, bit for bit, so
//! that their intervals overlap; the solid is their union.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

use super::tree::Tree;
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::capsule::Capsule;
use crate::solid::{Answer, Crossing, Scratch, Solid};

/// The solid.
#[derive(Clone, Debug)]
pub(super) struct ThickMesh {
    tree: Tree,
    /// Of each triangle of the tree.
    plates: Vec<Plate>,
    capsules: Vec<Capsule>,
    radius: f64,
}

/// A triangle.
#[derive(Clone, Debug)]
struct Plate {
    corners: [DVec3; 3],
    /// Of unit length; zero where the corners lie on one line.
    normal: DVec3,
    /// Its edges' capsules.
    edges: [u32; 3],
}

/// An end of a convex part: where, and which part of the boundary. Parts below the number of plates are plates, those from
/// there on capsules.
type End = (f64, u32);

impl ThickMesh {
    /// All points nearer than `radius` to the triangles.
    pub fn new(points: &[DVec3], tree: Tree, radius: f64) -> ThickMesh {
        let mut known: HashMap<[u32; 2], u32> = HashMap::new();
        let mut capsules = Vec::new();
        let mut edge = |a: u32, b: u32| {
            let ends = [a.min(b), a.max(b)];
            *known.entry(ends).or_insert_with(|| {
                let [from, to] = ends.map(|i| points[i as usize]);
                capsules.push(Capsule::new(radius, from, to));
                capsules.len() as u32 - 1
            })
        };
        let plate = |&[a, b, c]: &[u32; 3]| {
            let corners = [a, b, c].map(|i| points[i as usize]);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            Plate { corners, normal, edges: [edge(a, b), edge(b, c), edge(c, a)] }
        };
        let plates = tree.triangles.iter().map(plate).collect();
        ThickMesh { tree, plates, capsules, radius }
    }

    /// The part of the ray's line that is near one triangle.
    fn span(&self, triangle: u32, ray: &Ray) -> Option<[End; 2]> {
        let plate = &self.plates[triangle as usize];
        let first = self.plates.len() as u32;
        let of_edge = |e: u32| Some(self.capsules[e as usize].span(ray)?.map(|t| (t, first + e)));
        let flat = plate.span(ray, self.radius).map(|ends| ends.map(|t| (t, triangle)));
        let parts = plate.edges.into_iter().map(of_edge).chain([flat]).flatten();
        let lower = |a: End, b: End| if b.0 < a.0 { b } else { a };
        let higher = |a: End, b: End| if a.0 < b.0 { b } else { a };
        parts.reduce(|a, b| [lower(a[0], b[0]), higher(a[1], b[1])])
    }
}

impl Plate {
    /// The part of the ray's line inside the prism over the triangle, as high to both sides.
    fn span(&self, ray: &Ray, height: f64) -> Option<[f64; 2]> {
        let [a, b, c] = self.corners;
        let (shift, from) = ray.nearest_to((a + b + c) / 3.0);
        let middle = (a + b + c) / 3.0;
        let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| {
            let out = (to - from).cross(self.normal);
            (out, out.dot(from - middle))
        });
        let walls = sides.into_iter().chain([(self.normal, height), (-self.normal, height)]);
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        for (out, offset) in walls {
            let (room, slope) = (offset - out.dot(from), out.dot(ray.dir));
            if slope < 0.0 {
                lo = lo.max(room / slope);
            } else if 0.0 < slope {
                hi = hi.min(room / slope);
            } else if room <= 0.0 {
                return None;
            }
        }
        (lo < hi && lo.is_finite() && hi.is_finite()).then_some([shift + lo, shift + hi])
    }
}

impl Solid for ThickMesh {
    fn bounds(&self) -> Aabb {
        self.tree.bounds().inflated(self.radius)
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.capsules.iter().fold(Aabb::EMPTY, |all, capsule| all.union(capsule.extent(to_from)))
    }

    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let near = self.bounds().clip(ray);
        if near.is_empty() {
            return Answer::whole_line(false);
        }
        let from = 0.5 * (near.lo + near.hi);
        let own = Ray { origin: ray.at(from), dir: ray.dir };
        let mut spans: Vec<[End; 2]> = Vec::new();
        self.tree.visit_near(&own, self.radius, |i| spans.extend(self.span(i, &own)));
        spans.sort_unstable_by(|[a, c], [b, d]| {
            a.0.total_cmp(&b.0).then(d.0.total_cmp(&c.0)).then(a.1.cmp(&b.1))
        });
        let mut open: Option<[End; 2]> = None;
        let mut push = |[lo, hi]: [End; 2]| {
            out.push(Crossing::exact(from + lo.0, true, lo.1));
            out.push(Crossing::exact(from + hi.0, false, hi.1));
        };
        for next in spans {
            match &mut open {
                Some([_, hi]) if next[0].0 <= hi.0 => {
                    if hi.0 < next[1].0 {
                        *hi = next[1];
                    }
                }
                _ => {
                    open.into_iter().for_each(&mut push);
                    open = Some(next);
                }
            }
        }
        open.into_iter().for_each(push);
        Answer::whole_line(false)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let at = ray.at(crossing.t);
        match self.plates.get(crossing.part as usize) {
            Some(plate) => plate.normal * plate.normal.dot(at - plate.corners[0]).signum(),
            None => self.capsules[crossing.part as usize - self.plates.len()].normal_at(at),
        }
    }
}
