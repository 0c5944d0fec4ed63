//! `pss` renders scenes in which scanned objects, straight from their points, and analytic solids are
//! equal citizens of one constructive solid geometry (CSG).
//!
//! # The flow
//!
//! ```text
//! text --lang--> Scene --prepare--> Shot --render--> Film --output--> .png / .exr
//! ```
//!
//! Nouns ([`scene::Scene`], [`shot::Shot`], [`film::Film`]) are data and know no verb. A verb ([`lang`],
//! [`prepare`], [`render`], [`output`]) imports the nouns on its two sides, never another verb. A ray's own
//! path is [`shot::World`], [`csg`], [`solid`], ([`mls`], [`cloud`]), answered by intervals; then one surface
//! for the crossing that won.
//!
//! # Conventions
//!
//! Geometry is `f64` ([`glam::DVec3`]), colour is linear `f32`. Frames are right-handed, vectors are columns,
//! a transform is named by both its ends (`world_from_local`). Normals point out of the solid. A ray's `t`
//! counts multiples of its direction, which is never normalised, so `t` survives affine maps. Angles are
//! radians, pixels are counted from the top left.

// What the parser generator writes names it.
extern crate alloc;

pub mod check;
pub mod cloud;
pub mod compare;
pub mod csg;
mod deep;
pub mod diag;
pub mod film;
pub mod geom;
pub mod golden;
pub mod heights;
pub mod lang;
pub mod lsp;
pub mod measure;
pub mod mesh;
pub mod mls;
pub mod num;
pub mod output;
pub mod prepare;
pub mod raster;
pub mod render;
pub mod report;
pub mod scene;
pub mod shot;
pub mod sky;
pub mod solid;
pub mod source;
