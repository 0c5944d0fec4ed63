//! What test lines saw of a world, summed over all of them; sums do not depend on their order.

use rayon::prelude::*;

use super::closer;
use super::extents::extents;
use super::lines;
use super::logic::Logic;
use super::seen::Seen;
use super::witness::Witness;
use crate::csg::{Leaf, Object};
use crate::geom::Ray;
use crate::num::hash::Stream;
use crate::prepare::Outline;

/// What was seen.
#[derive(Debug)]
pub struct Evidence<'a> {
    /// The leaves.
    pub(super) leaves: &'a [Leaf],
    /// Where they were written.
    pub(super) outline: &'a Outline,
    pub(super) logic: Logic,
    pub(super) seen: Seen,
}

/// Lines that are looked at before the next are begun: at first, and at most, by so many tasks; in between so many that a round
/// takes one in so many of the steps, by what the lines before have taken.
const FIRST: usize = 4;
const ROUND: usize = 1024;
const TASKS: usize = 16;
const ROUNDS: u64 = 16;
/// Nodes of the expression that are evaluated, at most, before no more lines are looked at: a line that crosses much evaluates
/// it for each stretch.
const STEPS: u64 = 1 << 30;

impl<'a> Evidence<'a> {
    /// Casts all test lines; `sheets` are those beside the solids, `eye` is how far from the origin the rays of the picture
    /// begin.
    pub fn gather(object: &'a Object, outline: &'a Outline, sheets: &[Leaf], eye: f64) -> Evidence<'a> {
        let logic = Logic::new(outline);
        let extents = extents(&logic, object.leaves());
        let lines = lines::lines(object, outline, &logic, &extents);
        let caster = Caster { object, outline, logic: &logic, eye };
        let (mut seen, _) = caster.cast(scattered(lines), STEPS);
        let closer = closer::closer(object, outline, (&logic, &extents), &seen);
        let (more, whole) = caster.cast(closer.rays, STEPS / closer::SHARE);
        seen = seen.add(more);
        // Of what has not been looked at closer nothing is told.
        if whole {
            (seen.looked_at, seen.looked_at_parts) = (closer.pieces, closer.parts);
            seen.looked_at_leaves = closer.leaves;
        }
        seen.nothing.extend(closer::nothing(object, &seen));
        seen.gone.extend(closer::nothing_open(sheets));
        Evidence { leaves: object.leaves(), outline, logic, seen }
    }
}

impl Evidence<'_> {
    /// Whether no line was inside of anything.
    pub fn is_nothing(&self) -> bool {
        self.seen.parts.is_empty()
    }
}

/// Lines in an order without a pattern: the first of them are a fair choice.
fn scattered(lines: Vec<Ray>) -> Vec<Ray> {
    let mut numbered: Vec<(f64, usize, Ray)> =
        lines.into_iter().enumerate().map(|(i, ray)| (Stream::new(i as u64).unit(), i, ray)).collect();
    numbered.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    numbered.into_iter().map(|(_, _, ray)| ray).collect()
}

/// Casts lines.
struct Caster<'a> {
    object: &'a Object,
    outline: &'a Outline,
    logic: &'a Logic,
    eye: f64,
}

impl<'a> Caster<'a> {
    /// What lines see, round by round while there are steps left; whether that were all lines. The same for any number of
    /// threads.
    fn cast(&self, lines: Vec<Ray>, steps: u64) -> (Seen, bool) {
        let look = |batch: &[Ray]| {
            let mut witness = Witness::new(self.object, self.outline, self.logic, self.eye);
            batch.iter().for_each(|line| witness.look(line));
            let steps = witness.steps;
            (witness.finish(), steps)
        };
        let (mut seen, mut spent, mut done) = (Seen::default(), 0, 0);
        while done < lines.len() {
            if steps < spent {
                return (seen, false);
            }
            let each = spent / done.max(1) as u64;
            let next = if done == 0 { FIRST } else { (steps / ROUNDS / each.max(1)) as usize };
            let round = &lines[done..][..next.clamp(FIRST, ROUND).min(lines.len() - done)];
            let found: Vec<(Seen, u64)> = round.par_chunks(round.len().div_ceil(TASKS)).map(look).collect();
            for (more, steps) in found {
                (seen, spent) = (seen.add(more), spent + steps);
            }
            done += round.len();
        }
        (seen, true)
    }
}
