//! Volumes, middles and areas as integrals over lines along the axes ([`super::adaptive`]).
//!
//! The volume is the integral over the plane across an axis of how long the line along it is inside; the middle weighs the
//! middles of the spans by their lengths. Of the area of a face with unit normal n the plane across an axis sees |n_axis| dA, and
//! the squares of n's coordinates are 1 together: so the area is the sum over the three axes of the integral of |n_axis| over
//! the crossings of the line. It falls to zero at the outlines of a round shape, where a line sees much of it; a face along the
//! axis adds nothing, and none of the lines does.
//!
//! The cells begin with the boxes in which leaves matter, so that every leaf is looked at by lines of its own. A formula or a scan of
//! which a grid of lines through its box sees nothing may be anything in it: its box is added to the bar. Where something is seen, other
//! pieces of it that are much smaller may still be missed.

use glam::{DAffine3, DVec3};

use super::adaptive::{Found, Integral, Integrand, WIDTH};
use crate::csg::{Leaf, Object, Scratch, Spans};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::lang::Measured;
use crate::shot::World;
use crate::solid::Cost;

/// Lines for one integral, at most, by what asking the costliest leaf takes.
const MOST: [u64; 3] = [1 << 21, 1 << 20, 1 << 17];

/// What bars of volumes shall be at first, relative to the value, by the same: a twentieth of what is commonly allowed.
const ENOUGH: [f64; 3] = [5e-5, 5e-5, 2e-4];
/// And by which factor less each time that more is asked for.
const FINER: f64 = 0.25;
/// Areas may have bars by so much wider: every edge that a line sees is one to it, along three axes.
const WIDER: f64 = 10.0;
/// Rounds of lines after which an axis is chosen.
const PILOT: u32 = 2;
/// Leaves up to which choosing is worth the lines.
const MANY: usize = 1000;

/// Something measured over lines, at one accuracy after the other; what is told of one does not depend on which were asked for
/// before.
#[derive(Debug)]
pub struct Lines {
    bounds: Aabb,
    integral: Integral,
    enough: f64,
    /// How far faces may be off, world length.
    shift: f64,
    /// Boxes of leaves that may matter in them, and that no line was seen to meet.
    unmet: Vec<Aabb>,
    told: Vec<Found>,
}

impl Lines {
    /// The volume of what lies in a box, and its middle: along the axis which lines differ least along, of like ones that of
    /// the shortest side. A wall along the axis is an edge to lines, one across it is none. Where lines cost much, or are many, the
    /// shortest side is taken: there the ends of spans are most of what they see.
    pub fn of_volume(world: &World, bounds: &Aabb) -> Lines {
        const AXES: [&[usize]; 3] = [&[0], &[1], &[2]];
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| bounds.size()[*a].total_cmp(&bounds.size()[*b]));
        let of = |axis: usize| Lines::new(world, bounds, AXES[axis]);
        if cost(world) == Cost::Heavy || MANY < world.solids().leaves().len() {
            return of(order[0]);
        }
        let mut best: Option<(f64, Lines)> = None;
        for axis in order {
            let mut lines = of(axis);
            let bar = lines.integral.pilot(PILOT, &Lengths { world, bounds: *bounds });
            if best.as_ref().is_none_or(|(least, _)| bar < 0.5 * least) {
                best = Some((bar, lines));
            }
            if best.as_ref().is_some_and(|(least, _)| *least == 0.0) {
                break;
            }
        }
        best.map_or_else(|| of(order[0]), |(_, lines)| lines)
    }

    /// The area of it.
    pub fn of_area(world: &World, bounds: &Aabb) -> Lines {
        let lines = Lines::new(world, bounds, &[0, 1, 2]);
        Lines { enough: WIDER * lines.enough, ..lines }
    }

    fn new(world: &World, bounds: &Aabb, axes: &[usize]) -> Lines {
        let sheets = world.open().iter().map(|sheet| sheet.bounds);
        let boxes: Vec<Aabb> = world.solids().reaches().iter().copied().chain(sheets).collect();
        let leaves = || world.solids().leaves().iter().chain(world.open());
        let cost = cost(world) as usize;
        let shift = leaves().map(shift).fold(tolerance::cleanup(bounds.farthest()), f64::max);
        let integral = Integral::new(bounds, &boxes, axes, MOST[cost]);
        Lines {
            bounds: *bounds,
            integral,
            enough: ENOUGH[cost],
            shift,
            unmet: unmet(world),
            told: Vec::new(),
        }
    }

    /// What is known at an accuracy, and whether the next is finer.
    fn told(&mut self, level: usize, integrand: &impl Integrand) -> (Found, bool) {
        while self.told.len() <= level && (self.told.is_empty() || !self.integral.is_spent()) {
            let share = self.enough * FINER.powi(self.told.len() as i32);
            let found = self.integral.refine(self.told.len(), share, integrand);
            self.told.push(found);
        }
        let last = self.told.len() - 1;
        (self.told[level.min(last)], level < last || !self.integral.is_spent())
    }

    /// The volume, and the middle with one bar for its coordinates.
    pub fn volume(&mut self, world: &World, level: usize) -> (Measured, DVec3, f64) {
        let bounds = self.bounds;
        let half = 0.5 * bounds.size();
        let (found, is_open) = self.told(level, &Lengths { world, bounds });
        let Found { values: [value, moments @ ..], bars } = found;
        let unmet: f64 = self.unmet.iter().map(|b| b.size().element_product()).sum();
        let err = bars[0] + self.rounding() + unmet;
        let volume =
            Measured { value, err, size: self.size(value, bounds.size().element_product()), is_open };
        if value <= 0.0 {
            return (volume, DVec3::ZERO, 0.0);
        }
        let middle = DVec3::from_array(moments) / value;
        let bar = (0..3).map(|i| half[i] * (bars[i + 1] + err * (1.0 + middle[i].abs())) / value);
        (volume, bounds.center() + half * middle, bar.fold(0.0, f64::max))
    }

    /// The area of the boundary; of sheets that of one side.
    pub fn area(&mut self, world: &World, level: usize) -> Measured {
        let (found, is_open) = self.told(level, &Faces { world, bounds: self.bounds });
        let (value, err) = (found.values[0], found.bars[0]);
        let size = self.bounds.size();
        // A face that is moved changes its neighbours along its rim.
        let unmet: f64 = self.unmet.iter().map(Aabb::surface).sum();
        let err = err + 8.0 * self.shift * size.element_sum() + unmet;
        Measured { value, err, size: self.size(value, self.bounds.surface()), is_open }
    }

    /// What faces that are off add to the volume, by all that the box shows of them.
    fn rounding(&self) -> f64 {
        self.shift * self.bounds.surface()
    }

    /// What a bar is held against: the value, and where there is none what it would be of the whole box.
    fn size(&self, value: f64, of_box: f64) -> f64 {
        if value.abs() <= 0.0 { of_box } else { value.abs() }
    }
}

/// What the costliest leaf is.
fn cost(world: &World) -> Cost {
    let leaves = world.solids().leaves().iter().chain(world.open());
    leaves.map(|leaf| leaf.solid.cost()).max().unwrap_or(Cost::Closed)
}

fn shift(leaf: &Leaf) -> f64 {
    leaf.solid.shift_bound() * leaf.place.stretch + tolerance::cleanup(leaf.scale())
}

/// Lines along each axis, a square of so many, that look for a leaf in its box.
const GRID: usize = 16;

/// The boxes in which formulas and scans may matter and no line of a grid meets them; closed forms fill their boxes.
fn unmet(world: &World) -> Vec<Aabb> {
    let solids = world.solids();
    let boxes = solids.leaves().iter().zip(solids.reaches());
    let heavy = boxes.filter(|(leaf, reach)| {
        let may_be = !leaf.solid.extent_under(&DAffine3::IDENTITY).is_empty();
        leaf.solid.cost() == Cost::Heavy && may_be && reach.is_finite() && 0.0 < reach.size().min_element()
    });
    heavy.filter(|(leaf, reach)| !is_met(leaf, reach)).map(|(_, reach)| *reach).collect()
}

/// Whether a line of the grid over a box crosses a leaf in the box, or is inside of it there.
fn is_met(leaf: &Leaf, reach: &Aabb) -> bool {
    let (mut scratch, mut found) = (Scratch::default(), Vec::new());
    let share = |i: usize| (i as f64 + 0.5) / GRID as f64 - 0.5;
    (0..3 * GRID * GRID).any(|k| {
        let (axis, i, j) = (k % 3, k / 3 / GRID, k / 3 % GRID);
        let place = [(share(i), (axis + 1) % 3), (share(j), (axis + 2) % 3)]
            .map(|(share, across)| reach.center()[across] + share * reach.size()[across]);
        let ray = line(reach, axis, place);
        let (local, half) = (leaf.place.ray_to_local(&ray), 0.5 * reach.size()[axis]);
        let mut lo = -half;
        while lo < half {
            found.clear();
            let answer = leaf.crossings(&local, Interval::new(lo, half), &mut scratch.solid, &mut found);
            if answer.inside || found.iter().any(|crossing| crossing.t.abs() <= half) {
                return true;
            }
            if answer.range.hi <= lo {
                break;
            }
            lo = answer.range.hi;
        }
        false
    })
}

/// A box that holds all of an object that has an end.
pub fn domain(object: &Object, extent: &Aabb) -> Aabb {
    let bounds = object.bounds();
    if bounds.is_finite() { bounds } else { bounds.intersection(*extent) }
}

/// A line along an axis through a place of the plane across it.
pub fn line(bounds: &Aabb, axis: usize, place: [f64; 2]) -> Ray {
    let mut origin = bounds.center();
    origin[(axis + 1) % 3] = place[0];
    origin[(axis + 2) % 3] = place[1];
    Ray::new(origin, DVec3::AXES[axis])
}

/// How long lines are inside, and that times where the middles are, from the middle of the box in halves of its sides.
struct Lengths<'a> {
    world: &'a World,
    bounds: Aabb,
}

impl Integrand for Lengths<'_> {
    fn at(&self, axis: usize, place: [f64; 2], scratch: &mut Scratch, spans: &mut Spans) -> [f64; WIDTH] {
        let ray = line(&self.bounds, axis, place);
        spans.clear();
        self.world.spans(&ray, Interval::ALL, scratch, spans);
        let (center, half) = (self.bounds.center(), 0.5 * self.bounds.size());
        let mut sums = [0.0; WIDTH];
        for span in spans.iter() {
            let Interval { lo, hi } = span.interval();
            if !(lo.is_finite() && hi.is_finite()) {
                continue;
            }
            let middle = (ray.at(0.5 * (lo + hi)) - center) / half;
            sums[0] += hi - lo;
            (0..3).for_each(|i| sums[i + 1] += (hi - lo) * middle[i]);
        }
        sums
    }
}

/// What lines see of faces.
struct Faces<'a> {
    world: &'a World,
    bounds: Aabb,
}

impl Integrand for Faces<'_> {
    fn at(&self, axis: usize, place: [f64; 2], scratch: &mut Scratch, spans: &mut Spans) -> [f64; WIDTH] {
        let ray = line(&self.bounds, axis, place);
        spans.clear();
        self.world.spans(&ray, Interval::ALL, scratch, spans);
        let ends = spans.iter().flat_map(|span| [span.enter, span.exit]).flatten();
        let mut sum: f64 = ends.map(|end| end.normal[axis].abs()).sum();
        if !self.world.open().is_empty() {
            let mut hits = Vec::new();
            self.world.sheets(&ray, Interval::ALL, scratch, &mut hits);
            sum += hits.iter().map(|hit| hit.boundary.normal[axis].abs()).sum::<f64>();
        }
        [sum, 0.0, 0.0, 0.0]
    }
}
