//! The polynomial over the plane: weighted least squares in the frame (e1, e2, n) at q.
//!
//! Minimises sum w_i (z_i - sum c_ab u^a v^b)^2 over a + b <= degree by the normal equations, whose matrix holds
//! the moments sum w u^a v^b. In units of the local width its condition is at most some hundreds (degree 4, one
//! spacing), so Cholesky is exact enough; a polynomial that the samples do not determine is replaced by one of
//! lower degree, which is reported.
//!
//! Where samples are few, the terms of the highest degrees fade before they go: (sum w)^2 / sum w^2 = E effective samples
//! carry a ridge `rho_k = sum w * mu(E / n_k)` on the squares of the terms of total degree k, n_k the number of coefficients up to k, with
//! mu zero from 1.5 effective samples a coefficient on, and infinite at 1.2. The terms then vanish like the cube of
//! what is missing, so F keeps two derivatives, and `tests/surface_field.rs` holds grad F against differences there.

use super::MAX_DEGREE;
use super::neighbours::Neighbours;
use super::plane::Plane;
use super::{Facing, Stray, Weight};
use crate::num::cholesky::Cholesky;
use crate::num::lanes::{Lanes, sum};
use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::DVec3;

/// Coefficients of a polynomial of degree 4.
pub(super) const MAX_COEFFICIENTS: usize = 15;
const MAX_MOMENTS: usize = 45;

/// How many coefficients a degree has.
pub(super) const fn coefficients(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// The place of u^a v^b: all of a lower total degree first.
pub(super) const fn index(a: usize, b: usize) -> usize {
    let d = a + b;
    d * (d + 1) / 2 + b
}

/// A fitted polynomial with what its derivatives need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// The degree that the samples determine, at most the one asked.
    pub degree: usize,
    /// The directions of u and v.
    pub basis: [DVec3; 2],
    /// The coefficients c, local units.
    pub c: [f64; MAX_COEFFICIENTS],
    /// The first column of the inverse of the normal matrix: a0 . beta(u, v) is the shape function of a sample.
    pub a0: [f64; MAX_COEFFICIENTS],
    /// Mean of the samples in the plane, weighted, from q: it leaves zero at an open edge.
    pub drift: [f64; 2],
    /// Sum over the samples of weight times outward normal along n, over the sum of the weights.
    pub vote: f64,
    /// The share of the weight that is left after samples facing another way are left out.
    pub kept: f64,
    /// How c_0 falls with the ridges, per change of sum w and of sum w^2.
    pub fading: [f64; 2],
}

/// Effective samples a coefficient at which a term is gone, and from which on it is whole.
const GONE: f64 = 1.2;
const WHOLE: f64 = 1.5;

/// The ridge of u^a v^b beside that of u^k: one over the binomial coefficient of a + b = k over a, so that turning the
/// basis within the plane changes nothing.
const SHARES: [f64; MAX_COEFFICIENTS] = [
    1.0, //
    1.0,
    1.0, //
    1.0,
    0.5,
    1.0, //
    1.0,
    1.0 / 3.0,
    1.0 / 3.0,
    1.0, //
    1.0,
    0.25,
    1.0 / 6.0,
    0.25,
    1.0,
];

/// mu and its derivative with respect to E / n_k, for more than [`GONE`].
fn ridge(per_coefficient: f64) -> [f64; 2] {
    let (short, left) = ((WHOLE - per_coefficient).max(0.0), per_coefficient - GONE);
    let x = short / left;
    [x * x * x, -3.0 * x * x * (WHOLE - GONE) / (left * left) * f64::from(u8::from(0.0 < short))]
}

/// Fits at a settled plane.
pub(super) fn fit<W: Weight, A: Facing>(
    weight: W,
    _: A,
    near: &Neighbours,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
    degree: usize,
) -> Result<Fit, Stray> {
    let sums = match degree {
        0 => sums::<W, A, 0>(weight, near, r, plane, basis),
        1 => sums::<W, A, 1>(weight, near, r, plane, basis),
        2 => sums::<W, A, 2>(weight, near, r, plane, basis),
        3 => sums::<W, A, 3>(weight, near, r, plane, basis),
        _ => sums::<W, A, MAX_DEGREE>(weight, near, r, plane, basis),
    };
    let total = sums.moments[0];
    // Pivots below this share of their diagonal say that the samples do not determine the coefficient.
    const PIVOT: f64 = 1e-10;
    let effective = total * total / sums.squared;
    let enough = |d: usize| d == 0 || GONE * coefficients(d) as f64 * (1.0 + f64::EPSILON) < effective;
    for degree in (0..=degree.min(MAX_DEGREE)).rev().filter(|d| enough(*d)) {
        let n = coefficients(degree);
        let mut a = [[0.0; MAX_COEFFICIENTS]; MAX_COEFFICIENTS];
        for (i, (ia, ib)) in exponents(degree).enumerate() {
            for (j, (ja, jb)) in exponents(degree).enumerate().take(i + 1) {
                a[i][j] = sums.moments[index(ia + ja, ib + jb)];
            }
            let k = ia + ib;
            if 0 < k {
                a[i][i] += total * ridge(effective / coefficients(k) as f64)[0] * SHARES[i];
            }
        }
        if let Some(factor) = Cholesky::new(&a, n, PIVOT) {
            let mut unit = [0.0; MAX_COEFFICIENTS];
            unit[0] = 1.0;
            let (c, a0) = (factor.solve(&sums.heights), factor.solve(&unit));
            return Ok(Fit {
                degree,
                basis,
                c,
                a0,
                drift: sums.drift.map(|d| d / total),
                vote: sums.vote / total,
                kept: total / sums.whole,
                fading: fading(degree, &c, &a0, total, sums.squared),
            });
        }
    }
    Err(Stray::IllConditioned)
}

/// The change of c_0 by the ridges alone is -sum_k G_k d(rho_k), G_k the sum of a0 c over the terms of degree k.
fn fading(
    degree: usize,
    c: &[f64; MAX_COEFFICIENTS],
    a0: &[f64; MAX_COEFFICIENTS],
    total: f64,
    squared: f64,
) -> [f64; 2] {
    let effective = total * total / squared;
    let mut out = [0.0; 2];
    for k in 1..=degree {
        let n = coefficients(k) as f64;
        let [mu, slope] = ridge(effective / n);
        if mu == 0.0 {
            continue;
        }
        let g: f64 = (coefficients(k - 1)..coefficients(k)).map(|i| SHARES[i] * a0[i] * c[i]).sum();
        // rho = T mu(T^2 / (Q n)).
        out[0] -= g * (mu + 2.0 * effective * slope / n);
        out[1] += g * effective * slope * total / (n * squared);
    }
    out
}

/// The exponents of u and v in the order of [`index`].
fn exponents(degree: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..=degree).flat_map(|d| (0..=d).map(move |b| (d - b, b)))
}

struct Sums {
    moments: [f64; MAX_MOMENTS],
    heights: [f64; MAX_COEFFICIENTS],
    drift: [f64; 2],
    squared: f64,
    vote: f64,
    whole: f64,
}

fn sums<W: Weight, A: Facing, const D: usize>(
    weight: W,
    near: &Neighbours,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
) -> Sums {
    dispatch!(Level::new(), simd => sums_in::<_, W, A, D>(simd, weight, near, r, plane, basis))
}

#[inline(always)]
fn sums_in<S: Simd, W: Weight, A: Facing, const D: usize>(
    simd: S,
    weight: W,
    near: &Neighbours,
    r: DVec3,
    plane: &Plane,
    [e1, e2]: [DVec3; 2],
) -> Sums {
    let Plane { n, t } = *plane;
    let zero = Lanes::splat(simd, 0.0);
    let mut moments = [zero; MAX_MOMENTS];
    let mut heights = [zero; MAX_COEFFICIENTS];
    let (mut squared, mut vote, mut whole, mut du, mut dv) = (zero, zero, zero, zero, zero);
    for block in 0..near.blocks() {
        let (p, ih2) = near.block(simd, block);
        let d = p.minus(r);
        let (u, v, z) = (d.dot(e1), d.dot(e2), d.dot(n) - t);
        let facing = near.normals(simd, block).dot(n);
        let mut w = weight.value(simd, (u * u + v * v + z * z) * ih2);
        whole += w;
        if A::VARIES {
            w *= A::jet(simd, -facing)[0];
        }
        squared += w * w;
        vote += w * facing;
        du += w * u;
        dv += w * v;
        // w u^a v^b, row by row: powers of u grow along a, powers of v along b.
        let mut row = w;
        let mut row_z = w * z;
        for b in 0..=2 * D {
            let (mut m, mut mz) = (row, row_z);
            for a in 0..=2 * D - b {
                moments[index(a, b)] += m;
                m *= u;
                if a + b <= D {
                    heights[index(a, b)] += mz;
                    mz *= u;
                }
            }
            row *= v;
            row_z *= v;
        }
    }
    Sums {
        moments: moments.map(sum),
        heights: heights.map(sum),
        drift: [sum(du), sum(dv)],
        squared: sum(squared),
        vote: sum(vote),
        whole: sum(whole),
    }
}

/// Values and derivatives along u and v of two polynomials of one degree at eight places.
#[inline(always)]
pub(super) fn evaluate<S: Simd, const D: usize>(
    simd: S,
    p: &[f64; MAX_COEFFICIENTS],
    q: &[f64; MAX_COEFFICIENTS],
    u: Lanes<S>,
    v: Lanes<S>,
) -> [[Lanes<S>; 3]; 2] {
    let zero = Lanes::splat(simd, 0.0);
    let mut out = [[zero; 3]; 2];
    // Horner's rule in v over Horner's rules in u.
    for b in (0..=D).rev() {
        let mut inner = [[zero; 2]; 2];
        for a in (0..=D - b).rev() {
            for (row, c) in inner.iter_mut().zip([p, q]) {
                row[1] = row[1] * u + row[0];
                row[0] = row[0] * u + c[index(a, b)];
            }
        }
        for (o, i) in out.iter_mut().zip(inner) {
            o[2] = o[2] * v + o[0];
            o[0] = o[0] * v + i[0];
            o[1] = o[1] * v + i[1];
        }
    }
    out
}
