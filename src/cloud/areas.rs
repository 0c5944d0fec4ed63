//! The area each sample stands for.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::neighbours::{Neighbours, Table};

/// Neighbours that can bound a cell: in a random sampling a Voronoi cell has six, and more than 16 in one of
/// a million.
const AREA_NEIGHBOURS: usize = 16;

/// The disc that bounds a cell, in widths of its sample. On a ball of 20,000 quasi-random samples with a cap missing,
/// half a width cuts a quarter of the area off, three quarters leave it right to 0.4 % and one width adds 0.7 %.
pub const AREA_REACH: f64 = 0.75;

/// Corners of the polygon that stands for the disc.
const CORNERS: usize = 16;

/// Corners at most: each neighbour adds one.
const MOST: usize = CORNERS + AREA_NEIGHBOURS + 1;

/// The area of each sample's Voronoi cell in its tangent plane, within a disc of radius half its width (a
/// regular 16-gon of the disc's area); world length squared.
///
/// Cells of samples inside the surface fill it without gap. At a rim a cell ends at the disc: half a width is
/// 1.25 spacings in a random sampling, which cuts 1 % off the cells there and adds less than a spacing
/// beyond a rim. Normals need no sign. `tree` is that of the points.
pub fn areas(points: &[DVec3], normals: &[DVec3], widths: &[f64], tree: &Neighbours) -> Vec<f64> {
    let unit = Polygon::disc(1.0);
    tree.map(AREA_NEIGHBOURS, |i, near| {
        let (i, near) = (i as usize, near.iter().map(|n| n.index));
        cell(points, normals[i], &unit, 0.5 * widths[i], i, near)
    })
}

/// The same by a table of neighbours, of which the first sixteen count.
pub fn areas_by(points: &[DVec3], normals: &[DVec3], widths: &[f64], table: &Table) -> Vec<f64> {
    let unit = Polygon::disc(1.0);
    let near = |i: usize| table.row(i).iter().copied().take(AREA_NEIGHBOURS);
    let area = |i: usize| cell(points, normals[i], &unit, 0.5 * widths[i], i, near(i));
    (0..points.len()).into_par_iter().map(area).collect()
}

/// Axes of the plane across a unit vector (Duff et al. 2017); any for zero.
pub fn tangents(n: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

fn cell(
    points: &[DVec3],
    normal: DVec3,
    unit: &Polygon,
    reach: f64,
    i: usize,
    near: impl Iterator<Item = u32>,
) -> f64 {
    let (u, v) = tangents(normal);
    let mut polygon = unit.scaled(reach);
    for j in near {
        let d = points[j as usize] - points[i];
        let to = DVec2::new(d.dot(u), d.dot(v));
        // A neighbour more than half a reach off the plane is of another sheet.
        if d.dot(normal).abs() <= 0.5 * reach && 0.0 < to.length_squared() {
            polygon.cut(to, 0.5 * to.length_squared());
        }
    }
    polygon.area()
}

/// A convex polygon around the origin.
struct Polygon {
    corners: [DVec2; MOST],
    len: usize,
}

impl Polygon {
    /// The regular polygon with the area of a disc.
    fn disc(radius: f64) -> Polygon {
        let step = std::f64::consts::TAU / CORNERS as f64;
        // Its area is CORNERS / 2 r^2 sin(step).
        let r = radius * (step / step.sin()).sqrt();
        let corner =
            |k: usize| if k < CORNERS { r * DVec2::from_angle(step * k as f64) } else { DVec2::ZERO };
        Polygon { corners: std::array::from_fn(corner), len: CORNERS }
    }

    fn scaled(&self, by: f64) -> Polygon {
        Polygon { corners: self.corners.map(|c| by * c), len: self.len }
    }

    /// Keeps what has `x . to <= limit` (Sutherland and Hodgman 1974).
    fn cut(&mut self, to: DVec2, limit: f64) {
        let old = &self.corners[..self.len];
        if old.iter().all(|c| c.dot(to) <= limit) {
            return;
        }
        let mut kept = [DVec2::ZERO; MOST];
        let mut len = 0;
        let mut push = |c: DVec2| {
            // A line meets a convex polygon in two points, so a cut adds one corner at most, but for rounding.
            if len < MOST {
                kept[len] = c;
                len += 1;
            }
        };
        for (k, &a) in old.iter().enumerate() {
            let b = old[(k + 1) % old.len()];
            let (over_a, over_b) = (a.dot(to) - limit, b.dot(to) - limit);
            if over_a <= 0.0 {
                push(a);
            }
            if (over_a <= 0.0) != (over_b <= 0.0) {
                push(a + (b - a) * (over_a / (over_a - over_b)));
            }
        }
        (self.corners, self.len) = (kept, len);
    }

    fn area(&self) -> f64 {
        let corners = &self.corners[..self.len];
        let twice: f64 =
            corners.iter().enumerate().map(|(k, a)| a.perp_dot(corners[(k + 1) % corners.len()])).sum();
        0.5 * twice.max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_lattice_are_its_squares_and_a_lone_cell_is_the_disc() {
        let points: Vec<DVec3> =
            (0..49).map(|i| DVec3::new(f64::from(i % 7), f64::from(i / 7), 0.0)).collect();
        let found = areas(&points, &[DVec3::Z; 49], &[2.5; 49], &Neighbours::new(&points));
        assert!((found[24] - 1.0).abs() < 1e-14, "{}", found[24]);
        assert!(found[0] < 3.1 && 1.5 < found[0], "a corner: {}", found[0]);
        let disc = Polygon::disc(2.0).area();
        assert!((disc / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn tangents_are_a_frame() {
        for n in [DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::Z, DVec3::ONE.normalize()] {
            let (u, v) = tangents(n);
            assert!((u.cross(v) - n).length() < 1e-15 && u.dot(v).abs() < 1e-15);
        }
    }
}
