//! Equal corners made one, what has no area dropped, and the edges told that hold the mesh together.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::{Mesh, Soup};
use crate::cloud::{CloudError, check_extent};

/// How the triangles of a mesh meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seams {
    /// Different edges.
    pub edges: usize,
    /// Edges with an odd number of triangles: at such a one the surface ends.
    pub open: usize,
    /// Edges whose triangles do not run along it once each way: they disagree about which side is out.
    pub unlike: usize,
}

/// The different points, and for each point of a file which of them it is, unless it is not finite.
fn joined(all: &[DVec3]) -> (Vec<DVec3>, Vec<Option<u32>>) {
    let mut known: HashMap<[u64; 3], u32> = HashMap::new();
    let mut points = Vec::new();
    let place = all.iter().map(|p| {
        let key = p.to_array().map(f64::to_bits);
        p.is_finite().then(|| {
            *known.entry(key).or_insert_with(|| {
                points.push(*p);
                points.len() as u32 - 1
            })
        })
    });
    let place = place.collect();
    (points, place)
}

/// Makes a mesh of what a file holds. Corners are equal where their coordinates are.
pub fn mesh(soup: Soup) -> Result<Mesh, CloudError> {
    let (points, place) = joined(&soup.points);
    let (mut wild, mut thin, mut double) = (0usize, 0usize, 0usize);
    let mut seen = HashSet::new();
    let mut triangles = Vec::new();
    for corners in &soup.triangles {
        let [Some(a), Some(b), Some(c)] = corners.map(|i| place[i as usize]) else {
            wild += 1;
            continue;
        };
        if a == b || b == c || c == a {
            thin += 1;
            continue;
        }
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        if seen.insert(sorted) {
            triangles.push([a, b, c]);
        } else {
            double += 1;
        }
    }
    let mut mesh = Mesh { points, triangles, notes: Vec::new() };
    let flat = mesh.triangles.iter().filter(|t| has_no_area(&mesh, t)).count();
    let told = [
        (wild, "with corners that are not finite were dropped"),
        (thin, "with two corners at one place were dropped"),
        (double, "that stand twice were dropped"),
        (flat, "have their corners on one line: they were kept, as they join what lies beside them"),
    ];
    let counted = told.into_iter().filter(|(n, _)| 0 < *n);
    mesh.notes.extend(counted.map(|(n, what)| format!("triangles {what}: {n}")));
    if mesh.triangles.len() <= flat {
        let error = CloudError::bad("no mesh: the file has no triangle with an area");
        return Err(error.help("a mesh needs faces; a cloud of points is drawn by `points(...)`"));
    }
    check_extent(&mesh.points)?;
    Ok(mesh)
}

fn has_no_area(mesh: &Mesh, [a, b, c]: &[u32; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|i| mesh.points[*i as usize]);
    (b - a).cross(c - a) == DVec3::ZERO
}

impl Mesh {
    /// How its triangles meet.
    pub fn seams(&self) -> Seams {
        // For each edge its triangles, and those that run from the lower corner to the higher less the others.
        let mut edges: HashMap<(u32, u32), (u32, i32)> = HashMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
                let edge = edges.entry((from.min(to), from.max(to))).or_default();
                edge.0 += 1;
                edge.1 += if from < to { 1 } else { -1 };
            }
        }
        let open = edges.values().filter(|e| !e.0.is_multiple_of(2)).count();
        let unlike = edges.values().filter(|e| e.0.is_multiple_of(2) && e.1 != 0).count();
        Seams { edges: edges.len(), open, unlike }
    }
}
