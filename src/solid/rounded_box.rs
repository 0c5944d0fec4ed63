//! Boxes with rounded edges: all points nearer to a smaller box than a radius.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::block::Block;
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::lean::is_between;
use crate::geom::{Aabb, Interval, Lean, Ray};
use crate::num::roots::ball;

/// A box whose edges and corners are rounded with one radius: the Minkowski sum of its core and a ball.
#[derive(Clone, Copy, Debug)]
pub struct RoundedBox {
    /// The box around it; finite.
    pub outer: Aabb,
    /// The radius of edges and corners, above zero and at most half the shortest edge of `outer`.
    pub radius: f64,
}

/// Six places where a line enters or leaves one of the core's slabs, and the two ends of its range.
const BREAKS: usize = 8;

impl RoundedBox {
    /// The core; flat where the radius is half of an edge.
    fn core(&self) -> Aabb {
        let Aabb { min, max } = self.outer.inflated(-self.radius);
        Aabb { min, max: max.max(min) }
    }

    /// The range of the line in the outer box, the axis in whose face it runs, if it does.
    fn range(&self, ray: &Ray, shift: f64, lean: Lean) -> Option<([f64; 2], Option<usize>)> {
        let (mut lo, mut hi, mut face) = (f64::NEG_INFINITY, f64::INFINITY, None);
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.dir[axis]);
            let (min, max) = (self.outer.min[axis], self.outer.max[axis]);
            if d == 0.0 {
                if !is_between(o, min, max, lean.along(axis)) {
                    return None;
                }
                face = if o == min || o == max { Some(axis) } else { face };
                continue;
            }
            let (near, far) = if 0.0 < d { (min, max) } else { (max, min) };
            (lo, hi) = (lo.max((near - o) / d), hi.min((far - o) / d));
        }
        (lo < hi).then_some(([lo - shift, hi - shift], face))
    }
}

impl Solid for RoundedBox {
    fn bounds(&self) -> Aabb {
        self.outer
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        // The image of the unit ball under M reaches the length of M's row along each axis.
        let rows = to_from.matrix3.transpose();
        let reach =
            self.radius * DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        let core = self.core().transformed(to_from);
        Aabb { min: core.min - reach, max: core.max + reach }
    }

    /// The squared distance from the core is a sum over the axes whose slab the point is outside of: along the line a
    /// quadratic on each piece between two slab planes, convex as a whole. In each piece those axes alone make a ball, a
    /// cylinder or a slab of the radius; what is inside in any piece hangs together.
    fn crossings(&self, ray: &Ray, _: Interval, scratch: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let miss = Answer::whole_line(false);
        let core = self.core();
        let (center, half) = (core.center(), 0.5 * core.size());
        let (shift, o) = ray.nearest_to(center);
        let d = ray.dir;
        let Some(([first, last], face)) = self.range(ray, shift, scratch.lean) else { return miss };
        let mut breaks = [last; BREAKS];
        breaks[0] = first;
        for axis in 0..3 {
            for side in 0..2 {
                let plane = if side == 0 { -half[axis] } else { half[axis] };
                let u = (plane - o[axis]) / d[axis];
                if first < u && u < last {
                    breaks[1 + 2 * axis + side] = u;
                }
            }
        }
        breaks.sort_unstable_by(f64::total_cmp);
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        for pair in breaks.windows(2).filter(|w| w[0] < w[1]) {
            let middle = o + 0.5 * (pair[0] + pair[1]) * d;
            let beyond = middle.abs().cmpgt(half);
            let alone = |axis: usize| beyond.bitmask() == 1 << axis;
            let within = if beyond.bitmask() == 0 || face.is_some_and(alone) {
                Some([f64::NEG_INFINITY, f64::INFINITY])
            } else {
                let out = DVec3::select(beyond, o - half.copysign(middle), DVec3::ZERO);
                ball(out, DVec3::select(beyond, d, DVec3::ZERO), self.radius)
            };
            if let Some([a, b]) = within {
                let (a, b) = (a.max(pair[0]), b.min(pair[1]));
                if a < b {
                    (lo, hi) = (lo.min(a), hi.max(b));
                }
            }
        }
        let (lo, hi) = (shift + lo, shift + hi);
        if lo < hi {
            out.push(Crossing::exact(lo, true, 0));
            out.push(Crossing::exact(hi, false, 0));
        }
        miss
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        let (outer, radius) = (self.outer.inflated(by), self.radius + by);
        if !outer.min.cmplt(outer.max).all() {
            return Ok(None);
        }
        // Inward by more than the radius the edges are sharp.
        let sharp = || Arc::new(Block(outer)) as Arc<dyn Solid>;
        Ok(Some(if 0.0 < radius { Arc::new(RoundedBox { outer, radius }) } else { sharp() }))
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let (core, at) = (self.core(), ray.at(crossing.t));
        (at - at.clamp(core.min, core.max)).try_normalize().unwrap_or(DVec3::Z)
    }
}
