//! The evaluator that takes no short cut: all crossings of all leaves over the whole line, truth by evaluating the
//! expression in every elementary interval, then the clean-up and the owners as the design words them.

use pss::csg::{Expr, Leaf, Span, Spans};
use pss::geom::{Interval, Ray};
use pss::solid::{Crossing, Scratch};

/// 16 eps: the clean-up's thickness for lengths of one.
const CLEAN: f64 = 16.0 * f64::EPSILON;

/// All crossings of a leaf.
struct Track {
    inside: bool,
    crossings: Vec<(Crossing, f64)>,
}

/// An object and its leaves' crossings with one ray.
pub struct Oracle<'a> {
    leaves: &'a [Leaf],
    expr: &'a Expr,
    ray: &'a Ray,
    tracks: Vec<Track>,
}

/// A change of truth: t, the leaf whose face it is measured by, its crossing, entering, |d.n|.
#[derive(Clone, Copy, Debug)]
struct Raw {
    t: f64,
    leaf: usize,
    shift: f64,
    entering: bool,
    slope: f64,
    /// Whether the leaf's own crossing is an entry.
    crosses_in: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Node {
    Or,
    And,
    Xor,
}

/// What can be compared with a boundary: t, owner, flipped.
pub type End = Option<(f64, u32, bool)>;

impl<'a> Oracle<'a> {
    pub fn new(leaves: &'a [Leaf], expr: &'a Expr, ray: &'a Ray) -> Oracle<'a> {
        let tracks = leaves.iter().map(|leaf| track(leaf, ray)).collect();
        Oracle { leaves, expr, ray, tracks }
    }

    /// Whether a leaf holds the points just after `t`.
    fn holds(&self, leaf: usize, t: f64) -> bool {
        let before = self.tracks[leaf].crossings.iter().rev().find(|c| c.0.t <= t);
        before.map_or(self.tracks[leaf].inside, |c| c.0.entering)
    }

    fn truth(&self, expr: &Expr, t: f64) -> bool {
        match expr {
            Expr::Leaf(i) => self.holds(*i as usize, t),
            Expr::Not(inner) => !self.truth(inner, t),
            Expr::Or(list) => list.iter().any(|e| self.truth(e, t)),
            Expr::And(list) => list.iter().all(|e| self.truth(e, t)),
            Expr::Xor(list) => list.iter().filter(|e| self.truth(e, t)).count() % 2 == 1,
            Expr::Shared(inner) => self.truth(inner, t),
        }
    }

    /// Whether the line begins inside, and all changes before clean-up.
    fn raw(&self) -> (bool, Vec<Raw>) {
        let all = self.tracks.iter().flat_map(|track| &track.crossings);
        let mut ts: Vec<f64> = all.map(|c| c.0.t).collect();
        ts.sort_by(f64::total_cmp);
        ts.dedup();
        let begin = self.truth(self.expr, f64::NEG_INFINITY);
        let (mut inside, mut changes) = (begin, Vec::new());
        for t in ts {
            if self.truth(self.expr, t) != inside {
                inside = !inside;
                changes.push(self.change(t, inside));
            }
        }
        (begin, changes)
    }

    /// The change at `t`, measured by the crossing leaf with the smallest key.
    fn change(&self, t: f64, entering: bool) -> Raw {
        let crosses = |i: &usize| self.tracks[*i].crossings.iter().any(|c| c.0.t == t);
        let leaf = (0..self.leaves.len()).filter(crosses).min_by_key(|i| self.leaves[*i].key()).unwrap();
        let here = self.tracks[leaf].crossings.iter().rfind(|c| c.0.t == t).unwrap();
        Raw { t, leaf, shift: here.0.shift, entering, slope: here.1, crosses_in: here.0.entering }
    }

    fn tau(&self, a: &Raw, b: &Raw) -> f64 {
        let [la, lb] = [a, b].map(|r| &self.leaves[r.leaf]);
        // The points are the same but where the ray runs along both faces: there the nearer.
        let [pa, pb] = [a, b].map(|r| self.ray.at(r.t).length());
        let point = pa.min(pb);
        let lengths = [self.ray.origin.length(), point, la.scale(), lb.scale()];
        let errors = a.shift * la.place.stretch + b.shift * lb.place.stretch;
        CLEAN * lengths.into_iter().fold(0.0, f64::max) + errors
    }

    fn thin(&self, a: &Raw, b: &Raw) -> bool {
        (b.t - a.t) * a.slope.max(b.slope) <= self.tau(a, b)
    }

    /// All changes before clean-up, for a complaint.
    pub fn told(&self) -> String {
        format!("{:?}", self.raw())
    }

    /// All spans.
    pub fn spans(&self) -> Vec<[End; 2]> {
        let (begin, changes) = self.raw();
        let mut ends: Vec<Option<Raw>> = changes.into_iter().map(Some).collect();
        if begin {
            ends.insert(0, None);
        }
        if ends.len() % 2 == 1 {
            ends.push(None);
        }
        // Gaps are between the second end of a pair and the first of the next.
        let mut spans: Vec<[Option<Raw>; 2]> = Vec::new();
        for pair in ends.chunks(2) {
            match spans.last_mut() {
                Some([_, last]) if matches!((&*last, &pair[0]), (Some(a), Some(b)) if self.thin(a, b)) => {
                    *last = pair[1];
                }
                _ => spans.push([pair[0], pair[1]]),
            }
        }
        spans.retain(|s| !matches!(s, [Some(a), Some(b)] if self.thin(a, b)));
        spans.iter().map(|s| s.map(|end| end.map(|raw| self.owned(&raw)))).collect()
    }

    /// The boundary of a change and its owner.
    fn owned(&self, raw: &Raw) -> (f64, u32, bool) {
        let mut best: Option<(usize, bool)> = None;
        for i in 0..self.leaves.len() {
            let better = best.is_none_or(|(b, _)| self.leaves[i].key() < self.leaves[b].key());
            if let Some(entering) = self.face(i, raw).filter(|_| better) {
                best = Some((i, entering));
            }
        }
        let (owner, entering) = best.unwrap_or((raw.leaf, raw.crosses_in));
        (raw.t, owner as u32, entering != raw.entering)
    }

    /// Whether a leaf has a face within tau of a change that can be its own; the sense of its crossing.
    fn face(&self, leaf: usize, raw: &Raw) -> Option<bool> {
        let sense = sense(self.expr, leaf as u32);
        let fits = |c: &&(Crossing, f64)| sense.is_none_or(|not| (c.0.entering != not) == raw.entering);
        let crossings = self.tracks[leaf].crossings.iter().filter(fits);
        let (c, slope) = crossings.min_by(|a, b| (a.0.t - raw.t).abs().total_cmp(&(b.0.t - raw.t).abs()))?;
        let width = (c.t - raw.t).abs() * slope.max(raw.slope);
        let scales = [self.leaves[leaf].scale(), self.leaves[raw.leaf].scale()];
        let lengths = [self.ray.origin.length(), self.ray.at(raw.t).length(), scales[0], scales[1]];
        let errors =
            c.shift * self.leaves[leaf].place.stretch + raw.shift * self.leaves[raw.leaf].place.stretch;
        let near = width <= CLEAN * lengths.into_iter().fold(0.0, f64::max) + errors;
        (near && self.changes(leaf, raw, c.t)).then_some(c.entering)
    }

    /// Whether a leaf and every node above some use of it change from just before the two crossings to just after.
    fn changes(&self, leaf: usize, raw: &Raw, t: f64) -> bool {
        let ts = [t.min(raw.t).next_down(), t.max(raw.t)];
        self.differs(self.expr, ts) && self.changes_in(self.expr, false, Node::Or, leaf as u32, ts)
    }

    fn differs(&self, expr: &Expr, ts: [f64; 2]) -> bool {
        self.truth(expr, ts[0]) != self.truth(expr, ts[1])
    }

    /// Brackets are nothing: what has the operator of the node above it, complements pushed down, is part of that node.
    fn changes_in(&self, expr: &Expr, not: bool, above: Node, leaf: u32, ts: [f64; 2]) -> bool {
        let (node, list) = match expr {
            Expr::Leaf(i) => return *i == leaf && self.differs(expr, ts),
            Expr::Not(inner) => return self.changes_in(inner, !not, above, leaf, ts),
            Expr::Shared(inner) => return self.changes_in(inner, not, above, leaf, ts),
            Expr::Or(list) => (if not { Node::And } else { Node::Or }, list),
            Expr::And(list) => (if not { Node::Or } else { Node::And }, list),
            Expr::Xor(list) => (Node::Xor, list),
        };
        let part = node == above && !(node == Node::Xor && not);
        let below = not && node != Node::Xor;
        (part || self.differs(expr, ts)) && list.iter().any(|e| self.changes_in(e, below, node, leaf, ts))
    }

    /// Whether a range end lies so near to a change that the clean-up could tell the range from the line.
    pub fn near_a_change(&self, t: f64) -> bool {
        let near = |r: &Raw| (t - r.t).abs() * r.slope <= 64.0 * self.tau(r, r);
        self.raw().1.iter().any(near)
    }

    /// Whether each leaf's crossings are those of another ray with the sign of `t` changed, to the bit.
    pub fn mirrors(&self, other: &Oracle) -> bool {
        self.tracks.iter().zip(&other.tracks).all(|(a, b)| {
            let forth = a.crossings.iter().map(|c| c.0.t);
            let back = b.crossings.iter().rev().map(|c| -c.0.t);
            let last = b.crossings.last().map_or(b.inside, |c| c.0.entering);
            a.inside == last && forth.eq(back)
        })
    }
}

/// Whether a leaf is complemented on its way to the root: `None` if that is open, or not the same for all its uses.
fn sense(expr: &Expr, leaf: u32) -> Option<bool> {
    fn uses(expr: &Expr, leaf: u32, not: bool, clear: bool, out: &mut Vec<Option<bool>>) {
        match expr {
            Expr::Leaf(i) if *i == leaf => out.push(clear.then_some(not)),
            Expr::Leaf(_) => {}
            Expr::Not(inner) => uses(inner, leaf, !not, clear, out),
            Expr::Shared(inner) => uses(inner, leaf, not, clear, out),
            Expr::Xor(list) => list.iter().for_each(|e| uses(e, leaf, not, false, out)),
            Expr::Or(list) | Expr::And(list) => list.iter().for_each(|e| uses(e, leaf, not, clear, out)),
        }
    }
    let mut out = Vec::new();
    uses(expr, leaf, false, true, &mut out);
    let first = out.first().copied().flatten();
    if out.iter().all(|sense| *sense == first) { first } else { None }
}

fn track(leaf: &Leaf, ray: &Ray) -> Track {
    let local = leaf.place.ray_to_local(ray);
    let (mut scratch, mut lo, mut inside) = (Scratch::default(), f64::NEG_INFINITY, None);
    let mut crossings: Vec<(Crossing, f64)> = Vec::new();
    while lo < f64::INFINITY {
        let mut out = Vec::new();
        let answer = leaf.crossings(&local, Interval::new(lo, f64::INFINITY), &mut scratch, &mut out);
        inside = inside.or(Some(answer.inside));
        for c in out.into_iter().filter(|c| lo < c.t && c.t <= answer.range.hi) {
            let normal = leaf.place.normal_to_world(leaf.solid.normal(&local, &c, &mut scratch));
            crossings.push((c, ray.dir.dot(normal).abs()));
        }
        lo = if lo < answer.range.hi { answer.range.hi } else { f64::INFINITY };
    }
    Track { inside: inside.unwrap_or(false), crossings }
}

/// What an object answered, in the oracle's terms.
pub fn ends(spans: &Spans) -> Vec<[End; 2]> {
    let end = |s: &Span| [s.enter, s.exit].map(|b| b.map(|b| (b.t, b.leaf, b.flipped)));
    spans.iter().map(end).collect()
}

/// The part of a list in a range: ends at the low end are before it, ends at the high end in it.
pub fn clipped(list: &[[End; 2]], range: Interval) -> Vec<[End; 2]> {
    let inside = |e: End| e.filter(|e| range.lo < e.0 && e.0 <= range.hi);
    list.iter()
        .filter(|[a, b]| b.is_none_or(|b| range.lo < b.0) && a.is_none_or(|a| a.0 <= range.hi))
        .map(|[a, b]| [inside(*a), inside(*b)])
        .collect()
}
