//! Rays, ranges of them, boxes and placements, all `f64`; and the one place where tolerances are set.

mod aabb;
mod beam;
pub mod halves;
mod interval;
pub mod lean;
mod placement;
mod ray;
pub mod tolerance;

pub use aabb::Aabb;
pub use beam::Beam;
pub use interval::Interval;
pub use lean::Lean;
pub use placement::Placement;
pub use ray::Ray;
