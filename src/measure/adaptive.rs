//! Integrals over planes by lines at random places of cells, with a bar of error; cells are cut where lines differ.
//!
//! In each quarter of a cell the integrand is asked at two pairs of points, both points of a pair opposite each other about the
//! middle of the quarter, so that what is linear there adds nothing to the error (antithetic and stratified sampling; Hammersley
//! and Handscomb, Monte Carlo Methods, 5.3 and 5.6). A pair's mean is an unbiased estimate of the quarter's, and the square of
//! half the difference of two such means is one of the variance of both together; variances of quarters add up.
//!
//! Which cells are cut follows from a first set of points: what they say of the cells left is too little, as cells where they
//! missed an edge by chance were not cut. What is told is the sum over a second set, which no cut depends on: whenever cells are
//! cut it is drawn anew, in those too that are left, as those in which it found an edge would be gone. A cell is at most twice
//! as large as those around it: edges go on from cell to cell, and where the first set would miss one in a large cell the small
//! ones beside it have seen it. Without this the sum has a bias, as what is rare is missed where it matters most.
//!
//! The bar is Student's, with the degrees of freedom that variances of unlike size leave (Satterthwaite 1946), and no less than
//! what the two sets differ by. Whoever asks again until something is decided has as many chances to be misled as looks: the
//! first look misses once in two thousand times, each look more half as often, so that all together miss once in a thousand
//! (alpha spending: Lan and DeMets 1983).

use rayon::prelude::*;

use super::cells::{Planes, Rect};
use crate::csg::{Scratch, Spans};
use crate::geom::{Aabb, tolerance};
use crate::num::hash::{Stream, mix};

/// Numbers integrated together.
pub const WIDTH: usize = 4;
/// Lines in a cell, of each set.
const LINES: u64 = 16;
/// The cells that are cut next hold this share of the variance.
const SHARE: f64 = 0.75;
/// The bar of the first set is so much narrower than asked for before the second is drawn.
const SPARE: f64 = 0.7;
/// Differences of pairs are no normal numbers: most are small, and some are edges. By so much the bar is wider.
const TAILS: f64 = 1.25;

/// What is integrated: at a place of the plane across an axis, so many numbers.
pub trait Integrand: Sync {
    /// Its values; scratch and spans are lent, for anything.
    fn at(&self, axis: usize, place: [f64; 2], scratch: &mut Scratch, spans: &mut Spans) -> [f64; WIDTH];
}

/// A sum over cells, with its variances.
#[derive(Clone, Copy, Default, Debug)]
struct Sums {
    values: [f64; WIDTH],
    variances: [f64; WIDTH],
    /// Squares of the variances, for the degrees of freedom.
    squares: [f64; WIDTH],
}

impl Sums {
    fn add(&mut self, other: &Sums) {
        for k in 0..WIDTH {
            self.values[k] += other.values[k];
            self.variances[k] += other.variances[k];
            self.squares[k] += other.squares[k];
        }
    }

    fn variance(&self) -> f64 {
        self.variances.iter().sum()
    }

    fn bar(&self, k: usize, look: usize) -> f64 {
        if self.variances[k] <= 0.0 {
            return 0.0;
        }
        let freedom = self.variances[k] * (self.variances[k] / self.squares[k]);
        TAILS * student(normal(look), freedom) * self.variances[k].sqrt()
    }
}

/// How many standard deviations a normal number is off but for once in 2000 times at the first look, and at least twice as
/// seldom at each look more: the tail is the density over z times what rises with z, so that it halves at least with the density.
fn normal(look: usize) -> f64 {
    let first = 3.480_756_404_f64;
    (first * first + 2.0 * std::f64::consts::LN_2 * look as f64).sqrt()
}

/// Student's t where the normal number is z, by the expansion in the degrees of freedom (Fisher and Cornish 1960); within a
/// twentieth from four on.
fn student(z: f64, freedom: f64) -> f64 {
    let n = freedom.max(1.0);
    let [z3, z5, z7] = [3, 5, 7].map(|power| z.powi(power));
    let terms = [
        (z3 + z) / 4.0,
        (5.0 * z5 + 16.0 * z3 + 3.0 * z) / 96.0,
        (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / 384.0,
    ];
    z + terms[0] / n + terms[1] / (n * n) + terms[2] / (n * n * n)
}

/// A cell with what lines found in it.
#[derive(Clone, Copy, Debug)]
struct Cell {
    rect: Rect,
    /// By the first set and by the second.
    found: [Option<Sums>; 2],
    /// Whether it was cut.
    is_cut: bool,
}

impl Cell {
    fn new(rect: Rect) -> Cell {
        Cell { rect, found: [None; 2], is_cut: false }
    }

    fn variance(&self) -> f64 {
        self.found.iter().flatten().map(Sums::variance).sum()
    }
}

/// Integrals with bars, half their width.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Found {
    /// The integrals.
    pub values: [f64; WIDTH],
    /// The bars.
    pub bars: [f64; WIDTH],
}

/// An integral over the planes across some axes, as far as it is known.
#[derive(Clone, Debug)]
pub struct Integral {
    planes: Planes,
    cells: Vec<Cell>,
    /// How often the second set was drawn anew.
    drawn: u64,
    lines: u64,
    most: u64,
}

impl Integral {
    /// Of what lies in a box and in boxes of leaves in it; of so many lines, about, at most.
    pub fn new(bounds: &Aabb, boxes: &[Aabb], axes: &[usize], most: u64) -> Integral {
        let grain = tolerance::cleanup(bounds.farthest());
        let (planes, rects) = Planes::new(bounds, boxes, axes, grain);
        let cells = rects.into_iter().map(Cell::new).collect();
        Integral { planes, cells, drawn: 0, lines: 0, most }
    }

    /// Whether no more lines are left.
    pub fn is_spent(&self) -> bool {
        self.most <= self.lines
    }

    /// Some rounds of the first set alone; the bar of the first integral then.
    pub fn pilot(&mut self, rounds: u32, integrand: &impl Integrand) -> f64 {
        self.look(0, integrand);
        for _ in 0..rounds {
            self.cut();
            self.look(0, integrand);
        }
        self.total(0).bar(0, 0)
    }

    /// Goes on until every bar is within a share of the first integral, or lines are spent; bars of the look of this number.
    pub fn refine(&mut self, look: usize, share: f64, integrand: &impl Integrand) -> Found {
        let near =
            |sums: &Sums, share: f64| (0..WIDTH).all(|k| sums.bar(k, look) <= share * sums.values[0].abs());
        loop {
            self.look(0, integrand);
            let first = self.total(0);
            let is_last = self.most <= self.lines + 2 * LINES * self.without(1).count() as u64;
            if near(&first, SPARE * share) || is_last || !self.can_cut() {
                self.look(1, integrand);
                let second = self.total(1);
                if near(&second, share) || is_last || !self.can_cut() {
                    self.most = if is_last || !self.can_cut() { self.lines } else { self.most };
                    let apart = |k: usize| (second.values[k] - first.values[k]).abs();
                    let bars = std::array::from_fn(|k| second.bar(k, look).max(apart(k)));
                    return Found { values: second.values, bars };
                }
            }
            self.cut();
            self.forget_second();
        }
    }

    /// What cuts depend on is told no more.
    fn forget_second(&mut self) {
        self.cells.iter_mut().for_each(|cell| cell.found[1] = None);
        self.drawn += 1;
    }

    /// Cells that no lines of a set were cast in.
    fn without(&self, set: usize) -> impl Iterator<Item = usize> {
        let waits = move |(_, cell): &(usize, &Cell)| !cell.is_cut && cell.found[set].is_none();
        self.cells.iter().enumerate().filter(waits).map(|(i, _)| i)
    }

    fn total(&self, set: usize) -> Sums {
        let mut sums = Sums::default();
        let cells = self.cells.iter().filter(|cell| !cell.is_cut);
        cells.filter_map(|cell| cell.found[set]).for_each(|found| sums.add(&found));
        sums
    }

    fn look(&mut self, set: usize, integrand: &impl Integrand) {
        let seed = mix(set as u64 * (1 + self.drawn));
        let cells: Vec<(usize, Rect)> = self.without(set).map(|i| (i, self.cells[i].rect)).collect();
        let found = sampled(&cells, seed, integrand);
        for ((i, _), found) in cells.iter().zip(found) {
            self.cells[*i].found[set] = Some(found);
        }
        self.lines += LINES * cells.len() as u64;
    }

    fn varies(&self, cell: &Cell) -> bool {
        !cell.is_cut && 0.0 < cell.variance() && self.planes.is_wide(&cell.rect)
    }

    fn can_cut(&self) -> bool {
        self.cells.iter().any(|cell| self.varies(cell))
    }

    /// Cuts the cells that vary most.
    fn cut(&mut self) {
        let varied = self.cells.iter().enumerate().filter(|(_, cell)| self.varies(cell));
        let mut worst: Vec<(f64, usize)> = varied.map(|(i, cell)| (cell.variance(), i)).collect();
        worst.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        // Each makes four that are looked at twice.
        let room = (self.most.saturating_sub(self.lines) / (8 * LINES)).max(1) as usize;
        let mut left = SHARE * worst.iter().map(|(variance, _)| variance).sum::<f64>();
        for (variance, i) in worst.into_iter().take(room) {
            if left <= 0.0 {
                break;
            }
            left -= variance;
            self.cut_graded(i);
        }
    }

    /// Cuts a cell, and those around it that are larger.
    fn cut_graded(&mut self, first: usize) {
        let mut open = vec![first];
        while let Some(i) = open.pop() {
            let Cell { rect, is_cut, .. } = self.cells[i];
            if is_cut || !self.planes.is_wide(&rect) {
                continue;
            }
            open.extend(self.planes.coarser_around(&rect).map(|near| near as usize));
            self.cells[i].is_cut = true;
            let parts = self.planes.refine(&rect, self.cells.len() as u32);
            self.cells.extend(parts.into_iter().map(Cell::new));
        }
    }
}

/// What lines of a set find in cells, by their numbers.
fn sampled(cells: &[(usize, Rect)], seed: u64, integrand: &impl Integrand) -> Vec<Sums> {
    let room = || (Scratch::default(), Spans::new());
    let look = |lent: &mut (Scratch, Spans), (i, rect): &(usize, Rect)| {
        one(rect, mix(seed ^ *i as u64), integrand, &mut lent.0, &mut lent.1)
    };
    cells.par_iter().with_min_len(4).map_init(room, look).collect()
}

/// What the lines in a cell find.
fn one(rect: &Rect, seed: u64, integrand: &impl Integrand, scratch: &mut Scratch, spans: &mut Spans) -> Sums {
    let mut stream = Stream::new(seed);
    let mut sums = Sums::default();
    let quarter = 0.5 * rect.size();
    let area = 0.25 * rect.area();
    for corner in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
        let middle = rect.min + (glam::DVec2::from_array(corner) + 0.5) * quarter;
        let means: [[f64; WIDTH]; 2] = std::array::from_fn(|_| {
            let away = (glam::DVec2::new(stream.unit(), stream.unit()) - 0.5) * quarter;
            let pair = [middle + away, middle - away]
                .map(|place| integrand.at(rect.axis, place.to_array(), scratch, spans));
            std::array::from_fn(|k| 0.5 * (pair[0][k] + pair[1][k]))
        });
        for (k, (a, b)) in means[0].iter().zip(means[1]).enumerate() {
            let variance = (0.5 * area * (a - b)).powi(2);
            sums.values[k] += 0.5 * area * (a + b);
            sums.variances[k] += variance;
            sums.squares[k] += variance * variance;
        }
    }
    sums
}
