//! Single normals whose sign contradicts the winding number of all.

use glam::DVec3;
use rayon::prelude::*;

use super::Scene;
use crate::cloud::winding::Winding;

/// How far from a sample its two sides are looked at, per width: 1.5 spacings, where the sample itself adds
/// less than a tenth of the jump across a surface, and the far side of a thin wall of 2.5 widths is still far.
const SIDE: f64 = 0.75;

/// Only the sign of a jump of near 1 is asked for: errors of a few hundredths do no harm.
const OPENING: f64 = 1.5;

/// Turns every normal among `asked` on whose side the winding number is larger than on the other, all at once, until
/// none is left or `rounds` are over; after the first round only those turned and their neighbours are asked. Returns
/// how many differ from before. The areas need no signs.
///
/// The winding number falls by one across a surface along its normals; with a share `p` of them flipped at
/// random it still falls by `1 - 2p`. Patches flipped as a whole look right from near and stay.
pub fn improve(
    scene: Scene<'_>,
    areas: &[f64],
    normals: &mut [DVec3],
    mut asked: Vec<u32>,
    rounds: usize,
) -> usize {
    let before = normals.to_vec();
    for _ in 0..rounds {
        if asked.is_empty() {
            break;
        }
        let winding = Winding::new(scene.points, normals, areas, OPENING);
        let is_wrong = |i: &u32| {
            let i = *i as usize;
            let side = normals[i] * (SIDE * scene.widths[i]);
            winding.value(scene.points[i] - side) < winding.value(scene.points[i] + side)
        };
        let wrong: Vec<bool> = asked.par_iter().map(is_wrong).collect();
        let turned: Vec<u32> = asked.iter().zip(wrong).filter(|(_, wrong)| *wrong).map(|(i, _)| *i).collect();
        turned.iter().for_each(|&i| normals[i as usize] = -normals[i as usize]);
        let near = |&i: &u32| scene.table.row(i as usize).iter().copied().chain([i]);
        asked = turned.iter().flat_map(near).collect();
        asked.sort_unstable();
        asked.dedup();
    }
    normals.iter().zip(&before).filter(|(a, b)| a != b).count()
}
