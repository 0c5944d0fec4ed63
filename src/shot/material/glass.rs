//! Glass and liquids: bodies that light goes through, bent at their faces and coloured on its way.
//!
//! Which body is on which side of a face is not its business: intervals tell ([`crate::shot::clear`]).

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::finish::{Finish, Toward};
use super::microfacet::{Facets, reflected};
use super::rough_face::{RoughFace, one_turn};
use super::{Make, Material, color, number, positive, roughness};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// Something clear.
#[derive(Clone, Debug)]
pub struct Glass {
    /// Of refraction, against that of empty space.
    pub ior: f64,
    /// What is left of white light after [`Glass::depth`].
    pub color: Vec3,
    /// Scene units.
    pub depth: f64,
    /// Of bodies that overlap, the one with the larger fills what they share.
    pub priority: f64,
    /// Its faces; `None` for polished ones.
    pub rough: Option<Arc<RoughFace>>,
}

/// What becomes of light at a face.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Turn {
    /// To where it comes from, in the frame of the face.
    pub dir: DVec3,
    /// What it is multiplied with.
    pub weight: f64,
    /// Whether it went through the face.
    pub through: bool,
}

/// The share of unpolarised light that a face between two clear media reflects (Fresnel): `cosine` is that of the direction it
/// is seen from, `ratio` the index there over the index beyond. One where nothing goes through.
pub fn fresnel(cosine: f64, ratio: f64) -> f64 {
    if ratio == 1.0 {
        return 0.0;
    }
    let c = cosine.clamp(0.0, 1.0);
    let sin2 = ratio * ratio * (1.0 - c * c);
    if 1.0 <= sin2 {
        return 1.0;
    }
    let t = (1.0 - sin2).sqrt();
    let across = (ratio * c - t) / (ratio * c + t);
    let along = (c - ratio * t) / (c + ratio * t);
    0.5 * (across * across + along * along)
}

/// The direction beyond a face of light that is seen from `eye`, by the normal on the eye's side (Snell); `None` where nothing
/// goes through. Unit vectors that point away from the face.
pub fn refracted(eye: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let c = eye.dot(normal);
    let left = 1.0 - ratio * ratio * (1.0 - c * c);
    (0.0 < left).then(|| ((ratio * c - left.sqrt()) * normal - ratio * eye).normalize())
}

impl Glass {
    /// What is left of light after a way through it, scene units.
    pub fn left(&self, way: f64) -> Vec3 {
        let share = (way / self.depth) as f32;
        Vec3::from_array(self.color.to_array().map(|c| if c == 1.0 { 1.0 } else { c.powf(share) }))
    }

    /// Chooses whether light that is seen at a face was reflected or went through, and from where it came; `ratio` is the index
    /// on the eye's side over that beyond. Radiance grows by the square of the index where it enters a denser medium; that is
    /// left to the caller.
    pub fn turn(&self, ratio: f64, eye: DVec3, place: [f64; 2], lobe: f64) -> Option<Turn> {
        if let Some(rough) = &self.rough {
            return rough.turn(ratio, eye, place, lobe);
        }
        one_turn(None, ratio, eye, DVec3::Z, lobe)
    }
}

/// A pane without thickness: what a sheet of glass is. Of the light that goes in, the part that is reflected to and fro comes
/// out on both sides, 2 R / (1 + R) in all on this one.
impl Finish for Glass {
    fn toward(&self, _: Vec3, eye: DVec3, _: [f64; 2], lobe: f64) -> Option<Toward> {
        let once = fresnel(eye.z, 1.0 / self.ior);
        let back = 2.0 * once / (1.0 + once);
        let sharp = |dir, weight| Some(Toward { dir, weight, even: false, sharp: true });
        if lobe < back { sharp(reflected(eye, DVec3::Z), Vec3::ONE) } else { sharp(-eye, self.color) }
    }

    fn glass(&self) -> Option<&Glass> {
        Some(self)
    }
}

pub(super) const MAKE: Make = Make {
    decl: Decl {
        word: "glass",
        group: Group::Material,
        doc: "Clear, as glass, water or amber: bends light and shows what is in it and behind it, with `integrator: \"path\"` or \"direct\".",
        params: &[
            Param::placed(
                "color",
                Kind::Color,
                "of white light, what is left after `depth`; default #ffffff",
            ),
            Param::named("ior", Kind::Positive, "its index of refraction; default 1.5"),
            Param::named(
                "depth",
                Kind::Width,
                "the way through it after which light has its colour; default 1 scene unit",
            ),
            Param::named("roughness", Kind::Number, "0 (polished, the default) to 1"),
            Param::named(
                "priority",
                Kind::Number,
                "where bodies overlap the larger one fills what they share, of equals the later material; default 0",
            ),
        ],
        example: "glass(#e0f0e8, ior: 1.5, depth: 2)",
    },
    build,
};

fn build(call: &Call) -> Result<Material, BuildError> {
    let tint = color(call, "color", [1.0; 3])?;
    if tint.iter().any(|c| 1.0 < *c) {
        return Err(BuildError {
            param: "color",
            message: "`color` of glass is brighter than white".to_owned(),
            help: "light that goes through it would grow on its way".to_owned(),
        });
    }
    let ior = positive(call, "ior", 1.5)?;
    let glass = Glass {
        ior,
        color: Vec3::from_array(tint),
        depth: positive(call, "depth", 1.0)?,
        priority: number(call, "priority", 0.0)?,
        rough: Facets::new(roughness(call, 0.0)?).map(|facets| Arc::new(RoughFace::new(facets, ior))),
    };
    Ok(Material::new(tint, glass))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_reflect_what_fresnel_says() {
        // ((n - 1) / (n + 1))^2 = 0.04 at right angles, nothing of what lies in the plane at Brewster's angle, all beyond the
        // critical one.
        assert!((fresnel(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-15);
        let brewster = 1.5_f64.atan().cos();
        let across = (1.5_f64.powi(2) - 1.0) / (1.5_f64.powi(2) + 1.0);
        assert!((fresnel(brewster, 1.0 / 1.5) - 0.5 * across * across).abs() < 1e-15);
        assert_eq!(fresnel((1.0_f64 / 1.5).asin().cos() - 0.01, 1.5), 1.0);
        assert_eq!(fresnel(0.3, 1.0), 0.0);
    }

    #[test]
    fn bent_light_follows_snell_and_turns_back() {
        let eye = DVec3::new(0.6, 0.0, 0.8);
        let inside = refracted(eye, DVec3::Z, 1.0 / 1.5).unwrap();
        assert!((inside.x + 0.4).abs() < 1e-15 && inside.z < 0.0);
        let back = refracted(inside, -DVec3::Z, 1.5).unwrap();
        assert!((back - eye).length() < 1e-15, "{back}");
        // Past the critical angle, sine 2 / 3 from the denser side, nothing goes through.
        assert_eq!(refracted(DVec3::new(0.8, 0.0, 0.6), DVec3::Z, 1.5), None);
    }
}
