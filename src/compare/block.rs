//! Squares of nine pixels that are all off to the same side (the idea of OpenSCAD's picture tests).

use super::Difference;

/// Pictures as displays show them, from 0 to 1.
pub fn difference([w, h]: [u32; 2], a: &[[f64; 3]], b: &[[f64; 3]]) -> Difference {
    let (w, h) = (w as usize, h as usize);
    let off = |x: usize, y: usize, c: usize| 255.0 * (a[y * w + x][c] - b[y * w + x][c]);
    // The least of nine differences of one sign, of a square about a pixel.
    let about = |x: usize, y: usize, c: usize| {
        let nine = (0..9).map(|k| off(x + k % 3 - 1, y + k / 3 - 1, c));
        let [least, most] = nine.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, m], d| [l.min(d), m.max(d)]);
        least.max(-most).max(0.0)
    };
    let mut map = vec![0.0; w * h];
    for y in 1..h.saturating_sub(1) {
        for x in 1..w.saturating_sub(1) {
            map[y * w + x] = (0..3).map(|c| about(x, y, c)).fold(0.0, f64::max);
        }
    }
    Difference { value: map.iter().copied().fold(0.0, f64::max), map }
}
