//! Small symmetric systems of fixed size.
// Loops over indices of fixed length are unrolled; the textbook's formulas are in indices too.
#![allow(clippy::needless_range_loop)]

/// The factor L of a symmetric positive definite matrix A = L L^T, row by row in the lower triangle.
#[derive(Clone, Copy, Debug)]
pub struct Cholesky<const N: usize> {
    l: [[f64; N]; N],
    /// One over the diagonal of L.
    inverse: [f64; N],
}

impl<const N: usize> Cholesky<N> {
    /// Factors `a` (lower triangle read). `None` where a pivot falls below `ratio` times the diagonal element it came from,
    /// that is where the columns before it already span it to that precision (Golub and Van Loan, Matrix Computations 4.2).
    #[inline]
    pub fn new(a: &[[f64; N]; N], ratio: f64) -> Option<Cholesky<N>> {
        let mut l = [[0.0; N]; N];
        let mut inverse = [0.0; N];
        for i in 0..N {
            for j in 0..=i {
                let mut sum = a[i][j];
                for k in 0..j {
                    sum -= l[i][k] * l[j][k];
                }
                if i == j {
                    let large_enough = sum > ratio * a[i][i] && sum > 0.0;
                    if !large_enough {
                        return None;
                    }
                    l[i][i] = sum.sqrt();
                    inverse[i] = 1.0 / l[i][i];
                } else {
                    l[i][j] = sum * inverse[j];
                }
            }
        }
        Some(Cholesky { l, inverse })
    }

    /// Solves A x = b.
    #[inline]
    pub fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let mut x = [0.0; N];
        for i in 0..N {
            let mut sum = b[i];
            for k in 0..i {
                sum -= self.l[i][k] * x[k];
            }
            x[i] = sum * self.inverse[i];
        }
        for i in (0..N).rev() {
            let mut sum = x[i];
            for k in i + 1..N {
                sum -= self.l[k][i] * x[k];
            }
            x[i] = sum * self.inverse[i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_satisfies_its_equations() {
        let a = [[4.0, 2.0, 0.4], [2.0, 5.0, 1.0], [0.4, 1.0, 3.0]];
        let b = [1.0, -2.0, 0.5];
        let x = Cholesky::new(&a, 1e-12).unwrap().solve(&b);
        for i in 0..3 {
            let left: f64 = (0..3).map(|j| a[i][j] * x[j]).sum();
            assert!((left - b[i]).abs() < 1e-15);
        }
    }

    #[test]
    fn an_indefinite_or_dependent_matrix_is_refused() {
        assert!(Cholesky::new(&[[1.0, 2.0], [2.0, 1.0]], 1e-12).is_none());
        assert!(Cholesky::new(&[[1.0, 1.0], [1.0, 1.0]], 1e-12).is_none());
    }
}
