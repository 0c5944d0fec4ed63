//! The short way of a ray that meets few leaves, all of closed form, before its answer is known: each is asked as it comes in
//! sight and for the whole line, and truth is read from a table. It answers only where all that lies near the face it finds
//! crosses at one and the same t, so that the clean-up has no say; all other rays go the long way
//! ([`super::sweep`]), with the same answers.
//!
//! Its functions are inlined by force: each has two or three callers, which the compiler takes for too many, and a picture of
//! closed forms takes a twentieth fewer instructions so.

use super::bundle::Bundle;
use super::object::{Core, Scratch};
use super::room::Room;
use super::slots::{Few, Turn};
use super::spans::Boundary;
use super::truth::Truth;
use super::walk::Sight;
use glam::DVec3;

use crate::geom::{Interval, Ray, tolerance};
use crate::solid::{self, Cost};

/// What a look finds out.
enum Found<T> {
    /// The answer.
    Answer(T),
    /// Leaves that have not been met may have a say.
    More,
    /// The long way has to tell.
    Unclear,
}

/// A look along a ray.
pub(super) struct Look<'a> {
    core: &'a Core,
    ray: &'a Ray,
    range: Interval,
    room: &'a mut Room,
    scratch: &'a mut solid::Scratch,
    /// Every leaf that begins before this has been asked.
    known: f64,
    truths: Truths,
    /// The leaves that are inside in the room's state, once that is used.
    state: Option<u64>,
}

/// Where truth of the root is read for states of the leaves asked.
#[derive(Clone, Copy)]
enum Truths {
    /// Not known yet.
    Sought,
    /// From one of the room's, as far as that knows.
    Table(usize),
    /// From the room's state alone.
    State,
}

impl<'a> Look<'a> {
    /// `None` where the ray meets other leaves than closed forms at once.
    #[inline(always)]
    pub fn new(
        core: &'a Core,
        ray: &'a Ray,
        range: Interval,
        bundle: &Bundle,
        scratch: &'a mut Scratch,
    ) -> Option<Look<'a>> {
        let Scratch { solid: scratch, room, .. } = scratch;
        room.few.clear(core.id);
        let mut look = Look {
            core,
            ray,
            range,
            room,
            scratch,
            known: f64::INFINITY,
            truths: Truths::Sought,
            state: None,
        };
        if let Some(few) = bundle.few(core) {
            look.room.walk.begin_at_end();
            return few.iter().all(|leaf| look.take(*leaf)).then_some(look);
        }
        let Room { few, walk, .. } = &mut *look.room;
        walk.begin(&core.hierarchy, ray, range, |sight, leaf| show(core, few, sight, leaf));
        look.take_shown().then_some(look)
    }

    /// The first boundary in the range, and whether the ray goes in there; `None` where the long way has to tell.
    #[inline(always)]
    pub fn first(mut self) -> Option<Option<(Boundary, bool)>> {
        loop {
            let found = match self.begin() {
                Some((mask, from)) => self.change(mask, from),
                None => Found::More,
            };
            match found {
                Found::Answer(None) => return Some(None),
                Found::Answer(Some(turn)) => match self.alone(&turn) {
                    Found::Answer((met, normal)) => {
                        return Some(Some((self.boundary(&turn, met, normal), turn.entering)));
                    }
                    Found::More if self.meet_more() => {}
                    _ => return None,
                },
                Found::More if self.meet_more() => {}
                _ => return None,
            }
        }
    }

    /// Whether any part of the range is inside; `None` where the long way has to tell.
    #[inline(always)]
    pub fn any(mut self) -> Option<bool> {
        loop {
            let found = match self.begin() {
                Some((mask, _)) if self.inside(mask) => return Some(true),
                Some((mask, from)) => self.change(mask, from),
                None => Found::More,
            };
            match found {
                Found::Answer(None) => return Some(false),
                Found::Answer(Some(turn)) => match self.alone(&turn) {
                    Found::Answer(_) => return Some(true),
                    Found::More if self.meet_more() => {}
                    _ => return None,
                },
                Found::More if self.meet_more() => {}
                _ => return None,
            }
        }
    }

    /// Lets the hierarchy show leaves until one more has been asked; false where that is one too many or no closed form.
    #[inline(always)]
    fn meet_more(&mut self) -> bool {
        let count = self.room.few.count;
        while self.room.few.count == count && self.known < f64::INFINITY {
            let Room { few, walk, .. } = &mut *self.room;
            walk.step(&self.core.hierarchy, |sight, leaf| show(self.core, few, sight, leaf));
            if !self.take_shown() {
                return false;
            }
        }
        true
    }

    /// Asks the leaves in sight.
    #[inline(always)]
    fn take_shown(&mut self) -> bool {
        while let Some(leaf) = self.room.few.shown.pop() {
            if self.core.costs[leaf as usize] != Cost::Closed || !self.take(leaf) {
                return false;
            }
        }
        self.known = self.room.walk.least();
        if self.range.hi < self.known {
            self.known = f64::INFINITY;
        }
        self.truths = match self.truths {
            Truths::State => Truths::State,
            _ => Truths::Sought,
        };
        true
    }

    /// Asks a leaf and puts its crossings in order; false where there is no room. One that the line passes by needs none.
    #[inline(always)]
    fn take(&mut self, leaf: u32) -> bool {
        match self.core.tree.leaves()[leaf as usize].chord(self.ray, self.scratch) {
            Some(chord) if chord.is_none() => true,
            Some(chord) => self.room.few.keep(leaf, &chord),
            None => false,
        }
    }

    /// Whether it is inside where these leaves are.
    #[inline(always)]
    fn inside(&mut self, mask: u64) -> bool {
        if mask == 0 {
            return self.core.outside.root() == Truth::Yes;
        }
        if let Truths::Sought = self.truths {
            self.truths = self.room.table(self.core).map_or(Truths::State, Truths::Table);
        }
        let table = match self.truths {
            Truths::Table(table) => table,
            Truths::State | Truths::Sought => return self.inside_by_state(mask),
        };
        if let Some(told) = self.room.few.told(table, mask) {
            return told;
        }
        let inside = self.inside_by_state(mask);
        self.room.few.tell(table, mask, inside);
        inside
    }

    fn inside_by_state(&mut self, mask: u64) -> bool {
        let was = self.state.unwrap_or_else(|| {
            self.room.states_of(self.core);
            self.room.here.reset(&self.core.tree, &self.core.outside);
            0
        });
        let Room { few, here, .. } = &mut *self.room;
        for slot in (0..few.count).filter(|slot| (was ^ mask) >> slot & 1 == 1) {
            let truth = Truth::known(mask >> slot & 1 == 1);
            here.set(&self.core.tree, few.leaves[slot] as usize, truth);
        }
        self.state = Some(mask);
        here.root() == Truth::Yes
    }

    /// The leaves that the ray is inside of where its range begins, and how many crossings come before; `None` where others
    /// may begin before.
    #[inline(always)]
    fn begin(&self) -> Option<(u64, usize)> {
        if self.known <= self.range.lo {
            return None;
        }
        let (mut mask, mut before) = (self.room.few.inside, 0);
        for hit in self.room.few.hits().iter().take_while(|hit| hit.t <= self.range.lo) {
            mask ^= 1 << hit.slot;
            before += 1;
        }
        Some((mask, before))
    }

    /// The next change of truth in the range, from a crossing and the leaves before it on.
    #[inline(always)]
    fn change(&mut self, mut mask: u64, mut from: usize) -> Found<Option<Turn>> {
        let end = self.known.min(self.range.hi.next_up());
        let hits = self.room.few.hits();
        if hits.get(from).is_none_or(|hit| end <= hit.t) {
            // Nothing happens up to there, so the truth there need not be known.
            return if self.known < f64::INFINITY { Found::More } else { Found::Answer(None) };
        }
        let was = self.inside(mask);
        while from < self.room.few.hit_count {
            let hits = self.room.few.hits();
            let t = hits[from].t;
            if end <= t {
                break;
            }
            let (before, mut to) = (mask, from);
            while to < hits.len() && hits[to].t == t {
                let bit = 1 << hits[to].slot;
                if to != from && (mask ^ before) & bit != 0 {
                    // It comes and goes at once.
                    return Found::Unclear;
                }
                mask ^= bit;
                to += 1;
            }
            if self.inside(mask) != was {
                return Found::Answer(Some(Turn { from, to, before, after: mask, entering: !was }));
            }
            from = to;
        }
        if self.known < f64::INFINITY { Found::More } else { Found::Answer(None) }
    }

    /// The crossing that stands for a change.
    #[inline(always)]
    fn met(&self, turn: &Turn) -> usize {
        if turn.from + 1 == turn.to {
            return turn.from;
        }
        let key = |hit: &usize| {
            let leaf = self.room.few.leaves[self.room.few.hits()[*hit].slot as usize];
            (self.core.tree.leaves()[leaf as usize].key(), leaf)
        };
        (turn.from..turn.to).min_by_key(key).unwrap_or(turn.from)
    }

    /// The outward unit normal of the leaf of a crossing, world frame.
    #[inline(always)]
    fn normal(&mut self, hit: usize) -> DVec3 {
        let hit = self.room.few.hits()[hit];
        let (slot, crossing) = (hit.slot, hit.crossing());
        let leaf = &self.core.tree.leaves()[self.room.few.leaves[slot as usize] as usize];
        leaf.normal_along(self.ray, &crossing, self.scratch)
    }

    /// Whether nothing but what crosses at a change lies so near that the clean-up or the choice of an owner would look at it,
    /// or at what fills the point just inside: the normal of what stands for the change.
    #[inline(always)]
    fn alone(&mut self, turn: &Turn) -> Found<(usize, DVec3)> {
        let met = self.met(turn);
        let normal = self.normal(met);
        let (core, hits) = (self.core, self.room.few.hits());
        let t = hits[turn.from].t;
        let is_far = far_at(core, self.ray, t, normal);
        let before = turn.from == 0 || is_far(t - hits[turn.from - 1].t);
        let behind = hits.get(turn.to).is_none_or(|next| is_far(next.t - t));
        if !before || !behind || !is_far(f64::INFINITY) {
            return Found::Unclear;
        }
        if is_far(self.known - t) { Found::Answer((met, normal)) } else { Found::More }
    }

    /// The boundary at a change that is alone.
    #[inline(always)]
    fn boundary(&mut self, turn: &Turn, met: usize, normal: DVec3) -> Boundary {
        let tied = 1 < turn.to - turn.from;
        self.scratch.counts.ties += u64::from(tied);
        let owner = if tied { self.room.owner(self.core, turn) } else { met };
        let normal = if owner == met { normal } else { self.normal(owner) };
        let (core, hit) = (self.core, self.room.few.hits()[owner]);
        let (slot, crossing) = (hit.slot, hit.crossing());
        let leaf = self.room.few.leaves[slot as usize];
        let within = if turn.entering { turn.after } else { turn.before };
        let filler = match core.tree.leaves()[leaf as usize].material {
            Some(_) => None,
            None => self.room.filler(core, within),
        };
        let flipped = crossing.entering != turn.entering;
        let normal = if flipped { -normal } else { normal };
        Boundary { t: crossing.t, leaf: core.first(leaf), crossing, normal, flipped, filler }
    }
}

/// Whether so long a stretch of a ray, in multiples of its direction, is longer than any clean-up about a crossing at `t` with
/// this normal reaches: of no less than the lengths that the long way takes.
#[inline(always)]
pub(super) fn far_at(core: &Core, ray: &Ray, t: f64, normal: DVec3) -> impl Fn(f64) -> bool + use<> {
    let length = |v: DVec3| v.abs().element_sum();
    let (scale, point) = (core.bound.scale.max(length(ray.origin)), length(ray.at(t)));
    let reach = 2.0 * core.bound.shift + tolerance::cleanup(scale) + tolerance::cleanup(point);
    let slope = ray.dir.dot(normal).abs();
    // Of lengths along the normal: a product sooner than a quotient by a slope, which may be none.
    move |stretch| 2.0 * reach < stretch * slope
}

/// A leaf comes in sight. A closed form is asked sooner than its box is tried.
#[inline]
fn show(core: &Core, few: &mut Few, sight: &Sight, leaf: u32) {
    if core.costs[leaf as usize] == Cost::Closed || sight.inside(&core.hierarchy, leaf).is_some() {
        few.shown.push(leaf);
    }
}
