//! Constructive solid geometry on the intervals of a ray.
mod spans;

pub use spans::{Boundary, Span, Spans};
