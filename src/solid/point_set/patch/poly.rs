//! Polynomials in two variables over the square [-1, 1]^2, fitted to values and slopes at fixed nodes.

// Loops over indices of fixed length are unrolled.
#![allow(clippy::needless_range_loop)]

use std::sync::OnceLock;

use crate::num::cholesky::Cholesky;
use crate::num::monomials::{coefficients, exponents, index};

/// The highest degree of a patch.
pub const DEGREE: usize = 6;
/// Its coefficients.
pub const COEFFICIENTS: usize = coefficients(DEGREE);

/// Nodes along each side: with a value and a slope at each, four determine more than degree 6 along a line.
const SIDE: usize = 4;
/// Nodes that are fitted to.
pub const FITTED: usize = SIDE * SIDE;
/// Nodes that only measure: the centre and the corners, where a polynomial errs most.
pub const CHECKS: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
/// All nodes: those fitted to first.
pub const NODES: usize = FITTED + CHECKS.len();

/// Zeros of the Chebyshev polynomial of degree 4.
const CHEBYSHEV: [f64; SIDE] =
    [-0.923_879_532_511_286_8, -0.382_683_432_365_089_8, 0.382_683_432_365_089_8, 0.923_879_532_511_286_8];

/// Where a node stands.
pub fn node(i: usize) -> [f64; 2] {
    if i < FITTED { [CHEBYSHEV[i % SIDE], CHEBYSHEV[i / SIDE]] } else { CHECKS[i - FITTED] }
}

/// A value and its two slopes.
pub type Jet = [f64; 3];

/// How much a slope counts beside a value: over the half width of the square it tells as much about the end as a value
/// there would, but with the noise of a derivative.
const SLOPES: f64 = 0.3;

/// Exponents of x and y.
const EXPONENTS: [(usize, usize); COEFFICIENTS] = exponents();

/// The coefficients that fit best: a linear function of the jets at the fitted nodes, made once.
struct Fitting {
    /// For each coefficient its share of each datum.
    rows: Vec<[[f64; 3]; FITTED]>,
}

fn monomials(x: f64, y: f64) -> [Jet; COEFFICIENTS] {
    let power = |x: f64, n: usize| (0..n).fold(1.0, |p, _| p * x);
    EXPONENTS.map(|(a, b)| {
        let slope = |x: f64, n: usize| if n == 0 { 0.0 } else { n as f64 * power(x, n - 1) };
        [power(x, a) * power(y, b), slope(x, a) * power(y, b), power(x, a) * slope(y, b)]
    })
}

fn fitting() -> &'static Fitting {
    static FITTING: OnceLock<Fitting> = OnceLock::new();
    FITTING.get_or_init(|| {
        let weights = [1.0, SLOPES * SLOPES, SLOPES * SLOPES];
        let basis: [[Jet; COEFFICIENTS]; FITTED] = std::array::from_fn(|i| {
            let [x, y] = node(i);
            monomials(x, y)
        });
        let mut normal = [[0.0; COEFFICIENTS]; COEFFICIENTS];
        for b in &basis {
            for i in 0..COEFFICIENTS {
                for j in 0..COEFFICIENTS {
                    normal[i][j] += (0..3).map(|k| weights[k] * b[i][k] * b[j][k]).sum::<f64>();
                }
            }
        }
        // The nodes are fixed, and determine all coefficients: no pivot comes near this.
        const PIVOT: f64 = 1e-12;
        let mut rows = vec![[[0.0; 3]; FITTED]; COEFFICIENTS];
        if let Some(factor) = Cholesky::new(&normal, PIVOT) {
            for (node, b) in basis.iter().enumerate() {
                for k in 0..3 {
                    let right = std::array::from_fn(|i| weights[k] * b[i][k]);
                    let shares = factor.solve(&right);
                    (0..COEFFICIENTS).for_each(|i| rows[i][node][k] = shares[i]);
                }
            }
        }
        Fitting { rows }
    })
}

/// The polynomial of degree 6 nearest to the jets at the first [`FITTED`] nodes.
pub fn fit(jets: &[Jet; NODES]) -> [f64; COEFFICIENTS] {
    let rows = &fitting().rows;
    std::array::from_fn(|i| {
        rows[i].iter().zip(jets).map(|(r, j)| r[0] * j[0] + r[1] * j[1] + r[2] * j[2]).sum()
    })
}

/// The degree of a guide.
pub const GUIDE_DEGREE: usize = 3;
/// Its coefficients.
const GUIDE: usize = coefficients(GUIDE_DEGREE);

/// A jet somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// x and y.
    pub at: [f64; 2],
    /// Value and slopes there.
    pub jet: Jet,
}

/// The polynomial of degree 3 nearest to jets anywhere, and the root mean square of what the values miss it by; `None` where
/// they do not determine it.
pub fn fit_anywhere(jets: &[Placed]) -> Option<([f64; COEFFICIENTS], f64)> {
    let weights = [1.0, SLOPES * SLOPES, SLOPES * SLOPES];
    let mut normal = [[0.0; GUIDE]; GUIDE];
    let mut right = [0.0; GUIDE];
    for Placed { at: [x, y], jet } in jets {
        let (x, y) = (*x, *y);
        let values = [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y];
        let along_x = [0.0, 1.0, 0.0, 2.0 * x, y, 0.0, 3.0 * x * x, 2.0 * x * y, y * y, 0.0];
        let along_y = [0.0, 0.0, 1.0, 0.0, x, 2.0 * y, 0.0, x * x, 2.0 * x * y, 3.0 * y * y];
        for ((row, datum), weight) in [values, along_x, along_y].iter().zip(jet).zip(weights) {
            for i in 0..GUIDE {
                let scaled = weight * row[i];
                right[i] += scaled * datum;
                for j in 0..=i {
                    normal[i][j] += scaled * row[j];
                }
            }
        }
    }
    // Fewer digits left than this leave none to what is fitted.
    const PIVOT: f64 = 1e-8;
    let found = Cholesky::new(&normal, PIVOT)?.solve(&right);
    let mut c = [0.0; COEFFICIENTS];
    c[..GUIDE].copy_from_slice(&found);
    let off = |p: &Placed| (evaluate(&c, GUIDE_DEGREE, p.at[0], p.at[1])[0] - p.jet[0]).powi(2);
    let mean = jets.iter().map(off).sum::<f64>() / jets.len() as f64;
    Some((c, mean.sqrt()))
}

/// Value and slopes at a place.
#[inline]
pub fn evaluate(c: &[f64; COEFFICIENTS], degree: usize, x: f64, y: f64) -> Jet {
    match degree {
        0..=3 => horner::<3>(c, x, y),
        4 => horner::<4>(c, x, y),
        5 => horner::<5>(c, x, y),
        _ => horner::<6>(c, x, y),
    }
}

#[inline(always)]
fn horner<const D: usize>(c: &[f64; COEFFICIENTS], x: f64, y: f64) -> Jet {
    let mut out = [0.0; 3];
    for b in (0..=D).rev() {
        let (mut value, mut slope) = (0.0, 0.0);
        for a in (0..=D - b).rev() {
            slope = slope * x + value;
            value = value * x + c[index(a, b)];
        }
        out[2] = out[2] * y + out[0];
        out[0] = out[0] * y + value;
        out[1] = out[1] * y + slope;
    }
    out
}

/// How far from zero the terms of total degrees above the given one can add up to, over the square.
pub fn tail(c: &[f64; COEFFICIENTS], degree: usize) -> f64 {
    c.iter().zip(EXPONENTS).filter(|(_, (a, b))| degree < a + b).map(|(c, _)| c.abs()).sum()
}

/// Bounds over the square: of the value less its constant, of each slope, and of the second derivatives along a unit step
/// of the square.
pub fn bounds(c: &[f64; COEFFICIENTS]) -> ([f64; 3], f64) {
    let (mut first, mut second) = ([0.0; 3], 0.0);
    for (c, (a, b)) in c.iter().zip(EXPONENTS).skip(1) {
        let (c, a, b) = (c.abs(), a as f64, b as f64);
        first[0] += c;
        first[1] += a * c;
        first[2] += b * c;
        second += c * (a * (a - 1.0)).max(0.0) + c * (b * (b - 1.0)).max(0.0) + 2.0 * c * a * b;
    }
    (first, second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_six_is_fitted_exactly_with_its_slopes() {
        let c: [f64; COEFFICIENTS] = std::array::from_fn(|i| ((i * 37 % 11) as f64 - 5.0) / 7.0);
        let jets: [Jet; NODES] = std::array::from_fn(|i| {
            let [x, y] = node(i);
            evaluate(&c, DEGREE, x, y)
        });
        let fitted = fit(&jets);
        for (a, b) in c.iter().zip(fitted) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
        let (x, y, d) = (0.3, -0.7, 1e-6);
        let at = |x, y| evaluate(&c, DEGREE, x, y);
        assert!(((at(x + d, y)[0] - at(x - d, y)[0]) / (2.0 * d) - at(x, y)[1]).abs() < 1e-8);
        assert!(((at(x, y + d)[0] - at(x, y - d)[0]) / (2.0 * d) - at(x, y)[2]).abs() < 1e-8);
    }

    #[test]
    fn bounds_hold_over_the_square() {
        let c: [f64; COEFFICIENTS] = std::array::from_fn(|i| ((i * 53 % 13) as f64 - 6.0) / 9.0);
        let ([value, sx, sy], _) = bounds(&c);
        for i in 0..=20 {
            for j in 0..=20 {
                let [v, x, y] = evaluate(&c, DEGREE, f64::from(i) / 10.0 - 1.0, f64::from(j) / 10.0 - 1.0);
                assert!((v - c[0]).abs() <= value + 1e-12 && x.abs() <= sx + 1e-12 && y.abs() <= sy + 1e-12);
            }
        }
    }
}
