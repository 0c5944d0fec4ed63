//! Boxes around extrusions: how far the corners reach on their way up.
//!
//! The point of a corner q at height z reaches f(z) = row . (R(w z) M(z) q, z) along an axis of the image, R the turn and M the
//! scale, 1 - k z an axis. Without a turn f is straight and its ends are all. With one |f''| <= |row| |q| (w^2 m + 2 |w k|), m the
//! largest scale: over a piece of the path f lies within step^2 / 8 of that above its chord. Pieces whose bound is not above what is
//! reached somewhere are dropped, the others halved, until the bound is what is reached but for roundings (Piyavskii 1972). Oracle: of a
//! square turned by a quarter without scaling the corners reach their radius.

use glam::{DAffine3, DVec2, DVec3};

use super::Extrusion;
use crate::geom::Aabb;

/// Pieces of a whole turn at first.
const PIECES: f64 = 16.0;
/// Halvings: each leaves a quarter of what the first pieces, an eighth of (2 pi / 16)^2 high, leave; 2^-52 is a rounding.
const HALVINGS: usize = 24;

/// A corner's way between two heights.
#[derive(Clone, Copy)]
struct Piece {
    corner: DVec2,
    heights: [f64; 2],
}

impl Extrusion {
    /// A box around the image.
    pub(super) fn box_under(&self, to_from: &DAffine3) -> Aabb {
        let rows = to_from.matrix3.transpose();
        let mut all = Aabb { min: to_from.translation, max: to_from.translation };
        for (axis, row) in [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().enumerate() {
            all.min[axis] -= self.farthest(-row);
            all.max[axis] += self.farthest(row);
        }
        all
    }

    /// The largest `row . p` over its points.
    fn farthest(&self, row: DVec3) -> f64 {
        let end = |z: f64| {
            let corners = self.outline.edges().iter().map(|[corner, _]| self.reach(row, *corner, z));
            corners.fold(f64::NEG_INFINITY, f64::max)
        };
        let ends = end(0.0).max(end(self.height));
        if self.w == 0.0 { ends } else { self.farthest_turned(row, ends) }
    }

    fn reach(&self, row: DVec3, corner: DVec2, z: f64) -> f64 {
        let q = DVec2::from_angle(self.w * z).rotate(corner * (1.0 - self.k * z).max(DVec2::ZERO));
        row.dot(q.extend(z))
    }

    fn farthest_turned(&self, row: DVec3, ends: f64) -> f64 {
        let turns = self.w.abs() * self.height / std::f64::consts::TAU;
        let count = (PIECES * turns).ceil().max(1.0) as u32;
        let height = |i: u32| self.height * (f64::from(i) / f64::from(count));
        let mut step = self.height / f64::from(count);
        let largest = (1.0 - self.k * self.height).max_element().max(1.0);
        let bend = self.w * self.w * largest + 2.0 * self.w.abs() * self.k.abs().max_element();
        let rise =
            |corner: DVec2, step: f64| 0.125 * step * step * bend * row.truncate().length() * corner.length();
        let high = |piece: &Piece| {
            let [a, b] = piece.heights.map(|z| self.reach(row, piece.corner, z));
            a.max(b)
        };
        let corners = || self.outline.edges().iter().map(|[corner, _]| *corner);
        let way = move |corner: DVec2| {
            (0..count).map(move |i| Piece { corner, heights: [height(i), height(i + 1)] })
        };
        let mut reached = corners().flat_map(way).map(|piece| high(&piece)).fold(ends, f64::max);
        let may = |piece: &Piece, step: f64, reached: f64| reached < high(piece) + rise(piece.corner, step);
        let mut open: Vec<Piece> =
            corners().flat_map(way).filter(|piece| may(piece, step, reached)).collect();
        for _ in 0..HALVINGS {
            step *= 0.5;
            let halves = open.iter().flat_map(|Piece { corner, heights: [a, b] }| {
                let middle = 0.5 * (a + b);
                [[*a, middle], [middle, *b]].map(|heights| Piece { corner: *corner, heights })
            });
            let halves: Vec<Piece> = halves.collect();
            reached = halves.iter().map(high).fold(reached, f64::max);
            open = halves.into_iter().filter(|piece| may(piece, step, reached)).collect();
        }
        reached + open.iter().map(|piece| rise(piece.corner, step)).fold(0.0, f64::max)
    }
}
