//! Groups of things that belong together, and the signs of their members relative to each other.

/// Disjoint sets with a sign for each member relative to its set (Tarjan 1975, with parity).
#[derive(Clone, Debug)]
pub struct Groups {
    parent: Vec<u32>,
    size: Vec<u32>,
    /// Whether a member's sign is the opposite of its parent's.
    opposed: Vec<bool>,
}

impl Groups {
    /// `n` groups of one.
    pub fn new(n: usize) -> Groups {
        Groups { parent: (0..n as u32).collect(), size: vec![1; n], opposed: vec![false; n] }
    }

    /// The representative of `i`'s group, and whether `i`'s sign is opposed to its.
    pub fn find(&mut self, i: usize) -> (usize, bool) {
        let (mut root, mut sign) = (i, false);
        while self.parent[root] as usize != root {
            sign ^= self.opposed[root];
            root = self.parent[root] as usize;
        }
        // Points the whole path at the root.
        let (mut at, mut left) = (i, sign);
        while self.parent[at] as usize != root && at != root {
            let next = self.parent[at] as usize;
            let own = self.opposed[at];
            (self.parent[at], self.opposed[at]) = (root as u32, left);
            left ^= own;
            at = next;
        }
        (root, sign)
    }

    /// Joins the groups of two members of equal sign; false where they were one before.
    pub fn join(&mut self, i: usize, j: usize) -> bool {
        self.join_signed(i, j, false)
    }

    /// Joins the groups of two members, `opposed` saying whether their signs differ; false where they were
    /// one before, whatever their signs.
    pub fn join_signed(&mut self, i: usize, j: usize, opposed: bool) -> bool {
        let ((a, sign_a), (b, sign_b)) = (self.find(i), self.find(j));
        if a == b {
            return false;
        }
        let (big, small) = if self.size[a] < self.size[b] { (b, a) } else { (a, b) };
        self.parent[small] = big as u32;
        self.size[big] += self.size[small];
        self.opposed[small] = sign_a ^ sign_b ^ opposed;
        true
    }

    /// For each member the smallest member of its group.
    pub fn labels(&mut self) -> Vec<u32> {
        let n = self.parent.len();
        let mut first = vec![u32::MAX; n];
        let mut labels = vec![0; n];
        for (i, label) in labels.iter_mut().enumerate() {
            let root = self.find(i).0;
            if first[root] == u32::MAX {
                first[root] = i as u32;
            }
            *label = first[root];
        }
        labels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    #[test]
    fn signs_survive_any_order_of_joins() {
        let n = 300;
        let mut stream = Stream::new(3);
        let truth: Vec<bool> = (0..n).map(|_| stream.unit() < 0.5).collect();
        let mut groups = Groups::new(n);
        for _ in 0..4000 {
            let (i, j) = ((stream.unit() * n as f64) as usize, (stream.unit() * n as f64) as usize);
            if i % 3 == j % 3 {
                groups.join_signed(i, j, truth[i] != truth[j]);
            }
        }
        for i in 0..n {
            let ((a, sign_i), (b, sign_j)) = (groups.find(i), groups.find(i % 3));
            assert_eq!(a, b);
            assert_eq!(sign_i != sign_j, truth[i] != truth[i % 3]);
        }
        assert_eq!(groups.labels()[..6], [0, 1, 2, 0, 1, 2]);
    }
}
