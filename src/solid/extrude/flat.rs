//! Extrusions whose walls are planes, and level rays through any: in the outline's own plane the ray is a line.

use glam::{DVec2, Vec3Swizzles as _};

use super::{Extrusion, Frame, WALLS, back};
use crate::geom::{Interval, Ray};
use crate::solid::{Crossing, parity};

impl Extrusion {
    /// The crossings of a ray. Where walls are planes, a point p + t d of the ray lies over
    /// q(t) = (p + t d) / (m - k d_z t) of the outline, p and d without their z, m the scale at p: a line through
    /// p / m along w = m d + k d_z p, which t runs through until the scale is zero, at infinity. It crosses the
    /// outline where t (d + k d_z e) = m e - p, e a point of an edge; whether the scale is above zero there is told by
    /// the sign of w . (d + k d_z e). For a prism (k = 0) all that is the ray's own projection.
    ///
    /// A line with w = 0 (along the axis of a prism, or towards the tip of a pyramid) stands on one point of the
    /// outline. Counted from the side where the line comes from infinity: crossings are even in number up to there.
    /// Tested against boxes, cones of many sides and the states at mid-points by `tests/solid_outlines.rs`.
    pub(super) fn straight(
        &self,
        ray: &Ray,
        near: Interval,
        slab: Interval,
        ends: [u32; 2],
        out: &mut Vec<Crossing>,
    ) {
        let start = out.len();
        // The end of the ray's part in the box where the scale is larger keeps the most digits.
        let fall = self.k.x * ray.dir.z;
        let from = if 0.0 <= fall { near.lo } else { near.hi };
        let p = ray.at(from);
        let Frame { xy, m, turn } = self.frame(p);
        if m.min_element() <= 0.0 {
            return;
        }
        let d = back(turn).rotate(ray.dir.xy());
        let through = xy / m;
        let along = if fall == 0.0 { d / m } else { m.x * d + fall * xy };
        if along == DVec2::ZERO {
            if self.outline.contains(through) && slab.lo < slab.hi {
                out.push(Crossing::exact(slab.lo, true, ends[0]));
                out.push(Crossing::exact(slab.hi, false, ends[1]));
            }
            return;
        }
        self.outline.crossed(through, along, |edge, e| {
            let t = if fall == 0.0 {
                (e - through).dot(along) / along.length_squared()
            } else {
                let g = d + fall * e;
                if g.dot(along) <= 0.0 {
                    return;
                }
                (m.x * e - xy).dot(g) / g.length_squared()
            };
            out.push(Crossing::exact(from + t, true, WALLS + edge));
        });
        let odd = !(out.len() - start).is_multiple_of(2);
        // With a scale that falls along the ray the line is outside at its far end.
        parity::alternate(out, start, odd && 0.0 < fall);
        cut(out, start, slab, ends, odd && 0.0 < fall);
    }
}

/// What is left of alternating crossings within a slab, its ends crossed where the line is inside there. `inside`:
/// before the first crossing.
fn cut(out: &mut Vec<Crossing>, start: usize, slab: Interval, ends: [u32; 2], mut inside: bool) {
    if slab.is_empty() || slab.lo == slab.hi {
        out.truncate(start);
        return;
    }
    let before = out[start..].iter().take_while(|c| c.t <= slab.lo).count();
    inside ^= !before.is_multiple_of(2);
    out.drain(start..start + before);
    let within = out[start..].iter().take_while(|c| c.t < slab.hi).count();
    out.truncate(start + within);
    if inside {
        out.insert(start, Crossing::exact(slab.lo, true, ends[0]));
    }
    if inside == within.is_multiple_of(2) {
        out.push(Crossing::exact(slab.hi, false, ends[1]));
    }
}
