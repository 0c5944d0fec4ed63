//! What a CSG object answers: the intervals in which a ray is inside it.

use glam::DVec3;

use crate::geom::Interval;
use crate::solid::Crossing;

/// One end of a span.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Boundary {
    /// Where, in multiples of the ray's direction.
    pub t: f64,
    /// The leaf that owns this face; an index into the object's leaves.
    pub leaf: u32,
    /// The owner's own crossing, in the owner's frame.
    pub crossing: Crossing,
    /// The unit normal out of the object, world frame.
    pub normal: DVec3,
    /// Whether the owner's normal points into the object, as on the faces of a cutter.
    pub flipped: bool,
    /// A leaf with a material that fills the point just inside: the face shows it if its own leaf has none.
    pub filler: Option<u32>,
}

/// An interval inside the object; an end is `None` where the range asked, or space, ends before the object.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Span {
    /// Where the ray goes in.
    pub enter: Option<Boundary>,
    /// Where it comes out.
    pub exit: Option<Boundary>,
}

impl Span {
    /// The values of `t` in it.
    pub fn interval(&self) -> Interval {
        Interval::new(self.enter.map_or(f64::NEG_INFINITY, |b| b.t), self.exit.map_or(f64::INFINITY, |b| b.t))
    }
}

/// Disjoint spans in ascending order.
pub type Spans = Vec<Span>;
