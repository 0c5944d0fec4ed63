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

// Loops over indices of fixed length are unrolled, which keeps sums in registers.
#![allow(clippy::needless_range_loop)]

use super::MAX_DEGREE;
use super::blocks::Near;
use super::plane::Plane;
use super::{Facing, Stray, Weight};
use crate::num::cholesky::Cholesky;
use crate::num::lanes::{Lanes, sum};
use crate::num::monomials::{coefficients, exponents, index};
use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::DVec3;

/// Coefficients of a polynomial of degree 4.
pub(super) const MAX_COEFFICIENTS: usize = 15;
const MAX_MOMENTS: usize = 45;
const MAX_POWERS: usize = 2 * MAX_DEGREE + 1;

/// The exponents of u and v in the order of [`index`].
const EXPONENTS: [(usize, usize); MAX_MOMENTS] = exponents();

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
    near: Near,
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
    let effective = sums.moments[0] * sums.moments[0] / sums.squared;
    let enough = |d: usize| d == 0 || GONE * coefficients(d) as f64 * (1.0 + f64::EPSILON) < effective;
    let solved = |degree: usize| match degree {
        0 => solve::<1>(&sums),
        1 => solve::<3>(&sums),
        2 => solve::<6>(&sums),
        3 => solve::<10>(&sums),
        _ => solve::<MAX_COEFFICIENTS>(&sums),
    };
    let fitting = (0..=degree.min(MAX_DEGREE)).rev().filter(|d| enough(*d));
    let found = fitting.map(|d| Some((d, solved(d)?))).find_map(|found| found);
    let (degree, [c, a0]) = found.ok_or(Stray::IllConditioned)?;
    let total = sums.moments[0];
    Ok(Fit {
        degree,
        basis,
        c,
        a0,
        drift: sums.drift.map(|d| d / total),
        vote: sums.vote / total,
        kept: total / sums.whole,
        fading: fading(degree, &c, &a0, total, sums.squared),
    })
}

/// The `N` coefficients of a degree, and the first column of the inverse of the normal matrix; padded with zeros. `None` where
/// the samples do not determine them.
fn solve<const N: usize>(sums: &Sums) -> Option<[[f64; MAX_COEFFICIENTS]; 2]> {
    // Pivots below this share of their diagonal say that the samples do not determine the coefficient.
    const PIVOT: f64 = 1e-10;
    let total = sums.moments[0];
    let effective = total * total / sums.squared;
    let mut a = [[0.0; N]; N];
    for i in 0..N {
        let (ia, ib) = EXPONENTS[i];
        for j in 0..=i {
            let (ja, jb) = EXPONENTS[j];
            a[i][j] = sums.moments[index(ia + ja, ib + jb)];
        }
        let k = ia + ib;
        if 0 < k {
            a[i][i] += total * ridge(effective / coefficients(k) as f64)[0] * SHARES[i];
        }
    }
    let factor = Cholesky::new(&a, PIVOT)?;
    let mut unit = [0.0; N];
    unit[0] = 1.0;
    let heights = std::array::from_fn(|i| sums.heights[i]);
    Some([factor.solve(&heights), factor.solve(&unit)].map(|x| {
        let mut padded = [0.0; MAX_COEFFICIENTS];
        padded[..N].copy_from_slice(&x);
        padded
    }))
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
    near: Near,
    r: DVec3,
    plane: &Plane,
    basis: [DVec3; 2],
) -> Sums {
    let place = Place { near, r, plane: *plane, basis };
    dispatch!(Level::new(), simd => sums_in::<_, W, A, D>(simd, weight, place))
}

/// Where the sums are taken.
#[derive(Clone, Copy)]
struct Place<'a> {
    near: Near<'a>,
    r: DVec3,
    plane: Plane,
    basis: [DVec3; 2],
}

impl Place<'_> {
    /// Samples of a block in the frame at q, with their weights before and after how they face, and n times their normals.
    #[inline(always)]
    fn block<S: Simd, W: Weight, A: Facing>(&self, simd: S, weight: W, block: usize) -> [Lanes<S>; 6] {
        let Plane { n, t } = self.plane;
        let (p, ih2) = self.near.block(simd, block);
        let d = p.minus(self.r);
        let (u, v, z) = (d.dot(self.basis[0]), d.dot(self.basis[1]), d.dot(n) - t);
        let whole = weight.value(simd, (u * u + v * v + z * z) * ih2);
        if !A::VARIES && !A::VOTES {
            return [u, v, z, whole, whole, whole];
        }
        let facing = self.near.normals(simd, block).dot(n);
        let w = if A::VARIES { whole * A::jet(simd, -facing)[0] } else { whole };
        [u, v, z, whole, w, facing]
    }

    /// The moments from the `FIRST`th on, `COUNT` of them.
    #[inline(always)]
    fn moments<S: Simd, W: Weight, A: Facing, const FIRST: usize, const COUNT: usize>(
        &self,
        simd: S,
        weight: W,
        out: &mut [f64; MAX_MOMENTS],
    ) {
        let mut moments = [Lanes::splat(simd, 0.0); COUNT];
        for block in 0..self.near.len() {
            let [u, v, _, _, w, _] = self.block::<S, W, A>(simd, weight, block);
            let (row, power) = powers(w, u, v);
            for i in 0..COUNT {
                moments[i] += monomial(&row, &power, FIRST + i);
            }
        }
        for i in 0..COUNT {
            out[FIRST + i] = sum(moments[i]);
        }
    }
}

/// w u^a and v^b.
#[inline(always)]
fn powers<S: Simd>(
    w: Lanes<S>,
    u: Lanes<S>,
    v: Lanes<S>,
) -> ([Lanes<S>; MAX_POWERS], [Lanes<S>; MAX_POWERS]) {
    let (mut row, mut power) = ([w; MAX_POWERS], [v; MAX_POWERS]);
    for a in 1..MAX_POWERS {
        row[a] = row[a - 1] * u;
    }
    for b in 2..MAX_POWERS {
        power[b] = power[b - 1] * v;
    }
    (row, power)
}

#[inline(always)]
fn monomial<S: Simd>(row: &[Lanes<S>; MAX_POWERS], power: &[Lanes<S>; MAX_POWERS], i: usize) -> Lanes<S> {
    let (a, b) = EXPONENTS[i];
    if b == 0 { row[a] } else { row[a] * power[b] }
}

/// In parts, each with few enough sums to stay in registers, for which weights computed anew are a small price; and each in
/// loops of fixed length, which are unrolled.
#[inline(always)]
fn sums_in<S: Simd, W: Weight, A: Facing, const D: usize>(simd: S, weight: W, place: Place) -> Sums {
    let zero = Lanes::splat(simd, 0.0);
    let mut moments = [zero; MAX_COEFFICIENTS];
    let mut heights = [zero; MAX_COEFFICIENTS];
    let (mut squared, mut vote, mut whole, mut du, mut dv) = (zero, zero, zero, zero, zero);
    for block in 0..place.near.len() {
        let [u, v, z, all, w, facing] = place.block::<S, W, A>(simd, weight, block);
        if A::VARIES || A::VOTES {
            whole += all;
            vote += w * facing;
        }
        squared += w * w;
        if D == 0 {
            du += w * u;
            dv += w * v;
        }
        let (row, power) = powers(w, u, v);
        for i in 0..const { coefficients(if D == 2 { 4 } else { D }) } {
            let m = monomial(&row, &power, i);
            moments[i] += m;
            if i < coefficients(D) {
                heights[i] += m * z;
            }
        }
    }
    let mut out = [0.0; MAX_MOMENTS];
    out[..MAX_COEFFICIENTS].copy_from_slice(&each(&moments));
    match D {
        1 => place.moments::<S, W, A, 3, 3>(simd, weight, &mut out),
        3 => place.moments::<S, W, A, 10, 18>(simd, weight, &mut out),
        4 => {
            place.moments::<S, W, A, 15, 13>(simd, weight, &mut out);
            place.moments::<S, W, A, 28, 17>(simd, weight, &mut out);
        }
        _ => {}
    }
    let total = out[0];
    Sums {
        heights: each(&heights),
        drift: if D == 0 { [sum(du), sum(dv)] } else { [out[1], out[2]] },
        squared: sum(squared),
        vote: if A::VARIES || A::VOTES { sum(vote) } else { -total },
        whole: if A::VARIES { sum(whole) } else { total },
        moments: out,
    }
}

/// The sum of the lanes of each. (A loop: `array::map` is not inlined where the instructions are those of the level.)
#[inline(always)]
fn each<S: Simd, const N: usize>(lanes: &[Lanes<S>; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = sum(lanes[i]);
    }
    out
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
