//! Small symmetric systems of fixed size.

/// The factor L of a symmetric positive definite matrix A = L L^T, row by row in the lower triangle.
#[derive(Clone, Copy, Debug)]
pub struct Cholesky<const N: usize> {
    l: [[f64; N]; N],
    n: usize,
}

impl<const N: usize> Cholesky<N> {
    /// Factors the leading `n` by `n` block of `a` (lower triangle read). `None` where a pivot falls below
    /// `ratio` times the diagonal element it came from, that is where the columns before it already span it
    /// to that precision (Golub and Van Loan, Matrix Computations 4.2).
    pub fn new(a: &[[f64; N]; N], n: usize, ratio: f64) -> Option<Cholesky<N>> {
        let mut l = [[0.0; N]; N];
        for i in 0..n {
            for j in 0..=i {
                let products = l[i].iter().zip(&l[j]).take(j);
                let sum = products.fold(a[i][j], |sum, (x, y)| sum - x * y);
                if i == j {
                    let large_enough = sum > ratio * a[i][i] && sum > 0.0;
                    if !large_enough {
                        return None;
                    }
                    l[i][i] = sum.sqrt();
                } else {
                    l[i][j] = sum / l[j][j];
                }
            }
        }
        Some(Cholesky { l, n })
    }

    /// Solves A x = b.
    pub fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let (l, n) = (&self.l, self.n);
        let mut x = [0.0; N];
        for i in 0..n {
            let mut sum = b[i];
            for k in 0..i {
                sum -= l[i][k] * x[k];
            }
            x[i] = sum / l[i][i];
        }
        for i in (0..n).rev() {
            let mut sum = x[i];
            for k in i + 1..n {
                sum -= l[k][i] * x[k];
            }
            x[i] = sum / l[i][i];
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
        let x = Cholesky::new(&a, 3, 1e-12).unwrap().solve(&b);
        for i in 0..3 {
            let left: f64 = (0..3).map(|j| a[i][j] * x[j]).sum();
            assert!((left - b[i]).abs() < 1e-15);
        }
    }

    #[test]
    fn an_indefinite_or_dependent_matrix_is_refused() {
        assert!(Cholesky::new(&[[1.0, 2.0], [2.0, 1.0]], 2, 1e-12).is_none());
        assert!(Cholesky::new(&[[1.0, 1.0], [1.0, 1.0]], 2, 1e-12).is_none());
    }
}
