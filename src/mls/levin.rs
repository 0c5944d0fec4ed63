//! The plane of Levin's definition, form B: n spans the direction of least spread of the samples about q, and q is critical
//! along n.
//!
//! With theta, phi and the names of [`super::plane`], (n, t) solves
//!
//! ```text
//! K = B^T sum (2 s theta phi d - theta s^2 phi' m) = 0      T = J_t = 0
//! ```
//!
//! which is form A's system without the terms by which q follows n. It has no energy; its solution lies within some
//! thousandths of a width of form A's, so Newton's method from there settles in two or three steps, with the unsymmetric
//! Jacobian
//!
//! ```text
//! K_n = B^T [sum phi (2 theta - 4 t s theta') d d^T - 2 s theta phi' d m^T
//!            - (2 s theta - 2 t s^2 theta') phi' m d^T + theta s^2 phi'' m m^T] B - (n . K) I
//! K_t = B^T sum phi (-2 theta - 4 s^2 theta') d + (2 s theta + 2 s^3 theta') phi' m
//! T_n = J_nt^T     T_t = J_tt
//! ```
//!
//! Every point of the line q + s n has the same plane, so the projection is idempotent (Amenta and Kil 2004), which
//! form A is not.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::{DMat3, DVec3};

use super::blocks::Near;
use super::plane::Plane;
use super::{Facing, Stray, Weight};
use crate::num::lanes::{Lanes, sum};

/// The system at some (n, t) in a tangent basis.
#[derive(Clone, Copy, Debug)]
pub(super) struct System {
    /// K in the basis, and T.
    residual: DVec3,
    /// Its derivatives: columns by the turn of n along the basis, and by t.
    jacobian: DMat3,
    /// Its derivatives with respect to r, held at (n, t): columns in the basis (e1, e2, n).
    by_r: DMat3,
}

impl System {
    /// How the plane answers a displacement of r: columns in the basis (e1, e2, n), rows the turn of n along e1 and e2,
    /// and the change of t. `None` where the plane is not determined.
    pub fn response(&self) -> Option<DMat3> {
        Some(-invert(&self.jacobian)? * self.by_r)
    }
}

/// More steps than this mean that there is nothing to settle in.
const MAX_STEPS: usize = 24;
/// A step below this many local units leaves an error of its square, below rounding.
const LAST_STEP: f64 = 1e-8;
/// The solution is looked for no farther from form A's than this, radians and local units.
const FARTHEST: f64 = 0.5;

/// Walks from form A's plane to Levin's. The tangent basis turns along.
pub(super) fn settle<W: Weight, A: Facing>(
    weight: W,
    _: A,
    near: Near,
    r: DVec3,
    start: &Plane,
) -> Result<Plane, Stray> {
    let mut plane = *start;
    for _ in 0..MAX_STEPS {
        let (e1, e2) = plane.n.any_orthonormal_pair();
        let system = system::<W, A>(weight, near, r, &plane, [e1, e2]);
        let step = -invert(&system.jacobian).ok_or(Stray::IllConditioned)? * system.residual;
        let size = step.length();
        if !size.is_finite() {
            return Err(Stray::IllConditioned);
        }
        let n = (plane.n + step.x * e1 + step.y * e2).normalize();
        plane = Plane { n, t: plane.t + step.z };
        if FARTHEST < (n - start.n).length().max((plane.t - start.t).abs()) {
            return Err(Stray::Outside);
        }
        if size <= LAST_STEP {
            return Ok(plane);
        }
    }
    Err(Stray::Unsettled)
}

/// The system at a plane in a tangent basis.
pub(super) fn system<W: Weight, A: Facing>(
    weight: W,
    near: Near,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
) -> System {
    dispatch!(Level::new(), simd => system_in::<_, W, A>(simd, weight, near, r, plane, basis))
}

#[inline(always)]
fn system_in<S: Simd, W: Weight, A: Facing>(
    simd: S,
    weight: W,
    near: Near,
    r: DVec3,
    plane: &Plane,
    [e1, e2]: [DVec3; 2],
) -> System {
    let Plane { n, t } = *plane;
    let zero = Lanes::splat(simd, 0.0);
    let mut k = [zero; 3];
    let mut k_n = [[zero; 2]; 2];
    let mut k_t = [zero; 2];
    let mut t_n = [zero; 2];
    let (mut j_t, mut j_tt) = (zero, zero);
    // By r: the parts along x and along n, of K by rows, of T.
    let mut k_r = [[zero; 3]; 2];
    let mut t_r = [zero; 3];
    for block in 0..near.len() {
        let (p, ih2) = near.block(simd, block);
        let d = p.minus(r);
        let x = [d.dot(e1), d.dot(e2), d.dot(n) - t];
        let s = x[2];
        let [w, w1, w2] = weight.jet(simd, (x[0] * x[0] + x[1] * x[1] + s * s) * ih2);
        let (w1, w2) = (w1 * ih2, w2 * (ih2 * ih2));
        let m = near.normals(simd, block);
        let m = [m.dot(e1), m.dot(e2), m.dot(n)];
        let [f, f1, f2] = A::jet(simd, -m[2]);
        let s2 = s * s;
        let d = [x[0], x[1], d.dot(n)];
        let pull = w * s * f * 2.0;
        let turn = w * s2 * f1;
        for i in 0..3 {
            k[i] += pull * d[i] - turn * m[i];
        }
        let along = (w * s + w1 * s2 * s) * -2.0;
        j_t += along * f;
        j_tt += ((w + w) + w1 * s2 * 10.0 + w2 * (s2 * s2) * 4.0) * f;
        let mixed = w1 * s * (4.0 * t) - (w + w) - w1 * s2 * 6.0 + w2 * (s2 * s) * (4.0 * t);
        let own = ((w + w) - w1 * s * (4.0 * t)) * f;
        let (to_m, from_m) = (w * s * f1 * 2.0, (w * s - w1 * s2 * t) * f1 * 2.0);
        let facing = w * s2 * f2;
        let fall = ((w + w) + w1 * s2 * 4.0) * f;
        for i in 0..2 {
            for j in 0..2 {
                k_n[i][j] +=
                    own * d[i] * d[j] - to_m * d[i] * m[j] - from_m * m[i] * d[j] + facing * m[i] * m[j];
            }
            k_t[i] -= fall * d[i] + along * f1 * m[i];
            t_n[i] += mixed * f * d[i] - along * f1 * m[i];
            // dd = -dr, ds = -n . dr, d|x|^2 = -2 x . dr.
            let by_x = w1 * s * f * d[i] * -4.0 + w1 * s2 * f1 * m[i] * 2.0;
            for (j, x) in x.iter().enumerate() {
                k_r[i][j] += by_x * *x;
            }
            k_r[i][i] -= pull;
            k_r[i][2] += (s * f1 * m[i] - f * d[i]) * w * 2.0;
        }
        let by_x = (w1 * s + w2 * (s2 * s)) * f * 4.0;
        for (j, x) in x.iter().enumerate() {
            t_r[j] += by_x * *x;
        }
        t_r[2] += ((w + w) + w1 * s2 * 6.0) * f;
    }
    let normal = sum(k[2]);
    let row = |v: [Lanes<S>; 3]| DVec3::from_array(v.map(sum));
    let k_n = k_n.map(|row| row.map(sum));
    let rows = [
        DVec3::new(k_n[0][0] - normal, k_n[0][1], sum(k_t[0])),
        DVec3::new(k_n[1][0], k_n[1][1] - normal, sum(k_t[1])),
        DVec3::new(sum(t_n[0]), sum(t_n[1]), sum(j_tt)),
    ];
    System {
        residual: DVec3::new(sum(k[0]), sum(k[1]), sum(j_t)),
        jacobian: DMat3::from_cols(rows[0], rows[1], rows[2]).transpose(),
        by_r: DMat3::from_cols(row(k_r[0]), row(k_r[1]), row(t_r)).transpose(),
    }
}

/// The inverse of a matrix that is not too flat.
fn invert(m: &DMat3) -> Option<DMat3> {
    // A determinant this far below the product of the columns' lengths has no correct digit left.
    const FLATTEST: f64 = 1e-10;
    let size = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    (FLATTEST * size < m.determinant().abs()).then(|| m.inverse())
}
