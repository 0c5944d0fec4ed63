//! Binary hierarchies by halves: things stand in the order of the leaves, nodes in depth-first order, each with a bound of
//! the things below it. What bounds them and what is looked for is the caller's.

use std::cmp::Ordering;
use std::ops::Range;

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
        Halves::whole(things, Leaves { most: leaf, multiple: 1 }, how)
    }

    /// The same with every leaf full but the last one, so that leaf k begins with thing k * `leaf`; and up to `together` things,
    /// a power of two of leaves, so many leaves that begin at a multiple of their number are a node.
    pub fn full<T: Send>(
        things: &mut [T],
        leaf: usize,
        together: usize,
        how: &impl Halving<T, Bound = B>,
    ) -> Halves<B> {
        Halves::whole(things, Leaves { most: leaf, multiple: together }, how)
    }

    fn whole<T: Send>(things: &mut [T], leaves: Leaves, how: &impl Halving<T, Bound = B>) -> Halves<B> {
        if things.is_empty() {
            return Halves { nodes: Vec::new() };
        }
        // As many as will be, each of which is written over: subtrees are built where they stand.
        let node = Node { bound: how.bound(&things[..1]), start: 0, count: 0 };
        let mut nodes = vec![node; nodes_over(things.len(), leaves)];
        build(things, [0, 0], &mut nodes, leaves, how);
        Halves { nodes }
    }

    /// The bound of everything.
    pub fn root(&self) -> Option<&B> {
        self.nodes.first().map(|root| &root.bound)
    }

    /// Shows the things of every leaf all of whose bounds, from the root down, `meets` says yes to; in their order.
    #[inline(always)]
    pub fn visit(&self, meets: impl FnMut(&B) -> bool, mut show: impl FnMut(u32)) {
        self.visit_leaves(meets, |leaf| leaf.for_each(&mut show));
    }

    /// Shows every such leaf as the range of its things.
    #[inline(always)]
    pub fn visit_leaves(&self, mut meets: impl FnMut(&B) -> bool, mut show: impl FnMut(Range<u32>)) {
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
                show(node.start..node.start + node.count);
            }
        }
    }
}

/// How many things a leaf holds at most, and of what number the things before a half are a multiple, while it is less than
/// what is halved.
#[derive(Clone, Copy)]
struct Leaves {
    most: usize,
    multiple: usize,
}

impl Leaves {
    /// How many of so many things are the first half.
    fn half(self, count: usize) -> usize {
        let mut multiple = self.multiple;
        while count <= multiple && self.most < multiple {
            multiple /= 2;
        }
        (count / 2).next_multiple_of(multiple)
    }
}

/// How many nodes there are over so many things: of a binary tree twice as many as leaves, less one.
fn nodes_over(count: usize, leaves: Leaves) -> usize {
    if count <= leaves.most {
        return 1;
    }
    if leaves.most < leaves.multiple {
        // All leaves are full but the last.
        return 2 * count.div_ceil(leaves.most) - 1;
    }
    let half = leaves.half(count);
    1 + nodes_over(half, leaves) + nodes_over(count - half, leaves)
}

/// Fills in the nodes of a subtree; `first` and `at` are the places of its things and of its nodes among all.
fn build<T: Send, H: Halving<T>>(
    things: &mut [T],
    [first, at]: [u32; 2],
    nodes: &mut [Node<H::Bound>],
    leaves: Leaves,
    how: &H,
) {
    let bound = how.bound(things);
    if things.len() <= leaves.most {
        how.settle(things);
        nodes[0] = Node { bound, start: first, count: things.len() as u32 };
        return;
    }
    let axis = how.axis(things, &bound);
    let half = leaves.half(things.len());
    things.select_nth_unstable_by(half, |a, b| how.order(axis, a, b));
    let (low, high) = things.split_at_mut(half);
    let below = nodes_over(half, leaves);
    let [left, right] = [[first, at + 1], [first + half as u32, at + 1 + below as u32]];
    nodes[0] = Node { bound, start: right[1], count: 0 };
    let (low_nodes, high_nodes) = nodes[1..].split_at_mut(below);
    if PARALLEL < low.len() {
        let build_low = || build(low, left, low_nodes, leaves, how);
        join(build_low, || build(high, right, high_nodes, leaves, how));
    } else {
        build(low, left, low_nodes, leaves, how);
        build(high, right, high_nodes, leaves, how);
    }
}
