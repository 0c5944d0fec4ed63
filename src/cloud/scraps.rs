//! Samples that bound nothing: scraps of surface inside a body, or floating outside it.

use glam::DVec3;
use rayon::prelude::*;

use super::Samples;
use super::winding::Winding;

/// A sample bounds the region of winding number above one half if it is above on its inner side and below on its
/// outer one. One spacing away a sampled surface shows 0.9 and 0.1; these bounds leave room for noise, for uneven
/// sampling and for the rims of holes, where both sides approach one half.
const OUTER_AT_MOST: f64 = 0.7;
const INNER_AT_LEAST: f64 = 0.3;

/// Whether each sample bounds the inside: false for scraps. The winding number is asked one spacing to either side.
pub fn bounding(samples: &Samples, winding: &Winding) -> Vec<bool> {
    let side =
        |i: usize, by: f64| -> DVec3 { samples.points[i] + by * samples.spacing[i] * samples.normals[i] };
    let bounds = |i: usize| {
        winding.value(side(i, 1.0)) <= OUTER_AT_MOST && INNER_AT_LEAST <= winding.value(side(i, -1.0))
    };
    (0..samples.len()).into_par_iter().map(bounds).collect()
}

impl Samples {
    /// The samples for which `keep` holds, in their order; widths and spacings stay.
    pub fn selected(&self, keep: &[bool]) -> Samples {
        fn pick<T: Copy>(from: &[T], keep: &[bool]) -> Vec<T> {
            from.iter().zip(keep).filter(|(_, k)| **k).map(|(x, _)| *x).collect()
        }
        Samples {
            points: pick(&self.points, keep),
            normals: pick(&self.normals, keep),
            widths: pick(&self.widths, keep),
            spacing: pick(&self.spacing, keep),
            colors: self.colors.as_ref().map(|c| pick(c, keep)),
            opposed: self.opposed,
            turned: self.turned,
            estimated: self.estimated,
            notes: self.notes.clone(),
        }
    }
}
