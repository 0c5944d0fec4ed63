//! Where a ray passes through a boundary.

use super::Body;
use crate::geom::Interval;

/// A place where a ray's line passes through the boundary of one solid.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Crossing {
    /// Where, in multiples of the ray's direction.
    pub t: f64,
    /// Half the width, in `t`, of an interval that holds the exact crossing; 0 for closed forms, whose
    /// rounding the clean-up's own tolerance covers.
    pub err: f64,
    /// A bound of the displacement along the normal, length of the solid's own frame; 0 for closed forms.
    pub shift: f64,
    /// Whether the ray goes in as `t` grows.
    pub entering: bool,
    /// Which part of the boundary: the solid's own numbering.
    pub part: u32,
    /// Whether it is a cap over a hole of a scan.
    pub cap: bool,
}

impl Crossing {
    /// A crossing known in closed form.
    #[inline]
    pub fn exact(t: f64, entering: bool, part: u32) -> Crossing {
        Crossing { t, err: 0.0, shift: 0.0, entering, part, cap: false }
    }
}

/// What a list of crossings is good for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Answer {
    /// Whether the ray is inside where `range` begins.
    pub inside: bool,
    /// The range in which all crossings were reported.
    pub range: Interval,
}

impl Answer {
    /// Whether crossings are what an answer may have: finite, ascending, and, of a solid, ways in and out by turns.
    #[inline]
    pub fn is_sound(&self, crossings: &[Crossing], body: impl FnOnce() -> Body) -> bool {
        let (mut last, mut inside, mut ascend, mut turn) = (f64::MIN, self.inside, true, true);
        for c in crossings {
            ascend &= last <= c.t && c.t <= f64::MAX;
            turn &= inside != c.entering;
            (last, inside) = (c.t, c.entering);
        }
        ascend && (turn || body() == Body::Sheet)
    }

    /// All crossings of the whole line.
    #[inline]
    pub fn whole_line(inside: bool) -> Answer {
        Answer { inside, range: Interval::ALL }
    }
}
