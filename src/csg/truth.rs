//! Three-valued truth of a tree by counters: each leaf is out, in, or not asked yet; each node knows how many of its
//! children are true and how many unknown, so one change costs the depth, not the number of leaves.

use super::tree::{Kind, Tree, Up};

/// Out, in, or not known yet.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Truth {
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

#[derive(Clone, Copy, Debug, Default)]
struct Count {
    yes: u32,
    open: u32,
}

/// The state of every leaf and node.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    leaves: Vec<Truth>,
    counts: Vec<Count>,
}

impl State {
    /// The state in which the ray is outside every leaf.
    pub fn outside(tree: &Tree) -> State {
        let mut state = State {
            leaves: vec![Truth::No; tree.leaves().len()],
            counts: vec![Count::default(); tree.nodes.len()],
        };
        for up in tree.ups.iter().flatten() {
            state.counts[up.node as usize].yes += u32::from(up.negated);
        }
        // Nodes come after those above them, so children are counted before they are asked.
        for i in (1..tree.nodes.len()).rev() {
            if let Some(up) = tree.nodes[i].up {
                let value = state.node(tree, i).negated(up.negated);
                state.counts[up.node as usize].yes += u32::from(value == Truth::Yes);
            }
        }
        state
    }

    /// Takes another state over, without allocating where there is room.
    pub fn copy_from(&mut self, other: &State) {
        self.leaves.clone_from(&other.leaves);
        self.counts.clone_from(&other.counts);
    }

    pub fn root(&self, tree: &Tree) -> Truth {
        self.node(tree, 0)
    }

    fn node(&self, tree: &Tree, i: usize) -> Truth {
        let Count { yes, open } = self.counts[i];
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

    /// Whether knowing an open leaf can tell the root: every node on a way up is open.
    pub fn matters(&self, tree: &Tree, leaf: usize) -> bool {
        tree.ups[leaf].iter().any(|up| {
            let mut node = up.node as usize;
            loop {
                if self.node(tree, node) != Truth::Open {
                    return false;
                }
                match tree.nodes[node].up {
                    Some(up) => node = up.node as usize,
                    None => return true,
                }
            }
        })
    }

    /// Whether a leaf, and all nodes above one of its uses, pass the test; nothing may be open.
    fn all_above(&self, tree: &Tree, leaf: usize, test: impl Fn(&dyn Fn(&State) -> Truth) -> bool) -> bool {
        let passes = |mut node: usize| {
            loop {
                if !test(&|state| state.node(tree, node)) {
                    return false;
                }
                match tree.nodes[node].up {
                    Some(up) => node = up.node as usize,
                    None => return true,
                }
            }
        };
        test(&|state| state.leaves[leaf]) && tree.ups[leaf].iter().any(|up| passes(up.node as usize))
    }

    /// Whether a leaf and all nodes above one of its uses are inside.
    pub fn fills(&self, tree: &Tree, leaf: usize) -> bool {
        self.all_above(tree, leaf, |truth| truth(self) == Truth::Yes)
    }

    /// Whether a leaf and all nodes above one of its uses differ from another state.
    pub fn differs(&self, before: &State, tree: &Tree, leaf: usize) -> bool {
        self.all_above(tree, leaf, |truth| truth(self) != truth(before))
    }

    /// Sets a leaf.
    pub fn set(&mut self, tree: &Tree, leaf: usize, truth: Truth) {
        let before = std::mem::replace(&mut self.leaves[leaf], truth);
        if before != truth {
            for up in &tree.ups[leaf] {
                self.replace(tree, *up, before, truth);
            }
        }
    }

    /// Counts a child's change in the node above it, and on upwards while nodes change.
    fn replace(&mut self, tree: &Tree, mut up: Up, mut before: Truth, mut after: Truth) {
        loop {
            let node = up.node as usize;
            let was = self.node(tree, node);
            let count = &mut self.counts[node];
            match before.negated(up.negated) {
                Truth::Yes => count.yes -= 1,
                Truth::Open => count.open -= 1,
                Truth::No => {}
            }
            match after.negated(up.negated) {
                Truth::Yes => count.yes += 1,
                Truth::Open => count.open += 1,
                Truth::No => {}
            }
            let is = self.node(tree, node);
            match tree.nodes[node].up {
                Some(above) if was != is => (up, before, after) = (above, was, is),
                _ => return,
            }
        }
    }
}
