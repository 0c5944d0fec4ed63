//! Materials: one line of a table for each. How light falls on them is left to the integrator.

use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// What a surface does with light.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Material {
    /// Sends light on evenly to all sides.
    Matte {
        /// The share of light sent on, linear.
        color: [f32; 3],
    },
    /// Matte, in the colours of the scan itself.
    Points {
        /// Multiplies them, linear.
        tint: [f32; 3],
    },
}

/// `#cccccc` decoded: light enough to show shading, dark enough not to clip.
const DEFAULT_COLOR: [f32; 3] = [0.603_827_4; 3];

impl Default for Material {
    fn default() -> Material {
        Material::Matte { color: DEFAULT_COLOR }
    }
}

impl Material {
    /// Whether it asks what colour the surface itself has.
    pub fn reads_color(&self) -> bool {
        matches!(self, Material::Points { .. })
    }

    /// The share of light it sends on, linear; `own` is the colour that the surface itself has, if it has one.
    pub fn albedo(&self, own: Option<[f32; 3]>) -> [f32; 3] {
        match self {
            Material::Matte { color } => *color,
            Material::Points { tint } => {
                let own = own.unwrap_or(DEFAULT_COLOR);
                std::array::from_fn(|i| own[i] * tint[i])
            }
        }
    }
}

/// A kind of material.
struct Make {
    decl: Decl,
    build: fn(&Call) -> Result<Material, BuildError>,
}

/// All kinds of material; a new one is its line here.
const TABLE: &[Make] = &[
    Make {
        decl: Decl {
            word: "matte",
            group: Group::Material,
            doc: "Equally bright from all sides, as chalk or clay.",
            params: &[Param::placed("color", Kind::Color, "its colour; default #cccccc")],
            example: "matte(#b8683c)",
        },
        build: |call| Ok(Material::Matte { color: color(call, DEFAULT_COLOR)? }),
    },
    Make {
        decl: Decl {
            word: "points",
            group: Group::Material,
            doc: "Matte, in the colours of the scan's own points.",
            params: &[Param::placed("color", Kind::Color, "multiplies them; default #ffffff")],
            example: "material own(kind: \"points\")",
        },
        build: |call| Ok(Material::Points { tint: color(call, [1.0; 3])? }),
    },
];

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

fn color(call: &Call, otherwise: [f32; 3]) -> Result<[f32; 3], BuildError> {
    let color = call.color("color").unwrap_or(otherwise);
    if color.iter().all(|c| c.is_finite() && 0.0 <= *c) {
        return Ok(color);
    }
    Err(BuildError {
        param: "color",
        message: "`color` has a negative part".to_owned(),
        help: "a surface cannot send on less than nothing".to_owned(),
    })
}
