//! What the layers beside the colour hold. How they are kept is left to [`crate::film`].

use super::scenery::Seen;
use crate::film::{Aov, Film};
use crate::geom::Ray;

/// Writes the layers of a pixel whose centre's ray saw a surface of the given albedo.
pub fn keep(film: &mut Film, pixel: usize, ray: &Ray, seen: &Seen, albedo: [f32; 3]) {
    for layer in &mut film.layers {
        let n = layer.aov.channels().len();
        let values = values(layer.aov, ray, seen, albedo);
        layer.data[pixel * n..(pixel + 1) * n].copy_from_slice(&values[..n]);
    }
}

/// The values of a layer; of a layer with one channel the first counts.
fn values(aov: Aov, ray: &Ray, seen: &Seen, albedo: [f32; 3]) -> [f32; 3] {
    match aov {
        Aov::Depth => [distance(ray, seen) as f32; 3],
        Aov::Normal => {
            let normal = if seen.hit.sheet { seen.normal } else { seen.surface.normal };
            normal.as_vec3().to_array()
        }
        Aov::Position => seen.surface.point.as_vec3().to_array(),
        Aov::Albedo => albedo,
        Aov::Leaf => [(u64::from(seen.hit.boundary.leaf) + 1) as f32; 3],
    }
}

/// The distance from where the ray starts, world length.
pub fn distance(ray: &Ray, seen: &Seen) -> f64 {
    seen.hit.boundary.t * ray.dir.length()
}
