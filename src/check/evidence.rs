//! What test lines saw of a world, summed over all of them; sums do not depend on their order.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use rayon::prelude::*;

use super::closer;
use super::lines::{self, Event};
use super::logic::{Logic, State};
use crate::csg::{Leaf, Object};
use crate::geom::{Aabb, Ray, tolerance};
use crate::prepare::{Cutting, Outline};
use crate::solid::Scratch;
use crate::source::Span;

/// What was seen.
#[derive(Debug)]
pub struct Evidence<'a> {
    /// The leaves.
    pub(super) leaves: &'a [Leaf],
    /// Where they were written.
    pub(super) outline: &'a Outline,
    pub(super) seen: Seen,
}

/// Sums over lines. Leaves, solids drawn and cuts by their index; operands of cuts by the place in the text, as one text
/// may come to many solids.
#[derive(Debug, Default)]
pub(super) struct Seen {
    /// Leaves that are nothing ([`closer::nothing`]).
    pub nothing: BTreeSet<u32>,
    /// Leaves that a line crossed, with some thickness.
    pub crossed: BTreeSet<u32>,
    /// Solids drawn that a line was inside.
    pub parts: BTreeSet<u32>,
    /// Pairs of leaves whose faces coincide, and a box around where they were seen to.
    pub shared: BTreeMap<(u32, u32), Aabb>,
    /// Leaves whose faces stand nearer somewhere than the clean-up tells apart, but further than faces that are meant to
    /// coincide; a leaf with itself where it is as thin as that by itself. Whether it is a film there, not a slit.
    pub films: BTreeMap<(u32, u32), bool>,
    /// Leaves whose faces stand further apart than that, but nearer than anybody builds ([`tolerance::skin`]): a box around
    /// where, and whether it is a film there.
    pub skins: BTreeMap<(u32, u32), (Aabb, bool)>,
    /// Pairs of solids drawn, and a box around where lines were inside both.
    pub overlaps: BTreeMap<(u32, u32), Aabb>,
    /// Sheets that are nothing ([`closer::nothing_open`]).
    pub gone: BTreeSet<u32>,
    /// Intersections and symmetric differences that a line was inside.
    pub meetings: BTreeSet<Span>,
    /// Cutters that took something away.
    pub cutting: BTreeSet<Span>,
    /// Operands of cuts, intersections, symmetric differences and solids drawn that seemed to do nothing, or to be nothing, and were looked at closer.
    pub looked_at: BTreeSet<Span>,
    pub looked_at_parts: BTreeSet<u32>,
    /// Bases that a line was inside.
    pub bases: BTreeSet<Span>,
    /// Bases of which something was left.
    pub left: BTreeSet<Span>,
    /// Cutters that did not hold somewhere in their base.
    pub uncovering: BTreeSet<Span>,
    /// Cutters that cut the same: what their bases lost where none of them was needed, as the others cut it too. In the order
    /// of the text, at most [`ALIKE`] each.
    pub alike: BTreeSet<Vec<Span>>,
}

impl Seen {
    fn add(mut self, o: Seen) -> Seen {
        self.nothing.extend(o.nothing);
        self.crossed.extend(o.crossed);
        self.parts.extend(o.parts);
        for (pair, place) in o.shared {
            let known = self.shared.entry(pair).or_default();
            *known = known.union(place);
        }
        o.films.into_iter().for_each(|(pair, film)| *self.films.entry(pair).or_default() |= film);
        for (pair, (place, film)) in o.skins {
            let known = self.skins.entry(pair).or_default();
            *known = (known.0.union(place), known.1 | film);
        }
        self.gone.extend(o.gone);
        for (pair, place) in o.overlaps {
            let known = self.overlaps.entry(pair).or_default();
            *known = known.union(place);
        }
        self.meetings.extend(o.meetings);
        self.cutting.extend(o.cutting);
        self.bases.extend(o.bases);
        self.left.extend(o.left);
        self.uncovering.extend(o.uncovering);
        self.alike.extend(o.alike);
        self
    }
}

/// Of more cutters at one place it is not kept which.
const ALIKE: usize = 6;

/// Lines that one task looks at.
const BATCH: usize = 64;

impl<'a> Evidence<'a> {
    /// Casts all test lines; `sheets` are those beside the solids, `eye` is how far from the origin the rays of the picture
    /// begin.
    pub fn gather(object: &'a Object, outline: &'a Outline, sheets: &[Leaf], eye: f64) -> Evidence<'a> {
        let logic = Logic::new(outline);
        let lines = lines::lines(object, outline, logic.len());
        let look = |batch: &[Ray]| {
            let mut witness = Witness { eye, ..Witness::new(object, outline, &logic) };
            batch.iter().for_each(|line| witness.look(line));
            witness.finish()
        };
        let all = |lines: &[Ray]| -> Vec<Seen> { lines.par_chunks(BATCH).map(look).collect() };
        let mut seen = all(&lines).into_iter().fold(Seen::default(), Seen::add);
        let closer = closer::closer(object, outline, logic.len(), &seen);
        seen = all(&closer.rays).into_iter().fold(seen, Seen::add);
        (seen.looked_at, seen.looked_at_parts) = (closer.pieces, closer.parts);
        seen.nothing.extend(closer::nothing(object, &seen));
        seen.gone.extend(closer::nothing_open(sheets));
        Evidence { leaves: object.leaves(), outline, seen }
    }
}

/// Looks along lines.
struct Witness<'a> {
    object: &'a Object,
    outline: &'a Outline,
    logic: &'a Logic,
    /// How far from the origin the rays of the picture begin: what is thin to the clean-up is thin to theirs.
    eye: f64,
    seen: Seen,
    inside: Vec<bool>,
    events: Vec<Event>,
    state: State,
    scratch: Scratch,
    cuts: Vec<CutSeen>,
    meetings: Vec<bool>,
}

/// What was seen of a cut.
#[derive(Clone, Debug, Default)]
struct CutSeen {
    /// Whether a line was inside the base, and whether something was left of it there.
    base: bool,
    left: bool,
    /// For each cutter whether it took something away, and whether it did not hold somewhere in the base.
    cutters: Vec<[bool; 2]>,
}

impl<'a> Witness<'a> {
    fn new(object: &'a Object, outline: &'a Outline, logic: &'a Logic) -> Witness<'a> {
        Witness {
            object,
            outline,
            logic,
            eye: 0.0,
            seen: Seen::default(),
            inside: vec![false; object.leaves().len()],
            events: Vec::new(),
            state: State::default(),
            scratch: Scratch::default(),
            cuts: outline.cuts.iter().map(CutSeen::new).collect(),
            meetings: vec![false; outline.meetings.len()],
        }
    }

    /// All that was seen, operands of cuts by their places.
    fn finish(self) -> Seen {
        let mut seen = self.seen;
        let met = self.outline.meetings.iter().zip(&self.meetings).filter(|(_, held)| **held);
        seen.meetings.extend(met.map(|(meeting, _)| meeting.at));
        for (cut, found) in self.outline.cuts.iter().zip(&self.cuts) {
            let base = cut.base.as_ref().map(|base| base.at);
            seen.bases.extend(base.filter(|_| found.base));
            seen.left.extend(base.filter(|_| found.left));
            for (cutter, [cutting, uncovering]) in cut.cutters.iter().zip(&found.cutters) {
                seen.cutting.extend(cutting.then_some(cutter.at));
                seen.uncovering.extend(uncovering.then_some(cutter.at));
            }
        }
        seen
    }

    fn look(&mut self, ray: &Ray) {
        lines::ask(self.object, ray, &mut self.inside, &mut self.events, &mut self.scratch);
        let events = std::mem::take(&mut self.events);
        self.faces(&events, ray);
        self.stretches(&events, ray);
        self.events = events;
    }

    /// Pairs of faces too near to be told apart.
    fn faces(&mut self, events: &[Event], ray: &Ray) {
        for (i, a) in events.iter().enumerate() {
            for b in &events[i + 1..] {
                if !self.is_thin(a, b, ray) {
                    break;
                }
                if a.leaf != b.leaf && !self.is_one_cutter([a.leaf, b.leaf]) {
                    let pair = (a.leaf.min(b.leaf), a.leaf.max(b.leaf));
                    let place = self.seen.shared.entry(pair).or_default();
                    *place = place.including(ray.at(a.t));
                }
            }
        }
    }

    /// Whether two leaves are one cutter, taken from two solids drawn.
    fn is_one_cutter(&self, pair: [u32; 2]) -> bool {
        let [a, b] = pair.map(|i| &self.object.leaves()[i as usize]);
        let calls = pair.map(|i| self.outline.calls[i as usize]);
        let places = [a, b].map(|leaf| leaf.place.world_from_local);
        let part = |i: u32| self.outline.parts.iter().position(|part| part.leaves.contains(&i));
        let is_same = a.cutter && b.cutter && calls[0] == calls[1] && places[0] == places[1];
        is_same && part(pair[0]) != part(pair[1])
    }

    /// Whether what lies between two crossings is nothing to the clean-up of set algebra.
    fn is_thin(&self, a: &Event, b: &Event, ray: &Ray) -> bool {
        self.is_within(a, b, ray, (self.eye, tolerance::cleanup))
    }

    /// Whether two crossings stand no further apart, along a normal, than a tolerance of the scale in play, at least so large.
    fn is_within(&self, a: &Event, b: &Event, ray: &Ray, (least, tolerance): (f64, fn(f64) -> f64)) -> bool {
        let leaves = [a, b].map(|e| &self.object.leaves()[e.leaf as usize]);
        let scale = ray.origin.length().max(ray.at(a.t).length().min(ray.at(b.t).length()));
        let scale = scale.max(leaves[0].scale()).max(leaves[1].scale()).max(least);
        let error = a.crossing.shift * leaves[0].place.stretch + b.crossing.shift * leaves[1].place.stretch;
        let thickness = (b.t - a.t) * ray.dir.length() * a.slope.max(b.slope);
        thickness <= tolerance(scale) + error
    }

    /// The leaves of a thin stretch that is a film: of one leaf, or thicker than faces that are meant to coincide leave it.
    fn film_of(&self, a: &Event, b: &Event, ray: &Ray) -> Option<(u32, u32)> {
        let built = a.leaf == b.leaf || !self.is_within(a, b, ray, (0.0, tolerance::film));
        built.then_some((a.leaf.min(b.leaf), a.leaf.max(b.leaf)))
    }

    /// The size that the thickness of what two leaves leave is held against: of the larger, or how far they reach.
    fn size(&self, pair: [u32; 2]) -> f64 {
        let leaves = pair.map(|i| &self.object.leaves()[i as usize]);
        let sizes = leaves.map(|leaf| leaf.bounds.diagonal()).into_iter().filter(|size| size.is_finite());
        sizes.reduce(f64::max).unwrap_or_else(|| leaves[0].scale().max(leaves[1].scale()))
    }

    /// The leaves of a stretch that is not thin to the clean-up, but thinner than anybody builds of two: one shape as thin
    /// was written so.
    fn skin_of(&self, a: &Event, b: &Event, ray: &Ray) -> Option<(u32, u32)> {
        let thickness = (b.t - a.t) * ray.dir.length() * a.slope.max(b.slope);
        let is_skin = a.leaf != b.leaf && thickness <= tolerance::skin(self.size([a.leaf, b.leaf]));
        is_skin.then_some((a.leaf.min(b.leaf), a.leaf.max(b.leaf)))
    }

    /// The stretches between crossings, the unbounded ones included.
    fn stretches(&mut self, events: &[Event], ray: &Ray) {
        let (mut films, mut skins) = (Films::default(), Films::default());
        for i in 0..=events.len() {
            let (before, after) = (i.checked_sub(1).map(|i| &events[i]), events.get(i));
            if let Some(event) = before {
                self.inside[event.leaf as usize] = event.crossing.entering;
            }
            if before.zip(after).is_some_and(|(a, b)| a.t == b.t) {
                continue;
            }
            self.logic.evaluate(&self.inside, &mut self.state);
            let any = self.logic.parts.iter().any(|p| self.state.holds[*p as usize]);
            let thin = before.zip(after).filter(|(a, b)| self.is_thin(a, b, ray));
            let film = thin.and_then(|(a, b)| self.film_of(a, b, ray));
            if let Some(pair) = films.next(any, film) {
                *self.seen.films.entry(pair).or_default() |= !any;
            }
            let skin = before.zip(after).filter(|_| thin.is_none());
            let skin = skin.and_then(|(a, b)| self.skin_of(a, b, ray));
            if let (Some(pair), Some(at)) = (skins.next(any, skin), before) {
                let (place, film) = self.seen.skins.entry(pair).or_default();
                (*place, *film) = (place.including(ray.at(at.t)), *film | !any);
            }
            if thin.is_none() {
                let end = |e: Option<&Event>, none: f64| e.map_or(DVec3::splat(none), |e| ray.at(e.t));
                self.stretch([end(before, f64::NEG_INFINITY), end(after, f64::INFINITY)]);
            }
        }
    }

    /// A stretch with some thickness, between two points.
    fn stretch(&mut self, ends: [DVec3; 2]) {
        let (seen, holds) = (&mut self.seen, &self.state.holds);
        let inside = self.inside.iter().enumerate().filter(|(_, inside)| **inside);
        seen.crossed.extend(inside.map(|(leaf, _)| leaf as u32));
        let parts = self.logic.parts.iter().zip(0..).filter(|(node, _)| holds[**node as usize]);
        let parts: Vec<u32> = parts.map(|(_, part)| part).collect();
        for (k, a) in parts.iter().enumerate() {
            for b in &parts[k + 1..] {
                let known = seen.overlaps.entry((*a, *b)).or_default();
                *known = ends.into_iter().fold(*known, Aabb::including);
            }
        }
        seen.parts.extend(parts);
        for (found, node) in self.meetings.iter_mut().zip(&self.logic.meetings) {
            *found |= node.is_some_and(|n| holds[n as usize]);
        }
        for (found, nodes) in self.cuts.iter_mut().zip(&self.logic.cuts) {
            let held = |node: &Option<u32>| node.is_some_and(|n| holds[n as usize]);
            let in_base = held(&nodes.base);
            found.base |= in_base;
            found.left |= in_base && !nodes.cutters.iter().any(held);
            for ([cutting, uncovering], node) in found.cutters.iter_mut().zip(&nodes.cutters) {
                *cutting |= node.is_some_and(|n| holds[n as usize] && self.state.tells[n as usize]);
                *uncovering |= in_base && !held(node);
            }
        }
        self.seen.alike.extend(self.alike());
    }
}

impl Witness<'_> {
    /// The cutters that hold here, where each of them could be left out, and one of them cuts its base.
    fn alike(&self) -> Option<Vec<Span>> {
        let State { holds, tells, .. } = &self.state;
        let (mut all, mut cuts) = (Vec::new(), false);
        for (nodes, cut) in self.logic.cuts.iter().zip(&self.outline.cuts) {
            let in_base = nodes.base.is_none_or(|n| holds[n as usize]);
            for (node, piece) in nodes.cutters.iter().zip(&cut.cutters) {
                let Some(n) = node.filter(|n| holds[*n as usize]) else { continue };
                if tells[n as usize] || all.len() == ALIKE {
                    return None;
                }
                all.push(piece.at);
                cuts |= in_base;
            }
        }
        all.sort_unstable();
        (cuts && 1 < all.len()).then_some(all)
    }
}

impl CutSeen {
    fn new(cut: &Cutting) -> CutSeen {
        CutSeen { cutters: vec![[false; 2]; cut.cutters.len()], ..CutSeen::default() }
    }
}

/// Follows the truth along a line for films and slits: stretches that differ from both neighbours, which are alike.
#[derive(Default)]
struct Films {
    /// The truth before the film, and the leaves whose faces bound it.
    open: Option<(bool, (u32, u32))>,
    before: Option<bool>,
}

impl Films {
    /// The next stretch: its truth, and the leaves whose faces bound it if it is thin. Returns the leaves of a film that
    /// ended here.
    fn next(&mut self, holds: bool, thin_of: Option<(u32, u32)>) -> Option<(u32, u32)> {
        let open = self.open.take();
        let found = open.filter(|(before, _)| *before == holds).map(|(_, leaves)| leaves);
        if let (Some(before), Some(leaves)) = (self.before, thin_of)
            && before != holds
        {
            self.open = Some((before, leaves));
        }
        self.before = Some(holds);
        found
    }
}
