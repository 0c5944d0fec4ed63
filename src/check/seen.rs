//! Sums over test lines; they do not depend on the lines' order.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DMat3, DVec3};

use crate::geom::{Aabb, tolerance};
use crate::num::eigen::symmetric3;
use crate::source::Span;

/// Sums over lines. Leaves, solids drawn and cuts by their index; operands of cuts by the place in the text, as one text
/// may come to many solids.
#[derive(Debug, Default)]
pub(super) struct Seen {
    /// Leaves that are nothing ([`super::closer::nothing`]).
    pub nothing: BTreeSet<u32>,
    /// Leaves that a line crossed, with some thickness.
    pub crossed: BTreeSet<u32>,
    /// Solids drawn that a line was inside.
    pub parts: BTreeSet<u32>,
    /// Pairs of leaves whose faces coincide.
    pub shared: BTreeMap<(u32, u32), Near>,
    /// Leaves whose faces stand nearer somewhere than the clean-up tells apart, but further than faces that are meant to
    /// coincide; a leaf with itself where it is as thin as that by itself.
    pub films: BTreeMap<(u32, u32), Near>,
    /// Leaves whose faces stand further apart than that, but nearer than anybody builds ([`crate::geom::tolerance::skin`]).
    pub skins: BTreeMap<(u32, u32), Near>,
    /// Pairs of solids drawn, and a box around where lines were inside both.
    pub overlaps: BTreeMap<(u32, u32), Aabb>,
    /// Sheets that are nothing ([`super::closer::nothing_open`]).
    pub gone: BTreeSet<u32>,
    /// Intersections and symmetric differences that a line was inside.
    pub meetings: BTreeSet<Span>,
    /// Cutters that took something away.
    pub cutting: BTreeSet<Span>,
    /// Leaves of cutters, shapes that these are unions of, that a line was inside where it was inside what they cut.
    pub biting: BTreeSet<u32>,
    /// Operands of cuts, intersections, symmetric differences and solids drawn that seemed to do nothing, or to be nothing, and
    /// were looked at closer.
    pub looked_at: BTreeSet<Span>,
    pub looked_at_parts: BTreeSet<u32>,
    pub looked_at_leaves: BTreeSet<u32>,
    /// Bases that a line was inside.
    pub bases: BTreeSet<Span>,
    /// Bases of which something was left.
    pub left: BTreeSet<Span>,
    /// Cutters that did not hold somewhere in their base.
    pub uncovering: BTreeSet<Span>,
    /// Cutters that cut the same: what their bases lost where none of them was needed, as the others cut it too. In the order
    /// of the text, some few each.
    pub alike: BTreeSet<Vec<Span>>,
}

/// Where faces of two shapes stand near each other.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Near {
    /// How far apart they may stand to be as near as that, and the size of the smaller shape, at most: world length.
    pub margin: f64,
    pub size: f64,
    /// How many places were seen.
    pub seen: u32,
    /// Those of them at which the faces run along each other ([`tolerance::run_along`]).
    pub along: Spread,
    /// Whether what they leave is a film there, not a slit.
    pub film: bool,
}

/// Round faces that touch at a point, or along a line, stand near each other about there; what runs along another face does
/// so nearly wherever it is seen to be near. A rounded foot on a floor does both.
const ALONG: f64 = 0.25;
/// What is near over so much of a shape is near over an area, however large the clean-up is.
const SMALL: f64 = 0.01;
/// Places spread evenly over a disc deviate from its middle, along an axis, by a quarter of its width; over a strip by 0.29 of
/// its width. An eighth leaves a factor of two.
const DEVIATION: f64 = 0.125;

impl Near {
    pub fn add(&mut self, o: Near) {
        *self = Near {
            margin: self.margin.max(o.margin),
            size: self.size.max(o.size),
            seen: self.seen + o.seen,
            along: self.along.plus(o.along),
            film: self.film | o.film,
        };
    }

    /// Whether the faces are near over an area: at a tip, along an edge, or where round faces touch they are, up to some way
    /// from there.
    pub fn is_area(&self) -> bool {
        let touch = tolerance::touch(self.margin, self.size).min(SMALL * self.size);
        ALONG * f64::from(self.seen) <= self.along.count && DEVIATION * touch <= self.along.width()
    }
}

/// How places spread: sums of their offsets from a point near them, and of the products of these.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub count: f64,
    sum: DVec3,
    products: DMat3,
}

impl Default for Spread {
    /// No places; the default matrix is not zero.
    fn default() -> Spread {
        Spread { count: 0.0, sum: DVec3::ZERO, products: DMat3::ZERO }
    }
}

impl Spread {
    /// One place, by its offset.
    pub fn of(offset: DVec3) -> Spread {
        let products = DMat3::from_cols(offset.x * offset, offset.y * offset, offset.z * offset);
        Spread { count: 1.0, sum: offset, products }
    }

    fn plus(self, o: Spread) -> Spread {
        Spread { count: self.count + o.count, sum: self.sum + o.sum, products: self.products + o.products }
    }

    /// The standard deviation across the line that fits the places best: zero where they lie on one.
    fn width(&self) -> f64 {
        if self.count == 0.0 {
            return 0.0;
        }
        let mean = self.sum / self.count;
        let of_mean = DMat3::from_cols(mean.x * mean, mean.y * mean, mean.z * mean);
        let (mut values, _) = symmetric3(self.products * (1.0 / self.count) - of_mean);
        values.sort_by(f64::total_cmp);
        values[1].max(0.0).sqrt()
    }
}

impl Seen {
    pub fn add(mut self, o: Seen) -> Seen {
        self.nothing.extend(o.nothing);
        self.crossed.extend(o.crossed);
        self.parts.extend(o.parts);
        for (all, more) in
            [(&mut self.shared, o.shared), (&mut self.films, o.films), (&mut self.skins, o.skins)]
        {
            more.into_iter().for_each(|(pair, near)| all.entry(pair).or_default().add(near));
        }
        self.gone.extend(o.gone);
        for (pair, place) in o.overlaps {
            let known = self.overlaps.entry(pair).or_default();
            *known = known.union(place);
        }
        self.meetings.extend(o.meetings);
        self.cutting.extend(o.cutting);
        self.biting.extend(o.biting);
        self.bases.extend(o.bases);
        self.left.extend(o.left);
        self.uncovering.extend(o.uncovering);
        self.alike.extend(o.alike);
        self
    }
}
