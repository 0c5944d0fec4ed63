//! All roots of F in one band of a line, by a curvature certificate: a cell is left only when a bound of |F''|
//! proves that it holds no root, or exactly one, which is then bracketed and refined.
//!
//! With F and F' at both ends of a cell of length L and |F''| <= M inside it:
//! - ends of one sign: F stays above the parabolas F_a + F'_a x - M x^2/2 from either end; both are concave, so
//!   the larger of them is lowest where they meet or at the ends;
//! - ends of opposite signs: where |F'| > M L/2 at both ends, with the sign of the change, F' cannot vanish (each end
//!   answers for its half), so there is one root.
//!
//! M is 1/h of the nearest sample, and twice what the slopes at the ends show where that is more. It is measured, not
//! proved: a certificate given M. Cells too small to go on with are counted.

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
const BLIND: f64 = 0.5;
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
    pub stack: &'a mut Vec<(Probe, Probe)>,
}

impl Search<'_> {
    /// Finds the pieces and roots of the band, ascending.
    pub fn run(&mut self, band: Interval) {
        let (a, b) = (self.probe(band.lo), self.probe(band.hi));
        self.stack.clear();
        self.stack.push((a, b));
        // The piece being built: where it began, its state there, its first root.
        let mut open: Option<(f64, bool, usize)> = None;
        while let Some((a, b)) = self.stack.pop() {
            match (a.f, b.f) {
                (Some(fa), Some(fb)) => {
                    open.get_or_insert((a.s, fa[0] < 0.0, self.out.roots.len()));
                    self.defined_cell(&a, fa, &b, fb);
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
                    self.out.failures += u64::from(b.stray);
                }
                (None, Some(_)) => self.out.failures += u64::from(a.stray),
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
            self.out.pieces.push(Piece {
                range: Interval::new(lo, at.s),
                inside: [inside, f[0] < 0.0],
                roots: [first, self.out.roots.len()],
            });
        }
    }

    /// Drops pairs of crossings, one of them a jump, that lie nearer to each other than the jump is certain.
    fn drop_flaps(&mut self, first: usize) {
        let roots = &mut self.out.roots;
        let mut i = first;
        while i + 1 < roots.len() {
            let (a, b) = (&roots[i], &roots[i + 1]);
            let loose = if a.jump { a.err } else { 0.0 }.max(if b.jump { b.err } else { 0.0 });
            if b.s - a.s < loose {
                roots.drain(i..i + 2);
                i = i.saturating_sub(1).max(first);
            } else {
                i += 1;
            }
        }
    }

    fn probe(&mut self, s: f64) -> Probe {
        self.set.probe(self.line, s, self.spheres, self.room)
    }

    /// Puts both parts of a cell back; the nearer is looked at next.
    fn split(&mut self, a: Probe, b: Probe, share: f64) {
        let s = a.s + share.clamp(SHARE, 1.0 - SHARE) * (b.s - a.s);
        let middle = self.probe(s);
        self.stack.push((middle, b));
        self.stack.push((a, middle));
    }

    fn defined_cell(&mut self, a: &Probe, fa: [f64; 2], b: &Probe, fb: [f64; 2]) {
        let length = b.s - a.s;
        let width = a.width.min(b.width);
        let m = curvature(fa, fb, length, width);
        let changes = (fa[0] < 0.0) != (fb[0] < 0.0);
        let short = length <= SHORTEST * width;
        if length <= LONGEST * width || short {
            if !changes {
                let (lowest, share) = lower_bound(fa, fb, length, m);
                if 0.0 < lowest {
                    return;
                }
                if short {
                    self.out.failures += 1;
                } else {
                    self.split(*a, *b, share);
                }
                return;
            }
            let falls = fb[0] < fa[0];
            let steady = |slope: f64| 0.5 * m * length < if falls { -slope } else { slope };
            if steady(fa[1]) && steady(fb[1]) {
                let root = self.refine(a, fa, b, fb, m);
                self.out.roots.push(root);
                return;
            }
            if short {
                self.leave_change(a, fa, b, fb);
                return;
            }
        }
        let share = if changes { fa[0] / (fa[0] - fb[0]) } else { 0.5 };
        self.split(*a, *b, share);
    }

    /// A change of sign in a cell too short to look into: a tangent root, or a jump of F.
    fn leave_change(&mut self, a: &Probe, fa: [f64; 2], b: &Probe, fb: [f64; 2]) {
        self.out.failures += 1;
        let gap = (fa[0] - fb[0]).abs();
        // A continuous F of slope about 1 cannot change by more than this over the cell.
        let jump = 4.0 * (b.s - a.s) < gap;
        self.out.roots.push(Root {
            s: 0.5 * (a.s + b.s),
            err: 0.5 * (b.s - a.s),
            shift: fa[0].abs().min(fb[0].abs()).min(b.s - a.s),
            entering: fb[0] < fa[0],
            jump,
        });
        if jump && let Some(last) = self.out.roots.last_mut() {
            // Which side of a jump the surface belongs to is not known better than this.
            last.err = WALL * a.width.min(b.width);
        }
    }

    /// Refines the one root of a cell by Newton's method kept within the bracket, until the curvature bounds its
    /// error below the tolerance.
    fn refine(&mut self, a: &Probe, fa: [f64; 2], b: &Probe, fb: [f64; 2], m: f64) -> Root {
        let entering = fb[0] < fa[0];
        let (mut lo, mut hi) = ((a.s, fa[0]), (b.s, fb[0]));
        let (mut at, mut f) = if fa[0].abs() < fb[0].abs() { (a.s, fa) } else { (b.s, fb) };
        // The slope never falls below this inside the cell.
        let flattest = (fa[1].abs().min(fb[1].abs()) - 0.5 * m * (b.s - a.s)).max(0.0);
        // F itself is known to some roundings of sums over hundreds of samples.
        let floor = 1e-14 * a.width.max(b.width);
        for _ in 0..MAX_STEPS {
            let step = -f[0] / f[1];
            let next = at + step;
            if lo.0 < next && next < hi.0 {
                // Newton's remainder: |F(next)| <= M step^2 / 2.
                let shift = 0.5 * m * step * step + floor;
                if shift <= 0.5 * self.set.tolerance {
                    let err = shift / flattest.max(shift / (hi.0 - lo.0));
                    return Root { s: next, err, shift, entering, jump: false };
                }
                at = next;
            } else {
                at = lo.0 + (hi.0 - lo.0) * (lo.1 / (lo.1 - hi.1)).clamp(SHARE, 1.0 - SHARE);
            }
            let Some(found) = self.probe(at).f else { break };
            f = found;
            if (f[0] < 0.0) == (lo.1 < 0.0) {
                lo = (at, f[0])
            } else {
                hi = (at, f[0])
            }
            if f[0] == 0.0 {
                return Root {
                    s: at,
                    err: floor / flattest.max(f64::MIN_POSITIVE),
                    shift: floor,
                    entering,
                    jump: false,
                };
            }
        }
        self.out.failures += 1;
        let (s, err) = (0.5 * (lo.0 + hi.0), 0.5 * (hi.0 - lo.0));
        Root { s, err, shift: lo.1.abs().max(hi.1.abs()).min(err), entering, jump: false }
    }
}

/// Newton's steps in a bracket: a handful suffice; more say that F is not what its slopes promise.
const MAX_STEPS: usize = 40;

/// The bound M of |F''| used in a cell.
fn curvature(fa: [f64; 2], fb: [f64; 2], length: f64, width: f64) -> f64 {
    // Clean and noisy tori showed at most 0.43/h, clean scans about 0.5/h in all but one place in a hundred.
    const USUAL: f64 = 1.0;
    const MARGIN: f64 = 2.0;
    let slopes = (fb[1] - fa[1]).abs() / length;
    // Taylor's remainders from either end; at a jump they grow without bound as cells shrink.
    let change = fb[0] - fa[0];
    let remainder = (change - fa[1] * length).abs().max((change - fb[1] * length).abs());
    (USUAL / width).max(MARGIN * slopes).max(MARGIN * 2.0 * remainder / (length * length))
}

/// The least that |F| can be in a cell whose ends have one sign, and where, as a share of the cell.
fn lower_bound(fa: [f64; 2], fb: [f64; 2], length: f64, m: f64) -> (f64, f64) {
    let sign = if fa[0] < 0.0 { -1.0 } else { 1.0 };
    let (va, sa) = (sign * fa[0], sign * fa[1]);
    let (vb, sb) = (sign * fb[0], -sign * fb[1]);
    // From a: va + sa x - m x^2/2; from b: vb + sb (L-x) - m (L-x)^2/2. They meet where they are equal.
    let from_a = |x: f64| va + sa * x - 0.5 * m * x * x;
    let from_b = |x: f64| vb + sb * (length - x) - 0.5 * m * (length - x) * (length - x);
    let denominator = sa + sb - m * length;
    let meet = (vb - va + sb * length - 0.5 * m * length * length) / denominator;
    // M covers the remainders of both ends, so they meet inside, up to rounding.
    let meet = meet.clamp(0.0, length);
    (from_a(meet).min(from_b(meet)).min(va).min(vb), meet / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lower_bound_is_below_every_function_of_that_curvature() {
        // F = c + k (x - x0)^2 / 2 with |k| <= M.
        for (c, k, x0) in [(0.2, 0.9, 0.3), (0.05, 1.0, 0.7), (0.5, -0.8, 0.4), (0.001, 0.5, 0.5)] {
            let f = |x: f64| [c + 0.5 * k * (x - x0) * (x - x0), k * (x - x0)];
            let m = curvature(f(0.0), f(1.0), 1.0, 1.0);
            let (low, _) = lower_bound(f(0.0), f(1.0), 1.0, m);
            let least = (0..=1000).map(|i| f(i as f64 / 1000.0)[0]).fold(f64::INFINITY, f64::min);
            assert!(low <= least + 1e-12, "{low} {least}");
        }
    }

    #[test]
    fn a_clear_minimum_is_certified() {
        let (low, _) = lower_bound([0.5, -0.6], [0.5, 0.6], 1.0, 1.0);
        assert!(0.0 < low, "{low}");
    }
}
