//! Cameras: which ray belongs to a place in the picture. What the ray meets is left to [`super::World`].

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::geom::{Aabb, Beam, Ray, tolerance};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The `camera` item.
pub const DECL: Decl = Decl {
    word: "camera",
    group: Group::Camera,
    doc: "Where the picture is seen from.",
    params: &[
        Param::required("eye", Kind::Vector(3), "where the eye is"),
        Param::required("look_at", Kind::Vector(3), "the point in the middle of the picture"),
        Param::named("up", Kind::Vector(3), "what is up in the picture; default [0, 0, 1]"),
        Param::named("fov", Kind::Angle, "the vertical angle of view of a perspective; default 40deg"),
        Param::named("height", Kind::Size, "what an orthographic picture measures from bottom to top"),
        Param::named(
            "kind",
            Kind::Choice(&["perspective", "orthographic", "spherical"]),
            "the projection; with `height` alone it is orthographic",
        ),
        Param::named(
            "aperture",
            Kind::Size,
            "the diameter of the lens: what is not in focus is blurred; default 0",
        ),
        Param::named(
            "focus",
            Kind::Length,
            "how far from the eye, along the view, things are in focus; default at `look_at`",
        ),
    ],
    example: "camera(eye: [10, -20, 10], look_at: [0, 0, 0], fov: 30deg)",
};

/// The vertical angle of view where none is given, radians: between a normal and a portrait lens.
const DEFAULT_FOV: f64 = 40.0 * PI / 180.0;

/// The angle of view of a fitted camera, radians: a portrait lens, so that boxes look little distorted.
const FITTED_FOV: f64 = 30.0 * PI / 180.0;

/// How much farther than necessary a fitted camera stands: what leaves a margin of about a twentieth.
const FITTED_MARGIN: f64 = 1.1;

/// Where a fitted camera stands, seen from the middle of what is drawn: to the right, in front, above.
const FITTED_SIDE: DVec3 = DVec3::new(0.5, -0.75, 0.45);

/// A camera: a point and an orthonormal frame, and how they make rays. Pixels are square.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    /// Where the eye is; of an orthographic camera the middle of the plane that rays start from.
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    lens: Lens,
    opening: Option<Opening>,
}

/// The opening of a thin lens: a disc about the eye, across the view.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Opening {
    /// World length, above zero.
    radius: f64,
    /// How far ahead of the eye the plane lies in which all rays of a place meet, world length, above zero.
    focus: f64,
}

/// How places in the picture become rays.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Lens {
    /// Half the height of the picture at distance 1.
    Perspective { half_height: f64 },
    /// Half the shorter side of the picture at distance 1.
    Fitted { half_side: f64 },
    /// Half the height of the picture, world length.
    Orthographic { half_height: f64 },
    /// Longitude across, latitude down: all directions in one picture.
    Spherical,
}

/// Builds the camera of a `camera` item.
pub fn build(call: &Call) -> Result<Camera, BuildError> {
    let eye = call.vec3("eye").ok_or_else(|| error("eye", "`eye` is missing", "eye: [x, y, z]"))?;
    let look_at =
        call.vec3("look_at").ok_or_else(|| error("look_at", "`look_at` is missing", "look_at: [x, y, z]"))?;
    let lens = lens(call)?;
    let up = call.vec3("up").unwrap_or(DVec3::Z);
    let opening = opening(call, lens, eye.distance(look_at))?;
    Ok(Camera { opening, ..Camera::new(eye, look_at, up, lens)? })
}

fn opening(call: &Call, lens: Lens, usual: f64) -> Result<Option<Opening>, BuildError> {
    let diameter = call.number("aperture").unwrap_or(0.0);
    let focus = call.number("focus");
    if let Some(focus) = focus.filter(|f| !(f.is_finite() && 0.0 < *f)) {
        let help = "what is in focus lies ahead of the eye";
        return Err(error("focus", format!("`focus` is {focus}"), help));
    }
    if focus.is_some() && call.get("aperture").is_none() {
        return Err(error("focus", "without `aperture:` everything is in focus", "aperture: 5"));
    }
    if lens == Lens::Spherical && call.get("aperture").is_some() {
        return Err(error("aperture", "a spherical camera has no lens", "leave `aperture:` out"));
    }
    let opening = Opening { radius: 0.5 * diameter, focus: focus.unwrap_or(usual) };
    Ok((0.0 < opening.radius).then_some(opening))
}

fn error(param: &'static str, message: impl Into<String>, help: impl Into<String>) -> BuildError {
    BuildError { param, message: message.into(), help: help.into() }
}

fn lens(call: &Call) -> Result<Lens, BuildError> {
    let (fov, height) = (call.angle("fov"), call.number("height"));
    let alone = if height.is_some() && fov.is_none() { "orthographic" } else { "perspective" };
    let kind = call.text("kind").unwrap_or(alone);
    if height.is_some() && kind != "orthographic" {
        let help = "say `kind: \"orthographic\"`, or give a perspective `fov:`";
        return Err(error("height", format!("a {kind} camera has no `height`"), help));
    }
    if fov.is_some() && kind != "perspective" {
        let help = "an orthographic camera has a `height:`, a spherical one sees all around";
        return Err(error("fov", format!("a camera of kind \"{kind}\" has no `fov`"), help));
    }
    match kind {
        "spherical" => Ok(Lens::Spherical),
        "orthographic" => match height {
            Some(h) if h.is_finite() && 0.0 < h => Ok(Lens::Orthographic { half_height: 0.5 * h }),
            Some(_) => Err(error("height", "`height` must be above zero", "give the height of the view")),
            None => Err(error("", "an orthographic camera needs `height`", "height: 100")),
        },
        _ => {
            let fov = fov.unwrap_or(DEFAULT_FOV);
            if !(0.0 < fov && fov < PI) {
                let help = "the angle of view lies between 0deg and 180deg, both left out";
                return Err(error("fov", format!("`fov` is {}deg", fov.to_degrees()), help));
            }
            Ok(Lens::Perspective { half_height: (0.5 * fov).tan() })
        }
    }
}

impl Camera {
    fn new(eye: DVec3, look_at: DVec3, up: DVec3, lens: Lens) -> Result<Camera, BuildError> {
        let forward = (look_at - eye).normalize_or_zero();
        if forward == DVec3::ZERO {
            return Err(error("look_at", "`look_at` is where `eye` is", "move one of them"));
        }
        let up = up.normalize_or_zero();
        if up == DVec3::ZERO {
            return Err(error("up", "`up` has no direction", "up: [0, 0, 1]"));
        }
        let right = forward.cross(up);
        if right.length() <= tolerance::cleanup(1.0) {
            let help = "with a view straight up or down say what is up: `up: [0, 1, 0]`";
            return Err(error("up", "`up` is parallel to the view", help));
        }
        let right = right.normalize();
        Ok(Camera { eye, right, up: right.cross(forward), forward, lens, opening: None })
    }

    /// A three-quarter view that holds a box whatever the shape of the picture; of an empty or unbounded box,
    /// or a point, the view of a unit cube there.
    pub fn fit(bounds: Aabb) -> Camera {
        let usable = !bounds.is_empty() && bounds.is_finite();
        let center = if usable { bounds.center() } else { DVec3::ZERO };
        let sized = usable && 0.0 < bounds.diagonal();
        let bounds = if sized { bounds } else { Aabb::of_points([center]).inflated(0.5) };
        let toward = FITTED_SIDE.normalize();
        let right = DVec3::Z.cross(toward).normalize();
        let up = toward.cross(right);
        let half_side = (0.5 * FITTED_FOV).tan();
        // A corner is seen where its offset from the axis is at most `half_side` times its depth.
        let distance = bounds
            .corners()
            .map(|c| c - center)
            .map(|c| c.dot(toward) + c.dot(up).abs().max(c.dot(right).abs()) / half_side)
            .into_iter()
            .fold(0.0, f64::max);
        let eye = center + FITTED_MARGIN * distance * toward;
        Camera { eye, right, up, forward: -toward, lens: Lens::Fitted { half_side }, opening: None }
    }

    /// The ray through a place of a picture of `size` pixels. Places are continuous and start at the top left:
    /// the centre of pixel (i, j) is (i + 0.5, j + 0.5). The ray starts at the eye (of an orthographic
    /// camera: beside it, in its plane); its direction is not of unit length.
    #[inline]
    pub fn ray(&self, x: f64, y: f64, size: [u32; 2]) -> Ray {
        let (w, h) = (f64::from(size[0]), f64::from(size[1]));
        let offset = |unit: f64, side: f64| {
            let per_pixel = 2.0 * unit / side;
            per_pixel * (x - 0.5 * w) * self.right + per_pixel * (0.5 * h - y) * self.up
        };
        match self.lens {
            Lens::Perspective { half_height } => Ray::new(self.eye, self.forward + offset(half_height, h)),
            Lens::Fitted { half_side } => Ray::new(self.eye, self.forward + offset(half_side, h.min(w))),
            Lens::Orthographic { half_height } => Ray::new(self.eye + offset(half_height, h), self.forward),
            Lens::Spherical => {
                let (sin_long, cos_long) = (TAU * (x / w - 0.5)).sin_cos();
                let (sin_lat, cos_lat) = (PI * (0.5 - y / h)).sin_cos();
                let level = cos_long * self.forward + sin_long * self.right;
                Ray::new(self.eye, cos_lat * level + sin_lat * self.up)
            }
        }
    }

    /// The same through another place of the lens than its middle: `on_lens` are two numbers in [0, 1), spread evenly over its disc.
    /// Where the lens has no opening that is [`Camera::ray`].
    pub fn ray_through(&self, x: f64, y: f64, size: [u32; 2], on_lens: impl FnOnce() -> [f64; 2]) -> Ray {
        let ray = self.ray(x, y, size);
        let Some(Opening { radius, focus }) = self.opening else { return ray };
        let [u, v] = on_lens();
        let (sin, cos) = (TAU * v).sin_cos();
        let aside = radius * u.sqrt() * (cos * self.right + sin * self.up);
        // The direction reaches a length of one along the view: the focus is met at t = focus.
        Ray::new(ray.origin + aside, ray.dir - aside / focus)
    }

    /// All rays through a patch of the picture, given two corners of it; `None` where they are not means of those through
    /// the corners, or start from a lens.
    pub fn beam(&self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], size: [u32; 2]) -> Option<Beam> {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| self.ray(x, y, size));
        let straight =
            self.lens != Lens::Spherical && self.opening.is_none() && corners.iter().all(Ray::is_valid);
        straight.then(|| Beam::around(&corners))
    }

    /// Where the eye is.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }
}
