//! Whether a surface of points has an inside: measured, not believed.

use rayon::prelude::*;

use super::PointSet;
use crate::geom::Ray;
use crate::num::hash::Stream;
use crate::solid::{Body, Counts, Scratch};

/// What the chords say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solidity {
    /// How many chords were tried.
    pub chords: u32,
    /// How many were odd: an odd number of roots, or a gap whose ends disagree.
    pub odd: u32,
    /// Holes through which lines meet the surface an odd number of times.
    pub open_holes: u32,
    /// Area of these holes over that of the surface.
    pub missing: f64,
    /// The work done.
    pub counts: Counts,
}

impl Solidity {
    /// The share of odd chords.
    pub fn odd_share(&self) -> f64 {
        f64::from(self.odd) / f64::from(self.chords.max(1))
    }

    /// Whether the surface may be taken for a solid's.
    pub fn body(&self) -> Body {
        let solid = self.odd_share() <= MOST_ODD && self.missing <= MOST_MISSING;
        if solid { Body::Solid } else { Body::Sheet }
    }
}

/// Chords of the bounding sphere in a whole measurement.
const CHORDS: u32 = 10_000;
/// They are traced in batches, and no further batch once the outcome is certain.
const BATCH: u32 = 500;
/// A solid has at most this share of odd chords.
const MOST_ODD: f64 = 1e-3;
/// And at most this share of its surface is missing. Random chords fall short here: they are odd only where a hole is farther
/// than a width from its rim, and a bounding sphere has more area than what is in it.
const MOST_MISSING: f64 = 1e-3;

impl PointSet {
    /// Traces seeded chords of the bounding sphere, each through two independent points of it. Stops early once
    /// more chords are odd than a solid may have; the same result for any number of threads.
    pub fn measure(&self) -> Solidity {
        self.measure_until(MOST_ODD * f64::from(CHORDS))
    }

    /// Which holes are open: more than half of the lines through them are odd. A rim that the surface spans, such as of a
    /// hole narrower than the weights, is none.
    pub fn open_holes(&self, lines: &[Vec<Ray>]) -> Vec<bool> {
        let few = self.without_patches();
        let is_open = |lines: &Vec<Ray>| {
            let mut scratch = Scratch::default();
            let odd = lines.iter().filter(|line| few.chord_is_odd(line, &mut scratch)).count();
            lines.len() < 2 * odd
        };
        lines.par_iter().map(is_open).collect()
    }

    /// The same over all chords, however many are odd.
    pub fn measure_whole(&self) -> Solidity {
        self.measure_until(f64::INFINITY)
    }

    /// Stops once more than `most` chords are odd.
    fn measure_until(&self, most: f64) -> Solidity {
        let mut total =
            Solidity { chords: 0, odd: 0, open_holes: 0, missing: 0.0, counts: Counts::default() };
        // Too few lines for patches to pay.
        let few = self.without_patches();
        while total.chords < CHORDS && f64::from(total.odd) <= most {
            let batch = total.chords..total.chords + BATCH;
            let parts: Vec<(u32, Counts)> = batch
                .into_par_iter()
                .with_min_len(16)
                .map_init(Scratch::default, |scratch, i| {
                    scratch.counts = Counts::default();
                    let odd = few.chord_is_odd(&self.chord(u64::from(i)), scratch);
                    (u32::from(odd), scratch.counts)
                })
                .collect();
            for (odd, counts) in parts {
                total.odd += odd;
                total.counts.add(&counts);
            }
            total.chords += BATCH;
        }
        total.counts.odd_chords += u64::from(total.odd);
        total
    }

    /// The `i`-th chord.
    fn chord(&self, i: u64) -> Ray {
        Ray::chord(&mut Stream::new(i), self.bounds.center(), 0.5 * self.bounds.diagonal())
    }
}
