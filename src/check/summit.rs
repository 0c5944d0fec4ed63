//! Lines just below the summits of shapes: what a cutter or another operand reaches of a shape may be no more than its tip, its
//! rim or a cap, of which random lines see nothing.
//!
//! A summit is sought along a direction by lines across it, each step to the highest of eight around, half as far where none
//! is higher (a pattern search: Hooke and Jeeves 1961). Below it lines are sent across at depths that halve.

use glam::DVec3;

use crate::csg::Leaf;
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::{Crossing, Scratch};

/// Shapes of a side that are looked at, and directions for each.
const SHAPES: usize = 2;
const DIRECTIONS: usize = 4;
/// A region so much thinner than a shape, along an axis, is at one of its summits.
const THIN: f64 = 0.25;
/// Lines of the first look, along each of two axes, and halvings of a step.
const FIRST: i32 = 8;
const STEPS: usize = 60;
/// The least depth below a summit, as a power of two of the shape's size.
const DEEPEST: i32 = 40;
/// A line is tilted so much off an axis through a middle: in a plane of symmetry edges are met.
const TILT: f64 = 1e-6;

/// Lines at the summits of shapes of two sides toward where they can meet, and along the axes of the shapes.
pub(super) fn lines(sides: [&[Leaf]; 2], region: &Aabb) -> Vec<Ray> {
    let mut rays = Vec::new();
    let mut scratch = Scratch::default();
    for (side, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
        // Hundreds of lines through a scan would cost more than all the others.
        let exact = |leaf: &&Leaf| leaf.solid.shift_bound() == 0.0;
        let finite = |leaf: &&Leaf| leaf.bounds.is_finite() && !leaf.bounds.is_empty();
        for leaf in side.iter().filter(finite).filter(exact).take(SHAPES) {
            rays.extend(along_axes(leaf, leaf.bounds.center(), leaf.bounds.diagonal(), TILT));
            for toward in directions(leaf, other, region, &mut scratch).into_iter().take(DIRECTIONS) {
                rays.extend(below(leaf, toward, &mut scratch));
            }
        }
    }
    rays
}

/// Nearly along the axes of a shape, through its middle: where another one touches it all around.
pub(super) fn along_axes(leaf: &Leaf, middle: DVec3, length: f64, tilt: f64) -> [Ray; 3] {
    [0, 1, 2].map(|axis| {
        let (u, v) = (DVec3::AXES[axis], DVec3::AXES[(axis + 1) % 3]);
        let local = u + tilt * v + 0.77 * tilt * DVec3::AXES[(axis + 2) % 3];
        let dir = (leaf.place.world_from_local.matrix3 * local).normalize_or_zero();
        Ray::new(middle, length * dir)
    })
}

/// Where a shape's summit may stand in another: across the thinnest side of where both can be, and across the plane of an
/// unbounded one.
fn directions(leaf: &Leaf, other: &[Leaf], region: &Aabb, scratch: &mut Scratch) -> Vec<DVec3> {
    let mut all = Vec::new();
    let (size, own) = (region.size(), leaf.bounds.size());
    let thin = (0..3).min_by(|a, b| (size[*a] / own[*a]).total_cmp(&(size[*b] / own[*b])));
    if let Some(axis) = thin.filter(|axis| size[*axis] < THIN * own[*axis]) {
        let above = leaf.bounds.center()[axis] < region.center()[axis];
        all.push(if above { DVec3::AXES[axis] } else { -DVec3::AXES[axis] });
    }
    for unbounded in other.iter().filter(|leaf| !leaf.bounds.is_finite()).take(SHAPES) {
        if let Some(normal) = face_of(unbounded, leaf.bounds.center(), scratch) {
            all.extend([-normal, normal]);
        }
    }
    all
}

/// The normal of an unbounded shape where a line through a point meets it.
fn face_of(leaf: &Leaf, at: DVec3, scratch: &mut Scratch) -> Option<DVec3> {
    DVec3::AXES.into_iter().find_map(|axis| {
        let (local, found) = crossings(leaf, &Ray::new(at, axis), scratch);
        let crossing = found.first()?;
        Some(leaf.place.normal_to_world(leaf.solid.normal(&local, crossing, scratch)))
    })
}

/// Where the whole line of a ray crosses a shape alone; the ray in its frame.
fn crossings(leaf: &Leaf, ray: &Ray, scratch: &mut Scratch) -> (Ray, Vec<Crossing>) {
    let local = leaf.place.ray_to_local(ray);
    let mut found = Vec::new();
    leaf.crossings(&local, Interval::ALL, scratch, &mut found);
    (local, found)
}

/// How far along a unit direction a shape reaches on the line through a point, from there.
fn height(leaf: &Leaf, at: DVec3, toward: DVec3, scratch: &mut Scratch) -> f64 {
    let (_, found) = crossings(leaf, &Ray::new(at, toward), scratch);
    found.iter().filter(|c| !c.entering).map(|c| c.t).fold(f64::NEG_INFINITY, f64::max)
}

/// Lines across a shape at depths that halve below its summit.
fn below(leaf: &Leaf, toward: DVec3, scratch: &mut Scratch) -> Vec<Ray> {
    let (u, v) = toward.any_orthonormal_pair();
    let (middle, radius) = (leaf.bounds.center(), 0.5 * leaf.bounds.diagonal());
    let mut tried = |x: f64, y: f64| (height(leaf, middle + x * u + y * v, toward, scratch), [x, y]);
    let mut best = tried(0.0, 0.0);
    let grid = (-FIRST..=FIRST).flat_map(|i| (-FIRST..=FIRST).map(move |j| [i, j]));
    for [i, j] in grid {
        let [x, y] = [i, j].map(|k| radius * f64::from(k) / f64::from(FIRST));
        let next = tried(x, y);
        best = if best.0 < next.0 { next } else { best };
    }
    let mut step = radius / f64::from(FIRST);
    for _ in 0..STEPS {
        let [x, y] = best.1;
        let around = (0..9).filter(|k| *k != 4).map(|k| [f64::from(k % 3 - 1), f64::from(k / 3 - 1)]);
        let mut next = best;
        for [dx, dy] in around {
            let candidate = tried(x + step * dx, y + step * dy);
            next = if next.0 < candidate.0 { candidate } else { next };
        }
        step = if next.0 == best.0 { 0.5 * step } else { step };
        best = next;
    }
    let (top, [x, y]) = best;
    if !top.is_finite() {
        return Vec::new();
    }
    let at = middle + x * u + y * v + top * toward;
    let depths = (1..=DEEPEST).map(|k| radius * 0.5f64.powi(k));
    // A little askew, so that no line runs in a face.
    let askew = [(u + 0.013 * v).normalize(), (v - 0.017 * u).normalize()];
    depths.flat_map(|depth| askew.map(|dir| Ray::new(at - depth * toward, 2.0 * radius * dir))).collect()
}
