//! From linear light to what a display shows: exposure, tone curve, sRGB.

use std::sync::LazyLock;

use crate::num::srgb;
use crate::shot::settings::Tone;

/// How linear colours become 8-bit display values.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    gain: f32,
    tone: Tone,
    codes: &'static Codes,
}

impl Display {
    /// After so many stops of exposure.
    pub fn new(exposure: f64, tone: Tone) -> Display {
        Display { gain: exposure.exp2() as f32, tone, codes: &CODES }
    }

    /// What a display shows for a linear colour.
    #[inline]
    pub fn of(&self, color: [f32; 3]) -> [u8; 3] {
        let color = color.map(|c| c * self.gain);
        match self.tone {
            Tone::None => color.map(|c| self.codes.of(c)),
            Tone::Reinhard => reinhard(color).map(|c| self.codes.of(c)),
            // A cast saturates and takes NaN to 0.
            Tone::Agx => agx(color).map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8),
        }
    }
}

/// So many that none has more than one step between codes in it: the curve is steepest where it begins, 12.92 * 255 steps to
/// a unit.
const CELLS: usize = 4096;

/// Where codes begin, so that no pixel costs a power.
#[derive(Debug)]
struct Codes {
    /// The least linear value of each code, and one that none reaches.
    least: [f32; 257],
    /// The code at the low end of each cell of [0, 1].
    first: [u8; CELLS],
}

impl Codes {
    /// The 8-bit sRGB code nearest to a linear value, which is clamped to [0, 1]; of NaN it is 0.
    #[inline]
    fn of(&self, linear: f32) -> u8 {
        let c = linear.clamp(0.0, 1.0);
        let code = self.first[((c * CELLS as f32) as usize).min(CELLS - 1)];
        code + u8::from(self.least[usize::from(code) + 1] <= c)
    }
}

static CODES: LazyLock<Codes> = LazyLock::new(|| {
    let mut least = [0.0; 257];
    least[256] = f32::INFINITY;
    for (code, least) in least[..256].iter_mut().enumerate().skip(1) {
        let exact = srgb::decode((code as f64 - 0.5) / 255.0);
        let near = exact as f32;
        *least = if f64::from(near) < exact { near.next_up() } else { near };
    }
    let first = std::array::from_fn(|cell| {
        let low = cell as f32 / CELLS as f32;
        (least.partition_point(|least| *least <= low) - 1) as u8
    });
    Codes { least, first }
});

/// Luminance L becomes L / (1 + L), hue stays (Reinhard, Stark, Shirley and Ferwerda 2002, equation 3).
pub fn reinhard(color: [f32; 3]) -> [f32; 3] {
    // Rec. 709 weights.
    let luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    if luminance.is_infinite() { [1.0; 3] } else { color.map(|c| c / (1.0 + luminance)) }
}

/// Rows of the matrix into the wider triangle of AgX.
const AGX_INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_655, 0.078_433_6, 0.879_143],
];

/// Rows of its inverse.
const AGX_OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_85, 1.151_903_1, -0.098_961_18],
    [-0.052_971_635, -0.098_043_45, 1.151_073_7],
];

/// The AgX base look (Troy Sobotka 2022) as display-encoded values, in the fit by Benjamin Wrensch ("Minimal
/// AgX Implementation", 2023): into a wider triangle, logarithm, a polynomial for the curve, and back.
pub fn agx(color: [f32; 3]) -> [f32; 3] {
    /// Stops relative to 1 that the curve covers: ten below and six and a half above a middle grey of 0.18.
    const STOPS: [f32; 2] = [-12.473_93, 4.026_069];
    let curved = times(&AGX_INSET, color.map(|c| c.min(f32::MAX))).map(|c| {
        let stops = c.max(f32::MIN_POSITIVE).log2().clamp(STOPS[0], STOPS[1]);
        agx_curve((stops - STOPS[0]) / (STOPS[1] - STOPS[0]))
    });
    times(&AGX_OUTSET, curved)
}

/// The curve over the share of the stops, by Horner's rule.
fn agx_curve(x: f32) -> f32 {
    [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.002_32].iter().fold(0.0, |sum, c| sum * x + c)
}

fn times(rows: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn display(color: [f32; 3], exposure: f64, tone: Tone) -> [u8; 3] {
        Display::new(exposure, tone).of(color)
    }

    #[test]
    fn srgb_has_the_values_of_the_standard() {
        for (linear, code) in [(0.0, 0), (0.003_130_8, 10), (0.214_041_14, 128), (0.5, 188), (1.0, 255)] {
            assert_eq!(display([linear; 3], 0.0, Tone::None), [code; 3], "{linear}");
        }
        assert_eq!(display([f32::NAN, -1.0, f32::INFINITY], 0.0, Tone::None), [0, 0, 255]);
    }

    #[test]
    fn codes_are_the_standards_curve_rounded() {
        let curve = |c: f64| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        for bits in (0..=1.0_f32.to_bits()).step_by(997) {
            let c = f32::from_bits(bits);
            let exact = 255.0 * curve(f64::from(c));
            // The standard's two constants for where the curve begins meet within 1e-7; nothing is said that near a half.
            if 1e-4 < (exact.fract() - 0.5).abs() {
                assert_eq!(f64::from(CODES.of(c)), exact.round(), "{c:e}");
            }
        }
    }

    #[test]
    fn curves_never_fall_and_go_from_black_to_white() {
        for tone in [Tone::Agx, Tone::Reinhard, Tone::None] {
            let mut last = 0;
            for i in -140..=200 {
                let [r, g, b] = display([1.1_f32.powi(i); 3], 0.0, tone);
                // The matrices of the fit keep grey to one level.
                assert!(r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1, "{tone:?} {i}: {r} {g} {b}");
                assert!(last <= g, "{tone:?} falls at {i}");
                last = g;
            }
            assert_eq!(display([0.0; 3], 0.0, tone), [0; 3], "{tone:?}");
            assert_eq!(display([f32::INFINITY; 3], 0.0, tone), [255; 3], "{tone:?}");
        }
    }

    #[test]
    fn the_matrices_of_agx_undo_each_other() {
        for unit in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let back = times(&AGX_OUTSET, times(&AGX_INSET, unit));
            assert!(back.iter().zip(unit).all(|(a, b)| (a - b).abs() < 1e-4), "{back:?}");
        }
    }

    #[test]
    fn a_stop_doubles_the_light() {
        for tone in [Tone::Agx, Tone::Reinhard, Tone::None] {
            assert_eq!(display([0.1, 0.2, 0.3], 1.0, tone), display([0.2, 0.4, 0.6], 0.0, tone));
        }
    }
}
