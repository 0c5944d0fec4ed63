//! Materials: a file and one line of a table for each. How light finds its way between surfaces is left to the integrator.

mod emissive;
pub mod finish;
pub mod glass;
mod matte;
mod metal;
pub mod microfacet;
pub mod paint;
mod plastic;
pub mod rough_face;

use std::sync::{Arc, LazyLock};

use glam::DVec3;

use crate::scene::{BuildError, Call, Decl};
pub use finish::Finish;
pub use matte::{Matte, even_share, lifted};
pub use metal::Metal;
pub use paint::Paint;
pub use plastic::Plastic;

/// What a surface does with light.
#[derive(Clone, Debug)]
pub struct Material {
    /// The share of light it sends on, linear, or that is left on the way through it.
    pub paint: Paint,
    /// How it sends light on.
    pub finish: Arc<dyn Finish>,
}

/// `#cccccc` decoded: light enough to show shading, dark enough not to clip.
const DEFAULT_COLOR: [f32; 3] = [0.603_827_4; 3];

impl Default for Material {
    fn default() -> Material {
        Material::matte(DEFAULT_COLOR)
    }
}

impl Material {
    /// One colour all over.
    pub fn new(color: [f32; 3], finish: impl Finish + 'static) -> Material {
        Material { paint: Paint::Plain(color), finish: Arc::new(finish) }
    }

    /// With the colour, or the pattern, of a call.
    fn painted(call: &Call, finish: impl Finish + 'static) -> Result<Material, BuildError> {
        Ok(Material { paint: Paint::build(call)?, finish: Arc::new(finish) })
    }

    /// Sends light on evenly to all sides.
    pub fn matte(color: [f32; 3]) -> Material {
        Material::new(color, Matte)
    }

    /// That of an index that a surface carries; beyond the end, that of surfaces that have none.
    pub fn of(list: &[Material], index: u32) -> &Material {
        static BARE: LazyLock<Material> = LazyLock::new(Material::default);
        list.get(index as usize).unwrap_or(&BARE)
    }

    /// Whether it asks what colour the surface itself has.
    pub fn reads_color(&self) -> bool {
        matches!(self.paint, Paint::Own { .. })
    }

    /// The share of light it sends on at a point of the scene, linear; `own` is the colour that what is there has itself.
    pub fn albedo(&self, point: DVec3, own: Option<[f32; 3]>) -> [f32; 3] {
        self.paint.at(point, own)
    }

    /// Whether light goes through.
    pub fn is_clear(&self) -> bool {
        self.finish.glass().is_some()
    }
}

/// A kind of material.
struct Make {
    decl: Decl,
    build: fn(&Call) -> Result<Material, BuildError>,
}

/// All kinds of material; a new one is its file and its line here.
const TABLE: &[Make] = &[matte::MAKE, plastic::MAKE, metal::MAKE, glass::MAKE, emissive::MAKE, matte::POINTS];

/// The declarations of all materials.
pub fn decls() -> impl Iterator<Item = Decl> {
    TABLE.iter().map(|make| make.decl)
}

/// Builds the material of a call.
pub fn build(call: &Call) -> Result<Material, BuildError> {
    let make = TABLE.iter().find(|make| make.decl.word == call.word).ok_or_else(|| BuildError {
        param: "",
        message: format!("there is no material `{}`", call.word),
        help: format!("one of: {}", decls().map(|d| d.word).collect::<Vec<_>>().join(", ")),
    })?;
    (make.build)(call)
}

fn color(call: &Call, name: &'static str, otherwise: [f32; 3]) -> Result<[f32; 3], BuildError> {
    let color = call.color(name).unwrap_or(otherwise);
    if color.iter().all(|c| c.is_finite() && 0.0 <= *c) {
        return Ok(color);
    }
    Err(BuildError {
        param: name,
        message: format!("`{name}` has a negative part"),
        help: "a surface cannot send on less than nothing".to_owned(),
    })
}

fn number(call: &Call, name: &'static str, otherwise: f64) -> Result<f64, BuildError> {
    let x = call.number(name).unwrap_or(otherwise);
    let error = || BuildError {
        param: name,
        message: format!("`{name}` is not a finite number"),
        help: format!("the default is {otherwise}"),
    };
    x.is_finite().then_some(x).ok_or_else(error)
}

fn positive(call: &Call, name: &'static str, otherwise: f64) -> Result<f64, BuildError> {
    let x = number(call, name, otherwise)?;
    let error = || BuildError {
        param: name,
        message: format!("`{name}` must be above zero"),
        help: format!("the default is {otherwise}"),
    };
    (0.0 < x).then_some(x).ok_or_else(error)
}

fn roughness(call: &Call, otherwise: f64) -> Result<f64, BuildError> {
    let x = number(call, "roughness", otherwise)?;
    let error = || BuildError {
        param: "roughness",
        message: format!("`roughness` is {x}"),
        help: "it reaches from 0, polished, to 1".to_owned(),
    };
    (0.0..=1.0).contains(&x).then_some(x).ok_or_else(error)
}
