//! Rough faces between clear media: facets that reflect and refract.
//!
//! One turn off a facet loses what facets hide from each other. So that white glass stays white, what is left is scaled by the
//! share that one turn keeps at that cosine (Turquin, "Practical multiple scattering compensation for microfacet models", 2019):
//! no light is lost, and what turned several times among facets is taken to go where single turns go.

use std::sync::{PoisonError, RwLock};

use glam::DVec3;

use super::glass::{Turn, fresnel, refracted};
use super::microfacet::{Albedo, Facets, reflected};

/// Cosines, and the root of the number of facets, of a table: shares are off by up to 6e-3, most near the horizon.
const FINENESS: [usize; 2] = [64, 48];

/// The facets of a glass, and what one turn off them keeps.
#[derive(Debug)]
pub struct RoughFace {
    facets: Facets,
    /// By ratio: against empty space from both sides, and against what else it touches, made when first asked for.
    known: RwLock<Vec<(f64, Albedo)>>,
}

impl RoughFace {
    /// Facets of a glass with an index of refraction.
    pub fn new(facets: Facets, ior: f64) -> RoughFace {
        let own = [1.0 / ior, ior].map(|ratio| (ratio, kept(facets, ratio, FINENESS)));
        RoughFace { facets, known: RwLock::new(own.into()) }
    }

    /// Chooses where light that is seen came from ([`super::glass::Glass::turn`]).
    pub fn turn(&self, ratio: f64, eye: DVec3, place: [f64; 2], lobe: f64) -> Option<Turn> {
        let turn = one_turn(Some(self.facets), ratio, eye, self.facets.facing(eye, place), lobe)?;
        Some(Turn { weight: turn.weight / self.kept(ratio, eye.z), ..turn })
    }

    /// The share of light that one turn keeps, `ratio` being the index on the eye's side over that beyond.
    fn kept(&self, ratio: f64, cosine: f64) -> f64 {
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, albedo)) = known.iter().find(|(of, _)| *of == ratio) {
            return albedo.at(cosine);
        }
        drop(known);
        let made = kept(self.facets, ratio, FINENESS);
        let share = made.at(cosine);
        // Two threads may make the same; either serves.
        self.known.write().unwrap_or_else(PoisonError::into_inner).push((ratio, made));
        share
    }
}

/// One turn off a facet with a normal, or off a polished face.
pub(super) fn one_turn(
    facets: Option<Facets>,
    ratio: f64,
    eye: DVec3,
    half: DVec3,
    lobe: f64,
) -> Option<Turn> {
    if lobe < fresnel(eye.dot(half), ratio) {
        let dir = reflected(eye, half);
        let weight = facets.map_or(1.0, |facets| facets.unhidden(eye, dir));
        return (0.0 < dir.z).then_some(Turn { dir, weight, through: false });
    }
    let dir = refracted(eye, half, ratio)?;
    let weight = facets.map_or(1.0, |facets| facets.unhidden_through(dir));
    (dir.z < 0.0).then_some(Turn { dir, weight, through: true })
}

/// What one turn keeps: the mean over facets of both ways, each by its share.
fn kept(facets: Facets, ratio: f64, fineness: [usize; 2]) -> Albedo {
    Albedo::measured(facets, fineness, |eye, half| {
        let reflects = fresnel(eye.dot(half), ratio);
        let weight = |lobe| one_turn(Some(facets), ratio, eye, half, lobe).map_or(0.0, |turn| turn.weight);
        // Below all shares the light is reflected, at one it goes through.
        let back = if 0.0 < reflects { reflects * weight(-1.0) } else { 0.0 };
        if reflects < 1.0 { back + (1.0 - reflects) * weight(1.0) } else { back }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_as_near_as_they_say() {
        let mut worst = 0.0_f64;
        for face in [0.2, 0.5, 1.0].into_iter().filter_map(Facets::new).map(|f| RoughFace::new(f, 1.5)) {
            for ratio in [1.5, 1.0 / 1.5, 0.9, 1.7] {
                // Twice as many cosines, four times as many facets.
                let fine = kept(face.facets, ratio, FINENESS.map(|n| 2 * n));
                for cosine in (1..100).map(|i| f64::from(i) / 100.0) {
                    worst = worst.max((face.kept(ratio, cosine) - fine.at(cosine)).abs());
                }
            }
        }
        assert!(worst < 6e-3, "{worst}");
    }
}
