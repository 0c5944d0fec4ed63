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
//! which is linear in the displacement of q and in dn; both are summed over the samples once. All vectors here are
//! written in the basis (e1, e2, n), in which a sample stands at x = (u, v, z) from q.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::DVec3;

use super::neighbours::Neighbours;
use super::plane::Plane;
use super::polynomial::{Fit, evaluate};
use super::{MAX_DEGREE, Stray, Weight};
use crate::num::cholesky::Cholesky;
use crate::num::lanes::{Lanes, sum};

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
pub(super) fn gradient(
    weight: impl Weight,
    near: &Neighbours,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
    hessian: &[[f64; 3]; 3],
    fit: &Fit,
) -> Result<DVec3, Stray> {
    let f = match fit.degree {
        0 => forms::<0>(weight, near, r, plane, basis, fit),
        1 => forms::<1>(weight, near, r, plane, basis, fit),
        2 => forms::<2>(weight, near, r, plane, basis, fit),
        3 => forms::<3>(weight, near, r, plane, basis, fit),
        _ => forms::<MAX_DEGREE>(weight, near, r, plane, basis, fit),
    };
    // A minimum so flat that this many digits are lost is none.
    const PIVOT: f64 = 1e-8;
    let factor = Cholesky::new(hessian, 3, PIVOT).ok_or(Stray::Saddle)?;
    let column = |j: usize| factor.solve(&[-f.m_n[0][j], -f.m_n[1][j], -f.m_t[j]]);
    let local: [f64; 3] = std::array::from_fn(|j| {
        let [d1, d2, dt] = column(j);
        let turn = (f.by_n[0] - plane.t * f.by_x.x) * d1 + (f.by_n[1] - plane.t * f.by_x.y) * d2;
        dt * (1.0 - f.by_x.z) - f.by_x[j] + turn
    });
    Ok(local[0] * basis[0] + local[1] * basis[1] + local[2] * plane.n)
}

fn forms<const D: usize>(
    weight: impl Weight,
    near: &Neighbours,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
    fit: &Fit,
) -> Forms {
    dispatch!(Level::new(), simd => forms_in::<_, D>(simd, weight, near, r, plane, basis, fit))
}

#[inline(always)]
fn forms_in<S: Simd, const D: usize>(
    simd: S,
    weight: impl Weight,
    near: &Neighbours,
    r: DVec3,
    plane: &Plane,
    [e1, e2]: [DVec3; 2],
    fit: &Fit,
) -> Forms {
    let Plane { n, t } = *plane;
    let zero = Lanes::splat(simd, 0.0);
    let (mut c_sum, mut uu, mut uv, mut vv, mut un, mut vn) = (zero, zero, zero, zero, zero, zero);
    let (mut tu, mut tv, mut tn) = (zero, zero, zero);
    let (mut gx, mut gy, mut gz, mut h1, mut h2) = (zero, zero, zero, zero, zero);
    for block in 0..near.blocks() {
        let (p, ih2) = near.block(simd, block);
        let d = p.minus(r);
        let (u, v, s) = (d.dot(e1), d.dot(e2), d.dot(n) - t);
        let [w, w1, w2] = weight.jet(simd, (u * u + v * v + s * s) * ih2);
        let (w1, w2) = (w1 * ih2, w2 * (ih2 * ih2));
        let s2 = s * s;
        // M_n: d = p - r moves against r; c = 2 s theta - 2 t s^2 theta'.
        c_sum += (w * s - w1 * s2 * t) * 2.0;
        let k1 = w1 * s * (4.0 * t) - (w + w);
        let k2 = (w2 * s2 * t - w1 * s) * 4.0;
        let along = k1 + k2 * s;
        let (ku, kv) = (k2 * u, k2 * v);
        uu += ku * u;
        uv += ku * v;
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
        let pull = w1 * shape * residual * 2.0;
        let by_u = w_res * shape_u - w_shape * g_u;
        let by_v = w_res * shape_v - w_shape * g_v;
        gx += pull * u + by_u;
        gy += pull * v + by_v;
        gz += pull * s + w_shape;
        h1 += w_shape * u - by_u * s;
        h2 += w_shape * v - by_v * s;
    }
    let (c, uv) = (sum(c_sum), sum(uv));
    Forms {
        m_n: [DVec3::new(sum(uu) - c, uv, sum(un)), DVec3::new(uv, sum(vv) - c, sum(vn))],
        m_t: DVec3::new(sum(tu), sum(tv), sum(tn)),
        by_x: DVec3::new(sum(gx), sum(gy), sum(gz)),
        by_n: [sum(h1), sum(h2)],
    }
}
