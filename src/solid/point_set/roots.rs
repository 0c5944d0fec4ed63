//! All roots of F in one band of a line, by the certificates of [`super::certificate`]: a cell is left only when they
//! say that it holds no root, or exactly one, which is then bracketed and refined. Cells too small to go on with are counted.

use super::certificate::{Cell, Verdict};
use super::probe::{Probe, Room};
use super::{PointSet, hierarchy::Reach};
use crate::geom::{Interval, Ray};

/// A root, or a jump of F from one sign to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root {
    /// Arc length.
    pub s: f64,
    /// Half the width of an interval of s that holds it.
    pub err: f64,
    /// A bound of the displacement along the normal, world length.
    pub shift: f64,
    /// Whether F falls (the line goes in).
    pub entering: bool,
    /// Whether F jumps here instead of vanishing.
    pub jump: bool,
}

/// A stretch of a line on which F is defined, with the state at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// From where to where, arc length.
    pub range: Interval,
    /// Whether the line is inside where the piece begins, and where it ends.
    pub inside: [bool; 2],
    /// Its roots are this range of the list.
    pub roots: [usize; 2],
}

/// What a search found and what it could not decide.
#[derive(Debug, Default)]
pub(super) struct Findings {
    /// Pieces in ascending order.
    pub pieces: Vec<Piece>,
    /// Roots in ascending order.
    pub roots: Vec<Root>,
    /// Cells that were left undecided.
    pub failures: u64,
}

impl Findings {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.pieces.clear();
        self.roots.clear();
        self.failures = 0;
    }
}

/// A cell shorter than this many widths is left: F varies by less than its rounding there, or jumps.
const SHORTEST: f64 = 1e-7;
/// Where F is undefined at an end, the end of its domain is found to this many widths.
const DOMAIN: f64 = 0.02;
/// Cells undefined at both ends are searched down to this many widths for a domain between.
const BLIND: f64 = 0.2;
/// A cell is never longer than this many widths: neighbours and M belong to one place.
const LONGEST: f64 = 2.0;
/// A split leaves at least this share on either side.
const SHARE: f64 = 0.1;

/// Where definitions of inside disagree, the wall between them is uncertain by this many widths: the samples do not
/// resolve less.
pub(super) const WALL: f64 = 0.5;

/// The search in one band.
pub(super) struct Search<'a> {
    /// The surface.
    pub set: &'a PointSet,
    /// The line, of unit direction.
    pub line: &'a Ray,
    /// The trust spheres of the band.
    pub spheres: &'a [Reach],
    /// Room for evaluations.
    pub room: &'a mut Room,
    /// Where findings go.
    pub out: &'a mut Findings,
    /// Cells yet to look at, the last is the next.
    pub stack: &'a mut Vec<Stretch>,
}

/// A cell between two probes, with a bound of |F''''| where one is known (else infinite).
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    a: Probe,
    b: Probe,
    fourth: f64,
}

impl Search<'_> {
    /// Finds the pieces and roots of the band, ascending.
    pub fn run(&mut self, band: Interval) {
        let (a, b) = (self.probe(band.lo), self.probe(band.hi));
        self.stack.clear();
        self.stack.push(Stretch { a, b, fourth: f64::INFINITY });
        // The piece being built: where it began, its state there, its first root.
        let mut open: Option<(f64, bool, usize)> = None;
        // Where F was last lost, because the projection failed.
        let mut lost: Option<(Probe, [f64; 2])> = None;
        while let Some(Stretch { a, b, fourth }) = self.stack.pop() {
            match (a.f, b.f) {
                (Some(fa), Some(fb)) => {
                    open.get_or_insert((a.s, fa[0] < 0.0, self.out.roots.len()));
                    self.defined_cell(&a, &b, self.cell(&a, fa, &b, fb, fourth));
                }
                (None, None) => {
                    if BLIND * a.width.min(b.width) < b.s - a.s {
                        self.split(a, b, 0.5);
                    }
                }
                _ if DOMAIN * a.width.min(b.width) < b.s - a.s => self.split(a, b, 0.5),
                (Some(fa), None) => {
                    open.get_or_insert((a.s, fa[0] < 0.0, self.out.roots.len()));
                    self.close(&mut open, &a, fa);
                    self.out.failures += u64::from(b.stray && ends_early(&a, fa));
                    lost = b.stray.then_some((a, fa));
                }
                (None, Some(fb)) => {
                    self.out.failures += u64::from(a.stray && ends_early(&b, fb));
                    if let Some(before) = lost.take().filter(|_| a.stray) {
                        self.bridge(before, (b, fb), &mut open);
                    }
                }
            }
            if self.stack.is_empty()
                && let Some(fb) = b.f
            {
                self.close(&mut open, &b, fb);
            }
        }
    }

    fn close(&mut self, open: &mut Option<(f64, bool, usize)>, at: &Probe, f: [f64; 2]) {
        if let Some((lo, inside, first)) = open.take() {
            self.drop_flaps(first);
            // A domain no longer than its ends are uncertain, in which nothing happens, is a chance of where F was asked.
            if at.s - lo < DOMAIN * at.width && first == self.out.roots.len() {
                return;
            }
            self.out.pieces.push(Piece {
                range: Interval::new(lo, at.s),
                inside: [inside, f[0] < 0.0],
                roots: [first, self.out.roots.len()],
            });
        }
    }

    /// Takes a stretch without F for a jump, where it is no longer than a jump's wall is uncertain: the piece before it
    /// goes on after it, and a change of sign over it is a crossing.
    fn bridge(
        &mut self,
        (a, fa): (Probe, [f64; 2]),
        (b, fb): (Probe, [f64; 2]),
        open: &mut Option<(f64, bool, usize)>,
    ) {
        if WALL * a.width.min(b.width) < b.s - a.s {
            return;
        }
        let Some(piece) = self.out.pieces.pop() else { return };
        *open = Some((piece.range.lo, piece.inside[0], piece.roots[0]));
        if (fa[0] < 0.0) != (fb[0] < 0.0) {
            self.out.roots.push(Root {
                s: 0.5 * (a.s + b.s),
                err: WALL * a.width.min(b.width),
                shift: fa[0].abs().min(fb[0].abs()).min(b.s - a.s),
                entering: fb[0] < fa[0],
                jump: true,
            });
        }
    }

    /// Drops pairs of crossings, one of them a jump, that lie nearer to each other than the jump is certain: the nearest
    /// pair first, so that a line and its reverse drop the same.
    fn drop_flaps(&mut self, first: usize) {
        let roots = &mut self.out.roots;
        loop {
            let gap = |i: &usize| {
                let (a, b) = (&roots[*i], &roots[i + 1]);
                let loose = if a.jump { a.err } else { 0.0 }.max(if b.jump { b.err } else { 0.0 });
                let gap = b.s - a.s;
                (gap < loose).then_some(gap)
            };
            let pairs = first..roots.len().saturating_sub(1).max(first);
            let flap = pairs.filter_map(|i| Some((i, gap(&i)?))).min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((i, _)) = flap else { return };
            roots.drain(i..i + 2);
        }
    }

    fn probe(&mut self, s: f64) -> Probe {
        self.set.probe(self.line, s, self.spheres, self.room)
    }

    /// Puts both parts of a cell back; the nearer is looked at next.
    fn split(&mut self, a: Probe, b: Probe, share: f64) {
        let share = share.clamp(SHARE, 1.0 - SHARE);
        let middle = self.probe(a.s + share * (b.s - a.s));
        let fourth = match (a.f, middle.f, b.f) {
            (Some(fa), Some(f), Some(fb)) => {
                let whole = self.cell(&a, fa, &b, fb, f64::INFINITY);
                whole.fourth_at((middle.s - a.s) / whole.length, f)
            }
            _ => f64::INFINITY,
        };
        self.stack.push(Stretch { a: middle, b, fourth });
        self.stack.push(Stretch { a, b: middle, fourth });
    }

    fn cell(&self, a: &Probe, fa: [f64; 2], b: &Probe, fb: [f64; 2], fourth: f64) -> Cell {
        Cell { length: b.s - a.s, width: a.width.min(b.width), a: fa, b: fb, fourth }
    }

    fn defined_cell(&mut self, a: &Probe, b: &Probe, cell: Cell) {
        let verdict = if cell.length <= LONGEST * cell.width {
            cell.judge()
        } else if cell.changes() {
            Verdict::Split(cell.a[0] / (cell.a[0] - cell.b[0]))
        } else {
            Verdict::Split(0.5)
        };
        match verdict {
            Verdict::Empty => {}
            Verdict::One => {
                let root = self.refine(a.s, &cell);
                self.out.roots.push(root);
            }
            Verdict::Split(share) if SHORTEST * cell.width < cell.length => self.split(*a, *b, share),
            Verdict::Flat | Verdict::Split(_) => {
                self.out.failures += 1;
                if cell.changes() {
                    self.leave_change(a.s, &cell);
                }
            }
        }
    }

    /// A change of sign in a cell that cannot be looked into: a tangent root, or a jump of F.
    fn leave_change(&mut self, begin: f64, cell: &Cell) {
        let (fa, fb) = (cell.a[0], cell.b[0]);
        // A continuous F of slope about 1 cannot change by more than this over the cell.
        let jump = 4.0 * cell.length < (fa - fb).abs();
        self.out.roots.push(Root {
            s: begin + 0.5 * cell.length,
            // Which side of a jump the surface belongs to is not known better than its wall is.
            err: if jump { WALL * cell.width } else { 0.5 * cell.length },
            shift: fa.abs().min(fb.abs()).min(cell.length),
            entering: fb < fa,
            jump,
        });
    }

    /// Refines the one root of a cell by Newton's method kept within the bracket, from where the cubic through the ends
    /// vanishes, until the curvature bounds its error below the tolerance.
    fn refine(&mut self, begin: f64, cell: &Cell) -> Root {
        let m = cell.curvature();
        let entering = cell.b[0] < cell.a[0];
        let (mut lo, mut hi) = ((begin, cell.a[0]), (begin + cell.length, cell.b[0]));
        let mut at = begin + cell.cubic_root() * cell.length;
        let floor = cell.rounding();
        for _ in 0..MAX_STEPS {
            let Some(f) = self.probe(at).f else { break };
            if (f[0] < 0.0) == (lo.1 < 0.0) {
                lo = (at, f[0])
            } else {
                hi = (at, f[0])
            }
            let step = -f[0] / f[1];
            let next = at + step;
            // Newton's remainder: |F(next)| <= M step^2 / 2.
            let shift = 0.5 * m * step * step + floor;
            let inside = lo.0 <= next && next <= hi.0;
            if inside && shift <= 0.5 * self.set.tolerance {
                // The slope cannot fall below this between the root and here.
                let flattest = f[1].abs() - m * (2.0 * step.abs() + floor);
                let err = (shift / flattest.max(0.0)).min(hi.0 - lo.0);
                return Root { s: next, err, shift, entering, jump: false };
            }
            at = if inside {
                next
            } else {
                lo.0 + (hi.0 - lo.0) * (lo.1 / (lo.1 - hi.1)).clamp(SHARE, 1.0 - SHARE)
            };
        }
        self.out.failures += 1;
        let (s, err) = (0.5 * (lo.0 + hi.0), 0.5 * (hi.0 - lo.0));
        Root { s, err, shift: lo.1.abs().max(hi.1.abs()).min(err), entering, jump: false }
    }
}

/// Whether F is lost so near the surface that a crossing may be lost with it; farther off the tube just ends.
fn ends_early(last: &Probe, f: [f64; 2]) -> bool {
    f[0].abs() < TUBE_END * last.width
}

/// F is defined at least this many widths away from a surface that is sampled well: where normals agree the tube ends
/// past one width.
const TUBE_END: f64 = 0.7;

/// Newton's steps in a bracket: a handful suffice; more say that F is not what its slopes promise.
const MAX_STEPS: usize = 40;
