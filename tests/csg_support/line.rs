//! A leaf that is a set of intervals of the x axis: the algebra of intervals without geometry.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, dvec3};
use pss::csg::Leaf;
use pss::geom::{Aabb, Interval, Lean, Placement, Ray};
use pss::solid::{Answer, Chord, Cost, Crossing, Scratch, Solid};

use super::draws::Draws;

/// The ray on which `t` is x.
pub fn axis() -> Ray {
    Ray::new(DVec3::ZERO, DVec3::X)
}

/// Intervals along x; answers in pieces of a given length, if any is given, and counts the questions.
#[derive(Debug, Default)]
pub struct Line {
    /// Where it crosses, ascending; the first is an entry unless `inside`.
    pub ends: Vec<f64>,
    /// Whether it is inside at minus infinity.
    pub inside: bool,
    pub piece: Option<f64>,
    pub costly: bool,
    pub asked: AtomicU64,
    /// Bits that its crossings' `shift` has.
    pub shift: f64,
    /// How much wider than one its box is.
    pub wide: f64,
}

impl Line {
    pub fn new(ends: &[f64]) -> Line {
        Line { ends: ends.to_vec(), ..Line::default() }
    }

    pub fn asked(&self) -> u64 {
        self.asked.load(Ordering::Relaxed)
    }
}

impl Solid for Line {
    fn bounds(&self) -> Aabb {
        let unbounded = self.inside || self.ends.len() % 2 == 1;
        match (self.ends.first(), self.ends.last()) {
            _ if unbounded => Aabb::ALL,
            (Some(&a), Some(&b)) => {
                let half = 1.0 + self.wide;
                Aabb { min: dvec3(a, -half, -1.0), max: dvec3(b, half, 1.0) }
            }
            _ => Aabb::EMPTY,
        }
    }

    fn crossings(&self, _: &Ray, range: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        self.asked.fetch_add(1, Ordering::Relaxed);
        // A lazy leaf knows a piece of the line about the low end, from a grid that no range moves.
        let last = self.ends.last().copied().unwrap_or(0.0);
        let answered = match self.piece {
            Some(_) if last <= range.lo => Interval::new(range.lo, f64::INFINITY),
            Some(piece) if range.lo.is_finite() => {
                let cell = (range.lo / piece).floor();
                let cell = if range.lo < cell * piece { cell - 1.0 } else { cell };
                Interval::new(cell * piece, (cell + 1.0) * piece)
            }
            Some(piece) => Interval::new(range.lo, -64.0 * piece),
            None => Interval::ALL,
        };
        let mut inside = self.inside;
        for (i, &t) in self.ends.iter().enumerate() {
            let entering = (i % 2 == 0) != self.inside;
            if t <= answered.lo {
                inside = entering;
            } else if t <= answered.hi {
                out.push(Crossing { shift: self.shift, ..Crossing::exact(t, entering, i as u32) });
            }
        }
        Answer { inside, range: answered }
    }

    /// Where it is one interval.
    fn chord(&self, _: &Ray, _: &Lean) -> Option<Chord> {
        let plain = !self.costly && self.piece.is_none() && self.shift == 0.0;
        let (ends, parts) = match (self.inside, &self.ends[..]) {
            (false, []) => (Chord::NONE.ends, [0; 2]),
            (false, &[lo]) => ([lo, f64::INFINITY], [0; 2]),
            (false, &[lo, hi]) => ([lo, hi], [0, 1]),
            (true, []) => ([f64::NEG_INFINITY, f64::INFINITY], [0; 2]),
            (true, &[hi]) => ([f64::NEG_INFINITY, hi], [0; 2]),
            _ => return None,
        };
        plain.then(|| {
            self.asked.fetch_add(1, Ordering::Relaxed);
            Chord { ends, parts }
        })
    }

    fn normal(&self, _: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        if crossing.entering { -DVec3::X } else { DVec3::X }
    }

    fn shift_bound(&self) -> f64 {
        self.shift
    }

    fn cost(&self) -> Cost {
        match (self.costly, self.piece) {
            (true, _) => Cost::Heavy,
            (false, Some(_)) => Cost::Search,
            (false, None) => Cost::Closed,
        }
    }
}

/// Places a line as the leaf of a rank.
pub fn leaf(line: Line, rank: u64) -> Leaf {
    let mut leaf = Leaf::new(Arc::new(line), Placement::IDENTITY);
    leaf.rank = rank;
    leaf
}

/// Up to eight intervals with integer ends 0..=64, now and then unbounded.
pub fn random(draws: &mut Draws, unbounded: bool) -> Line {
    let mut ends: Vec<f64> = (0..2 * draws.below(9)).map(|_| draws.below(65) as f64).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let inside = unbounded && draws.chance(0.2);
    if !unbounded && ends.len() % 2 == 1 {
        ends.pop();
    }
    Line { ends, inside, ..Line::default() }
}
