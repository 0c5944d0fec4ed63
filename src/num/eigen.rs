//! Eigenvalues and eigenvectors of symmetric 3x3 matrices.

use glam::{DMat3, DVec3};

/// The eigenvalues of a symmetric matrix, ascending, and unit eigenvectors, the columns of a rotation.
///
/// Cyclic Jacobi (Golub and Van Loan, Matrix Computations 8.5): rotations in the planes (0,1), (0,2), (1,2)
/// zero one off-diagonal entry each, until all are below rounding; convergence is quadratic, 4 to 6 sweeps.
/// Values err by a few ulps of the largest, vectors by that over the gap between values. Equal values give
/// some orthonormal basis of their space. Only the upper triangle is read. The matrix must be finite; it is
/// scaled first, so that no product overflows. The zero matrix gives zeros and the axes.
pub fn symmetric3(m: DMat3) -> ([f64; 3], DMat3) {
    /// Enough for every finite matrix; the loop ends by itself long before.
    const SWEEPS: usize = 30;
    let mut a = [[m.x_axis.x, m.y_axis.x, m.z_axis.x], [0.0, m.y_axis.y, m.z_axis.y], [0.0, 0.0, m.z_axis.z]];
    let scale = a.iter().flatten().fold(0.0f64, |s, v| s.max(v.abs()));
    if scale == 0.0 || !scale.is_finite() {
        return ([0.0; 3], DMat3::IDENTITY);
    }
    a.iter_mut().flatten().for_each(|v| *v /= scale);
    let mut v = [DVec3::X, DVec3::Y, DVec3::Z];
    for _ in 0..SWEEPS {
        if a[0][1].abs() + a[0][2].abs() + a[1][2].abs() <= f64::MIN_POSITIVE {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut v, p, q);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    let [x, y, z] = order.map(|i| v[i]);
    let z = if x.cross(y).dot(z) < 0.0 { -z } else { z };
    (order.map(|i| a[i][i] * scale), DMat3::from_cols(x, y, z))
}

/// Zeroes `a[p][q]` by a rotation in that plane, and turns the vectors with it.
fn rotate(a: &mut [[f64; 3]; 3], v: &mut [DVec3; 3], p: usize, q: usize) {
    let off = a[p][q];
    // An entry that the diagonal does not notice is zero.
    if off.abs() <= 0.5 * f64::EPSILON * f64::EPSILON * (a[p][p].abs() + a[q][q].abs()) {
        a[p][q] = 0.0;
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * off);
    let t = 1.0f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    a[p][p] -= t * off;
    a[q][q] += t * off;
    a[p][q] = 0.0;
    let r = 3 - p - q;
    let (rp, rq) = ((r.min(p), r.max(p)), (r.min(q), r.max(q)));
    let (ap, aq) = (a[rp.0][rp.1], a[rq.0][rq.1]);
    a[rp.0][rp.1] = c * ap - s * aq;
    a[rq.0][rq.1] = s * ap + c * aq;
    (v[p], v[q]) = (c * v[p] - s * v[q], s * v[p] + c * v[q]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    fn random(stream: &mut Stream) -> DMat3 {
        let mut draw = || stream.normal() * 10f64.powf(6.0 * stream.unit() - 3.0);
        let (a, b, c, d, e, f) = (draw(), draw(), draw(), draw(), draw(), draw());
        DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(b, d, e), DVec3::new(c, e, f))
    }

    #[test]
    fn values_agree_with_another_implementation_and_vectors_diagonalise() {
        let mut stream = Stream::new(7);
        for _ in 0..2000 {
            let m = random(&mut stream);
            let (values, vectors) = symmetric3(m);
            let other = nalgebra::Matrix3::from_column_slice(&m.to_cols_array()).symmetric_eigenvalues();
            let mut other = [other[0], other[1], other[2]];
            other.sort_by(f64::total_cmp);
            let scale = values[0].abs().max(values[2].abs());
            for k in 0..3 {
                assert!((values[k] - other[k]).abs() <= 1e-14 * scale, "{values:?} {other:?}");
                let v = vectors.col(k);
                assert!((m * v - values[k] * v).length() <= 1e-14 * scale);
            }
            assert!((vectors.determinant() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn equal_values_and_zero_give_a_basis() {
        for (m, values) in [
            (DMat3::ZERO, [0.0; 3]),
            (DMat3::IDENTITY * 3.0, [3.0; 3]),
            (DMat3::from_diagonal(DVec3::new(5.0, -1.0, 5.0)), [-1.0, 5.0, 5.0]),
            (DMat3::from_cols(DVec3::ONE, DVec3::ONE, DVec3::ONE) * 1e200, [0.0, 0.0, 3e200]),
        ] {
            let (found, vectors) = symmetric3(m);
            for k in 0..3 {
                assert!((found[k] - values[k]).abs() <= 1e-15 * values[2].abs(), "{found:?}");
            }
            assert!((vectors.determinant() - 1.0).abs() < 1e-14);
        }
    }
}
