//! Logarithm and exponential by additions, products and quotients alone, so that the bits are the same on every
//! machine: those of the system differ between platforms.

/// ln 2 in two parts: whole multiples of the first, up to a thousand, are exact.
pub(crate) const LN2_HI: f64 = 0.693_147_180_369_123_8;
/// The rest of it.
pub(crate) const LN2_LO: f64 = 1.908_214_929_270_587_7e-10;

/// 1 / k!: the Taylor series of exp.
pub(crate) const TAYLOR: [f64; 14] = {
    let mut c = [1.0; 14];
    let mut k = 1;
    while k < 14 {
        c[k] = c[k - 1] / k as f64;
        k += 1;
    }
    c
};

/// e^x within 2 ulp for |x| < 708; below that 0, above it infinite.
///
/// x = k ln 2 + f with |f| <= ln 2 / 2; the Taylor series of exp to degree 13 ends below 1e-17.
pub fn exp(x: f64) -> f64 {
    const LIMIT: f64 = 708.0;
    if LIMIT <= x.abs() || x.is_nan() {
        return if x < 0.0 { 0.0 } else { f64::INFINITY };
    }
    let k = (x * std::f64::consts::LOG2_E).round_ties_even();
    let f = (x - k * LN2_HI) - k * LN2_LO;
    let mut p = TAYLOR[13];
    for c in TAYLOR[..13].iter().rev() {
        p = p * f + c;
    }
    p * f64::from_bits(((k as i64 + 1023) as u64) << 52)
}

/// ln(1 + u) within 2 ulp for 0 <= u <= 1.
///
/// 2 artanh(s) with s = u / (2 + u) <= 1/3; above sqrt 2 - 1 half of 1 + u is taken instead and ln 2 added, so that
/// |s| <= 0.172 and the series to s^23 ends below 1e-18.
pub fn ln_1p(u: f64) -> f64 {
    let (s, whole) = if u <= std::f64::consts::SQRT_2 - 1.0 {
        (u / (2.0 + u), 0.0)
    } else {
        ((u - 1.0) / (u + 3.0), std::f64::consts::LN_2)
    };
    whole + twice_artanh(s)
}

/// ln x within 2 ulp, or 2^-53 where it is less than that, for finite x > 0; minus infinity for 0.
pub fn ln(x: f64) -> f64 {
    if x < f64::MIN_POSITIVE {
        // Subnormal numbers are as good as zero to what is asked here.
        return f64::NEG_INFINITY;
    }
    let bits = x.to_bits();
    let mantissa = f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52);
    let above = u64::from(std::f64::consts::SQRT_2 < mantissa);
    let m = if above == 1 { 0.5 * mantissa } else { mantissa };
    let k = ((bits >> 52) + above) as f64 - 1023.0;
    k * LN2_HI + (k * LN2_LO + twice_artanh((m - 1.0) / (m + 1.0)))
}

/// 2 artanh(s) = 2 (s + s^3 / 3 + s^5 / 5 + ...) for |s| <= 0.172.
fn twice_artanh(s: f64) -> f64 {
    let z = s * s;
    let mut p = 1.0 / 23.0;
    for k in (1..23).step_by(2).rev() {
        p = p * z + 1.0 / f64::from(k);
    }
    2.0 * s * p
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    #[test]
    fn logarithm_and_exponential_agree_with_the_systems_to_two_ulp() {
        let mut stream = Stream::new(1);
        let near = |a: f64, b: f64| (a - b).abs() <= 2.0 * f64::EPSILON * b.abs();
        for _ in 0..20_000 {
            let x = 1400.0 * (stream.unit() - 0.5);
            assert!(near(exp(x), x.exp()), "{x}");
            let y = x.exp2();
            assert!(near(ln(y), y.ln()) || (ln(y) - y.ln()).abs() <= f64::EPSILON, "{y:e}");
            let u = stream.unit();
            assert!(near(ln_1p(u), u.ln_1p()), "{u}");
        }
        assert_eq!([exp(0.0), exp(-1e9), exp(f64::NEG_INFINITY)], [1.0, 0.0, 0.0]);
        assert_eq!([ln(1.0), ln(0.0)], [0.0, f64::NEG_INFINITY]);
    }
}
