//! The planes that lines are cast across, cut into cells: first along the boxes of the leaves, so that each of them has cells,
//! and lines, of its own size, however small it is in the whole; then where what lines find varies.
//!
//! Faces along the axes end where their boxes end: cells that begin there hold no edge of them, and boxes are measured to
//! rounding. What no box reaches is no cell.

use std::collections::VecDeque;

use glam::DVec2;

use crate::geom::Aabb;

/// A box at least so wide, against a cell that it touches, is not cut out of it: it is met by the lines of whole strata.
const NARROW: f64 = 0.5;
/// In a cell that so few edges of boxes cross it is cut along all of them.
const FEW: usize = 12;
/// Cells that boxes may ask for, and more of them for each box: long ones that cross ask for the square of their number.
const CUTS: usize = 2048;
const CUTS_OF_EACH: usize = 4;
/// So many cells are made of the whole before anything is known, by this many halvings of one at most.
const FIRST: usize = 256;
const HALVINGS: u32 = 8;
/// Up to so many are halved once more than that asks for.
const MANY: usize = 1 << 12;

/// A rectangle of the plane across an axis; its coordinates are those of the two axes after it, in turn.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rect {
    /// 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// The smallest corner.
    pub min: DVec2,
    /// The largest.
    pub max: DVec2,
}

impl Rect {
    /// What a box is along an axis.
    pub fn of(bounds: &Aabb, axis: usize) -> Rect {
        let flat = |p: glam::DVec3| DVec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3]);
        Rect { axis, min: flat(bounds.min), max: flat(bounds.max) }
    }

    /// The sides.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// The area.
    pub fn area(&self) -> f64 {
        let size = self.size();
        size.x * size.y
    }

    /// The two parts below and above a coordinate along one side.
    pub fn split(self, along: usize, at: f64) -> [Rect; 2] {
        let mut parts = [self, self];
        parts[0].max[along] = at;
        parts[1].min[along] = at;
        parts
    }

    fn overlaps(&self, other: &Rect) -> bool {
        self.min.cmplt(other.max).all() && other.min.cmplt(self.max).all()
    }
}

/// A rectangle, and how it is cut.
#[derive(Clone, Copy, Debug)]
struct Node {
    rect: Rect,
    /// Along which side, where, and the first of its two parts.
    cut: Option<(usize, f64, u32)>,
    /// The cell that it is.
    cell: Option<u32>,
}

/// Cuts of the planes across some axes.
#[derive(Clone, Default, Debug)]
pub struct Planes {
    nodes: Vec<Node>,
    /// For each axis.
    roots: [Option<u32>; 3],
    /// What is narrower is not cut, world length.
    grain: f64,
}

impl Planes {
    /// The planes across some axes of what lies in a box, cut along the boxes of leaves; and the first cells, in order.
    pub fn new(bounds: &Aabb, boxes: &[Aabb], axes: &[usize], grain: f64) -> (Planes, Vec<Rect>) {
        let mut planes = Planes { nodes: Vec::new(), roots: [None; 3], grain };
        let mut cells = Vec::new();
        for &axis in axes {
            let whole = Rect::of(bounds, axis);
            let root = planes.add(whole);
            planes.roots[axis] = Some(root);
            let boxes = boxes.iter().filter(|b| !b.is_empty()).map(|b| Rect::of(b, axis));
            let plots = planes.plots(root, boxes.filter(|b| b.overlaps(&whole)).collect());
            let (count, mut halvings) = (plots.len().max(1), 0);
            while halvings < HALVINGS && (count << halvings < FIRST || halvings < 2 && count < MANY) {
                halvings += 1;
            }
            for plot in plots {
                cells.extend(planes.halved(plot, halvings));
            }
        }
        for (i, node) in (0..).zip(&cells) {
            planes.nodes[*node as usize].cell = Some(i);
        }
        let rects = cells.iter().map(|node| planes.nodes[*node as usize].rect).collect();
        (planes, rects)
    }

    fn add(&mut self, rect: Rect) -> u32 {
        self.nodes.push(Node { rect, cut: None, cell: None });
        self.nodes.len() as u32 - 1
    }

    fn split(&mut self, node: u32, along: usize, at: f64) -> [u32; 2] {
        let parts = self.nodes[node as usize].rect.split(along, at).map(|rect| self.add(rect));
        self.nodes[node as usize].cut = Some((along, at, parts[0]));
        parts
    }

    /// Cuts out what is narrow first, the widest cells first; what lies in no box is left.
    fn plots(&mut self, root: u32, boxes: Vec<Rect>) -> Vec<u32> {
        let most = CUTS + CUTS_OF_EACH * boxes.len();
        let (mut open, mut later) = (VecDeque::from([(root, boxes)]), VecDeque::new());
        let (mut plots, mut waits) = (Vec::new(), true);
        while let Some((node, boxes)) = open.pop_front().or_else(|| {
            waits = false;
            later.pop_front()
        }) {
            if boxes.is_empty() {
                continue;
            }
            let is_full = most < open.len() + later.len() + plots.len();
            match self.cut(node, &boxes).filter(|_| !is_full) {
                None => plots.push(node),
                Some(cut) if waits && !cut.is_narrow => later.push_back((node, boxes)),
                Some(Cut { along, at, .. }) => {
                    for part in self.split(node, along, at) {
                        let rect = self.nodes[part as usize].rect;
                        let inside = boxes.iter().copied().filter(|b| b.overlaps(&rect)).collect();
                        open.push_back((part, inside));
                    }
                    waits = true;
                }
            }
        }
        plots.sort_unstable();
        plots
    }

    /// Where edges of boxes ask for a cut of a node: through the middle one across which some box is narrowest.
    fn cut(&self, node: u32, boxes: &[Rect]) -> Option<Cut> {
        let rect = self.nodes[node as usize].rect;
        let mut edges = [0, 1].map(|along| {
            let is_in = |x: &f64| rect.min[along] + self.grain < *x && *x < rect.max[along] - self.grain;
            let all = boxes.iter().flat_map(|b| [b.min[along], b.max[along]]);
            all.filter(is_in).collect::<Vec<f64>>()
        });
        let count = edges[0].len() + edges[1].len();
        let narrowest = [0, 1].map(|along| {
            let is_cut = |b: &&Rect| rect.min[along] < b.min[along] || b.max[along] < rect.max[along];
            let share = |b: &Rect| b.size()[along] / rect.size()[along];
            boxes.iter().filter(is_cut).map(share).fold(f64::INFINITY, f64::min)
        });
        let along = match [edges[0].is_empty(), edges[1].is_empty()] {
            [true, true] => return None,
            [false, true] => 0,
            [true, false] => 1,
            [false, false] => usize::from(narrowest[1] < narrowest[0]),
        };
        let is_narrow = narrowest[along] < NARROW;
        if !is_narrow && FEW < count {
            return None;
        }
        let middle = edges[along].len() / 2;
        let (_, at, _) = edges[along].select_nth_unstable_by(middle, f64::total_cmp);
        Some(Cut { along, at: *at, is_narrow })
    }

    /// The parts of a node that so many halvings of the longer side make.
    fn halved(&mut self, node: u32, times: u32) -> Vec<u32> {
        let mut parts = vec![node];
        for _ in 0..times {
            let halves = parts.iter().flat_map(|part| {
                let Rect { min, max, .. } = self.nodes[*part as usize].rect;
                let along = usize::from(max.x - min.x < max.y - min.y);
                self.split(*part, along, 0.5 * (min[along] + max[along]))
            });
            parts = halves.collect();
        }
        parts
    }

    /// Whether a cell can be cut.
    pub fn is_wide(&self, rect: &Rect) -> bool {
        2.0 * self.grain < rect.size().max_element()
    }

    /// Cuts a cell; its parts are numbered from `next` on.
    pub fn refine(&mut self, rect: &Rect, next: u32) -> Vec<Rect> {
        let Some(node) = self.node_at(rect.axis, 0.5 * (rect.min + rect.max)) else { return Vec::new() };
        let (size, middle) = (rect.size(), 0.5 * (rect.min + rect.max));
        let long = usize::from(size.x < size.y);
        let mut parts: Vec<u32> = self.split(node, long, middle[long]).into();
        if size[long] <= 2.0 * size[1 - long] {
            parts = parts.into_iter().flat_map(|p| self.split(p, 1 - long, middle[1 - long])).collect();
        }
        self.nodes[node as usize].cell = None;
        for (part, cell) in parts.iter().zip(next..) {
            self.nodes[*part as usize].cell = Some(cell);
        }
        parts.into_iter().map(|part| self.nodes[part as usize].rect).collect()
    }

    fn node_at(&self, axis: usize, at: DVec2) -> Option<u32> {
        let mut node = self.roots[axis]?;
        let Rect { min, max, .. } = self.nodes[node as usize].rect;
        if !(min.cmple(at).all() && at.cmple(max).all()) {
            return None;
        }
        while let Some((along, cut, first)) = self.nodes[node as usize].cut {
            node = first + u32::from(cut <= at[along]);
        }
        Some(node)
    }

    /// The cells around one that are more than half again as wide or high.
    pub fn coarser_around(&self, rect: &Rect) -> impl Iterator<Item = u32> {
        let (size, middle) = (rect.size(), 0.5 * (rect.min + rect.max));
        let around =
            (0..9).filter(|i| *i != 4).map(move |i| DVec2::new(f64::from(i % 3), f64::from(i / 3)) - 1.0);
        around.filter_map(move |toward| {
            let Node { rect: found, cell, .. } =
                self.nodes[self.node_at(rect.axis, middle + toward * size)? as usize];
            cell.filter(|_| (1.5 * size).cmplt(found.size()).any())
        })
    }
}

/// A cut along one side.
#[derive(Clone, Copy)]
struct Cut {
    along: usize,
    at: f64,
    is_narrow: bool,
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::num::hash::Stream;

    /// Boxes from a thousandth of the whole to half of it.
    fn boxes(count: usize) -> Vec<Aabb> {
        let mut stream = Stream::new(5);
        let mut point = || DVec3::new(stream.unit(), stream.unit(), stream.unit());
        let one = |_| {
            let min = 0.5 * point();
            Aabb { min, max: min + 0.5 * 0.002f64.powf(point().x) * (0.1 + point()).min(DVec3::ONE) }
        };
        (0..count).map(one).collect()
    }

    #[test]
    fn every_box_has_cells_of_its_own_size() {
        let whole = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        for count in [1, 10, 300] {
            let boxes = boxes(count);
            let (_, cells) = Planes::new(&whole, &boxes, &[2], 1e-14);
            for b in &boxes {
                let flat = Rect::of(b, 2);
                let mut near = cells.iter().filter(|cell| cell.overlaps(&flat));
                assert!(near.any(|cell| cell.size().cmple(2.001 * flat.size()).all()), "{b:?}");
            }
            // Of one box all cells are its own.
            assert!(1 < count || cells.iter().all(|cell| cell.overlaps(&Rect::of(&boxes[0], 2))));
        }
    }

    #[test]
    fn cells_that_are_cut_tile_what_they_were() {
        let whole = Aabb { min: DVec3::ZERO, max: DVec3::new(4.0, 1.0, 1.0) };
        let (mut planes, cells) = Planes::new(&whole, &[whole], &[2], 1e-14);
        let parts = planes.refine(&cells[0], cells.len() as u32);
        assert!((parts.iter().map(Rect::area).sum::<f64>() - cells[0].area()).abs() < 1e-15);
        // Those beside it are larger than its parts now.
        assert!(parts.iter().any(|part| 0 < planes.coarser_around(part).count()));
        let area = cells.iter().map(Rect::area).sum::<f64>();
        assert!((area - 4.0).abs() < 1e-12);
    }
}
