//! Three-valued truth of a tree by counters: each leaf is out, in, or not asked yet; each node knows how many of its
//! children are true and how many unknown. One change costs the nodes that change with it, and going back to the
//! outside costs what was changed, however many leaves there are.

use super::tree::{Kind, Tree, Up};

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

    fn negated(self, negated: bool) -> Truth {
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
    counts: Vec<Count>,
    /// Leaves set since the outside.
    touched: Vec<u32>,
    /// Nodes whose children changed, the lowest last.
    waiting: Vec<u32>,
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
            ..State::default()
        };
        for leaf in 0..tree.leaves().len() {
            for up in tree.leaf_ups.of(leaf) {
                state.counts[up.node as usize].yes += u32::from(up.negated);
            }
        }
        for i in 0..tree.nodes.len() {
            let value = state.evaluated(tree, i);
            state.counts[i].value = value;
            for up in tree.node_ups.of(i) {
                state.counts[up.node as usize].yes += u32::from(value.negated(up.negated) == Truth::Yes);
            }
        }
        state
    }

    /// Every leaf outside again.
    pub fn reset(&mut self, tree: &Tree) {
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

    /// Whether some way from these nodes up to the root passes the test all along.
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
            if node == root {
                return true;
            }
            match tree.node_ups.of(node) {
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
            if node as usize == root {
                return true;
            }
            open.extend(tree.node_ups.of(node as usize).iter().map(|up| up.node));
        }
        false
    }

    /// Whether knowing an open leaf can tell the root: every node on a way up is open.
    pub fn matters(&self, tree: &Tree, leaf: usize) -> bool {
        self.climbs(tree, tree.leaf_ups.of(leaf), |node| self.counts[node].value == Truth::Open)
    }

    /// Of the nodes on an open leaf's way up the first that is known, where there is only one way: knowing the leaf cannot
    /// tell the root until that node is open again.
    pub fn blocker(&self, tree: &Tree, leaf: usize) -> Option<u32> {
        let mut up = tree.leaf_up[leaf];
        while up.is_one() {
            if self.counts[up.node as usize].value != Truth::Open {
                return Some(up.node);
            }
            up = tree.node_up[up.node as usize];
        }
        None
    }

    /// Puts a node into `woken` when it is open again.
    pub fn watch(&mut self, node: u32) {
        self.watched[node as usize] = true;
    }

    /// Whether a leaf and all nodes above one of its uses are inside; nothing may be open.
    pub fn fills(&self, tree: &Tree, leaf: usize) -> bool {
        self.leaves[leaf] == Truth::Yes
            && self.climbs(tree, tree.leaf_ups.of(leaf), |node| self.counts[node].value == Truth::Yes)
    }

    /// Whether a leaf and all nodes above one of its uses differ from another state; nothing may be open.
    pub fn differs(&self, before: &State, tree: &Tree, leaf: usize) -> bool {
        let node = |node: usize| self.counts[node].value != before.counts[node].value;
        self.leaves[leaf] != before.leaves[leaf] && self.climbs(tree, tree.leaf_ups.of(leaf), node)
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
            (was, is) = self.renew(tree, node);
            if was == is {
                return;
            }
            (up, below) = (tree.node_up[node], Some(node));
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
        while let Some(node) = self.waiting.pop() {
            let node = node as usize;
            self.counts[node].queued = false;
            let (was, is) = self.renew(tree, node);
            if is != was {
                self.count(tree.node_ups.of(node), was, is);
            }
        }
    }

    /// Counts a child's change in the nodes above it.
    fn count(&mut self, ups: &[Up], was: Truth, is: Truth) {
        for up in ups {
            let count = &mut self.counts[up.node as usize];
            count.recount(*up, was, is);
            if !std::mem::replace(&mut count.queued, true) {
                let at = self.waiting.partition_point(|n| up.node < *n);
                self.waiting.insert(at, up.node);
            }
        }
    }

    /// Looks at a node again; its value before and now.
    fn renew(&mut self, tree: &Tree, node: usize) -> (Truth, Truth) {
        let is = self.evaluated(tree, node);
        let was = std::mem::replace(&mut self.counts[node].value, is);
        if is == Truth::Open && was != is && std::mem::take(&mut self.watched[node]) {
            self.woken.push(node as u32);
        }
        (was, is)
    }
}
