//! Meshes.
#![allow(dead_code, missing_docs)]

use glam::DVec3;
use pss::geom::Aabb;
use pss::mesh::Mesh;
use pss::solid::mesh::TriangleMesh;

pub fn made(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(Mesh { points, triangles, notes: Vec::new() })
}

pub fn cube(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let points = Aabb { min: low, max: high }.corners().to_vec();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    (points, triangles)
}
