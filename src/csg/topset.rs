//! Sets of small numbers that tell their greatest at once: words of bits, and above each 64 words one that says which of
//! them hold any.

/// The words of several sets, one after the other.
pub(super) type Words = Vec<u64>;

/// Where the words of a set are, and how many numbers it is for.
#[derive(Clone, Copy, Debug)]
pub(super) struct TopSet {
    start: u32,
    size: u32,
}

/// Of 64-fold steps up to any `u32`.
const MOST_LAYERS: usize = 6;

impl TopSet {
    /// A set of numbers below `size`, its words put behind the others.
    pub fn new(size: u32, words: &mut Words) -> TopSet {
        let start = words.len() as u32;
        let mut layer = size;
        loop {
            layer = layer.div_ceil(64).max(1);
            words.resize(words.len() + layer as usize, 0);
            if layer == 1 {
                return TopSet { start, size };
            }
        }
    }

    /// The first word of each layer, and how many layers there are.
    #[inline]
    fn layers(self) -> ([usize; MOST_LAYERS], usize) {
        let (mut starts, mut count) = ([self.start as usize; MOST_LAYERS], 1);
        let mut layer = self.size.div_ceil(64);
        while 1 < layer {
            starts[count] = starts[count - 1] + layer as usize;
            layer = layer.div_ceil(64);
            count += 1;
        }
        (starts, count)
    }

    /// Puts a number in or takes it out.
    #[inline]
    pub fn put(self, words: &mut Words, number: u32, is_in: bool) {
        let (starts, count) = self.layers();
        let mut at = number as usize;
        for start in &starts[..count] {
            let (word, bit) = (&mut words[start + at / 64], 1 << (at % 64));
            let was = *word;
            *word = if is_in { was | bit } else { was & !bit };
            if (was == 0) == (*word == 0) {
                return;
            }
            at /= 64;
        }
    }

    /// The greatest.
    #[inline]
    pub fn top(self, words: &Words) -> Option<u32> {
        let (starts, count) = self.layers();
        descend(words, &starts[..count], 0)
    }

    /// The greatest of those below a number.
    #[inline]
    pub fn top_below(self, words: &Words, number: u32) -> Option<u32> {
        if self.size <= number {
            return self.top(words);
        }
        let (starts, count) = self.layers();
        let mut at = number as usize;
        for layer in 0..count {
            let below = (1u64 << (at % 64)) - 1;
            let word = words[starts[layer] + at / 64] & below;
            if word != 0 {
                return descend(words, &starts[..layer], at / 64 * 64 + highest(word));
            }
            at /= 64;
        }
        None
    }
}

fn highest(word: u64) -> usize {
    63 - word.leading_zeros() as usize
}

/// From a word of the layer above these, the greatest number; with no layer left the word is the number.
fn descend(words: &Words, starts: &[usize], from: usize) -> Option<u32> {
    let mut at = from;
    for start in starts.iter().rev() {
        let word = words[start + at];
        if word == 0 {
            return None;
        }
        at = 64 * at + highest(word);
    }
    Some(at as u32)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::num::hash::Stream;

    #[test]
    fn a_set_tells_what_a_sorted_set_tells() {
        for size in [1, 2, 63, 64, 65, 4095, 4096, 4097, 300_000] {
            let (mut words, mut stream) = (vec![7], Stream::new(u64::from(size)));
            let (set, mut truth) = (TopSet::new(size, &mut words), BTreeSet::new());
            let mut number = || (stream.unit() * f64::from(size)) as u32;
            for step in 0..3000 {
                let n = number();
                let is_in = step % 3 != 0;
                set.put(&mut words, n, is_in);
                if is_in {
                    truth.insert(n)
                } else {
                    truth.remove(&n)
                };
                assert_eq!(set.top(&words), truth.last().copied());
                let n = number();
                assert_eq!(set.top_below(&words, n), truth.range(..n).next_back().copied(), "{size}");
            }
            assert_eq!(set.top_below(&words, size), truth.last().copied());
            truth.iter().for_each(|n| set.put(&mut words, *n, false));
            assert_eq!(set.top(&words), None);
            assert!(words[1..].iter().all(|w| *w == 0) && words[0] == 7);
        }
    }
}
