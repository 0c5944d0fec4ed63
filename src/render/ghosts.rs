//! What is drawn to be seen through: laid over a finished colour, face after face, as thin tinted glass that bends
//! and shadows nothing.

use super::scenery::Seen;
use crate::csg::{Scratch, Spans};
use crate::geom::{Interval, Ray};
use crate::shot::{Hit, Material, World};

/// How much of what lies behind a face is covered where that is seen squarely.
const COVER: f64 = 0.12;

/// The same at its rim: outlines stand out, as in pictures by X-rays.
const RIM: f64 = 0.5;

/// Up to where faces stand before what is seen. A face on the very surface is none of them, as which of the two is nearer
/// there is rounding.
fn clear(ray: &Ray, seen: &Seen) -> f64 {
    let slope = ray.dir.dot(seen.surface.normal).abs();
    (seen.hit.boundary.t - 2.0 * seen.surface.offset / slope).max(0.0)
}

/// The ghosts of a picture and what faces are crossed.
pub struct Ghosts<'a> {
    world: &'a World,
    materials: &'a [Material],
}

impl<'a> Ghosts<'a> {
    /// Of a world of their own; materials by the index that a surface carries.
    pub fn new(world: &'a World, materials: &'a [Material]) -> Ghosts<'a> {
        Ghosts { world, materials }
    }

    /// Lays the faces between the eye and what it sees over a linear colour with its coverage.
    pub fn over(&self, scratch: &mut Scratch, ray: &Ray, seen: Option<&Seen>, behind: [f32; 4]) -> [f32; 4] {
        let range = Interval::new(0.0, seen.map_or(f64::INFINITY, |seen| clear(ray, seen)));
        let mut color = behind;
        for hit in self.faces(scratch, ray, range).iter().rev() {
            let surface = self.world.surface(ray, hit);
            let material = Material::of(self.materials, surface.material);
            let own =
                if material.reads_color() { self.world.color(hit, surface.point, scratch) } else { None };
            let facing = (surface.normal.dot(ray.dir) / ray.dir.length()).abs().min(1.0);
            let cover = (RIM + (COVER - RIM) * facing) as f32;
            let [r, g, b] = material.albedo(surface.point, own);
            for (under, own) in color.iter_mut().zip([r, g, b, 1.0]) {
                *under += cover * (own - *under);
            }
        }
        color
    }

    /// Faces in a range of a ray, the nearest first.
    fn faces(&self, scratch: &mut Scratch, ray: &Ray, range: Interval) -> Vec<Hit> {
        let mut spans = Spans::default();
        self.world.spans(ray, range, scratch, &mut spans);
        let mut faces = Vec::new();
        self.world.sheets(ray, range, scratch, &mut faces);
        for span in &spans {
            for (boundary, entering) in [(span.enter, true), (span.exit, false)] {
                // A span that is clipped, or never ends, has no face there.
                if let Some(boundary) = boundary.filter(|b| range.lo < b.t && b.t < range.hi) {
                    faces.push(Hit { boundary, entering, sheet: false });
                }
            }
        }
        faces.sort_by(|a, b| a.boundary.t.total_cmp(&b.boundary.t));
        faces
    }
}
