//! What one test line after another sees: faces that stand near each other, and what holds on the stretches between.

use glam::DVec3;

use super::lines::{self, Event};
use super::logic::{Logic, State};
use super::seen::{Near, Seen, Spread};
use crate::csg::Object;
use crate::geom::{Aabb, Ray, tolerance};
use crate::prepare::{Cutting, Outline};
use crate::solid::Scratch;
use crate::source::Span;

/// Each of many faces at one place is held against so many after it: of a hundred copies each is near some.
const TOGETHER: usize = 12;
/// A line that meets faces at less than this, the sine of the angle, grazes a round shape, and is in it for a short way only,
/// whose thickness is the square of that.
const GRAZING: f64 = 0.01;
/// Of more cutters at one place it is not kept which.
const ALIKE: usize = 6;

/// Looks along lines.
pub(super) struct Witness<'a> {
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
    /// Leaves and solids drawn that a line was inside.
    crossed: Vec<bool>,
    parts: Vec<bool>,
    /// Shapes of cutters that a line was inside where it was inside what they cut.
    biting: Vec<bool>,
    /// Nodes evaluated.
    pub steps: u64,
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
    /// Nothing seen yet; `eye` is how far from the origin the rays of the picture begin.
    pub fn new(object: &'a Object, outline: &'a Outline, logic: &'a Logic, eye: f64) -> Witness<'a> {
        Witness {
            object,
            outline,
            logic,
            eye,
            seen: Seen::default(),
            inside: vec![false; object.leaves().len()],
            events: Vec::new(),
            state: State::default(),
            scratch: Scratch::default(),
            cuts: outline.cuts.iter().map(CutSeen::new).collect(),
            meetings: vec![false; outline.meetings.len()],
            crossed: vec![false; object.leaves().len()],
            parts: vec![false; outline.parts.len()],
            biting: vec![false; object.leaves().len()],
            steps: 0,
        }
    }

    /// All that was seen, operands of cuts by their places.
    pub fn finish(self) -> Seen {
        let mut seen = self.seen;
        let those = |list: Vec<bool>| (0..).zip(list).filter(|(_, is)| *is).map(|(i, _)| i);
        seen.crossed.extend(those(self.crossed));
        seen.parts.extend(those(self.parts));
        seen.biting.extend(those(self.biting));
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

    pub fn look(&mut self, ray: &Ray) {
        lines::ask(self.object, ray, &mut self.inside, &mut self.events, &mut self.scratch);
        let events = std::mem::take(&mut self.events);
        self.steps += (events.len() as u64 + 1) * self.logic.len() as u64;
        self.faces(&events, ray);
        self.stretches(&events, ray);
        self.events = events;
    }

    /// Pairs of faces too near to be told apart.
    fn faces(&mut self, events: &[Event], ray: &Ray) {
        for (i, a) in events.iter().enumerate() {
            for b in events[i + 1..].iter().take(TOGETHER) {
                let Some(near) = self.thin(a, b, ray) else {
                    break;
                };
                if a.leaf != b.leaf && !self.is_one_cutter([a.leaf, b.leaf]) {
                    self.seen.shared.entry(pair(a, b)).or_default().add(near);
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

    /// What two crossings are where what lies between them is nothing to the clean-up of set algebra.
    fn thin(&self, a: &Event, b: &Event, ray: &Ray) -> Option<Near> {
        self.within(a, b, ray, self.margin(a, b, ray, (self.eye, tolerance::cleanup)))
    }

    /// How far apart two crossings may stand, along a normal, by a tolerance of the scale in play, at least so large.
    fn margin(&self, a: &Event, b: &Event, ray: &Ray, (least, tolerance): (f64, fn(f64) -> f64)) -> f64 {
        let leaves = [a, b].map(|e| &self.object.leaves()[e.leaf as usize]);
        let scale = ray.origin.length().max(ray.at(a.t).length().min(ray.at(b.t).length()));
        let scale = scale.max(leaves[0].scale()).max(leaves[1].scale()).max(least);
        let error = a.crossing.shift * leaves[0].place.stretch + b.crossing.shift * leaves[1].place.stretch;
        tolerance(scale) + error
    }

    /// What two crossings are that stand no further apart, along a normal, than a margin.
    fn within(&self, a: &Event, b: &Event, ray: &Ray, margin: f64) -> Option<Near> {
        let thickness = (b.t - a.t) * ray.dir.length() * a.slope.max(b.slope);
        (thickness <= margin).then(|| {
            let (i, j) = pair(a, b);
            let boxes = [i, j].map(|leaf| self.object.leaves()[leaf as usize].bounds);
            let finite = || boxes.iter().filter(|bounds| bounds.is_finite());
            // A line is as long as what it looks at, and begins there.
            let far = || ray.origin.length() + ray.dir.length();
            let size = finite().map(Aabb::diagonal).reduce(f64::min).unwrap_or_else(far);
            let about = finite().next().map_or(DVec3::ZERO, Aabb::center);
            let is_along = a.normal.cross(b.normal).length() <= tolerance::run_along(margin, size);
            let along = if is_along { Spread::of(ray.at(a.t) - about) } else { Spread::default() };
            Near { margin, size, seen: 1, along, film: false }
        })
    }

    /// Whether a thin stretch is a film: of one leaf, or thicker than faces that are meant to coincide leave it.
    fn is_film(&self, a: &Event, b: &Event, ray: &Ray) -> bool {
        a.leaf == b.leaf || self.within(a, b, ray, self.margin(a, b, ray, (0.0, tolerance::film))).is_none()
    }

    /// The size that the thickness of what two leaves leave is held against: of the larger, or how far they reach.
    fn size(&self, pair: [u32; 2]) -> f64 {
        let leaves = pair.map(|i| &self.object.leaves()[i as usize]);
        let sizes = leaves.map(|leaf| leaf.bounds.diagonal()).into_iter().filter(|size| size.is_finite());
        sizes.reduce(f64::max).unwrap_or_else(|| leaves[0].scale().max(leaves[1].scale()))
    }

    /// What a stretch is that is not thin to the clean-up, but thinner than anybody builds of two: one shape as thin was
    /// written so.
    fn skin(&self, a: &Event, b: &Event, ray: &Ray) -> Option<Near> {
        let plain = GRAZING < a.slope.max(b.slope) && a.leaf != b.leaf;
        let margin = tolerance::skin(self.size([a.leaf, b.leaf]));
        self.within(a, b, ray, margin).filter(|_| plain)
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
            let both = before.zip(after);
            let thin = both.and_then(|(a, b)| Some((pair(a, b), self.thin(a, b, ray)?)));
            let film = thin.filter(|_| both.is_some_and(|(a, b)| self.is_film(a, b, ray)));
            let skin = both.filter(|_| thin.is_none());
            let skin = skin.and_then(|(a, b)| Some((pair(a, b), self.skin(a, b, ray)?)));
            for (follower, found, seen) in
                [(&mut films, film, &mut self.seen.films), (&mut skins, skin, &mut self.seen.skins)]
            {
                if let Some((pair, near)) = follower.next(any, found) {
                    seen.entry(pair).or_default().add(Near { film: !any, ..near });
                }
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
        self.crossed.iter_mut().zip(&self.inside).for_each(|(crossed, inside)| *crossed |= inside);
        let parts = self.logic.parts.iter().zip(0..).filter(|(node, _)| holds[**node as usize]);
        let parts: Vec<u32> = parts.map(|(_, part)| part).collect();
        for (k, a) in parts.iter().enumerate() {
            for b in &parts[k + 1..] {
                let known = seen.overlaps.entry((*a, *b)).or_default();
                *known = ends.into_iter().fold(*known, Aabb::including);
            }
        }
        parts.iter().for_each(|part| self.parts[*part as usize] = true);
        for (found, node) in self.meetings.iter_mut().zip(&self.logic.meetings) {
            *found |= node.is_some_and(|n| holds[n as usize]);
        }
        for (found, nodes) in self.cuts.iter_mut().zip(&self.logic.cuts) {
            let held = |node: &Option<u32>| node.is_some_and(|n| holds[n as usize]);
            let in_base = held(&nodes.base);
            found.base |= in_base;
            if in_base || nodes.base.is_none() {
                let shapes = nodes.shapes.iter().map(|(node, _)| self.logic.leaf(*node) as usize);
                shapes.filter(|i| self.inside[*i]).for_each(|i| self.biting[i] = true);
            }
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

/// The leaves of two crossings.
fn pair(a: &Event, b: &Event) -> (u32, u32) {
    (a.leaf.min(b.leaf), a.leaf.max(b.leaf))
}

/// A stretch between faces near each other: their leaves, and how they stand.
type Stretch = ((u32, u32), Near);

/// Follows the truth along a line for films and slits: stretches that differ from both neighbours, which are alike.
#[derive(Default)]
struct Films {
    /// The truth before the film, and the film.
    open: Option<(bool, Stretch)>,
    before: Option<bool>,
}

impl Films {
    /// The next stretch: its truth, and how its ends stand if it is thin. Returns a film that ended here.
    fn next(&mut self, holds: bool, thin: Option<Stretch>) -> Option<Stretch> {
        let open = self.open.take();
        let found = open.filter(|(before, _)| *before == holds).map(|(_, film)| film);
        if let (Some(before), Some(film)) = (self.before, thin)
            && before != holds
        {
            self.open = Some((before, film));
        }
        self.before = Some(holds);
        found
    }
}
