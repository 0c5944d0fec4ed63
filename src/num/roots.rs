//! Real roots of polynomials.

/// The real roots of `a t^2 + 2 b t + c`, ascending, given the discriminant `b^2 - a c` computed by the caller
/// in whatever form loses least; a double root gives `None`, as a tangent has no inside.
///
/// The root of larger magnitude comes from `-b -+ sqrt(disc)` without cancellation, the other from the
/// product of the roots (Vieta; Press et al., Numerical Recipes 5.6). `a` must not be zero.
pub fn quadratic(a: f64, b: f64, c: f64, discriminant: f64) -> Option<[f64; 2]> {
    if discriminant.is_nan() || discriminant <= 0.0 {
        return None;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let (t0, t1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    let (lo, hi) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
    (lo < hi).then_some([lo, hi])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_root_beside_a_large_one_keeps_its_digits() {
        // (t - 1e8)(t - 1e-8) = t^2 - (1e8 + 1e-8) t + 1
        let b = -0.5 * (1e8 + 1e-8);
        let [lo, hi] = quadratic(1.0, b, 1.0, b * b - 1.0).unwrap();
        assert!((lo / 1e-8 - 1.0).abs() < 1e-15 && (hi / 1e8 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_double_root_has_no_inside() {
        assert_eq!(quadratic(1.0, -1.0, 1.0, 0.0), None);
        assert_eq!(quadratic(1.0, 0.0, 1.0, -1.0), None);
    }
}
