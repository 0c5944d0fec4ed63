//! What the layers beside the colour hold. How they are kept is left to [`crate::film`].

use super::scenery::{Scenery, Seen, Tracer};
use crate::csg::Span;
use crate::film::{Aov, Film};
use crate::geom::Ray;
use crate::solid::Counts;

/// What is known of a pixel once the ray through its centre is traced.
struct Facts<'a> {
    ray: &'a Ray,
    seen: Option<&'a Seen>,
    albedo: [f32; 3],
    owner: u32,
    leaf: u64,
    /// What lies along the whole ray, where a layer asks for it.
    spans: &'a [Span],
    /// The work of tracing them.
    along: Counts,
}

/// What is known of a pixel once it is done.
#[derive(Clone, Copy, Default, Debug)]
pub struct Sums {
    /// The work of all its rays.
    pub work: Counts,
    /// The squared standard error of its brightness.
    pub variance: f64,
    /// How many samples it has.
    pub samples: u32,
}

/// Writes the layers of a pixel whose centre's ray saw a surface of the given albedo, or nothing.
pub fn keep<S: Scenery>(
    film: &mut Film,
    pixel: usize,
    ray: &Ray,
    seen: Option<(&Seen, [f32; 3])>,
    tracer: &mut Tracer<S>,
) {
    let before = tracer.scratch.solid.counts;
    let asked = film.layers.iter().any(|layer| layer.aov.is_of_insides());
    let spans = if asked { tracer.scenery.spans(ray, &mut tracer.scratch) } else { Vec::new() };
    let facts = Facts {
        ray,
        seen: seen.map(|(seen, _)| seen),
        albedo: seen.map_or([0.0; 3], |(_, albedo)| albedo),
        owner: seen.map_or(0, |(seen, _)| tracer.scenery.owner(&seen.hit)),
        leaf: seen.map_or(0, |(seen, _)| tracer.scenery.leaf(&seen.hit)),
        spans: &spans,
        along: tracer.scratch.solid.counts.since(&before),
    };
    for layer in &mut film.layers {
        let Some(values) = values(layer.aov, &facts) else { continue };
        let n = layer.aov.channels().len();
        layer.data[pixel * n..(pixel + 1) * n].copy_from_slice(&values[..n]);
    }
}

/// Writes the layers that are known once all rays of a pixel are traced.
pub fn sum_up(film: &mut Film, pixel: usize, sums: &Sums) {
    let projections = sums.work.projections - sums.work.building;
    for layer in &mut film.layers {
        layer.data[pixel] = match layer.aov {
            Aov::Projections => projections as f32,
            Aov::Cost => (projections + sums.work.leaf_queries) as f32,
            Aov::Variance => sums.variance as f32,
            Aov::Samples => sums.samples as f32,
            _ => continue,
        };
    }
}

/// The values of a layer; of a layer with one channel the first counts. `None` where it stays as it is.
fn values(aov: Aov, facts: &Facts) -> Option<[f32; 3]> {
    let Facts { ray, seen, spans, along, .. } = facts;
    let way =
        |span: &Span| span.interval().intersect(crate::geom::Interval::AHEAD).length() * ray.dir.length();
    let value = match aov {
        Aov::Layers => spans.len() as f32,
        Aov::Thickness => spans.iter().map(way).fold(0.0, |sum, way| sum + way) as f32,
        Aov::Wall => spans.first().map_or(0.0, way) as f32,
        Aov::Ties => along.ties as f32,
        Aov::Parity => along.parity_repairs as f32,
        Aov::Projections | Aov::Cost | Aov::Variance | Aov::Samples => return None,
        Aov::Depth => distance(ray, (*seen)?) as f32,
        Aov::Owner => seen.map(|_| facts.owner as f32)?,
        Aov::Leaf => seen.map(|_| facts.leaf as f32)?,
        Aov::Albedo => return seen.map(|_| facts.albedo),
        Aov::Position => return seen.map(|seen| seen.surface.point.as_vec3().to_array()),
        Aov::Normal => {
            let normal = |seen: &Seen| if seen.hit.sheet { seen.normal } else { seen.surface.normal };
            return seen.map(|seen| normal(seen).as_vec3().to_array());
        }
    };
    Some([value; 3])
}

/// The distance from where the ray starts, world length.
pub fn distance(ray: &Ray, seen: &Seen) -> f64 {
    seen.hit.boundary.t * ray.dir.length()
}
