//! Monomials in two variables, all of a lower total degree first.

/// How many coefficients a polynomial of a degree has.
pub const fn coefficients(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// The place of u^a v^b.
pub const fn index(a: usize, b: usize) -> usize {
    let d = a + b;
    d * (d + 1) / 2 + b
}

/// The exponents of u and v of the first `N`.
pub const fn exponents<const N: usize>() -> [(usize, usize); N] {
    let mut all = [(0, 0); N];
    let (mut i, mut d) = (0, 0);
    while i < N {
        if coefficients(d) <= i {
            d += 1;
        }
        let b = i - index(d, 0);
        all[i] = (d - b, b);
        i += 1;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_stand_at_their_index() {
        for (i, (a, b)) in exponents::<45>().into_iter().enumerate() {
            assert_eq!(index(a, b), i);
        }
        assert_eq!(coefficients(8), 45);
    }
}
