//! Constructive solid geometry on the intervals of a ray: leaves, the expression over them, and the sweep that
//! answers which parts of a ray are inside. No concrete solid is known here.

mod bundle;
mod cleanup;
mod clip;
mod convex;
mod expr;
mod few;
mod group;
mod handful;
mod hierarchy;
mod leaf;
mod object;
mod open;
mod owner;
mod queue;
mod reach;
mod room;
mod same;
mod slots;
mod spans;
mod stem;
mod sweep;
mod topset;
mod tree;
mod truth;
mod walk;

pub use bundle::Bundle;
pub use clip::{Clipped, Clippee};
pub use expr::Expr;
pub use group::Group;
pub use leaf::Leaf;
pub use object::{Object, Part, Scratch};
pub use spans::{Boundary, Span, Spans};
