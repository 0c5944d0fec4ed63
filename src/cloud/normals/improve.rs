//! Single normals whose sign contradicts the winding number of all.

use glam::DVec3;
use rayon::prelude::*;

use super::Scene;
use crate::cloud::winding::Winding;

/// How far from a sample its two sides are looked at, per width: 1.5 spacings, where the sample itself adds
/// less than a tenth of the jump across a surface, and the far side of a thin wall of 2.5 widths is still far.
const SIDE: f64 = 0.75;

/// Turns every normal on whose side the winding number is larger than on the other, all at once, until none is
/// left or `rounds` are over; returns how many differ from before. Unsigned areas suffice.
///
/// The winding number falls by one across a surface along its normals; with a share `p` of them flipped at
/// random it still falls by `1 - 2p` (Xu et al., globally consistent normal orientation, 2023, use the same
/// sides). Patches flipped as a whole look right from near and stay.
pub fn improve(scene: Scene<'_>, areas: &[f64], normals: &mut [DVec3], rounds: usize) -> usize {
    let before = normals.to_vec();
    for _ in 0..rounds {
        let winding = Winding::new(scene.points, normals, areas, Winding::OPENING);
        let wrong = |i: usize| {
            let side = normals[i] * (SIDE * scene.widths[i]);
            winding.value(scene.points[i] - side) < winding.value(scene.points[i] + side)
        };
        let wrong: Vec<bool> = (0..normals.len()).into_par_iter().map(wrong).collect();
        normals.iter_mut().zip(&wrong).filter(|(_, wrong)| **wrong).for_each(|(n, _)| *n = -*n);
        if !wrong.contains(&true) {
            break;
        }
    }
    normals.iter().zip(&before).filter(|(a, b)| a != b).count()
}
