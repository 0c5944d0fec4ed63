//! Lines where unbounded shapes can meet without an end: what they leave of each other may lie far away, in a wedge between
//! planes that nearly run along each other, or along the axis of a cylinder.
//!
//! A line has no end either, so that what is unbounded is met by many of them; each of the four wedges of two planes, and each
//! of the eight corners of three, has a line of its own from its edge or tip.

use glam::{DMat3, DVec3};

use super::lines::{is_edge, through};
use super::summit::along_axes;
use crate::csg::Leaf;
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::Scratch;

/// Random lines.
const RANDOM: u64 = 600;
/// Of a side of more unbounded shapes nothing is said.
const SHAPES: usize = 8;
/// Lines about the origin by which a point of a shape's face is sought, and how far from it the first of them pass: each of
/// the next octaves has as many.
const SOUGHT: u64 = 16;
const OCTAVES: i32 = 60;

/// A plane that touches an unbounded shape.
#[derive(Clone, Copy)]
struct Face {
    at: DVec3,
    normal: DVec3,
    /// A point inside the shape, or of its face.
    inside: DVec3,
}

/// Whether the lines can tell what two sides leave of each other.
pub(super) fn can_tell(sides: [&[Leaf]; 2]) -> bool {
    sides.into_iter().all(|side| side.iter().filter(|leaf| !leaf.bounds.is_finite()).count() <= SHAPES)
}

/// Lines through where two sides meet without an end, and about it.
pub(super) fn lines(sides: [&[Leaf]; 2], region: &Aabb) -> Vec<Ray> {
    let all = || sides.into_iter().flatten();
    let endless: Vec<&Leaf> = all().filter(|leaf| !leaf.bounds.is_finite()).collect();
    let mut scratch = Scratch::default();
    let faces: Vec<Face> = endless.iter().filter_map(|leaf| face(leaf, &mut scratch)).collect();
    let reach = faces.iter().map(|face| face.at.length()).chain(all().map(Leaf::scale)).fold(0.0, f64::max);
    let reach = if reach == 0.0 { 1.0 } else { 2.0 * reach };
    let middle = DVec3::ZERO.clamp(region.min, region.max);
    let about = Aabb { min: middle, max: middle }.inflated(reach).intersection(*region);
    let within: Vec<DVec3> = faces.iter().map(|face| face.inside).chain([about.center()]).collect();
    let axes = endless.iter().flat_map(|leaf| within.iter().flat_map(|at| along_axes(leaf, *at, reach, 0.0)));
    let mut rays: Vec<Ray> = axes.collect();
    let from_edges = wedges(&faces, about.center()).into_iter().chain(corners(&faces));
    rays.extend(from_edges.map(|ray| Ray::new(ray.origin, reach * ray.dir)));
    if !is_edge(&about) {
        let anywhere = (0..RANDOM).map(|number| through(&about, reach, number));
        rays.extend(anywhere.zip(within.iter().cycle()).enumerate().map(|(i, (ray, at))| match i % 2 {
            0 => ray,
            _ => Ray::new(ray.origin, reach * (at - ray.origin).normalize_or_zero()),
        }));
    }
    rays
}

/// The place of a shape's face that is nearest to the origin of those that some lines meet; the first octave that meets one.
fn face(leaf: &Leaf, scratch: &mut Scratch) -> Option<Face> {
    let scale = if leaf.scale() == 0.0 { 1.0 } else { leaf.scale() };
    for octave in -1..OCTAVES {
        let reach = if octave < 0 { 0.0 } else { scale * 2f64.powi(octave) };
        let about = Aabb { min: DVec3::ZERO, max: DVec3::ZERO }.inflated(reach);
        let met = (0..SOUGHT).filter_map(|number| met(leaf, &through(&about, scale, number), scratch));
        let nearest = met.min_by(|a, b| a.at.length().total_cmp(&b.at.length()));
        if nearest.is_some() {
            return nearest;
        }
    }
    None
}

/// Where the whole line of a ray meets a shape alone, nearest to the ray's origin.
fn met(leaf: &Leaf, ray: &Ray, scratch: &mut Scratch) -> Option<Face> {
    let local = leaf.place.ray_to_local(ray);
    let mut found = Vec::new();
    leaf.crossings(&local, Interval::ALL, scratch, &mut found);
    let nearest = found.iter().min_by(|a, b| a.t.abs().total_cmp(&b.t.abs()))?;
    let normal = leaf.place.normal_to_world(leaf.solid.normal(&local, nearest, scratch));
    let chord = found.windows(2).find(|ends| ends[0].entering && !ends[1].entering);
    let inside = ray.at(chord.map_or(nearest.t, |ends| 0.5 * (ends[0].t + ends[1].t)));
    Some(Face { at: ray.at(nearest.t), normal, inside })
}

/// Two lines into the four wedges of each two planes.
fn wedges(faces: &[Face], middle: DVec3) -> Vec<Ray> {
    let mut rays = Vec::new();
    for (i, a) in faces.iter().enumerate() {
        for b in &faces[i + 1..] {
            let edge = a.normal.cross(b.normal).normalize_or_zero();
            let at = meeting([*a, *b, Face { at: middle, normal: edge, inside: middle }]);
            // Of planes that nearly run along each other one of these keeps no digits.
            let (sum, difference) = (a.normal + b.normal, a.normal - b.normal);
            let larger = if difference.length() < sum.length() { sum } else { difference };
            let into = [larger, edge.cross(larger)];
            rays.extend(into.map(|dir| Ray::new(at, dir.normalize_or_zero())));
        }
    }
    rays
}

/// Four lines into the eight corners of each three planes.
fn corners(faces: &[Face]) -> Vec<Ray> {
    let mut rays = Vec::new();
    for (i, a) in faces.iter().enumerate() {
        for (j, b) in faces.iter().enumerate().skip(i + 1) {
            for c in &faces[j + 1..] {
                let at = meeting([*a, *b, *c]);
                let edges =
                    [[a, b], [b, c], [c, a]].map(|[a, b]| a.normal.cross(b.normal).normalize_or_zero());
                let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
                let into = signs.map(|[s, t]| edges[0] + s * edges[1] + t * edges[2]);
                rays.extend(into.map(|dir| Ray::new(at, dir.normalize_or_zero())));
            }
        }
    }
    rays
}

/// The point of three planes; not a number where two of them run along each other.
fn meeting(faces: [Face; 3]) -> DVec3 {
    let rows = DMat3::from_cols_array_2d(&faces.map(|face| face.normal.to_array())).transpose();
    let offsets = faces.map(|face| face.normal.dot(face.at));
    rows.inverse() * DVec3::from_array(offsets)
}
