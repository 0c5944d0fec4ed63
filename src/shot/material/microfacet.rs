//! Rough mirrors: facets whose slopes follow the distribution of Trowbridge and Reitz (GGX; Walter et al., "Microfacet
//! Models for Refraction through Rough Surfaces", 2007), with the shadowing of Smith for both directions together (Heitz,
//! "Understanding the Masking-Shadowing Function", 2014).
//!
//! What facets send to other facets is lost to one reflection; how much is measured once for each roughness, so that it
//! can be given back ([`Albedo`]).

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// Facets of one roughness, above zero.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Facets {
    /// The slope that they typically have.
    alpha: f64,
}

impl Facets {
    /// Facets for a roughness from 0 to 1, of which the slope is the square, as is usual; `None` for a mirror.
    pub fn new(roughness: f64) -> Option<Facets> {
        (0.0 < roughness).then_some(Facets { alpha: roughness * roughness })
    }

    /// Smith's Lambda: facets hidden for each one seen.
    fn hidden(&self, dir: DVec3) -> f64 {
        let tan2 = (dir.x * dir.x + dir.y * dir.y) / (dir.z * dir.z);
        0.5 * ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0)
    }

    /// The share of area whose facets have this normal, a steradian.
    fn share(&self, half: DVec3) -> f64 {
        let a2 = self.alpha * self.alpha;
        // (h.z^2 (a^2 - 1) + 1) without the cancellation near the axis.
        let spread = a2 * half.z * half.z + half.x * half.x + half.y * half.y;
        a2 / (PI * spread * spread)
    }

    /// The normal of a facet that is seen from a direction, each by the area it shows (Dupuy and Benyoub, "Sampling Visible
    /// GGX Normals with Spherical Caps", 2023).
    pub fn facing(&self, eye: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        let a = self.alpha;
        let stretched = DVec3::new(a * eye.x, a * eye.y, eye.z).normalize();
        let z = (1.0 - v) * (1.0 + stretched.z) - stretched.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = (TAU * u).sin_cos();
        let half = DVec3::new(radius * cos, radius * sin, z) + stretched;
        DVec3::new(a * half.x, a * half.y, half.z.max(0.0)).normalize_or(DVec3::Z)
    }

    /// How many of the facets that are seen from one direction are seen from another as well, both above the surface.
    pub fn unhidden(&self, eye: DVec3, light: DVec3) -> f64 {
        (1.0 + self.hidden(eye)) / (1.0 + self.hidden(eye) + self.hidden(light))
    }

    /// The same where light goes through: the directions lie on two sides, and hide independently.
    pub fn unhidden_through(&self, light: DVec3) -> f64 {
        1.0 / (1.0 + self.hidden(light))
    }

    /// The share of light that a white facet mirror sends from one direction to the other, a steradian, times the cosine, and
    /// the density of directions that [`Facets::facing`] leads to by reflection.
    pub fn mirrored(&self, eye: DVec3, light: DVec3) -> (f64, f64) {
        let half = (eye + light).normalize_or(DVec3::Z);
        let density = self.share(half) / (1.0 + self.hidden(eye)) / (4.0 * eye.z);
        (density * self.unhidden(eye, light), density)
    }
}

/// The direction that a mirror with a normal reflects to.
pub fn reflected(eye: DVec3, half: DVec3) -> DVec3 {
    2.0 * eye.dot(half) * half - eye
}

/// How much of the light from all around a mirror of facets sends to the eye, by the cosine under which that looks.
#[derive(Clone, PartialEq, Debug)]
pub struct Albedo {
    /// At roots of cosines from 0 to 1, evenly: the share changes fastest near the horizon.
    by_root: Vec<f64>,
    /// Over all cosines, each by its area.
    pub mean: f64,
}

impl Albedo {
    /// How many cosines are measured; between them the share is a straight line.
    const STEPS: usize = 64;
    /// The root of the number of facets that each takes. With these numbers shares are off by up to 4e-4.
    const SIDE: usize = 48;

    /// Measures facets that reflect a share of light by its angle to them (its cosine is given).
    pub fn new(facets: Facets, reflects: impl Fn(f64) -> f64) -> Albedo {
        Albedo::measured(facets, [Self::STEPS, Self::SIDE], |eye, half| {
            let light = reflected(eye, half);
            if light.z <= 0.0 { 0.0 } else { reflects(eye.dot(half)) * facets.unhidden(eye, light) }
        })
    }

    /// Measures what each facet sends on, by the direction to the eye and the facet's normal, at so many cosines and, squared,
    /// facets.
    pub fn measured(
        facets: Facets,
        [steps, side]: [usize; 2],
        sends: impl Fn(DVec3, DVec3) -> f64,
    ) -> Albedo {
        let at = |i: usize| {
            // At the horizon itself no facet is seen; the limit is taken from beside it.
            let z = ((i as f64).max(0.125) / steps as f64).powi(2);
            let eye = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            let place = |k: usize| (k as f64 + 0.5) / side as f64;
            let one = |k: usize| {
                // Steep facets, the last of the second number, matter most and are few: they are taken more densely.
                let rest = 1.0 - place(k % side);
                let half = facets.facing(eye, [place(k / side), 1.0 - rest * rest]);
                2.0 * rest * sends(eye, half)
            };
            (0..side * side).map(one).sum::<f64>() / (side * side) as f64
        };
        Albedo::of((0..=steps).map(at).collect())
    }

    /// Of a mirror without facets.
    pub fn smooth(reflects: impl Fn(f64) -> f64) -> Albedo {
        Albedo::of((0..=Self::STEPS).map(|i| reflects((i as f64 / Self::STEPS as f64).powi(2))).collect())
    }

    fn of(by_root: Vec<f64>) -> Albedo {
        // The integral over the cosine z = s^2 of a share a + b s times 2 z: of (a + b s) 4 s^3 over the root s.
        let step = 1.0 / (by_root.len() - 1) as f64;
        let piece = |(i, pair): (usize, &[f64])| {
            let (lo, hi) = (i as f64 * step, (i + 1) as f64 * step);
            let b = (pair[1] - pair[0]) / step;
            let a = pair[0] - b * lo;
            let whole = |s: f64| a * s.powi(4) + 0.8 * b * s.powi(5);
            whole(hi) - whole(lo)
        };
        let mean = by_root.windows(2).enumerate().map(piece).sum();
        Albedo { by_root, mean }
    }

    /// The share at a cosine from 0 to 1.
    pub fn at(&self, cosine: f64) -> f64 {
        let place = cosine.clamp(0.0, 1.0).sqrt() * (self.by_root.len() - 1) as f64;
        let i = (place as usize).min(self.by_root.len() - 2);
        let share = place - i as f64;
        (1.0 - share) * self.by_root[i] + share * self.by_root[i + 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A direction at a cosine, turned.
    fn at(z: f64, turn: f64) -> DVec3 {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    }

    #[test]
    fn facets_seen_from_anywhere_show_the_area_that_the_surface_shows() {
        // The integral of D(h) (h . eye)+ / (1 + Lambda) over the sphere is eye.z: midpoints in angle, no code shared with
        // the sampling.
        for roughness in [0.3, 0.6, 1.0] {
            let facets = Facets::new(roughness).unwrap();
            for z in [0.1, 0.5, 0.9] {
                let eye = at(z, 0.0);
                let (n, mut sum) = (400, 0.0);
                for i in 0..n {
                    for j in 0..n {
                        let theta = (i as f64 + 0.5) / n as f64 * 0.5 * PI;
                        let half = at(theta.cos(), (j as f64 + 0.5) / n as f64 * TAU);
                        sum += facets.share(half) * half.dot(eye).max(0.0) * theta.sin();
                    }
                }
                let area = sum * 0.5 * PI / n as f64 * TAU / n as f64 / (1.0 + facets.hidden(eye));
                assert!((area / z - 1.0).abs() < 2e-3, "{roughness} {z}: {area}");
            }
        }
    }

    #[test]
    fn chosen_facets_have_the_density_that_is_stated() {
        let facets = Facets::new(0.7).unwrap();
        let eye = at(0.4, 0.3);
        // Means over chosen directions against integrals of the stated density over a grid, of what a light would send.
        let light = |dir: DVec3| if dir.z > 0.0 { dir.z * (1.0 + dir.x) } else { 0.0 };
        let n = 300;
        let place = |k: usize| (k as f64 + 0.5) / n as f64;
        let (mut chosen, mut stated) = (0.0, 0.0);
        for i in 0..n {
            for j in 0..n {
                let half = facets.facing(eye, [place(i), place(j)]);
                chosen += light(reflected(eye, half));
                let dir = at(place(i), place(j) * TAU);
                stated += light(dir) * facets.mirrored(eye, dir).1 * TAU;
            }
        }
        assert!((chosen / stated - 1.0).abs() < 2e-3, "{chosen} {stated}");
    }

    #[test]
    fn smooth_facets_lose_nothing_and_rough_ones_lose_much() {
        let albedo = |roughness| Albedo::new(Facets::new(roughness).unwrap(), |_| 1.0);
        assert!(0.999 < albedo(0.1).mean);
        // Heitz et al. 2016, figure 1: rough conductors lose up to 60 % at a roughness of one; at the normal 55 % is left.
        assert!((0.35..0.65).contains(&albedo(1.0).mean), "{}", albedo(1.0).mean);
        let mean = Albedo::smooth(|z| z).mean;
        assert!((mean - 2.0 / 3.0).abs() < 1e-3, "{mean}");
    }
}
