//! Quadrics: where a polynomial of the second degree is below zero.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::num::roots;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "quadric",
        group: Group::Primitive,
        doc: "Where a quadratic form is below zero: squares by x^2, y^2, z^2, products by xy, yz, zx, linear by x, y, z.",
        params: &[
            Param::named("squares", Kind::Vector(3), "factors of x^2, y^2, z^2 (default 0)"),
            Param::named("products", Kind::Vector(3), "factors of x y, y z, z x (default 0)"),
            Param::named("linear", Kind::Vector(3), "factors of x, y, z (default 0)"),
            Param::named("constant", Kind::Number, "what is added (default 0)"),
        ],
        example: "quadric(squares: [1, 1, -1], constant: -0.25)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    let of = |name| call.vec3(name).unwrap_or(DVec3::ZERO);
    let (squares, products, linear) = (of("squares"), of("products"), of("linear"));
    if squares == DVec3::ZERO && products == DVec3::ZERO && linear == DVec3::ZERO {
        return Err(BuildError {
            param: "",
            message: "a quadric needs a factor that is not zero".into(),
            help: "write `quadric(squares: [1, 1, 0], constant: -1)` for all x^2 + y^2 < 1".into(),
        });
    }
    Ok(Arc::new(Quadric::new(squares, products, linear, call.number("constant").unwrap_or(0.0))))
}

/// Points with p . A p + 2 b . p + c < 0. Unbounded for all but ellipsoids.
#[derive(Clone, Copy, Debug)]
pub struct Quadric {
    /// Symmetric.
    a: DMat3,
    b: DVec3,
    c: f64,
    /// Of an ellipsoid its centre, the inverse of `a`, and the square of its size in the metric of `a`; zero if it holds
    /// nothing.
    ellipsoid: Option<(DVec3, DMat3, f64)>,
}

/// A leading minor is above zero beyond doubt if it is above this share of the product of the squares in it: rounding
/// and the inverse are then harmless.
const DEFINITE: f64 = 64.0 * tolerance::EPS;

impl Quadric {
    /// From the factors of x^2, y^2, z^2, of x y, y z, z x, of x, y, z, and what is added.
    pub fn new(squares: DVec3, products: DVec3, linear: DVec3, c: f64) -> Quadric {
        let h = 0.5 * products;
        let a = DMat3::from_cols(
            DVec3::new(squares.x, h.x, h.z),
            DVec3::new(h.x, squares.y, h.y),
            DVec3::new(h.z, h.y, squares.z),
        );
        let mut quadric = Quadric { a, b: 0.5 * linear, c, ellipsoid: None };
        // Sylvester's criterion.
        let two = squares.x * squares.y;
        let definite = 0.0 < squares.x
            && DEFINITE * two < two - h.x * h.x
            && DEFINITE * two * squares.z < a.determinant();
        if definite {
            let inverse = a.inverse();
            let center = -(inverse * quadric.b);
            quadric.ellipsoid = Some((center, inverse, (-quadric.value(center)).max(0.0)));
        }
        quadric
    }

    fn value(&self, p: DVec3) -> f64 {
        p.dot(self.a * p + 2.0 * self.b) + self.c
    }

    /// Half the derivative of the value at `p` along `d`.
    fn half_slope(&self, p: DVec3, d: DVec3) -> f64 {
        d.dot(self.a * p + self.b)
    }

    /// The line's quadratic a u^2 + 2 b u + c about `o`. What cannot be told from zero is zero: a root that only its
    /// rounding error makes would lie farther off than any length in play.
    fn along(&self, o: DVec3, d: DVec3) -> [f64; 3] {
        let size = DMat3::from_cols(self.a.x_axis.abs(), self.a.y_axis.abs(), self.a.z_axis.abs());
        let rounding = tolerance::FORM * tolerance::EPS;
        let a = d.dot(self.a * d);
        if rounding * d.abs().dot(size * d.abs()) < a.abs() {
            return [a, self.half_slope(o, d), self.value(o)];
        }
        let b = self.half_slope(o, d);
        let noise = rounding * d.abs().dot(size * o.abs() + self.b.abs());
        [0.0, if noise < b.abs() { b } else { 0.0 }, self.value(o)]
    }

    /// b^2 - a c. Where the two nearly cancel, at the quadratic's lowest point instead, where it is the value of the form
    /// at a point of the ray, as exact as any.
    fn discriminant(&self, o: DVec3, d: DVec3, [a, b, c]: [f64; 3]) -> f64 {
        let plain = b * b - a * c;
        if 0.5 * b * b < plain {
            return plain;
        }
        let lowest = o - (b / a) * d;
        let b = self.half_slope(lowest, d);
        b * b - a * self.value(lowest)
    }
}

impl Solid for Quadric {
    fn bounds(&self) -> Aabb {
        // What a box holds it must hold in spite of rounding; it decides nothing.
        let tight = self.extent_under(&DAffine3::IDENTITY);
        tight.inflated(if tight.is_finite() { tight.diagonal() / 1024.0 } else { 0.0 })
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        let Some((center, inverse, size)) = self.ellipsoid else { return Aabb::ALL };
        if size == 0.0 {
            return Aabb::EMPTY;
        }
        // Along n an ellipsoid p . A p < k reaches the root of k n . A^-1 n.
        let rows = to_from.matrix3.transpose();
        let reach = [rows.x_axis, rows.y_axis, rows.z_axis].map(|n| (size * n.dot(inverse * n)).sqrt());
        let (center, reach) = (to_from.transform_point3(center), DVec3::from_array(reach));
        Aabb { min: center - reach, max: center + reach }
    }

    /// At most two crossings; between them the line is inside where the quadratic is convex, outside where it is concave.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let about = self.ellipsoid.map_or(DVec3::ZERO, |(center, ..)| center);
        let (shift, o) = ray.nearest_to(about);
        let (o, d) = (o + about, ray.dir);
        let line = self.along(o, d);
        let [a, b, c] = line;
        if a == 0.0 {
            if b == 0.0 {
                return Answer::whole_line(c < 0.0);
            }
            out.push(Crossing::exact(shift - 0.5 * c / b, b < 0.0, 0));
            return Answer::whole_line(0.0 < b);
        }
        let mut inside = a < 0.0;
        if let Some(pair) = roots::quadratic(a, b, c, self.discriminant(o, d, line)) {
            let [lo, hi] = pair.map(|u| shift + u);
            let (begins, ends) = (lo.is_finite(), hi.is_finite());
            if begins && lo < hi {
                out.push(Crossing::exact(lo, !inside, 0));
            }
            if ends && lo < hi {
                out.push(Crossing::exact(hi, inside, 0));
            }
            // A root at infinity is crossed before the line begins.
            inside ^= !begins && lo < hi;
        }
        Answer::whole_line(inside)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        // At the apex of a cone there is no normal.
        (self.a * ray.at(crossing.t) + self.b).try_normalize().unwrap_or(DVec3::Z)
    }
}
