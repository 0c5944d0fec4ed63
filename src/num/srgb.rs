//! The curve between linear light and sRGB, from 0 to 1 (IEC 61966-2-1).

/// Linear light of an encoded value.
pub fn decode(c: f64) -> f64 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// The encoded value of linear light.
pub fn encode(c: f64) -> f64 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// How fast the encoded value grows with linear light.
pub fn slope(c: f64) -> f64 {
    if c <= 0.003_130_8 { 12.92 } else { 1.055 / 2.4 * libm::pow(c, 1.0 / 2.4 - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_undoes_the_other() {
        for i in 0..=255 {
            let c = f64::from(i) / 255.0;
            assert!((encode(decode(c)) - c).abs() < 1e-7, "{c}");
        }
        assert!((decode(0.5) - 0.214_041_14).abs() < 1e-8);
        for c in [0.001, 0.1, 0.7] {
            assert!((slope(c) - (encode(c + 1e-6) - encode(c - 1e-6)) / 2e-6).abs() < 1e-4, "{c}");
        }
    }
}
