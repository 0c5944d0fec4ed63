//! Constructive solid geometry on the intervals of a ray: leaves, the expression over them, and the sweep that
//! answers which parts of a ray are inside. No concrete solid is known here.

mod cleanup;
mod clip;
mod object;
mod owner;
mod spans;
mod sweep;
mod tree;
mod truth;

pub use clip::{Clipped, Clippee};
pub use object::{Object, Scratch};
pub use spans::{Boundary, Span, Spans};
pub use tree::{Expr, Kind, Leaf, Tree};
