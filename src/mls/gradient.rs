//! The gradient of F in closed form.
//!
//! Stationarity of (n, t) is differentiated with respect to r with the solution held by the Hessian H:
//! `Y = -H^-1 [B^T M_n; M_t]` gives dn/dr and dt/dr. The value g(0,0) = c_0 of a weighted least squares fit with
//! residuals rho and shape functions lambda = a0 . beta changes by
//!
//! ```text
//! dc_0 = sum (dw lambda + w a0 . dbeta) rho + w lambda (dz - c . dbeta)
//! ```
//!
//! and, where ridges fade terms by what sum w and sum w^2 say, by sum (S + 2 w S') dw more. All of it is linear in the
//! displacement of q and in dn; both are summed over the samples once. All vectors here are written in the basis (e1, e2, n), in which a sample stands at x = (u, v, z) from q.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::{DMat3, DVec3};

use super::blocks::Near;
use super::plane::Plane;
use super::polynomial::{Fit, evaluate};
use super::{Facing, MAX_DEGREE, Stray, Weight};
use crate::num::cholesky::Cholesky;
use crate::num::lanes::{Lanes, sum};

/// How the plane answers a displacement of r.
#[derive(Clone, Copy, Debug)]
pub(super) enum Answers<'a> {
    /// It stays a minimum of J, whose Hessian in the basis of the fit this is.
    Minimum(&'a [[f64; 3]; 3]),
    /// Columns in the basis (e1, e2, n), rows the turn of n along e1 and e2, and the change of t.
    Given(DMat3),
}

/// Linear forms in the displacement of r, q and n, summed over the samples.
struct Forms {
    /// M_n in the rows of the tangent basis: d(gradient along e1, e2)/dr.
    m_n: [DVec3; 2],
    /// M_t.
    m_t: DVec3,
    /// dc_0 per displacement of the samples relative to q.
    by_x: DVec3,
    /// dc_0 per turn of n along e1 and e2.
    by_n: [f64; 2],
}

/// grad F in the frame of the world (F and r share their unit, so it has none).
///
/// Fails with [`Stray::Saddle`] where the plane is not a strict local minimum.
pub(super) fn gradient<W: Weight, A: Facing>(
    weight: W,
    _: A,
    near: Near,
    r: DVec3,
    plane: &Plane,
    answers: Answers,
    fit: &Fit,
) -> Result<DVec3, Stray> {
    let basis = fit.basis;
    let f = match fit.degree {
        0 => forms::<W, A, 0>(weight, near, r, plane, basis, fit),
        1 => forms::<W, A, 1>(weight, near, r, plane, basis, fit),
        2 => forms::<W, A, 2>(weight, near, r, plane, basis, fit),
        3 => forms::<W, A, 3>(weight, near, r, plane, basis, fit),
        _ => forms::<W, A, MAX_DEGREE>(weight, near, r, plane, basis, fit),
    };
    let columns: [[f64; 3]; 3] = match answers {
        Answers::Minimum(hessian) => {
            // A minimum so flat that this many digits are lost is none.
            const PIVOT: f64 = 1e-8;
            let factor = Cholesky::new(hessian, PIVOT).ok_or(Stray::Saddle)?;
            std::array::from_fn(|j| factor.solve(&[-f.m_n[0][j], -f.m_n[1][j], -f.m_t[j]]))
        }
        Answers::Given(response) => response.to_cols_array_2d(),
    };
    let local: [f64; 3] = std::array::from_fn(|j| {
        let [d1, d2, dt] = columns[j];
        let turn = (f.by_n[0] - plane.t * f.by_x.x) * d1 + (f.by_n[1] - plane.t * f.by_x.y) * d2;
        dt * (1.0 - f.by_x.z) - f.by_x[j] + turn
    });
    Ok(local[0] * basis[0] + local[1] * basis[1] + local[2] * plane.n)
}

fn forms<W: Weight, A: Facing, const D: usize>(
    weight: W,
    near: Near,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
    fit: &Fit,
) -> Forms {
    dispatch!(Level::new(), simd => forms_in::<_, W, A, D>(simd, weight, near, r, plane, basis, fit))
}

#[inline(always)]
fn forms_in<S: Simd, W: Weight, A: Facing, const D: usize>(
    simd: S,
    weight: W,
    near: Near,
    r: DVec3,
    plane: &Plane,
    [e1, e2]: [DVec3; 2],
    fit: &Fit,
) -> Forms {
    let Plane { n, t } = *plane;
    let zero = Lanes::splat(simd, 0.0);
    let (mut c_sum, mut uu, mut uv, mut vu, mut vv) = (zero, zero, zero, zero, zero);
    let (mut un, mut vn) = (zero, zero);
    let (mut tu, mut tv, mut tn) = (zero, zero, zero);
    let (mut gx, mut gy, mut gz, mut h1, mut h2) = (zero, zero, zero, zero, zero);
    for block in 0..near.len() {
        let (p, ih2) = near.block(simd, block);
        let d = p.minus(r);
        let (u, v, s) = (d.dot(e1), d.dot(e2), d.dot(n) - t);
        let [mut w, w1, w2] = weight.jet(simd, (u * u + v * v + s * s) * ih2);
        let (mut w1, mut w2) = (w1 * ih2, w2 * (ih2 * ih2));
        let s2 = s * s;
        let mut by_facing = None;
        if A::VARIES {
            let m = near.normals(simd, block);
            let (m1, m2) = (m.dot(e1), m.dot(e2));
            let [f, f1, _] = A::jet(simd, -m.dot(n));
            // M_n gains - phi' m (d(theta s^2)/dr)^T = phi' m (2 s^2 theta' x + 2 s theta n)^T.
            let (k, kn) = (w1 * s2 * f1 * 2.0, w * s * f1 * 2.0);
            let along = k * s + kn;
            uu += k * m1 * u;
            uv += k * m1 * v;
            vu += k * m2 * u;
            vv += k * m2 * v;
            un += along * m1;
            vn += along * m2;
            by_facing = Some((w * f1, m1, m2));
            w *= f;
            w1 *= f;
            w2 *= f;
        }
        // M_n: d = p - r moves against r; c = 2 s theta - 2 t s^2 theta'.
        c_sum += (w * s - w1 * s2 * t) * 2.0;
        let k1 = w1 * s * (4.0 * t) - (w + w);
        let k2 = (w2 * s2 * t - w1 * s) * 4.0;
        let along = k1 + k2 * s;
        let (ku, kv) = (k2 * u, k2 * v);
        uu += ku * u;
        uv += ku * v;
        vu += ku * v;
        vv += kv * v;
        un += along * u;
        vn += along * v;
        // M_t.
        let m1 = (w + w) + w1 * s2 * 6.0;
        let m2 = (w1 * s + w2 * (s2 * s)) * 4.0;
        tu += m2 * u;
        tv += m2 * v;
        tn += m1 + m2 * s;
        // dc_0.
        let [[shape, shape_u, shape_v], [g, g_u, g_v]] = evaluate::<_, D>(simd, &fit.a0, &fit.c, u, v);
        let residual = s - g;
        let (w_res, w_shape) = (w * residual, w * shape);
        let by_weight = shape * residual + (w * (2.0 * fit.fading[1]) + fit.fading[0]);
        let pull = w1 * by_weight * 2.0;
        let by_u = w_res * shape_u - w_shape * g_u;
        let by_v = w_res * shape_v - w_shape * g_v;
        gx += pull * u + by_u;
        gy += pull * v + by_v;
        gz += pull * s + w_shape;
        h1 += w_shape * u - by_u * s;
        h2 += w_shape * v - by_v * s;
        if let Some((w_turn, m1, m2)) = by_facing {
            // dw = theta phi' dc with dc = -m . dn.
            let pull = w_turn * by_weight;
            h1 -= pull * m1;
            h2 -= pull * m2;
        }
    }
    let c = sum(c_sum);
    Forms {
        m_n: [DVec3::new(sum(uu) - c, sum(uv), sum(un)), DVec3::new(sum(vu), sum(vv) - c, sum(vn))],
        m_t: DVec3::new(sum(tu), sum(tv), sum(tn)),
        by_x: DVec3::new(sum(gx), sum(gy), sum(gz)),
        by_n: [sum(h1), sum(h2)],
    }
}
