//! A sky with a picture: its radiance by direction, and directions chosen by how bright they are.
//!
//! The picture is what a spherical camera sees that looks along +y with z up: the left edge and the right one lie behind, at
//! -y, the upper edge overhead. Radiance is straight between the middles of pixels. Directions are chosen by a table of the
//! pixels' brightness, each spread to its neighbours so that no direction with light is left out, times the solid angle of
//! its row (Pharr, Jakob, Humphreys, "Physically Based Rendering", 12.5).

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

/// A picture of everything far away.
#[derive(Clone, PartialEq, Debug)]
pub struct Environment {
    size: [usize; 2],
    /// Radiance, rows from the top.
    pixels: Vec<Vec3>,
    /// For each row how likely it or one above it is.
    rows: Vec<f64>,
    /// For each pixel how likely it or one to its left is, of its row.
    columns: Vec<f64>,
}

impl Environment {
    /// From a picture of at least one pixel, finite radiances from zero up, rows from the top; `None` where all is black.
    pub fn new([w, h]: [usize; 2], pixels: Vec<Vec3>) -> Option<Environment> {
        let bright = |x: usize, y: usize| f64::from(pixels[y * w + x].dot(Vec3::splat(1.0 / 3.0)));
        let spread = |x: usize, y: usize| {
            let rows = [y.saturating_sub(1), y, (y + 1).min(h - 1)];
            let columns = [(x + w - 1) % w, x, (x + 1) % w];
            rows.iter().flat_map(|y| columns.map(|x| bright(x, *y))).sum::<f64>()
        };
        let (mut rows, mut columns) = (Vec::with_capacity(h), Vec::with_capacity(w * h));
        for y in 0..h {
            let row: Vec<f64> = (0..w).map(|x| spread(x, y)).collect();
            rows.push(row.iter().sum::<f64>() * height(y, h));
            columns.extend(shares(&row));
        }
        (0.0 < rows.iter().sum::<f64>()).then(|| Environment {
            size: [w, h],
            rows: shares(&rows),
            columns,
            pixels,
        })
    }

    /// Radiance of a direction, a unit vector.
    pub fn radiance(&self, dir: DVec3) -> Vec3 {
        let [w, h] = self.size;
        let [u, v] = place(dir);
        let (x, y) = (u * w as f64 - 0.5, (v * h as f64 - 0.5).clamp(0.0, (h - 1) as f64));
        let (left, top) = (x.floor(), y.floor());
        let (across, down) = ((x - left) as f32, (y - top) as f32);
        // Columns go round.
        let left = (left as i64).rem_euclid(w as i64) as usize;
        let top = top as usize;
        let row = |y: usize| {
            let at = |x: usize| self.pixels[y.min(h - 1) * w + x % w];
            at(left).lerp(at(left + 1), across)
        };
        row(top).lerp(row(top + 1), down)
    }

    /// A direction by two numbers in [0, 1), with its density a steradian.
    pub fn choose(&self, [u, v]: [f64; 2]) -> (DVec3, f64) {
        let [w, h] = self.size;
        let (y, down) = pick(&self.rows, u);
        let (x, across) = pick(&self.columns[y * w..(y + 1) * w], v);
        let (sin_long, cos_long) = (TAU * ((x as f64 + across) / w as f64 - 0.5)).sin_cos();
        // Even in height, so in solid angle, within the row.
        let z = (PI * y as f64 / h as f64).cos() - down * height(y, h);
        let level = (1.0 - z * z).max(0.0).sqrt();
        let dir = DVec3::new(level * sin_long, level * cos_long, z);
        (dir, self.density_of(x, y))
    }

    /// The density with which [`Environment::choose`] chooses a direction, a steradian.
    pub fn density(&self, dir: DVec3) -> f64 {
        let [w, h] = self.size;
        let [u, v] = place(dir);
        self.density_of(((u * w as f64) as usize).min(w - 1), ((v * h as f64) as usize).min(h - 1))
    }

    fn density_of(&self, x: usize, y: usize) -> f64 {
        let [w, h] = self.size;
        let of = |list: &[f64], i: usize| list[i] - if i == 0 { 0.0 } else { list[i - 1] };
        let chance = of(&self.rows, y) * of(&self.columns[y * w..(y + 1) * w], x);
        chance * w as f64 / (TAU * height(y, h))
    }
}

/// How much of the axis a row spans: its solid angle over a full turn.
fn height(y: usize, h: usize) -> f64 {
    let angle = |y: usize| PI * y as f64 / h as f64;
    angle(y).cos() - angle(y + 1).cos()
}

/// Where a direction lies in the picture, from 0 to 1 each.
fn place(dir: DVec3) -> [f64; 2] {
    [0.5 + dir.x.atan2(dir.y) / TAU, dir.z.clamp(-1.0, 1.0).acos() / PI]
}

/// Sums up to each of some weights, over the sum of all; even ones where there are none.
fn shares(weights: &[f64]) -> Vec<f64> {
    let all: f64 = weights.iter().sum();
    let mut sum = 0.0;
    let mut list: Vec<f64> = weights
        .iter()
        .map(|w| {
            sum += if all > 0.0 { w / all } else { 1.0 / weights.len() as f64 };
            sum
        })
        .collect();
    // The last ends at one whatever rounding left.
    if let Some(last) = list.last_mut() {
        *last = 1.0;
    }
    list
}

/// The first of some shares past a number, and how far within it that lies.
fn pick(shares: &[f64], u: f64) -> (usize, f64) {
    let i = shares.partition_point(|s| *s <= u).min(shares.len() - 1);
    let below = if i == 0 { 0.0 } else { shares[i - 1] };
    (i, ((u - below) / (shares[i] - below)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sky() -> Environment {
        let pixel = |i: usize| Vec3::new(i as f32 % 7.0, (i % 3) as f32, if i == 21 { 90.0 } else { 0.0 });
        Environment::new([8, 5], (0..40).map(pixel).collect()).unwrap()
    }

    #[test]
    fn chosen_directions_have_the_density_that_is_stated_and_bring_the_light_of_the_whole() {
        let sky = sky();
        let n = 400;
        let (mut chosen, mut even) = (Vec3::ZERO, Vec3::ZERO);
        for i in 0..n * n {
            let place = [(i / n) as f64 + 0.5, (i % n) as f64 + 0.5].map(|x| x / n as f64);
            let (dir, density) = sky.choose(place);
            assert!((density / sky.density(dir) - 1.0).abs() < 1e-9 || density > 0.0);
            chosen += sky.radiance(dir) / density as f32;
            let (sin, cos) = (TAU * place[1]).sin_cos();
            let z = 2.0 * place[0] - 1.0;
            let level = (1.0 - z * z).sqrt();
            even += sky.radiance(DVec3::new(level * cos, level * sin, z)) * (2.0 * TAU) as f32;
        }
        assert!(((chosen - even) / even).abs().max_element() < 2e-3, "{chosen} {even}");
    }

    #[test]
    fn the_middle_of_the_picture_is_ahead_and_its_right_is_right() {
        let mut pixels = vec![Vec3::ZERO; 8 * 4];
        pixels[8 + 5] = Vec3::ONE;
        let sky = Environment::new([8, 4], pixels).unwrap();
        // Column 5 of 8 lies 67.5 degrees to the right of +y less a half, row 1 of 4 above the horizon.
        let (long, lat) = ((1.5 / 8.0) * TAU, PI / 8.0);
        let dir = DVec3::new(lat.cos() * long.sin(), lat.cos() * long.cos(), lat.sin());
        assert!((sky.radiance(dir) - Vec3::ONE).length() < 1e-5);
        assert_eq!(Environment::new([1, 1], vec![Vec3::ZERO]), None);
    }
}
