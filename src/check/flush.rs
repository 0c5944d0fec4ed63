//! Lines at faces that may coincide: where sides of the boxes of two shapes lie in one plane and overlap. Shapes with flat
//! sides along the axes mostly share faces so, and a small shared face is missed by lines that know nothing of it.

use std::collections::HashSet;

use glam::DVec3;

use crate::csg::Object;
use crate::geom::{Aabb, Ray, tolerance};

/// Pairs that are looked at.
const PAIRS: usize = 2000;
/// Lines for each: their touching an edge by chance is one in many.
const LINES: usize = 4;

/// A side of a box: where it is along its axis, and whose.
#[derive(Clone, Copy)]
struct Side {
    at: f64,
    leaf: u32,
}

/// Lines through the middles of what sides of two boxes share, at most `most`.
pub(super) fn lines(object: &Object, most: usize) -> Vec<Ray> {
    let leaves = object.leaves();
    let mut known = HashSet::new();
    let mut rays = Vec::new();
    for axis in 0..3 {
        let mut sides = Vec::new();
        for (leaf, i) in leaves.iter().zip(0..).filter(|(leaf, _)| leaf.bounds.is_finite()) {
            sides.extend([leaf.bounds.min, leaf.bounds.max].map(|p| Side { at: p[axis], leaf: i }));
        }
        sides.sort_by(|a, b| a.at.total_cmp(&b.at).then(a.leaf.cmp(&b.leaf)));
        for (i, a) in sides.iter().enumerate() {
            for b in sides[i + 1..].iter().take(PAIRS).take_while(|b| is_one_plane(a, b)) {
                let boxes = [a, b].map(|side| leaves[side.leaf as usize].bounds);
                let shared = boxes[0].intersection(boxes[1]);
                if rays.len() + LINES > most || known.len() == PAIRS {
                    return rays;
                }
                if a.leaf != b.leaf && is_face(&shared, axis) && known.insert((axis, a.leaf, b.leaf)) {
                    rays.extend(through(&shared, axis, a.at, boxes[0].union(boxes[1]).diagonal()));
                }
            }
        }
    }
    rays
}

/// Whether two sides may be meant to lie in one plane.
fn is_one_plane(a: &Side, b: &Side) -> bool {
    b.at - a.at <= tolerance::cleanup(a.at.abs().max(b.at.abs()))
}

/// Whether what two boxes share has an area across an axis.
fn is_face(shared: &Aabb, axis: usize) -> bool {
    let size = shared.max - shared.min;
    let across = |i: usize| tolerance::cleanup(shared.farthest()) < size[(axis + i) % 3];
    across(1) && across(2)
}

/// Lines across a rectangle, none in a plane of symmetry, where edges are met.
fn through(shared: &Aabb, axis: usize, at: f64, length: f64) -> impl Iterator<Item = Ray> {
    let (u, v, w) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3], DVec3::AXES[axis]);
    let (middle, size) = (shared.center(), shared.max - shared.min);
    let places = [[0.03, 0.07], [-0.31, 0.23], [0.37, -0.17], [-0.11, -0.41]];
    places.into_iter().take(LINES).map(move |[a, b]| {
        let mut origin = middle + (a * size).dot(u) * u + (b * size).dot(v) * v;
        origin[axis] = at;
        Ray::new(origin, length * (w + 0.071 * u - 0.053 * v).normalize())
    })
}
