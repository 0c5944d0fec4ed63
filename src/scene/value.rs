//! Values that a call holds once names, units and types are resolved.

use glam::DVec3;
use litemap::LiteMap;
use serde::{Deserialize, Serialize, Serializer};

use super::{Formula, Shape};
use crate::source::Span;

/// A resolved value. Lengths are numbers of scene units, angles radians, colours linear.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Value {
    /// A number, or a length in scene units.
    Number(f64),
    /// An angle, radians.
    Angle(f64),
    /// A colour, linear.
    Color([f32; 3]),
    /// Two to four numbers.
    Vector(Vec<f64>),
    /// Points.
    Points(Vec<DVec3>),
    /// Text.
    Text(String),
    /// Text that names a file.
    Path {
        /// As written.
        text: String,
        /// The folder that a relative name starts from: that of the scene file that wrote it; empty for the
        /// working directory.
        base: std::path::PathBuf,
        /// Whether it came by `-D`: such a file may lie anywhere.
        from_command_line: bool,
    },
    /// True or false.
    Bool(bool),
    /// Closed loops of points in a plane.
    Loops(Vec<Vec<[f64; 2]>>),
    /// A list of texts.
    Texts(Vec<String>),
    /// A shape.
    Shape(Shape),
    /// A linear condition on x, y, z, such as `z < 60`: points where `normal . p < offset`.
    HalfSpace {
        /// Points out of the half-space; not of unit length.
        normal: DVec3,
        /// The plane is `normal . p = offset`.
        offset: f64,
    },
    /// A condition on x, y, z of any form.
    Formula(std::sync::Arc<Formula>),
}

/// A value with the place where it was written.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Arg {
    /// The value.
    pub value: Value,
    /// The place of its expression.
    pub at: Span,
}

/// A call of something declared in a [`super::Catalog`], its arguments named, checked and typed. Arguments
/// that were not written are absent: whoever builds the thing knows its defaults.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Call {
    /// The declared name.
    pub word: String,
    /// Arguments by name.
    #[serde(serialize_with = "as_map")]
    pub args: LiteMap<String, Arg>,
    /// The place of the whole call.
    pub at: Span,
}

/// Of no arguments too: left to itself that map writes an empty list.
fn as_map<S: Serializer>(args: &LiteMap<String, Arg>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(args)
}

impl Call {
    /// The argument, if it was written.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.args.get(name).map(|a| &a.value)
    }

    /// Where the argument was written, else the whole call.
    pub fn place(&self, name: &str) -> Span {
        self.args.get(name).map_or(self.at, |a| a.at)
    }

    /// A number or length.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// An angle, radians.
    pub fn angle(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Angle(x) => Some(*x),
            _ => None,
        }
    }

    /// A colour, linear.
    pub fn color(&self, name: &str) -> Option<[f32; 3]> {
        match self.get(name)? {
            Value::Color(c) => Some(*c),
            _ => None,
        }
    }

    /// A vector of three numbers.
    pub fn vec3(&self, name: &str) -> Option<DVec3> {
        match self.get(name)? {
            Value::Vector(v) if v.len() == 3 => Some(DVec3::new(v[0], v[1], v[2])),
            _ => None,
        }
    }

    /// Two numbers.
    pub fn vec2(&self, name: &str) -> Option<[f64; 2]> {
        match self.get(name)? {
            Value::Vector(v) if v.len() == 2 => Some([v[0], v[1]]),
            _ => None,
        }
    }

    /// Closed loops of points.
    pub fn loops(&self, name: &str) -> Option<&[Vec<[f64; 2]>]> {
        match self.get(name)? {
            Value::Loops(loops) => Some(loops),
            _ => None,
        }
    }

    /// Text.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Text(s) => Some(s),
            _ => None,
        }
    }

    /// True or false.
    pub fn flag(&self, name: &str) -> Option<bool> {
        match self.get(name)? {
            Value::Bool(b) => Some(*b),
            _ => None,
        }
    }
}
