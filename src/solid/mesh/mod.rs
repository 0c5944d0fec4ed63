//! Meshes of triangles: solids where no edge is open, sheets else. Inside is where a ray has crossed an odd number of
//! triangles, so it matters neither which way round they are nor whether several closed parts lie in one file; where
//! two of those overlap, their common part is outside.

mod shear;
mod thick;
mod tree;

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Body, Crossing, Scratch, Solid, parity};
use crate::geom::{Aabb, Interval, Ray};
use crate::mesh::{Mesh, Seams};
use crate::scene::{Decl, Group, Kind, Param};

use shear::Shear;
use thick::ThickMesh;
use tree::Tree;

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "mesh",
        group: Group::Primitive,
        doc: "A mesh of triangles from a file. A Solid where every edge has an even number of triangles, whichever way \
              they face, else a Sheet.",
        params: &[Param {
            name: "file",
            kind: Kind::Path,
            by_place: true,
            required: true,
            doc: "a PLY, OBJ or STL file",
        }],
        example: "mesh(\"part.stl\")",
    },
    build: Build::Mesh,
};

/// A mesh that answers rays.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    points: Vec<DVec3>,
    tree: Tree,
    seams: Seams,
}

impl TriangleMesh {
    /// Sorts the triangles into a hierarchy.
    pub fn new(mesh: Mesh) -> TriangleMesh {
        let seams = mesh.seams();
        let tree = Tree::new(&mesh.points, mesh.triangles);
        TriangleMesh { points: mesh.points, tree, seams }
    }

    /// How its triangles meet.
    pub fn seams(&self) -> Seams {
        self.seams
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.tree.triangles[triangle as usize].map(|i| self.points[i as usize])
    }

    /// Not of unit length; zero for a triangle whose corners lie on one line.
    fn normal_of(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }
}

impl Solid for TriangleMesh {
    fn body(&self) -> Body {
        if self.seams.open == 0 { Body::Solid } else { Body::Sheet }
    }

    fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        Aabb::of_points(self.points.iter().map(|p| to_from.transform_point3(*p)))
    }

    /// All triangles that the line meets, each by itself; see [`shear`] why none is missed or met twice at an edge.
    /// On a closed mesh they are even in number.
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        let solid = self.body() == Body::Solid;
        let answer = match solid {
            true => Answer::whole_line(false),
            false => Answer { inside: false, range: Interval::new(range.lo, f64::INFINITY) },
        };
        let near = self.bounds().clip(ray);
        if near.is_empty() {
            return answer;
        }
        let start = out.len();
        // From the middle of the box: a far origin would round every corner apart from its neighbours.
        let from = 0.5 * (near.lo + near.hi);
        let own = Ray { origin: ray.at(from), dir: ray.dir };
        let shear = Shear::new(&own);
        self.tree.visit(&own, |i| {
            if let Some(t) = shear.hit(self.corners(i)) {
                out.push(Crossing::exact(from + t, self.normal_of(i).dot(ray.dir) < 0.0, i));
            }
        });
        if solid {
            parity::alternate(out, start, false);
            if !(out.len() - start).is_multiple_of(2) {
                debug_assert!(false, "an odd line through a closed mesh: {ray:?}");
                scratch.counts.parity_repairs += 1;
                out.pop();
            }
        } else {
            out[start..].sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.part.cmp(&b.part)));
            let before = out[start..].iter().take_while(|c| c.t <= range.lo).count();
            out.drain(start..start + before);
        }
        answer
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        parity::outward(self.normal_of(crossing.part), ray, crossing)
    }

    fn thickened(&self, by: f64) -> Option<Arc<dyn Solid>> {
        let sheet = self.body() == Body::Sheet;
        sheet.then(|| Arc::new(ThickMesh::new(&self.points, self.tree.clone(), 0.5 * by)) as Arc<dyn Solid>)
    }

    fn sheet_words(&self) -> String {
        let Seams { open, edges, .. } = self.seams;
        let s = if open == 1 { "" } else { "s" };
        format!("a Sheet: {open} open edge{s} of {edges}")
    }
}
