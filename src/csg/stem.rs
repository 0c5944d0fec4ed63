//! Chains of unions and intersections by turns, as ((a - b) | c) - d makes them, followed as one: of all that stands beside the
//! chain, what is highest up has the last word. So a change costs the same however long the chain is.
//!
//! A level of a stem is a node; its child on the level below is left out of its counts. A union's level is decided where any
//! of its other children is true, an intersection's where any is false: then the stem is, from there up, what that level
//! says, until a higher one is decided. Levels by turns are unions and intersections, so the parity tells which.

use super::topset::{TopSet, Words};
use super::tree::{Kind, Node, Up};
use super::truth::Truth;

/// Where a node stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Its stem.
    pub stem: u32,
    /// Counted from the stem's lowest node.
    pub level: u32,
}

/// A stem of two or more levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stem {
    /// Its highest node.
    pub top: u32,
    /// What the lowest level is.
    lowest: Kind,
    /// For each parity the levels that are decided, half as numbers, and those with a child not known yet.
    decided: [TopSet; 2],
    open: [TopSet; 2],
}

/// The stems of a tree.
#[derive(Clone, Debug, Default)]
pub(super) struct Stems {
    stems: Vec<Stem>,
    /// For each node its place, unless it stands alone.
    places: Vec<Option<Place>>,
    /// All sets empty.
    words: Words,
}

impl Stems {
    /// Of nodes, children first, each with the one node it counts in, if it is one. Of the nodes below one that could be its
    /// next lower level the one with most below it is: so there are few stems on any way up.
    pub fn new(nodes: &mut [Node], node_up: &[Up]) -> Stems {
        let mut sizes = vec![1u64; nodes.len()];
        let mut heaviest: Vec<Option<u32>> = vec![None; nodes.len()];
        for (i, up) in node_up.iter().enumerate().filter(|(_, up)| up.is_one()) {
            let above = up.node as usize;
            sizes[above] += sizes[i];
            let chained =
                !up.negated && nodes[i].kind != Kind::Xor && nodes[above].kind.is_other(nodes[i].kind);
            if chained && heaviest[above].is_none_or(|other| sizes[other as usize] < sizes[i]) {
                heaviest[above] = Some(i as u32);
            }
        }
        let mut stems = Stems { stems: Vec::new(), places: vec![None; nodes.len()], words: Vec::new() };
        let mut is_top = vec![true; nodes.len()];
        heaviest.iter().flatten().for_each(|lower| is_top[*lower as usize] = false);
        for top in (0..nodes.len()).filter(|i| is_top[*i] && heaviest[*i].is_some()) {
            stems.add(top, &heaviest, nodes);
        }
        stems
    }

    fn add(&mut self, top: usize, heaviest: &[Option<u32>], nodes: &mut [Node]) {
        let down = |node: &usize| heaviest[*node].map(|lower| lower as usize);
        let levels: Vec<usize> = std::iter::successors(Some(top), down).collect();
        let (stem, count) = (self.stems.len() as u32, levels.len() as u32);
        for (level, node) in (0..count).rev().zip(&levels) {
            self.places[*node] = Some(Place { stem, level });
            nodes[*node].arity -= u32::from(0 < level);
        }
        let mut set = || TopSet::new(count.div_ceil(2), &mut self.words);
        let lowest = nodes[levels[levels.len() - 1]].kind;
        self.stems.push(Stem { top: top as u32, lowest, decided: [set(), set()], open: [set(), set()] });
    }

    /// Room for the sets of a state, all empty.
    pub fn words(&self) -> Words {
        self.words.clone()
    }

    /// The stem and the place of a node that has levels above or below it.
    #[inline]
    pub fn of(&self, node: usize) -> Option<(&Stem, Place)> {
        self.places[node].map(|place| (&self.stems[place.stem as usize], place))
    }
}

/// The greatest level of a set of those of one parity.
fn level(half: Option<u32>, parity: usize) -> Option<u32> {
    half.map(|half| 2 * half + parity as u32)
}

impl Stem {
    /// The parity of the levels that, decided, make the stem this; the others leave it or make it the opposite.
    fn parity(&self, truth: Truth) -> usize {
        usize::from((self.lowest == Kind::Or) != (truth == Truth::Yes))
    }

    /// What levels of a parity make of the stem where they are decided.
    fn says(&self, parity: u32) -> Truth {
        Truth::known((self.lowest == Kind::Or) == parity.is_multiple_of(2))
    }

    /// Notes that a level is decided, or has children not known.
    #[inline]
    pub fn put(&self, words: &mut Words, level: u32, decided: bool, open: bool) {
        let parity = (level % 2) as usize;
        self.decided[parity].put(words, level / 2, decided);
        self.open[parity].put(words, level / 2, open);
    }

    /// Of those decided, the highest level below one.
    #[inline]
    fn decided_below(&self, words: &Words, end: u32) -> Option<u32> {
        // Of even levels those below `end` are the first (end + 1) / 2, of odd ones the first end / 2.
        let even = self.decided[0].top_below(words, end.div_ceil(2));
        let odd = self.decided[1].top_below(words, end / 2);
        level(even, 0).max(level(odd, 1))
    }

    /// What the highest decided level of some says, or with none of them what a lowest level with nothing in it is.
    fn known(&self, decided: Option<u32>) -> Truth {
        decided.map_or(self.says(1), |level| self.says(level))
    }

    /// What the top is.
    #[inline]
    pub fn value(&self, words: &Words) -> Truth {
        let [even, odd] = [0, 1].map(|parity| level(self.decided[parity].top(words), parity));
        let decided = even.max(odd);
        let value = self.known(decided);
        // Levels that say the same change nothing.
        let other = 1 - self.parity(value);
        let open = level(self.open[other].top(words), other);
        if decided < open { Truth::Open } else { value }
    }

    /// Whether knowing an open child of a level can tell the top, which is open.
    pub fn matters(&self, words: &Words, at: u32) -> bool {
        let decided = self.decided_below(words, u32::MAX);
        if decided.is_some_and(|decided| at <= decided) {
            return false;
        }
        let value = self.known(decided);
        let parity = (at % 2) as usize;
        if parity != self.parity(value) {
            return true;
        }
        // What lies below has to be able to be other than what this level says.
        let other = 1 - parity;
        let end = if other == 0 { at.div_ceil(2) } else { at / 2 };
        decided < level(self.open[other].top_below(words, end), other)
    }

    /// What a level is, nothing being open.
    pub fn value_at(&self, words: &Words, level: u32) -> Truth {
        self.known(self.decided_below(words, level + 1))
    }

    /// Whether some level above makes of a truth the opposite.
    pub fn turns_above(&self, words: &Words, at: u32, truth: Truth) -> bool {
        let other = 1 - self.parity(truth);
        level(self.decided[other].top(words), other).is_some_and(|top| at < top)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::csg::tree::Tree;
    use crate::csg::truth::State;
    use crate::csg::{Expr, Leaf};
    use crate::geom::Placement;
    use crate::num::hash::Stream;
    use crate::solid::half_space::HalfSpace;

    fn below(stream: &mut Stream, n: usize) -> usize {
        (stream.unit() * n as f64) as usize
    }

    /// Mostly chains, in which the chain stands anywhere among its siblings; sometimes with a shared part.
    fn expr(stream: &mut Stream, leaves: usize, depth: usize, shared: &Arc<Expr>) -> Expr {
        let leaf = |stream: &mut Stream| Expr::Leaf(below(stream, leaves) as u32);
        if depth == 0 {
            return leaf(stream);
        }
        let mut list = vec![expr(stream, leaves, depth - 1, shared)];
        for _ in 0..1 + below(stream, 2) {
            let sibling = match below(stream, 12) {
                0 => expr(stream, leaves, depth / 2, shared),
                1 => Expr::Shared(shared.clone()),
                _ => leaf(stream),
            };
            let at = below(stream, list.len() + 1);
            list.insert(at, sibling);
        }
        let node = match below(stream, 15) {
            0 => Expr::Xor(list),
            n if n % 2 == 0 => Expr::And(list),
            _ => Expr::Or(list),
        };
        if below(stream, 4) == 0 { Expr::Not(Box::new(node)) } else { node }
    }

    /// Every node's value by its children one by one.
    struct Plain<'a> {
        tree: &'a Tree,
        leaves: Vec<Truth>,
        nodes: Vec<Truth>,
    }

    impl Plain<'_> {
        fn new(tree: &Tree, leaves: Vec<Truth>) -> Plain<'_> {
            let mut children = vec![Vec::new(); tree.nodes.len()];
            for (i, truth) in leaves.iter().enumerate() {
                tree.leaf_ups
                    .of(i)
                    .iter()
                    .for_each(|up| children[up.node as usize].push(truth.negated(up.negated)));
            }
            let mut nodes = Vec::new();
            for i in 0..tree.nodes.len() {
                let has = |truth| children[i].contains(&truth);
                let odd = children[i].iter().filter(|c| **c == Truth::Yes).count() % 2 == 1;
                let value = match tree.nodes[i].kind {
                    Kind::Or if has(Truth::Yes) => Truth::Yes,
                    Kind::And if has(Truth::No) => Truth::No,
                    _ if has(Truth::Open) => Truth::Open,
                    Kind::Or => Truth::No,
                    Kind::And => Truth::Yes,
                    Kind::Xor => Truth::known(odd),
                };
                nodes.push(value);
                tree.node_ups
                    .of(i)
                    .iter()
                    .for_each(|up| children[up.node as usize].push(value.negated(up.negated)));
            }
            Plain { tree, leaves, nodes }
        }

        /// Whether some way up has only nodes that pass.
        fn climbs(&self, ups: &[Up], test: &dyn Fn(usize) -> bool) -> bool {
            ups.iter().any(|up| {
                let node = up.node as usize;
                let above = self.tree.node_ups.of(node);
                test(node) && (above.is_empty() || self.climbs(above, test))
            })
        }
    }

    /// Truth of the root, what matters, what fills and what differs, against the definitions, over random changes of random
    /// chains.
    #[test]
    fn stems_tell_what_every_node_by_itself_tells() {
        let mut stream = Stream::new(5);
        let leaf =
            Leaf::new(Arc::new(HalfSpace { normal: glam::DVec3::Z, offset: 0.0 }), Placement::IDENTITY);
        let mut levels = 0;
        for round in 0..400 {
            let count = 1 + below(&mut stream, 24);
            let shared = Arc::new(expr(&mut stream, count, 2, &Arc::new(Expr::Leaf(0))));
            let depth = [3, 8, 40, 150][round % 4];
            let whole = expr(&mut stream, count, depth, &shared);
            let tree = Tree::new(vec![leaf.clone(); count], &whole);
            levels += (0..tree.nodes.len()).filter(|i| tree.stems.of(*i).is_some()).count();
            let mut state = State::outside(&tree);
            let mut plain = Plain::new(&tree, vec![Truth::No; count]);
            for step in 0..60 {
                let kinds = if step % 3 == 0 { 3 } else { 2 };
                let truth = [Truth::No, Truth::Yes, Truth::Open][below(&mut stream, kinds)];
                let changed = below(&mut stream, count);
                let (before, plain_before) = (state.clone(), plain);
                let mut leaves = plain_before.leaves.clone();
                leaves[changed] = truth;
                state.set(&tree, changed, truth);
                plain = Plain::new(&tree, leaves);
                assert_eq!(state.root(), *plain.nodes.last().unwrap());
                let known = |p: &Plain| !p.leaves.contains(&Truth::Open);
                for i in 0..count {
                    let ups = tree.leaf_ups.of(i);
                    if plain.leaves[i] == Truth::Open {
                        let open = |node: usize| plain.nodes[node] == Truth::Open;
                        assert_eq!(state.matters(&tree, i), plain.climbs(ups, &open));
                    }
                    if known(&plain) {
                        let inside = |node: usize| plain.nodes[node] == Truth::Yes;
                        let fills = plain.leaves[i] == Truth::Yes && plain.climbs(ups, &inside);
                        assert_eq!(state.fills(&tree, i), fills);
                    }
                    if known(&plain) && known(&plain_before) {
                        let other = |node: usize| plain.nodes[node] != plain_before.nodes[node];
                        let differs = plain.leaves[i] != plain_before.leaves[i] && plain.climbs(ups, &other);
                        assert_eq!(state.differs(&before, &tree, i), differs);
                    }
                }
            }
            state.reset(&tree, &State::outside(&tree));
            let outside = Plain::new(&tree, vec![Truth::No; count]);
            assert_eq!(state.root(), *outside.nodes.last().unwrap());
        }
        assert!(1000 < levels, "{levels}");
    }
}
