//! The reference plane: a local minimum (n, t) of J by Newton's method, form A of the definition.
//!
//! With d = p - r, s = n.d - t, x = d - t n, theta' and theta'' the derivatives of the weight with respect to
//! |x|^2 (everything in local units):
//!
//! ```text
//! J_n  = sum (2 s theta - 2 t s^2 theta') d          J_t  = sum -2 s theta - 2 s^3 theta'
//! J_nn = sum (2 theta - 8 t s theta' + 4 t^2 s^2 theta'') d d^T
//! J_nt = sum (-2 theta - 6 s^2 theta' + 4 t s theta' + 4 t s^3 theta'') d
//! J_tt = sum 2 theta + 10 s^2 theta' + 4 s^4 theta''
//! ```
//!
//! On the unit sphere with the tangent basis B the Riemannian Hessian is B^T J_nn B - (n . J_n) I. For the Gaussian
//! these are the formulas of the literature; here theta is any weight. Checked against finite differences.

use glam::{DMat3, DVec3};

use super::neighbours::Neighbours;
use super::{Stray, Weight};
use crate::num::cholesky::Cholesky;
use crate::num::eigen::symmetric3;
use crate::num::lanes::{F4, V4};

/// A plane in the frame of the point r, local units: q = r + t n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Unit normal, into the solid.
    pub n: DVec3,
    /// Signed distance of the plane from r along n.
    pub t: f64,
}

/// J and its derivatives at some (n, t), in the tangent basis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// The energy.
    pub energy: f64,
    /// The sum of the weights.
    pub weight: f64,
    /// Tangent basis of the sphere of normals at n.
    pub basis: [DVec3; 2],
    /// The gradient in (basis, t).
    pub gradient: [f64; 3],
    /// The Hessian in (basis, t).
    pub hessian: [[f64; 3]; 3],
}

/// Newton's steps are halved until the energy falls; more halvings than this mean that rounding decides.
const MAX_HALVINGS: usize = 12;
/// Two to four steps are usual; more than this means that there is no minimum to settle in.
const MAX_STEPS: usize = 24;
/// A step below this many local units (radians) is followed by an error of its square: below rounding.
const LAST_STEP: f64 = 3e-8;
/// The largest single step, radians and local units: the quadratic model is good for no more.
const LONGEST_STEP: f64 = 0.5;

/// Where the search starts: the mean normal of the oriented samples, weighted about r, which points at the
/// sheet that r belongs to where two are in reach; the plane through their weighted centroid. It depends on r
/// alone, never on an earlier search, and so does the branch it leads to.
pub(super) fn start(weight: impl Weight, near: &Neighbours, r: DVec3) -> Result<Plane, Stray> {
    let (mut sum, mut centroid, mut normal) = (F4::ZERO, V4::default(), V4::default());
    for (p, outward, ih2) in near.blocks() {
        let d = p.minus(r);
        let w = weight.value(d.length_squared() * ih2);
        sum += w;
        d.add_to(w, &mut centroid);
        outward.add_to(w, &mut normal);
    }
    let sum = sum.sum();
    // Below this share of one full sample nothing is near: r lies outside every support.
    const NOTHING: f64 = 1e-6;
    if sum < NOTHING {
        return Err(Stray::Sparse);
    }
    let centroid = centroid.sum() / sum;
    let mean = normal.sum() / sum;
    // Normals that cancel to less than this are those of two sheets, or of none.
    const COHERENT: f64 = 0.3;
    let n =
        if COHERENT < mean.length() { -mean.normalize() } else { principal(weight, near, r, centroid, mean) };
    Ok(Plane { n, t: n.dot(centroid) })
}

/// The direction of least spread of the weighted samples about their centroid, turned against `outward`.
fn principal(weight: impl Weight, near: &Neighbours, r: DVec3, centroid: DVec3, outward: DVec3) -> DVec3 {
    let mut m = DMat3::ZERO;
    for (p, _, ih2) in near.blocks() {
        let d = p.minus(r);
        let w = weight.value(d.length_squared() * ih2);
        let e = d.minus(centroid);
        let (mut cx, mut cy, mut cz) = (V4::default(), V4::default(), V4::default());
        e.add_to(w * e.x, &mut cx);
        e.add_to(w * e.y, &mut cy);
        e.add_to(w * e.z, &mut cz);
        m += DMat3::from_cols(cx.sum(), cy.sum(), cz.sum());
    }
    let (_, vectors) = symmetric3(m);
    let n = vectors.x_axis;
    if n.dot(outward) <= 0.0 { n } else { -n }
}

/// J and its first two derivatives at a plane.
pub(super) fn jet(weight: impl Weight, near: &Neighbours, r: DVec3, plane: &Plane) -> Jet {
    let Plane { n, t } = *plane;
    let (e1, e2) = n.any_orthonormal_pair();
    let (mut sum, mut energy, mut j_t, mut j_tt) = (F4::ZERO, F4::ZERO, F4::ZERO, F4::ZERO);
    let (mut g1, mut g2, mut gn) = (F4::ZERO, F4::ZERO, F4::ZERO);
    let (mut h11, mut h12, mut h22, mut h1t, mut h2t) = (F4::ZERO, F4::ZERO, F4::ZERO, F4::ZERO, F4::ZERO);
    for (p, _, ih2) in near.blocks() {
        let d = p.minus(r);
        let (a, b, c) = (d.dot(e1), d.dot(e2), d.dot(n));
        let s = c - t;
        let rho = (a * a + b * b + s * s) * ih2;
        let [w, w1, w2] = weight.jet(rho);
        let (w1, w2) = (w1 * ih2, w2 * (ih2 * ih2));
        let s2 = s * s;
        let (ws, w1s2) = (w * s, w1 * s2);
        let first = (ws - w1s2 * t) * 2.0;
        let second = (w + w) - w1 * s * (8.0 * t) + w2 * s2 * (4.0 * t * t);
        let mixed = w1 * s * (4.0 * t) - (w + w) - w1s2 * 6.0 + w2 * (s2 * s) * (4.0 * t);
        sum += w;
        energy += ws * s;
        j_t += (ws + w1s2 * s) * -2.0;
        j_tt += (w + w) + w1s2 * 10.0 + w2 * (s2 * s2) * 4.0;
        g1 += first * a;
        g2 += first * b;
        gn += first * c;
        let (sa, sb) = (second * a, second * b);
        h11 += sa * a;
        h12 += sa * b;
        h22 += sb * b;
        h1t += mixed * a;
        h2t += mixed * b;
    }
    let gn = gn.sum();
    let (h12, h1t, h2t) = (h12.sum(), h1t.sum(), h2t.sum());
    Jet {
        energy: energy.sum(),
        weight: sum.sum(),
        basis: [e1, e2],
        gradient: [g1.sum(), g2.sum(), j_t.sum()],
        hessian: [[h11.sum() - gn, h12, h1t], [h12, h22.sum() - gn, h2t], [h1t, h2t, j_tt.sum()]],
    }
}

/// Newton's step, made a descent step where the Hessian is not positive definite by taking the absolute values of
/// its eigenvalues.
fn step(jet: &Jet) -> [f64; 3] {
    let g = jet.gradient.map(|x| -x);
    // A pivot this far below its diagonal has no correct digit left.
    const PIVOT: f64 = 1e-12;
    let y = match Cholesky::new(&jet.hessian, 3, PIVOT) {
        Some(factor) => factor.solve(&g),
        None => {
            let h = &jet.hessian;
            let (values, v) = symmetric3(DMat3::from_cols_array_2d(h));
            let largest = values[0].abs().max(values[2].abs());
            let g = DVec3::from_array(g);
            let scaled = |i: usize, axis: DVec3| {
                axis * (axis.dot(g) / values[i].abs().max(1e-6 * largest).max(f64::MIN_POSITIVE))
            };
            (scaled(0, v.x_axis) + scaled(1, v.y_axis) + scaled(2, v.z_axis)).to_array()
        }
    };
    let longest = y[0].hypot(y[1]).max(y[2].abs());
    if longest <= LONGEST_STEP { y } else { y.map(|x| x * (LONGEST_STEP / longest)) }
}

fn moved(plane: &Plane, jet: &Jet, y: [f64; 3], by: f64) -> Plane {
    let n = plane.n + by * (y[0] * jet.basis[0] + y[1] * jet.basis[1]);
    Plane { n: n.normalize(), t: plane.t + by * y[2] }
}

/// Walks from a start to the local minimum. The jet returned is that of the last step's beginning, at most
/// `LAST_STEP` away from the plane returned.
///
/// Fails with [`Stray::Unsettled`] where the search does not end, and with [`Stray::Sparse`] where it leaves the
/// samples behind (the energy falls to nothing at infinity: the spurious minimum of the un-normalised problem).
pub(super) fn settle(
    weight: impl Weight,
    near: &Neighbours,
    r: DVec3,
    start: Plane,
) -> Result<(Plane, Jet), Stray> {
    let mut plane = start;
    let mut here = jet(weight, near, r, &plane);
    for _ in 0..MAX_STEPS {
        if here.weight <= 0.0 {
            return Err(Stray::Sparse);
        }
        let y = step(&here);
        let size = y[0].hypot(y[1]).max(y[2].abs());
        if size.is_nan() {
            return Err(Stray::IllConditioned);
        }
        if size <= LAST_STEP {
            return Ok((moved(&plane, &here, y, 1.0), here));
        }
        let mut by = 1.0;
        let mut halvings = 0;
        loop {
            let next = moved(&plane, &here, y, by);
            let there = jet(weight, near, r, &next);
            // Rounding of a sum of that many terms of this size must not refuse a step.
            let slack = 1e-12 * here.energy.abs() + 1e-28 * here.weight;
            if there.energy <= here.energy + slack || halvings == MAX_HALVINGS {
                plane = next;
                here = there;
                break;
            }
            by *= 0.5;
            halvings += 1;
        }
    }
    Err(Stray::Unsettled)
}
