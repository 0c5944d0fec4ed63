//! Rough faces between clear media: facets that reflect and refract.
//!
//! One turn off a facet loses what facets hide from each other. So that white glass stays white, what is left is scaled by the
//! share that one turn keeps at that cosine (Turquin, "Practical multiple scattering compensation for microfacet models", 2019):
//! no light is lost, and what turned several times among facets is taken to go where single turns go.

use std::sync::OnceLock;

use glam::DVec3;

use super::glass::{Turn, fresnel, refracted};
use super::microfacet::{Albedo, Facets, reflected};

/// The largest index over another that tables are made for; beyond, those of the end are taken.
const WIDEST: f64 = 4.0;

/// Tables between one over the largest ratio and the largest, evenly in its logarithm.
const RATIOS: usize = 25;

/// Cosines and facets, squared, of the tables of a glass against empty space, and of those between that serve nested bodies.
/// With these numbers shares are off by up to 1e-3 and 5e-3.
const FINE: [usize; 2] = [64, 48];
const COARSE: [usize; 2] = [32, 24];

/// The facets of a glass, and what one turn off them keeps.
#[derive(Debug)]
pub struct RoughFace {
    facets: Facets,
    ior: f64,
    /// Seen from empty space, and from inside.
    own: [Albedo; 2],
    /// By ratio; made when first asked for.
    others: OnceLock<Vec<Albedo>>,
}

impl RoughFace {
    /// Facets of a glass with an index of refraction.
    pub fn new(facets: Facets, ior: f64) -> RoughFace {
        let own = [1.0 / ior, ior].map(|ratio| kept(facets, ratio, FINE));
        RoughFace { facets, ior, own, others: OnceLock::new() }
    }

    /// Chooses where light that is seen came from ([`super::glass::Glass::turn`]).
    pub fn turn(&self, ratio: f64, eye: DVec3, place: [f64; 2], lobe: f64) -> Option<Turn> {
        let turn = once(self.facets, ratio, eye, self.facets.facing(eye, place), lobe)?;
        Some(Turn { weight: turn.weight / self.kept(ratio, eye.z), ..turn })
    }

    /// The share of light that one turn keeps, `ratio` being the index on the eye's side over that beyond.
    fn kept(&self, ratio: f64, cosine: f64) -> f64 {
        if ratio == self.ior {
            return self.own[1].at(cosine);
        }
        if ratio == 1.0 / self.ior {
            return self.own[0].at(cosine);
        }
        let others = self.others.get_or_init(|| {
            let ratio = |i: usize| WIDEST.powf(2.0 * i as f64 / (RATIOS - 1) as f64 - 1.0);
            (0..RATIOS).map(|i| kept(self.facets, ratio(i), COARSE)).collect()
        });
        let place = 0.5 * (ratio.ln() / WIDEST.ln() + 1.0).clamp(0.0, 2.0) * (RATIOS - 1) as f64;
        let i = (place as usize).min(RATIOS - 2);
        let share = place - i as f64;
        (1.0 - share) * others[i].at(cosine) + share * others[i + 1].at(cosine)
    }
}

/// One turn off a facet.
fn once(facets: Facets, ratio: f64, eye: DVec3, half: DVec3, lobe: f64) -> Option<Turn> {
    if lobe < fresnel(eye.dot(half), ratio) {
        let dir = reflected(eye, half);
        return (0.0 < dir.z).then(|| Turn { dir, weight: facets.unhidden(eye, dir), through: false });
    }
    let dir = refracted(eye, half, ratio)?;
    (dir.z < 0.0).then(|| Turn { dir, weight: facets.unhidden_through(dir), through: true })
}

/// What one turn keeps: the mean over facets of both ways, each by its share.
fn kept(facets: Facets, ratio: f64, fineness: [usize; 2]) -> Albedo {
    Albedo::measured(facets, fineness, |eye, half| {
        let reflects = fresnel(eye.dot(half), ratio);
        let weight = |lobe| once(facets, ratio, eye, half, lobe).map_or(0.0, |turn| turn.weight);
        // Below all shares the light is reflected, at one it goes through.
        let back = if 0.0 < reflects { reflects * weight(-1.0) } else { 0.0 };
        if reflects < 1.0 { back + (1.0 - reflects) * weight(1.0) } else { back }
    })
}
