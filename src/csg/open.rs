//! Leaves that a ray may be inside of and that have not been asked: the next to ask is the cheapest whose answer can tell
//! the object's truth. One that cannot tell waits at the node in its way until that is open again, so that no leaf is
//! looked at for every other.

use std::collections::HashMap;

use super::tree::Tree;
use super::truth::State;
use crate::solid::Cost;

/// A leaf: what it costs, which it is, and of the leaves met, which.
type Ready = (Cost, u32, u32);

/// The open leaves of a sweep.
#[derive(Debug, Default)]
pub(super) struct Open {
    /// By [`Cost`]. Of those that cost the same the last to come in sight is the first asked: which, changes no answer.
    ready: [Vec<Ready>; 3],
    /// By the node in their way.
    waiting: HashMap<u32, Vec<Ready>>,
    /// Those with several ways up, each with something in it, or with a stem that leaves them no say.
    restless: Vec<Ready>,
}

impl Open {
    pub fn clear(&mut self) {
        self.ready.iter_mut().for_each(Vec::clear);
        self.restless.clear();
        if !self.waiting.is_empty() {
            self.waiting.clear();
        }
    }

    /// Adds a leaf.
    pub fn push(&mut self, cost: Cost, leaf: u32, met: u32) {
        self.put((cost, leaf, met));
    }

    #[inline]
    fn put(&mut self, ready: Ready) {
        self.ready[ready.0 as usize].push(ready);
    }

    /// The next to ask, of the leaves met.
    pub fn pop(&mut self, tree: &Tree, state: &mut State) -> Option<u32> {
        while let Some(node) = state.woken.pop() {
            self.waiting.remove(&node).into_iter().flatten().for_each(|ready| self.put(ready));
        }
        while let Some(ready) = self.restless.pop() {
            self.put(ready);
        }
        while let Some(ready) = self.ready.iter_mut().find_map(Vec::pop) {
            let (_, leaf, met) = ready;
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
