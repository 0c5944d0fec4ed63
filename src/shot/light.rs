//! Lights: what they send to a point. Whether anything is in the way is left to the integrator.
//!
//! Radiances are scaled so that a matte surface of colour c that faces a sun or a point light, or lies under a
//! sky alone, has radiance c x colour x intensity.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;

use super::Environment;

use crate::geom::tolerance;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The `light` item.
pub const DECL: Decl = Decl {
    word: "light",
    group: Group::Light,
    doc: "A sun (`direction`), a point light (`at`), an area light (`at`, `size` and `look_at`) or, by `color` or `image` alone, a sky. Only a sky is seen straight; a soft sun and an area light are seen in mirrors and through what bends light.",
    params: &[
        Param::named("direction", Kind::Vector(3), "a sun: the way its light travels"),
        Param::named("softness", Kind::Angle, "the sun's full angular diameter; default 0deg"),
        Param::named("at", Kind::Vector(3), "a point light: where it is"),
        Param::named(
            "size",
            Kind::Vector(2),
            "an area light: width and height of a rectangle in the middle of which `at` is; its light is that of a point light, so a larger one is dimmer to look at",
        ),
        Param::named("look_at", Kind::Vector(3), "the point that an area light faces; behind it is no light"),
        Param::named("falloff", Kind::Bool, "whether a point light fades with distance; default true"),
        Param::named(
            "image",
            Kind::Path,
            "a sky: an EXR, HDR or PNG of all directions, what a spherical camera sees that looks along +y",
        ),
        Param::named("color", Kind::Color, "its colour; default white"),
        Param::named("intensity", Kind::Number, "a factor of the colour; default 1"),
    ],
    example: "light sun(direction: [-1, 2, -3], intensity: 3, softness: 2deg)",
};

/// A light. `color` is linear and holds the intensity: what a white matte surface that gets all of it shows.
#[derive(Clone, PartialEq, Debug)]
pub enum Light {
    /// Light from far away.
    Sun {
        /// Unit vector from a surface to the middle of the sun.
        toward: DVec3,
        /// Half the sun's angular diameter, radians, at most a quarter turn.
        half_angle: f64,
        /// Colour times intensity.
        color: [f32; 3],
    },
    /// Light from a point.
    Point {
        /// Where.
        at: DVec3,
        /// Whether it fades with the square of the distance, 1 at one scene unit.
        falloff: bool,
        /// Colour times intensity.
        color: [f32; 3],
    },
    /// Light from one side of a rectangle; from afar as bright as a point light of its colour, along its axis.
    Area {
        /// The middle.
        at: DVec3,
        /// Half the sides, vectors.
        half: [DVec3; 2],
        /// Unit vector across it, to where it shines.
        facing: DVec3,
        /// Colour times intensity.
        color: [f32; 3],
    },
    /// Light from all around.
    Sky {
        /// Radiance of every direction.
        color: [f32; 3],
    },
    /// Light from all around, by a picture.
    Image {
        /// Its radiance by direction.
        map: Arc<Environment>,
        /// Multiplies it.
        color: [f32; 3],
    },
    /// Light from the eye, without distance and without shadow: what the eye sees it reaches.
    Headlight {
        /// Colour times intensity.
        color: [f32; 3],
    },
}

/// The share of the sky where a scene has no light; the headlight is the rest, so that a surface that faces
/// the eye in the open shows its own colour.
const DEFAULT_SKY: f32 = 0.4;

/// What lights a scene that has no light: a sky and a headlight.
pub const DEFAULT: [Light; 2] =
    [Light::Sky { color: [DEFAULT_SKY; 3] }, Light::Headlight { color: [1.0 - DEFAULT_SKY; 3] }];

/// Builds the light of a `light` item; `map` is what its `image` holds.
pub fn build(call: &Call, map: Option<Arc<Environment>>) -> Result<Light, BuildError> {
    let color = radiance(call)?;
    let (direction, at) = (call.vec3("direction"), call.vec3("at"));
    if call.get("softness").is_some() && direction.is_none() {
        return Err(error("softness", "only a sun has `softness`", "give the sun a `direction:`"));
    }
    if call.get("falloff").is_some() && at.is_none() {
        return Err(error("falloff", "only a point light has `falloff`", "give the point light `at:`"));
    }
    if call.get("image").is_some() {
        return sky_of(call, color, map);
    }
    if call.get("size").is_some() || call.get("look_at").is_some() {
        return area(call, color);
    }
    match (direction, at) {
        (Some(_), Some(_)) => {
            Err(error("at", "a light has either `direction` or `at`", "make two lights of it"))
        }
        (Some(direction), None) => sun(call, direction, color),
        (None, Some(at)) => Ok(Light::Point { at, falloff: call.flag("falloff").unwrap_or(true), color }),
        (None, None) if call.get("color").is_some() => Ok(Light::Sky { color }),
        (None, None) => Err(error(
            "",
            "nothing says what light this is",
            "give `direction:` for a sun, `at:` for a point light, with `size:` and `look_at:` for an area light, or `color:` for a sky",
        )),
    }
}

/// A sky with a picture, black where that is black.
fn sky_of(call: &Call, color: [f32; 3], map: Option<Arc<Environment>>) -> Result<Light, BuildError> {
    for other in ["direction", "softness", "at", "size", "look_at", "falloff"] {
        if call.get(other).is_some() {
            let help = "a sky has `image:`, `color:` and `intensity:`";
            return Err(error(other, format!("a sky has no `{other}`"), help));
        }
    }
    Ok(map.map_or(Light::Sky { color: [0.0; 3] }, |map| Light::Image { map, color }))
}

fn area(call: &Call, color: [f32; 3]) -> Result<Light, BuildError> {
    for other in ["direction", "softness", "falloff"] {
        if call.get(other).is_some() {
            let help = "an area light has `at:`, `size:` and `look_at:`";
            return Err(error(other, format!("an area light has no `{other}`"), help));
        }
    }
    let (Some(at), Some([w, h]), Some(look_at)) = (call.vec3("at"), call.vec2("size"), call.vec3("look_at"))
    else {
        return Err(error(
            "",
            "an area light is not whole",
            "it has `at:`, `size: [width, height]` and `look_at:`",
        ));
    };
    if !(0.0 < w && 0.0 < h && w.is_finite() && h.is_finite()) {
        return Err(error(
            "size",
            "`size` must be above zero",
            "size: [2, 1]; without `size:` and `look_at:` it is a point light",
        ));
    }
    let facing = (look_at - at).normalize_or_zero();
    if facing == DVec3::ZERO {
        return Err(error("look_at", "`look_at` is where the light is", "move one of them"));
    }
    // Its width lies level; of one that faces straight up or down along x.
    let right = facing.cross(DVec3::Z);
    let right = if right.length() <= tolerance::cleanup(1.0) { DVec3::X } else { right.normalize() };
    let up = right.cross(facing).normalize();
    Ok(Light::Area { at, half: [0.5 * w * right, 0.5 * h * up], facing, color })
}

fn sun(call: &Call, direction: DVec3, color: [f32; 3]) -> Result<Light, BuildError> {
    let toward = -direction.normalize_or_zero();
    if toward == DVec3::ZERO {
        return Err(error("direction", "`direction` has no direction", "direction: [0, 0, -1]"));
    }
    let softness = call.angle("softness").unwrap_or(0.0);
    if !(0.0..=PI).contains(&softness) {
        let message = format!("`softness` is {}deg", softness.to_degrees());
        return Err(error("softness", message, "the sun's diameter lies between 0deg and 180deg"));
    }
    Ok(Light::Sun { toward, half_angle: 0.5 * softness, color })
}

fn radiance(call: &Call) -> Result<[f32; 3], BuildError> {
    let color = call.color("color").unwrap_or([1.0; 3]);
    let intensity = call.number("intensity").unwrap_or(1.0);
    if !(intensity.is_finite() && 0.0 <= intensity) {
        return Err(error("intensity", "`intensity` is negative", "a light cannot take light away"));
    }
    if !color.iter().all(|c| c.is_finite() && 0.0 <= *c) {
        return Err(error("color", "`color` has a negative part", "a light cannot take light away"));
    }
    let radiance = color.map(|c| c * intensity as f32);
    if !radiance.iter().all(|c| c.is_finite()) {
        return Err(error("intensity", "the light is too bright to count with", "make `intensity` smaller"));
    }
    Ok(radiance)
}

fn error(param: &'static str, message: impl Into<String>, help: impl Into<String>) -> BuildError {
    BuildError { param, message: message.into(), help: help.into() }
}
