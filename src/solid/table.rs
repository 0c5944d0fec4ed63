//! The table of primitives: the language, the help and the conformance tests read it. A new primitive is its
//! file and one line here.

use std::sync::Arc;

use super::{
    Solid, block, capsule, cone, cylinder, extrude, half_space, heightfield, implicit, mesh, plane, points,
    quadric, revolve, sphere, superellipsoid, torus, tube,
};
use crate::geom::Aabb;
use crate::scene::{BuildError, Call, Decl};

/// A solid, or why there is none.
pub type Made = Result<Arc<dyn Solid>, BuildError>;

/// How a primitive is made.
#[derive(Clone, Copy, Debug)]
pub enum Build {
    /// From the arguments alone.
    Exact(fn(&Call) -> Result<Arc<dyn Solid>, BuildError>),
    /// From the triangles of a file.
    Mesh,
    /// From the heights of an image file.
    Heights,
    /// From the arguments and the box around another solid, which bounds it: the two are intersected.
    Bounded {
        /// The argument that is the other solid.
        by: &'static str,
        /// Its maker, given the box.
        build: fn(&Call, &Aabb) -> Made,
    },
    /// From the samples of a file or of another solid: whoever prepares the scene fetches those.
    Points,
}

/// A primitive: what the language may write and how it is made.
#[derive(Clone, Copy, Debug)]
pub struct Primitive {
    /// Its declaration.
    pub decl: Decl,
    /// Its maker.
    pub build: Build,
}

/// All primitives.
pub static PRIMITIVES: &[Primitive] = &[
    block::PRIMITIVE,
    sphere::PRIMITIVE,
    cylinder::PRIMITIVE,
    cone::PRIMITIVE,
    capsule::PRIMITIVE,
    tube::PRIMITIVE,
    torus::PRIMITIVE,
    superellipsoid::PRIMITIVE,
    quadric::PRIMITIVE,
    extrude::PRIMITIVE,
    half_space::PRIMITIVE,
    heightfield::PRIMITIVE,
    mesh::PRIMITIVE,
    implicit::PRIMITIVE,
    plane::PRIMITIVE,
    points::PRIMITIVE,
    revolve::PRIMITIVE,
];

/// The declarations of all primitives.
pub fn decls() -> impl Iterator<Item = Decl> {
    PRIMITIVES.iter().map(|p| p.decl)
}

/// The primitive with this word.
pub fn find(word: &str) -> Option<&'static Primitive> {
    PRIMITIVES.iter().find(|p| p.decl.word == word)
}
