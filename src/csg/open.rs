//! Leaves that a ray may be inside of and that have not been asked: the next to ask is the cheapest whose answer can tell
//! the object's truth. One that cannot tell waits at the node in its way until that is open again, so that no leaf is
//! looked at for every other.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use super::tree::Tree;
use super::truth::State;
use crate::solid::Cost;

/// What it costs, which leaf it is, and of the leaves met, which.
type Ready = Reverse<(Cost, u32, u32)>;

/// The open leaves of a sweep.
#[derive(Debug, Default)]
pub(super) struct Open {
    ready: BinaryHeap<Ready>,
    /// By the node in their way.
    waiting: HashMap<u32, Vec<Ready>>,
    /// Those with several ways up, each with something in it.
    restless: Vec<Ready>,
}

impl Open {
    pub fn clear(&mut self) {
        self.ready.clear();
        self.restless.clear();
        if !self.waiting.is_empty() {
            self.waiting.clear();
        }
    }

    /// Adds a leaf.
    pub fn push(&mut self, cost: Cost, leaf: u32, met: u32) {
        self.ready.push(Reverse((cost, leaf, met)));
    }

    /// The next to ask, of the leaves met.
    pub fn pop(&mut self, tree: &Tree, state: &mut State) -> Option<u32> {
        while let Some(node) = state.woken.pop() {
            self.ready.extend(self.waiting.remove(&node).unwrap_or_default());
        }
        self.ready.extend(self.restless.drain(..));
        while let Some(ready) = self.ready.pop() {
            let Reverse((_, leaf, met)) = ready;
            match state.blocker(tree, leaf as usize) {
                Some(node) => {
                    state.watch(node);
                    self.waiting.entry(node).or_default().push(ready);
                }
                None if state.matters(tree, leaf as usize) => return Some(met),
                None => self.restless.push(ready),
            }
        }
        None
    }
}
