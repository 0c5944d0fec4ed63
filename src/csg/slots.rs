//! What a ray meets while it meets little: its leaves in slots, all their crossings in order, and tables of truth for
//! leaves that are met together again and again.

use super::object::Core;
use super::room::Room;
use super::truth::{State, Truth};
use crate::solid::{Chord, Crossing};

/// Of more leaves than this a first surface makes most needless, which the long way finds out.
const FEW: usize = 16;
/// Closed forms are convex: a line crosses each at most twice.
const MOST: usize = 2 * FEW;
/// All states of so many leaves are the bits of a word.
const IN_A_WORD: usize = 6;
/// Of more leaves than this truth is not kept.
const TABLED: usize = 8;
const WORDS: usize = 1 << (TABLED - IN_A_WORD);

/// The leaves that a ray meets, as they came; places past the last hold anything.
type Leaves = [u32; FEW];

/// Truth of an object's root for states of some leaves, all others outside, as far as it has been asked for.
#[derive(Clone, Copy, Debug)]
struct Table {
    tree: u64,
    leaves: Leaves,
    count: usize,
    /// Bit i: whether it is known for the leaves that have a bit in i, and what it is.
    known: [u64; WORDS],
    root: [u64; WORDS],
}

impl Table {
    const NONE: Table = Table { tree: 0, leaves: [0; FEW], count: 0, known: [0; WORDS], root: [0; WORDS] };

    fn is_of(&self, tree: u64, leaves: &[u32]) -> bool {
        self.tree == tree && &self.leaves[..self.count] == leaves
    }
}

/// Neighbouring rays mostly meet the same leaves.
const TABLES: usize = 256;
/// An odd number without a pattern (the golden ratio's digits, Knuth's multiplicative hashing).
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;

/// A crossing of one of the leaves met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub t: f64,
    /// [`Crossing::part`].
    part: u32,
    /// Of the leaves met, which.
    pub slot: u8,
    /// Whether the ray goes into that leaf.
    pub entering: bool,
}

impl Hit {
    /// As the leaf would tell it.
    #[inline]
    pub fn crossing(&self) -> Crossing {
        Crossing::exact(self.t, self.entering, self.part)
    }
}

/// Where truth changes: at crossings that all have one t.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Their places in the order, half-open.
    pub from: usize,
    pub to: usize,
    /// The leaves that the ray is inside of before and after.
    pub before: u64,
    pub after: u64,
    /// Whether the ray goes into the object.
    pub entering: bool,
}

/// Room for the short way, lent by a thread.
#[derive(Debug)]
pub(super) struct Few {
    pub leaves: Leaves,
    pub count: usize,
    /// Of the object and these leaves.
    hash: u64,
    /// Leaves in sight and not asked yet.
    pub shown: Vec<u32>,
    /// Bit i: whether the line comes from inside the leaf in slot i.
    pub inside: u64,
    /// Ascending.
    hits: [Hit; MOST],
    pub hit_count: usize,
    /// None until the first is asked for.
    tables: Vec<Table>,
}

impl Default for Few {
    fn default() -> Few {
        Few {
            leaves: [0; FEW],
            count: 0,
            hash: 0,
            shown: Vec::new(),
            inside: 0,
            hits: [Hit { t: 0.0, part: 0, slot: 0, entering: false }; MOST],
            hit_count: 0,
            tables: Vec::new(),
        }
    }
}

impl Room {
    /// Where truth of the root is kept for the leaves met; `None` where they are too many.
    #[inline]
    pub fn table(&mut self, core: &Core) -> Option<usize> {
        let few = &mut self.few;
        if TABLED < few.count {
            return None;
        }
        if few.tables.is_empty() {
            few.tables = vec![Table::NONE; TABLES];
        }
        let which = (few.hash >> 56) as usize;
        let table = &mut few.tables[which];
        if !table.is_of(core.id, &few.leaves[..few.count]) {
            *table = Table { tree: core.id, leaves: few.leaves, count: few.count, ..Table::NONE };
        }
        Some(which)
    }

    /// Of leaves that all cross where truth changes, the one that owns the face, by its place among the crossings: of those
    /// that take part the one with the smallest key ([`super::owner`]).
    pub fn owner(&mut self, core: &Core, turn: &Turn) -> usize {
        self.states_of(core);
        self.few.put(core, turn.before, &mut self.before);
        self.few.put(core, turn.after, &mut self.here);
        let leaves = core.tree.leaves();
        let leaf = |hit: usize| self.few.leaves[self.few.hits[hit].slot as usize];
        let makes = |hit: usize| self.here.differs(&self.before, &core.tree, leaf(hit) as usize);
        let fits = |hit: usize| {
            let entering = self.few.hits[hit].entering;
            core.tree.negated[leaf(hit) as usize].is_none_or(|not| (entering != not) == turn.entering)
        };
        let key = |hit: &usize| (leaves[leaf(*hit) as usize].key(), leaf(*hit));
        let all = || turn.from..turn.to;
        let first = all().min_by_key(key).unwrap_or(turn.from);
        if makes(first) {
            return first;
        }
        all().filter(|hit| fits(*hit) && makes(*hit)).min_by_key(key).unwrap_or(first)
    }

    /// Of the leaves with a material that fill the object where these leaves are, the last written.
    #[inline]
    pub fn filler(&mut self, core: &Core, mask: u64) -> Option<u32> {
        let (leaves, slots, met) = (core.tree.leaves(), 0..self.few.count, self.few.leaves);
        let inside = slots.filter(|slot| mask >> slot & 1 == 1).map(|slot| met[slot]);
        let can = |leaf: &u32| leaves[*leaf as usize].can_fill();
        if !inside.clone().any(|leaf| can(&leaf)) {
            return None;
        }
        self.states_of(core);
        self.few.put(core, mask, &mut self.here);
        let state = &self.here;
        let fill = inside.filter(can).filter(|leaf| state.fills(&core.tree, *leaf as usize));
        fill.max_by_key(|leaf| (core.tree.last[*leaf as usize], *leaf)).map(|leaf| core.first(leaf))
    }
}

impl Few {
    /// Truth of the root where these leaves are inside, if a table knows.
    #[inline]
    pub fn told(&self, table: usize, mask: u64) -> Option<bool> {
        let (word, bit) = ((mask >> IN_A_WORD) as usize, mask & 63);
        let Table { known, root, .. } = &self.tables[table];
        (known[word] >> bit & 1 == 1).then_some(root[word] >> bit & 1 == 1)
    }

    /// Keeps it.
    pub fn tell(&mut self, table: usize, mask: u64, inside: bool) {
        let (word, bit) = ((mask >> IN_A_WORD) as usize, mask & 63);
        self.tables[table].known[word] |= 1 << bit;
        self.tables[table].root[word] |= u64::from(inside) << bit;
    }

    #[inline]
    pub fn clear(&mut self, tree: u64) {
        (self.count, self.hash) = (0, tree.wrapping_mul(MIX));
        (self.inside, self.hit_count) = (0, 0);
        self.shown.clear();
    }

    /// Makes a state in which the leaves in these slots are inside.
    fn put(&self, core: &Core, mask: u64, state: &mut State) {
        state.reset(&core.tree, &core.outside);
        for slot in (0..self.count).filter(|slot| mask >> slot & 1 == 1) {
            state.set(&core.tree, self.leaves[slot] as usize, Truth::Yes);
        }
    }

    #[inline]
    pub fn hits(&self) -> &[Hit] {
        &self.hits[..self.hit_count]
    }

    /// Keeps a leaf with the ends of its chord; false where there is no room for it.
    #[inline(always)]
    pub fn keep(&mut self, leaf: u32, chord: &Chord) -> bool {
        let slot = self.count;
        if slot == FEW {
            return false;
        }
        self.leaves[slot] = leaf;
        self.hash = (self.hash ^ u64::from(leaf)).wrapping_mul(MIX);
        self.count += 1;
        self.inside |= u64::from(chord.begins_inside()) << slot;
        for (end, entering) in [(0, true), (1, false)] {
            let (t, part) = (chord.ends[end], chord.parts[end]);
            // An infinite end is no crossing; a chord that is none has two.
            if t.is_finite() {
                self.insert(Hit { t, part, slot: slot as u8, entering });
            }
        }
        true
    }

    /// Behind those at the same t.
    #[inline(always)]
    fn insert(&mut self, hit: Hit) {
        let mut at = self.hit_count;
        while 0 < at && hit.t < self.hits[at - 1].t {
            self.hits[at] = self.hits[at - 1];
            at -= 1;
        }
        self.hits[at] = hit;
        self.hit_count += 1;
    }
}
