//! Sums over test lines; they do not depend on the lines' order.

use std::collections::{BTreeMap, BTreeSet};

use crate::geom::Aabb;
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
    /// Pairs of leaves whose faces coincide, and a box around where they were seen to.
    pub shared: BTreeMap<(u32, u32), Aabb>,
    /// Leaves whose faces stand nearer somewhere than the clean-up tells apart, but further than faces that are meant to
    /// coincide; a leaf with itself where it is as thin as that by itself.
    pub films: BTreeMap<(u32, u32), Thin>,
    /// Leaves whose faces stand further apart than that, but nearer than anybody builds ([`crate::geom::tolerance::skin`]).
    pub skins: BTreeMap<(u32, u32), Thin>,
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

/// Where what two shapes leave is thin: a box around the places seen, and whether it is a film there, not a slit.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Thin {
    pub place: Aabb,
    pub film: bool,
}

impl Thin {
    pub fn add(&mut self, o: Thin) {
        *self = Thin { place: self.place.union(o.place), film: self.film | o.film };
    }
}

impl Seen {
    pub fn add(mut self, o: Seen) -> Seen {
        self.nothing.extend(o.nothing);
        self.crossed.extend(o.crossed);
        self.parts.extend(o.parts);
        for (pair, place) in o.shared {
            let known = self.shared.entry(pair).or_default();
            *known = known.union(place);
        }
        o.films.into_iter().for_each(|(pair, thin)| self.films.entry(pair).or_default().add(thin));
        o.skins.into_iter().for_each(|(pair, thin)| self.skins.entry(pair).or_default().add(thin));
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
