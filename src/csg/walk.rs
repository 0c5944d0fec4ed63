//! A walk along a ray through a hierarchy of boxes, front to back: a leaf comes out when nothing that is left can begin
//! before it.
//!
//! What happens in single precision is measured from where the ray enters the box around all, in the frame where that box
//! is two long, along a direction whose largest component is 1: every number is of the order of one wherever the scene and
//! the eye are, and one bound covers all roundings ([`ROOM`]).

use glam::Vec4;

use super::hierarchy::{Hierarchy, LEAF, Node, WIDTH};
use crate::geom::{Aabb, Interval, Ray};

/// By so much boxes are grown: planes, the ray's start and their difference are each rounded, 2^-24 of at most 2, and
/// what a direction of less than [`STEEPEST`] would move on the way.
const ROOM: f32 = 1.0 / (1u32 << 21) as f32;

/// What three roundings, of the inverse, the difference and the product, do to a place along the ray, relative, and as
/// much again.
const LOOSE: f32 = 1.0 / (1u32 << 21) as f32;

/// Directions have no inverse past this, so that no product is infinite: on the way through the box around all, two long, a
/// component that small moves less than [`ROOM`].
const STEEPEST: f64 = (1u64 << 60) as f64;

/// Each end of a part of a ray in a box carries four roundings: of the plane's offset, the inverse, the product and the
/// box's own corner.
const PAD: f64 = 8.0 * f64::EPSILON;

/// A ray made ready to be tried on boxes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sight {
    range: Interval,
    inverse: [f64; 3],
    /// 1 where the direction is below zero: the high plane is the near one.
    back: [usize; 3],
    /// The origin moved by the growth of the boxes, as the near and as the far plane see it.
    near: [f64; 3],
    far: [f64; 3],
}

impl Sight {
    /// Boxes are grown by what a far origin adds to the errors of crossings.
    #[inline]
    fn new(ray: &Ray, range: Interval, grow: f64) -> Sight {
        let d = ray.dir.to_array();
        let back = d.map(|d| usize::from(d < 0.0));
        let o = ray.origin.to_array();
        let sign = |axis: usize| if back[axis] == 1 { -grow } else { grow };
        Sight {
            range,
            inverse: d.map(f64::recip),
            back,
            near: std::array::from_fn(|axis| o[axis] + sign(axis)),
            far: std::array::from_fn(|axis| o[axis] - sign(axis)),
        }
    }

    /// The part of the ray inside a box, widened by a few ulps. Along an axis that the ray is square to, the products are
    /// infinite of the right sign, or, in the very plane of a face, no number, which the comparisons leave aside.
    #[inline]
    fn part(&self, b: &Aabb) -> Interval {
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let planes = [b.min[axis], b.max[axis]];
            let near = (planes[self.back[axis]] - self.near[axis]) * self.inverse[axis];
            let far = (planes[1 - self.back[axis]] - self.far[axis]) * self.inverse[axis];
            lo = if lo < near { near } else { lo };
            hi = if far < hi { far } else { hi };
        }
        // An infinite end of a box that is missed has no ulp: `min` and `max` keep it.
        Interval::new(lo.min(lo - PAD * lo.abs()), hi.max(hi + PAD * hi.abs()))
    }

    /// Where the ray is inside a leaf's box, not cut to the range; `None` where it misses it in the range.
    #[inline]
    pub fn inside(&self, hierarchy: &Hierarchy, leaf: u32) -> Option<Interval> {
        let bounds = &hierarchy.boxes[leaf as usize];
        let part = if *bounds == Aabb::ALL { Interval::ALL } else { self.part(bounds) };
        (!part.intersect(self.range).is_empty()).then_some(part)
    }
}

/// The same in single precision, for nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Fast {
    inverse: [Vec4; 3],
    back: [usize; 3],
    near: [Vec4; 3],
    far: [Vec4; 3],
    end: Vec4,
    /// Where the walk starts and what a unit of it is, as t of the ray.
    start: f64,
    unit: f64,
}

impl Fast {
    /// For a part of the ray inside the box around all.
    fn new(hierarchy: &Hierarchy, sight: &Sight, ray: &Ray, part: Interval, grow: f64) -> Fast {
        let grid = &hierarchy.grid;
        let speed = ray.dir.abs().max_element() * grid.scale;
        let start = (ray.origin + part.lo * ray.dir - grid.center) * grid.scale;
        let length = (part.hi - part.lo) * speed;
        // The start is a sum of lengths that may be far larger than the box.
        let far = (ray.origin.abs() + (part.lo * ray.dir).abs() + grid.center.abs()).max_element();
        let slack = (grow + PAD * far) * grid.scale;
        let unit = speed.recip();
        let every = !(start.is_finite() && length.is_finite() && unit.is_finite() && slack < 1.0);
        let axis = |axis: usize| {
            let inverse = (sight.inverse[axis].abs() * ray.dir.abs().max_element()).min(STEEPEST);
            let sign = if sight.back[axis] == 1 { -1.0f32 } else { 1.0 };
            let moved = sign * (slack as f32 + ROOM);
            let o = start[axis] as f32;
            (Vec4::splat(sign * inverse as f32), Vec4::splat(o + moved), Vec4::splat(o - moved))
        };
        let axes = [axis(0), axis(1), axis(2)];
        let fast = Fast {
            inverse: axes.map(|a| a.0),
            back: sight.back,
            near: axes.map(|a| a.1),
            far: axes.map(|a| a.2),
            end: Vec4::splat(length as f32 * (1.0 + LOOSE) + ROOM),
            start: part.lo,
            unit,
        };
        if every { Fast::of_all(part.lo) } else { fast }
    }

    /// Meets every box: for rays that single precision cannot tell anything about.
    fn of_all(start: f64) -> Fast {
        let (inverse, near, far) = ([Vec4::ONE; 3], [Vec4::splat(16.0); 3], [Vec4::splat(-16.0); 3]);
        Fast { inverse, near, far, end: Vec4::splat(64.0), back: [0; 3], start, unit: 0.0 }
    }

    /// Which boxes are met, a bit each, and no later than where.
    #[inline]
    fn met(&self, node: &Node) -> (u32, [f32; WIDTH]) {
        let (mut lo, mut hi) = (Vec4::ZERO, self.end);
        for axis in 0..3 {
            let planes = &node.planes[axis];
            let back = self.back[axis];
            lo = lo.max((planes[back] - self.near[axis]) * self.inverse[axis]);
            hi = hi.min((planes[1 - back] - self.far[axis]) * self.inverse[axis]);
        }
        (lo.cmple(hi * (1.0 + LOOSE)).bitmask(), (lo * (1.0 - LOOSE)).to_array())
    }

    /// A t of the ray that is no later than a place on the walk.
    #[inline]
    fn t(&self, place: f32) -> f64 {
        let way = f64::from(place) * self.unit;
        self.start + way - PAD * (self.start.abs() + way)
    }
}

/// A node still to be opened.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    node: u32,
    /// No later than where the ray enters it or anything below on the stack.
    least: f64,
}

/// A walk along a ray.
#[derive(Clone, Debug, Default)]
pub(super) struct Walk {
    sight: Sight,
    fast: Fast,
    stack: Vec<Waiting>,
}

impl Walk {
    /// Begins: shows the leaves that are tried one by one, of which the ray may miss some.
    #[inline]
    pub fn begin(
        &mut self,
        hierarchy: &Hierarchy,
        ray: &Ray,
        range: Interval,
        mut show: impl FnMut(&Sight, u32),
    ) {
        let grow = hierarchy.grow(ray.origin.length());
        self.sight = Sight::new(ray, range, grow);
        self.stack.clear();
        for leaf in &hierarchy.wide {
            show(&self.sight, *leaf);
        }
        if !hierarchy.nodes.is_empty() {
            let part = self.sight.part(&hierarchy.grid.bounds).intersect(range);
            if !part.is_empty() {
                self.fast = Fast::new(hierarchy, &self.sight, ray, part, grow);
                self.stack.push(Waiting { node: 0, least: self.fast.t(0.0) });
            }
        }
    }

    /// Begins where there is nothing to walk through.
    pub fn begin_at_end(&mut self) {
        self.stack.clear();
    }

    /// Nothing that has not been shown begins before this.
    #[inline]
    pub fn least(&self) -> f64 {
        self.stack.last().map_or(f64::INFINITY, |w| w.least)
    }

    /// Opens one node; shows leaves, of which the ray may miss some.
    #[inline]
    pub fn step(&mut self, hierarchy: &Hierarchy, mut show: impl FnMut(&Sight, u32)) {
        let Some(Waiting { node, .. }) = self.stack.pop() else { return };
        let node = &hierarchy.nodes[node as usize];
        let (mut mask, at) = self.fast.met(node);
        // The near ones are opened first, so they are pushed last.
        let (mut nodes, mut count) = ([(0.0f32, 0u32); WIDTH], 0);
        while mask != 0 {
            let side = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            let child = node.child[side];
            if child & LEAF != 0 {
                show(&self.sight, child & !LEAF);
                continue;
            }
            let mut place = count;
            while 0 < place && nodes[place - 1].0 < at[side] {
                nodes[place] = nodes[place - 1];
                place -= 1;
            }
            nodes[place] = (at[side], child);
            count += 1;
        }
        for (at, node) in &nodes[..count] {
            let least = self.fast.t(*at).min(self.least());
            self.stack.push(Waiting { node: *node, least });
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Numbers in [0, 1) without a pattern (Weyl's sequence over the fractional part of the golden ratio, squared once).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            (z >> 11) as f64 / (1u64 << 53) as f64
        }

        fn point(&mut self) -> DVec3 {
            DVec3::from_array(std::array::from_fn(|_| 2.0 * self.next() - 1.0))
        }
    }

    /// Boxes of a size, some flat, around a place.
    fn boxes(numbers: &mut Numbers, count: usize, at: DVec3, size: f64) -> Vec<Aabb> {
        let one = |_| {
            let center = at + size * numbers.point();
            let mut half = 0.3 * size * numbers.next() * numbers.point().abs();
            half[0] *= f64::from(u8::from(numbers.next() < 0.8));
            Aabb { min: center - half, max: center + half }
        };
        (0..count).map(one).collect()
    }

    /// Rays across a box: any, along an axis, in a face, from far away.
    fn ray(numbers: &mut Numbers, kind: usize, b: &Aabb, size: f64) -> Ray {
        let toward = b.center() + 0.6 * b.size() * numbers.point();
        let dir = match kind % 4 {
            0 => numbers.point(),
            1 => DVec3::AXES[kind / 4 % 3] * if kind % 8 < 4 { 1.0 } else { -1.0 },
            2 => DVec3::new(numbers.point().x, 0.0, -1e-40),
            _ => 1e-3 * numbers.point(),
        };
        let toward = if kind.is_multiple_of(3) { DVec3 { z: b.max.z, ..toward } } else { toward };
        let away = [0.1, 3.0, 1e5][kind % 3] * size * (1.0 + numbers.next()) / dir.length();
        Ray::new(toward - away * dir, dir)
    }

    #[test]
    fn a_walk_shows_every_box_that_double_precision_meets_and_none_too_late() {
        let mut numbers = Numbers(1);
        let (mut met, mut shown) = (0u64, 0u64);
        for round in 0..120 {
            let size = [1e-9, 1.0, 1e9, 1e-300, 1e290][round % 5];
            let at = [0.0, 30.0, 1e7][round % 3] * size * numbers.point();
            let all = boxes(&mut numbers, 2 + 7 * round, at, size);
            let hierarchy = Hierarchy::new(all.clone(), 1.0);
            for kind in 0..200 {
                let target = all[(numbers.next() * all.len() as f64) as usize];
                let ray = ray(&mut numbers, kind, &target, size);
                let range = [Interval::ALL, Interval::AHEAD, Interval::new(0.0, 1.0)][kind % 3];
                let mut seen = vec![false; all.len()];
                let mut walk = Walk::default();
                walk.begin(&hierarchy, &ray, range, |_, leaf| seen[leaf as usize] = true);
                let sight = walk.sight;
                let inside: Vec<_> = (0..all.len()).map(|i| sight.inside(&hierarchy, i as u32)).collect();
                while walk.least() < f64::INFINITY {
                    for i in (0..all.len()).filter(|i| !seen[*i]) {
                        let lo = inside[i].map_or(f64::INFINITY, |part| part.lo.max(range.lo));
                        assert!(walk.least() <= lo, "round {round} kind {kind}: {} {lo}", walk.least());
                    }
                    walk.step(&hierarchy, |_, leaf| seen[leaf as usize] = true);
                }
                for (i, part) in inside.iter().enumerate() {
                    assert!(part.is_none() || seen[i], "round {round} kind {kind}: {part:?} of {ray:?}");
                }
                met += inside.iter().flatten().count() as u64;
                shown += seen.iter().filter(|s| **s).count() as u64;
            }
        }
        // And it culls: few more than needed, though rays that start 1e5 sizes away are among them.
        assert!(0 < met && (shown as f64) < 1.1 * met as f64, "{shown} shown of {met}");
    }
}
