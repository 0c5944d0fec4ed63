//! Binary hierarchies by halves: things stand in the order of the leaves, nodes in depth-first order, each with a bound of
//! the things below it. What bounds them and what is looked for is the caller's.

use std::cmp::Ordering;

use rayon::join;

/// How things are bounded and halved.
pub trait Halving<T>: Sync {
    /// What holds some things.
    type Bound: Copy + Send;

    /// The bound of some things.
    fn bound(&self, things: &[T]) -> Self::Bound;

    /// The axis along which these things, with this bound, are halved.
    fn axis(&self, things: &[T], bound: &Self::Bound) -> usize;

    /// The order of two things along an axis; it tells all things apart that are not the same, so that the halves do not
    /// depend on how the median is found.
    fn order(&self, axis: usize, a: &T, b: &T) -> Ordering;

    /// Puts the things of a leaf in order.
    fn settle(&self, _things: &mut [T]) {}
}

/// The nodes over things.
#[derive(Clone, Debug)]
pub struct Halves<B> {
    nodes: Vec<Node<B>>,
}

#[derive(Clone, Copy, Debug)]
struct Node<B> {
    bound: B,
    /// First thing of a leaf; of an inner node the second child (the first follows the node).
    start: u32,
    /// How many things; 0 for inner nodes.
    count: u32,
}

/// Below this many things a task is too small to share.
const PARALLEL: usize = 4096;

/// Deeper than any tree of 2^32 things halved at each level.
const DEEPEST: usize = 64;

impl<B: Copy + Send> Halves<B> {
    /// Puts things in the order of leaves of at most `leaf`; `O(n log n)`, the same for any number of threads.
    pub fn new<T: Send>(things: &mut [T], leaf: usize, how: &impl Halving<T, Bound = B>) -> Halves<B> {
        Halves { nodes: if things.is_empty() { Vec::new() } else { build(things, 0, leaf, how) } }
    }

    /// The bound of everything.
    pub fn root(&self) -> Option<&B> {
        self.nodes.first().map(|root| &root.bound)
    }

    /// Shows the things of every leaf all of whose bounds, from the root down, `meets` says yes to; in their order.
    #[inline(always)]
    pub fn visit(&self, mut meets: impl FnMut(&B) -> bool, mut show: impl FnMut(u32)) {
        let mut stack = [0u32; DEEPEST];
        let mut depth = usize::from(!self.nodes.is_empty());
        while 0 < depth {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !meets(&node.bound) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index + 1;
                depth += 2;
            } else {
                (node.start..node.start + node.count).for_each(&mut show);
            }
        }
    }
}

/// Nodes of a subtree; `first` is the place of its things in the whole order.
fn build<T: Send, H: Halving<T>>(things: &mut [T], first: u32, leaf: usize, how: &H) -> Vec<Node<H::Bound>> {
    let node = Node { bound: how.bound(things), start: first, count: things.len() as u32 };
    if things.len() <= leaf {
        how.settle(things);
        return vec![node];
    }
    let axis = how.axis(things, &node.bound);
    let half = things.len() / 2;
    things.select_nth_unstable_by(half, |a, b| how.order(axis, a, b));
    let (low, high) = things.split_at_mut(half);
    let build_low = |low: &mut [T]| build(low, first, leaf, how);
    let build_high = |high: &mut [T]| build(high, first + half as u32, leaf, how);
    let (left, right) = if PARALLEL < low.len() {
        join(|| build_low(low), || build_high(high))
    } else {
        (build_low(low), build_high(high))
    };
    let second = 1 + left.len() as u32;
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Node { start: second, count: 0, ..node });
    nodes.extend(left.into_iter().map(|n| shifted(n, 1)));
    nodes.extend(right.into_iter().map(|n| shifted(n, second)));
    nodes
}

/// A node of a subtree that begins `by` places later; only inner nodes point at nodes.
fn shifted<B>(node: Node<B>, by: u32) -> Node<B> {
    if node.count == 0 { Node { start: node.start + by, ..node } } else { node }
}
