//! Height fields: all points between the floor and a surface whose heights an image holds.
//!
//! Each pixel is a corner of the surface; between four of them it is bilinear. Two triangles a cell would choose a
//! diagonal that the image does not have; a bilinear cell has none, has the edges of its neighbours, and meets a ray in
//! the roots of one quadratic.

mod pyramid;

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3Swizzles as _};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid, parity};
use crate::geom::{Aabb, Interval, Ray};
use crate::heights::Heights;
use crate::num::roots;
use crate::scene::{Call, Decl, Group, Kind, Param, Value};

use pyramid::{Block, Pyramid};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "heightfield",
        group: Group::Primitive,
        doc: "The solid under a surface whose heights are the greys of an image: black is z = 0, white is z = h. The \
              middle of its floor is the origin; the image's left is at low x, its top at high y, its outermost \
              pixels lie on the border.",
        params: &[
            Param {
                name: "file",
                kind: Kind::Path,
                by_place: true,
                required: true,
                doc: "a PNG of 8 or 16 bits, or an EXR",
            },
            Param::required(
                "size",
                Kind::SizeOrVector,
                "[w, d, h]: extent along x, along y, height of white",
            ),
        ],
        example: "heightfield(\"hills.png\", size: [40, 30, 8])",
    },
    build: Build::Heights,
};

/// Makes the solid of a call whose image has been read.
pub fn build(call: &Call, heights: Heights) -> Arc<dyn Solid> {
    let size = match call.get("size") {
        Some(Value::Vector(v)) if v.len() == 3 => DVec3::new(v[0], v[1], v[2]),
        _ => DVec3::splat(call.number("size").unwrap_or(0.0)),
    };
    Arc::new(HeightField::new(heights, size))
}

/// Parts of the boundary: the surface, then the floor and the walls at low and high x and y.
const SURFACE: u32 = 0;
const FLOOR: u32 = 1;
const WALLS: u32 = 2;

/// Points of a rectangle about the origin with 0 <= z < f(x, y).
#[derive(Clone, Debug)]
pub struct HeightField {
    heights: Heights,
    pyramid: Pyramid,
    /// Low corner of the rectangle.
    low: DVec2,
    /// Extent of a cell.
    cell: DVec2,
    /// Height of 1.
    tall: f64,
    bounds: Aabb,
}

/// A cell: the heights of its corners at low x low y, high low, low high, high high.
#[derive(Clone, Copy, Debug)]
struct Cell {
    low: DVec2,
    h: [f64; 4],
}

impl HeightField {
    /// `size`: extent along x and y, height of white. Nothing where one of them is zero.
    pub fn new(heights: Heights, size: DVec3) -> HeightField {
        let cells = DVec2::new(heights.width as f64 - 1.0, heights.depth as f64 - 1.0);
        let highest = f64::from(heights.values.iter().copied().fold(0.0, f32::max)) * size.z;
        let half = 0.5 * size.xy();
        let bounds = Aabb { min: (-half).extend(0.0), max: half.extend(highest) };
        let pyramid = Pyramid::new(&heights);
        HeightField { heights, pyramid, low: -half, cell: size.xy() / cells, tall: size.z, bounds }
    }

    fn is_nothing(&self) -> bool {
        !(0.0 < self.cell.min_element() && 0.0 < self.bounds.max.z)
    }

    fn cells(&self) -> [usize; 2] {
        [self.heights.width - 1, self.heights.depth - 1]
    }

    fn height(&self, i: usize, j: usize) -> f64 {
        // Rows of the image run down, y runs up.
        let row = self.heights.depth - 1 - j;
        self.tall * f64::from(self.heights.values[row * self.heights.width + i])
    }

    fn cell(&self, i: usize, j: usize) -> Cell {
        let low = self.low + self.cell * DVec2::new(i as f64, j as f64);
        Cell { low, h: [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| self.height(i, j)) }
    }

    /// The cell that holds a place of the rectangle, a neighbour of it within roundings of a border.
    fn cell_at(&self, p: DVec2) -> Cell {
        let place = (p - self.low) / self.cell;
        let [w, d] = self.cells();
        // Casts saturate: what is left of the first cell counts to the first.
        self.cell((place.x as usize).min(w - 1), (place.y as usize).min(d - 1))
    }

    /// The surface's height and its slopes at a place, by the cell given.
    fn surface(&self, cell: &Cell, p: DVec2) -> (f64, DVec2) {
        let uv = (p - cell.low) / self.cell;
        let [a, b, c, d] = cell.h;
        let twist = (d - c) - (b - a);
        let slope = DVec2::new((b - a) + twist * uv.y, (c - a) + twist * uv.x);
        (a + (b - a) * uv.x + (c - a) * uv.y + twist * uv.x * uv.y, slope / self.cell)
    }

    fn contains(&self, p: DVec3) -> bool {
        let q = p.xy();
        let over = self.bounds.min.xy().cmple(q).all() && q.cmplt(self.bounds.max.xy()).all();
        over && 0.0 <= p.z && p.z < self.surface(&self.cell_at(q), q).0
    }

    /// Shows the roots of a ray with the surface of a cell in a range of t: with s = t - t0, t0 the range's middle,
    /// z - f(x, y) = c + 2 b s + a s^2, where a is the product of both slopes across the cell and its twist. Roots
    /// beyond the range go, but for the room that [`Pyramid::cells_on`] has left.
    fn roots(&self, cell: &Cell, ray: &Ray, range: Interval, mut show: impl FnMut(f64)) {
        let middle = 0.5 * (range.lo + range.hi);
        let p = ray.at(middle);
        let (height, slope) = self.surface(cell, p.xy());
        let twist = (cell.h[3] - cell.h[2]) - (cell.h[1] - cell.h[0]);
        let across = ray.dir.xy() / self.cell;
        let (a, b, c) =
            (-twist * across.x * across.y, 0.5 * (ray.dir.z - slope.dot(ray.dir.xy())), p.z - height);
        let mut keep = |s: f64| {
            if range.contains(middle + s) {
                show(middle + s);
            }
        };
        if a == 0.0 {
            keep(-0.5 * c / b);
        } else if let Some(both) = roots::quadratic(a, b, c, b * b - a * c) {
            both.into_iter().for_each(keep);
        }
    }
}

impl Solid for HeightField {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Candidates are the planes of floor and walls, and the roots of all cells whose heights the ray passes between;
    /// which of them count is decided in the middle of the gaps. Tested against boxes, wedges and saddles in closed
    /// form and against all cells one by one.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let near = self.bounds.clip(ray);
        if self.is_nothing() || near.is_empty() {
            return Answer::whole_line(false);
        }
        let start = out.len();
        let from = 0.5 * (near.lo + near.hi);
        let own = Ray { origin: ray.at(from), dir: ray.dir };
        let mut show = |t: f64, part: u32| out.push(Crossing::exact(t, true, part));
        show(-own.origin.z / own.dir.z, FLOOR);
        for axis in 0..2 {
            for (high, at) in [self.bounds.min[axis], self.bounds.max[axis]].into_iter().enumerate() {
                show((at - own.origin[axis]) / own.dir[axis], WALLS + 2 * axis as u32 + high as u32);
            }
        }
        let block = Block { low: self.low, cell: self.cell, tall: self.tall };
        self.pyramid.cells_on(&own, &block, &self.bounds, |i, j, range| {
            self.roots(&self.cell(i, j), &own, range, |t| show(t, SURFACE));
        });
        parity::where_it_changes(out, start, |t| self.contains(own.at(t)));
        parity::shift(out, start, from);
        Answer::whole_line(false)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        let normal = match crossing.part {
            SURFACE => {
                let q = ray.at(crossing.t).xy();
                (-self.surface(&self.cell_at(q), q).1).extend(1.0)
            }
            FLOOR => DVec3::Z,
            part if part < WALLS + 2 => DVec3::X,
            _ => DVec3::Y,
        };
        parity::outward(normal, ray, crossing)
    }
}
