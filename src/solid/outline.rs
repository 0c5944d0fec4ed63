//! Outlines: closed loops of points in a plane. A point is inside where a ray from it to the right crosses the loops
//! an odd number of times (the even-odd rule), so a loop in a loop is a hole, whichever way round either runs.
//!
//! Who lies on the outline is decided by a shift of the point by less than anything, to the right and by less than
//! that up: left and lower edges belong to the inside, right and upper ones do not, as with a box.

use std::cmp::Ordering;

use glam::DVec2;

use crate::geom::halves::{Halves, Halving};
use crate::scene::BuildError;

/// Loops, their edges in the order of a hierarchy over them.
#[derive(Clone, Debug)]
pub struct Outline {
    edges: Vec<[DVec2; 2]>,
    nodes: Halves<Frame>,
}

/// The low and the high corner of what holds some edges.
type Frame = [DVec2; 2];

/// Edges are halved by their middles, across the longer side of their frame.
struct Edges;

impl Halving<[DVec2; 2]> for Edges {
    type Bound = Frame;

    fn bound(&self, edges: &[[DVec2; 2]]) -> Frame {
        edges
            .iter()
            .flatten()
            .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[lo, hi], p| [lo.min(*p), hi.max(*p)])
    }

    fn axis(&self, _: &[[DVec2; 2]], [min, max]: &Frame) -> usize {
        let size = *max - *min;
        usize::from(size.x < size.y)
    }

    fn order(&self, axis: usize, a: &[DVec2; 2], b: &[DVec2; 2]) -> Ordering {
        let middle = |e: &[DVec2; 2]| e[0][axis] + e[1][axis];
        let ends = |e: &[DVec2; 2]| [e[0].x, e[0].y, e[1].x, e[1].y];
        let rest = || ends(a).iter().zip(ends(b)).map(|(x, y)| x.total_cmp(&y)).find(|o| o.is_ne());
        middle(a).total_cmp(&middle(b)).then(rest().unwrap_or(Ordering::Equal))
    }
}

/// Edges a leaf.
const LEAF: usize = 4;

impl Outline {
    /// Makes an outline of loops of points; the last point of a loop is joined to the first, and may repeat it.
    ///
    /// Fails for a loop of fewer than three points that differ, of points on one line, or with a number that is not
    /// finite. `param` is the argument that the loops came by.
    pub fn new(loops: &[Vec<[f64; 2]>], param: &'static str) -> Result<Outline, BuildError> {
        let wrong = |message: String| BuildError {
            param,
            message,
            help: "write the corners in order, such as `[[0, 0], [4, 0], [2, 3]]`; a hole is a second list"
                .into(),
        };
        let mut edges = Vec::new();
        for (i, one) in loops.iter().enumerate() {
            let name = if loops.len() == 1 { "the outline".to_owned() } else { format!("loop {}", i + 1) };
            let mut points: Vec<DVec2> = one.iter().map(|p| DVec2::from_array(*p) + DVec2::ZERO).collect();
            if !points.iter().all(|p| p.is_finite()) {
                return Err(wrong(format!("{name} has a coordinate that is not finite")));
            }
            points.dedup();
            while 1 < points.len() && points.first() == points.last() {
                points.pop();
            }
            if points.len() < 3 {
                let n = points.len();
                return Err(wrong(format!("{name} has {n} points that differ; three make an area")));
            }
            let along = points[1] - points[0];
            if points.iter().all(|p| along.perp_dot(*p - points[0]) == 0.0) {
                return Err(wrong(format!("{name} has no area: its points lie on one line")));
            }
            edges.extend((0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]]));
        }
        if edges.is_empty() {
            return Err(wrong("the outline has no points".into()));
        }
        let nodes = Halves::new(&mut edges, LEAF, &Edges);
        Ok(Outline { edges, nodes })
    }

    /// The edges; an edge is known by its place in this list.
    pub fn edges(&self) -> &[[DVec2; 2]] {
        &self.edges
    }

    /// Corners of a box around the outline.
    pub fn corners(&self) -> [DVec2; 2] {
        self.nodes.root().copied().unwrap_or([DVec2::ZERO; 2])
    }

    /// Shows every edge of the boxes that `meets` says yes to.
    pub fn visit(&self, mut meets: impl FnMut(DVec2, DVec2) -> bool, show: impl FnMut(u32)) {
        self.nodes.visit(|[min, max]| meets(*min, *max), show);
    }

    /// Whether a point is inside: the edges that the ray from it to the right crosses, counted (Shimrat 1962, with
    /// half-open edges). An edge has the point to its left or right by the sign of one determinant, which is exact for
    /// edges along the axes and off by roundings for others: so near an edge either answer may come.
    pub fn contains(&self, q: DVec2) -> bool {
        let mut odd = false;
        let level = |min: DVec2, max: DVec2| min.y <= q.y && q.y < max.y && q.x < max.x;
        self.visit(level, |i| {
            let [a, b] = self.edges[i as usize];
            if (q.y < a.y) == (q.y < b.y) {
                return;
            }
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            let left = if q.x < a.x.min(b.x) {
                true
            } else if a.x.max(b.x) <= q.x {
                false
            } else {
                0.0 < (high - low).perp_dot(q - low)
            };
            odd ^= left;
        });
        odd
    }

    /// Shows every edge that the line from `through` along `dir` crosses, with the place on the edge. Each corner lies
    /// to one side of the line, decided once for both its edges, so each loop is crossed an even number of times. A
    /// corner on the line lies to that side on which the line would see it if it were shifted as the module says.
    pub fn crossed(&self, through: DVec2, dir: DVec2, mut show: impl FnMut(u32, DVec2)) {
        // Monotone in each coordinate, also after rounding: the corners of a box bound it for the points inside.
        let side = |x: f64, y: f64| (x - through.x) * dir.y - (y - through.y) * dir.x;
        let tie = if dir.y == 0.0 { 0.0 < dir.x } else { dir.y < 0.0 };
        let left = |s: f64| 0.0 < s || (s == 0.0 && tie);
        let meets = |min: DVec2, max: DVec2| {
            let (x0, x1) = if 0.0 <= dir.y { (min.x, max.x) } else { (max.x, min.x) };
            let (y0, y1) = if 0.0 <= dir.x { (max.y, min.y) } else { (min.y, max.y) };
            side(x0, y0) <= 0.0 && 0.0 <= side(x1, y1)
        };
        self.visit(meets, |i| {
            let [a, b] = self.edges[i as usize];
            let (sa, sb) = (side(a.x, a.y), side(b.x, b.y));
            if left(sa) != left(sb) {
                // Both on the line: the tie is one, so they cannot differ; hence sa - sb is not zero.
                show(i, a + (sa / (sa - sb)) * (b - a));
            }
        });
    }
}
