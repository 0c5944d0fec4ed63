//! Three-valued truth of a tree by counters: each leaf is out, in, or not asked yet; each node knows how many of its
//! children are true and how many unknown. One change costs the stems ([`super::stem`]) that change with it, and going back
//! to the outside costs what was changed, however many leaves there are.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::topset::Words;
use super::tree::{Kind, Node, Tree, Up};

/// Out, in, or not known yet.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum Truth {
    /// Outside.
    #[default]
    No,
    /// Inside.
    Yes,
    /// Not asked yet.
    Open,
}

impl Truth {
    /// From a known state.
    pub fn known(inside: bool) -> Truth {
        if inside { Truth::Yes } else { Truth::No }
    }

    pub fn negated(self, negated: bool) -> Truth {
        match (self, negated) {
            (Truth::Yes, true) => Truth::No,
            (Truth::No, true) => Truth::Yes,
            (state, _) => state,
        }
    }
}

/// What is known of a node.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    yes: u32,
    open: u32,
    value: Truth,
    /// Whether it waits to be looked at again.
    queued: bool,
    /// What its stem has been told of it: whether it is decided, whether it has open children.
    told: [bool; 2],
}

impl Count {
    /// A child changes.
    fn recount(&mut self, up: Up, was: Truth, is: Truth) {
        match was.negated(up.negated) {
            Truth::Yes => self.yes -= 1,
            Truth::Open => self.open -= 1,
            Truth::No => {}
        }
        match is.negated(up.negated) {
            Truth::Yes => self.yes += 1,
            Truth::Open => self.open += 1,
            Truth::No => {}
        }
    }
}

/// The state of every leaf and node.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    leaves: Vec<Truth>,
    /// Of the nodes of a stem only the highest has a value.
    counts: Vec<Count>,
    /// Of the stems.
    words: Words,
    /// Leaves set since the outside.
    touched: Vec<u32>,
    /// Nodes whose children changed, the lowest first.
    waiting: BinaryHeap<Reverse<u32>>,
    /// Nodes that somebody waits for to be open again ([`State::watch`]).
    watched: Vec<bool>,
    /// Of those, which were open again since.
    pub woken: Vec<u32>,
}

impl State {
    /// The state in which the ray is outside every leaf.
    pub fn outside(tree: &Tree) -> State {
        let mut state = State {
            leaves: vec![Truth::No; tree.leaves().len()],
            counts: vec![Count::default(); tree.nodes.len()],
            watched: vec![false; tree.nodes.len()],
            words: tree.stems.words(),
            ..State::default()
        };
        for leaf in 0..tree.leaves().len() {
            for up in tree.leaf_ups.of(leaf) {
                state.counts[up.node as usize].yes += u32::from(up.negated);
            }
        }
        for i in 0..tree.nodes.len() {
            let (top, _, value) = state.renew(tree, i);
            if top != i {
                continue;
            }
            // A stem of which nothing is decided has a value too.
            let value = tree.stems.of(i).map_or(value, |(stem, _)| stem.value(&state.words));
            state.counts[i].value = value;
            for up in tree.node_ups.of(i) {
                state.counts[up.node as usize].yes += u32::from(value.negated(up.negated) == Truth::Yes);
            }
        }
        state
    }

    /// Every leaf outside again, given the state that is so: it is copied where that costs less than to go back step by step.
    pub fn reset(&mut self, tree: &Tree, outside: &State) {
        /// Bytes that are copied in the time of one step back, about: twenty nanoseconds at 16 bytes each.
        const A_STEP: usize = 320;
        let bytes = self.leaves.len() + self.counts.len() * size_of::<Count>() + self.words.len() * 8;
        if bytes < A_STEP * self.touched.len() {
            self.leaves.copy_from_slice(&outside.leaves);
            self.counts.copy_from_slice(&outside.counts);
            self.words.clone_from(&outside.words);
            self.touched.clear();
            return;
        }
        while let Some(leaf) = self.touched.pop() {
            self.put(tree, leaf as usize, Truth::No);
        }
    }

    pub fn root(&self) -> Truth {
        self.counts.last().map_or(Truth::No, |c| c.value)
    }

    fn evaluated(&self, tree: &Tree, i: usize) -> Truth {
        let Count { yes, open, .. } = self.counts[i];
        let node = &tree.nodes[i];
        match node.kind {
            Kind::Or if 0 < yes => Truth::Yes,
            Kind::And if yes + open < node.arity => Truth::No,
            _ if 0 < open => Truth::Open,
            Kind::Or => Truth::No,
            Kind::And => Truth::Yes,
            Kind::Xor => Truth::known(yes % 2 == 1),
        }
    }

    /// Whether some way from these nodes up to the root passes the test all along. What is tested is a node with all
    /// above it in its stem.
    fn climbs(&self, tree: &Tree, ups: &[Up], test: impl Fn(usize) -> bool) -> bool {
        let root = tree.nodes.len() - 1;
        let mut node = match ups {
            [one] => one.node as usize,
            _ => return self.climbs_somewhere(tree, ups, test),
        };
        loop {
            if !test(node) {
                return false;
            }
            let top = tree.top(node);
            if top == root {
                return true;
            }
            match tree.node_ups.of(top) {
                [one] => node = one.node as usize,
                several => return self.climbs_somewhere(tree, several, test),
            }
        }
    }

    /// The same where ways part: every node is tried once.
    fn climbs_somewhere(&self, tree: &Tree, ups: &[Up], test: impl Fn(usize) -> bool) -> bool {
        let root = tree.nodes.len() - 1;
        let mut open: Vec<u32> = ups.iter().map(|up| up.node).collect();
        let mut tried = std::collections::HashSet::new();
        while let Some(node) = open.pop() {
            if !tried.insert(node) || !test(node as usize) {
                continue;
            }
            let top = tree.top(node as usize);
            if top == root {
                return true;
            }
            open.extend(tree.node_ups.of(top).iter().map(|up| up.node));
        }
        false
    }

    /// Whether knowing an open leaf can tell the root: every node on a way up is open.
    pub fn matters(&self, tree: &Tree, leaf: usize) -> bool {
        let open = |node: usize| match tree.stems.of(node) {
            None => self.counts[node].value == Truth::Open,
            Some((stem, place)) => {
                self.counts[stem.top as usize].value == Truth::Open && stem.matters(&self.words, place.level)
            }
        };
        self.climbs(tree, tree.leaf_ups.of(leaf), open)
    }

    /// Of the stems on an open leaf's way up the top of the first that is known, where there is only one way: knowing the leaf
    /// cannot tell the root until that is open again.
    pub fn blocker(&self, tree: &Tree, leaf: usize) -> Option<u32> {
        let mut up = tree.leaf_up[leaf];
        while up.is_one() {
            let top = tree.top(up.node as usize);
            if self.counts[top].value != Truth::Open {
                return Some(top as u32);
            }
            up = tree.node_up[top];
        }
        None
    }

    /// Puts the top of a stem into `woken` when it is open again.
    pub fn watch(&mut self, top: u32) {
        self.watched[top as usize] = true;
    }

    /// Whether a leaf and all nodes above one of its uses are inside; nothing may be open.
    pub fn fills(&self, tree: &Tree, leaf: usize) -> bool {
        let inside = |node: usize| match tree.stems.of(node) {
            None => self.counts[node].value == Truth::Yes,
            Some((stem, place)) => {
                stem.value_at(&self.words, place.level) == Truth::Yes
                    && !stem.turns_above(&self.words, place.level, Truth::Yes)
            }
        };
        self.leaves[leaf] == Truth::Yes && self.climbs(tree, tree.leaf_ups.of(leaf), inside)
    }

    /// Whether a leaf and all nodes above one of its uses differ from another state; nothing may be open.
    pub fn differs(&self, before: &State, tree: &Tree, leaf: usize) -> bool {
        let differ = |node: usize| match tree.stems.of(node) {
            None => self.counts[node].value != before.counts[node].value,
            Some((stem, place)) => {
                let value = |state: &State| stem.value_at(&state.words, place.level);
                let turns = |state: &State| stem.turns_above(&state.words, place.level, value(state));
                value(self) != value(before) && !turns(self) && !turns(before)
            }
        };
        self.leaves[leaf] != before.leaves[leaf] && self.climbs(tree, tree.leaf_ups.of(leaf), differ)
    }

    /// Sets a leaf.
    pub fn set(&mut self, tree: &Tree, leaf: usize, truth: Truth) {
        if self.leaves[leaf] == Truth::No && truth != Truth::No {
            self.touched.push(leaf as u32);
        }
        self.put(tree, leaf, truth);
    }

    fn put(&mut self, tree: &Tree, leaf: usize, truth: Truth) {
        let before = std::mem::replace(&mut self.leaves[leaf], truth);
        if before == truth {
            return;
        }
        // Most things have one way up.
        let (mut was, mut is, mut up, mut below) = (before, truth, tree.leaf_up[leaf], None);
        while up.is_one() {
            let node = up.node as usize;
            self.counts[node].recount(up, was, is);
            let top;
            (top, was, is) = self.renew(tree, node);
            if was == is {
                return;
            }
            (up, below) = (tree.node_up[top], Some(top));
        }
        if up != Up::NONE {
            let ups = below.map_or_else(|| tree.leaf_ups.of(leaf), |node| tree.node_ups.of(node));
            self.put_all(tree, ups, was, is);
        }
    }

    /// The same where ways part: children before those above them, so that a node is looked at once, however many ways
    /// lead to it.
    fn put_all(&mut self, tree: &Tree, ups: &[Up], was: Truth, is: Truth) {
        self.count(ups, was, is);
        while let Some(Reverse(node)) = self.waiting.pop() {
            let node = node as usize;
            self.counts[node].queued = false;
            let (top, was, is) = self.renew(tree, node);
            if is != was {
                self.count(tree.node_ups.of(top), was, is);
            }
        }
    }

    /// Counts a child's change in the nodes above it.
    fn count(&mut self, ups: &[Up], was: Truth, is: Truth) {
        for up in ups {
            let count = &mut self.counts[up.node as usize];
            count.recount(*up, was, is);
            if !std::mem::replace(&mut count.queued, true) {
                self.waiting.push(Reverse(up.node));
            }
        }
    }

    /// Looks at a node again; the top of its stem, and the value of that before and now.
    #[inline]
    fn renew(&mut self, tree: &Tree, node: usize) -> (usize, Truth, Truth) {
        let (top, is) = match tree.stems.of(node) {
            None => (node, self.evaluated(tree, node)),
            Some((stem, place)) => {
                let Count { yes, open, .. } = self.counts[node];
                let Node { kind, arity } = tree.nodes[node];
                let decided = if kind == Kind::Or { 0 < yes } else { yes + open < arity };
                let told = [decided, 0 < open];
                if std::mem::replace(&mut self.counts[node].told, told) == told {
                    let value = self.counts[stem.top as usize].value;
                    return (stem.top as usize, value, value);
                }
                stem.put(&mut self.words, place.level, decided, 0 < open);
                (stem.top as usize, stem.value(&self.words))
            }
        };
        let was = std::mem::replace(&mut self.counts[top].value, is);
        if is == Truth::Open && was != is && std::mem::take(&mut self.watched[top]) {
            self.woken.push(top as u32);
        }
        (top, was, is)
    }
}
