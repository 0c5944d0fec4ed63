//! One seeded generator, and draws of coordinates in which ties and near-ties are frequent.

use glam::DVec3;

/// A 64-bit xorshift generator.
pub struct Draws(u64);

impl Draws {
    pub fn new(seed: u64) -> Draws {
        Draws(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// One of `0..n`.
    pub fn below(&mut self, n: usize) -> usize {
        (((self.bits() >> 32) * n as u64) >> 32) as usize
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    pub fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    pub fn among<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, self.below(i + 1));
        }
    }

    /// A third small integers, a third earlier values a little displaced, a third of any magnitude.
    pub fn coordinate(&mut self, earlier: &mut Vec<f64>) -> f64 {
        let value = match self.below(3) {
            1 if !earlier.is_empty() => self.pick(earlier) + self.displacement(),
            2 => 10f64.powf(self.between(-3.0, 1.0)) * self.pick(&[-1.0, 1.0]),
            _ => self.below(7) as f64 - 3.0,
        };
        if earlier.len() < 64 {
            earlier.push(value);
        }
        value
    }

    /// Nothing, roundings, and what lies about the clean-up's thickness.
    fn displacement(&mut self) -> f64 {
        let eps = f64::EPSILON;
        let size = self.pick(&[0.0, 0.0, eps, 4.0 * eps, 16.0 * eps, 64.0 * eps, 1e-14, 1e-12, 1.0]);
        size * self.pick(&[-1.0, 1.0])
    }

    pub fn vector(&mut self, earlier: &mut Vec<f64>) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.coordinate(earlier)))
    }

    /// A unit vector.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::from_array(std::array::from_fn(|_| self.between(-1.0, 1.0)));
            if 0.01 < v.length_squared() && v.length_squared() <= 1.0 {
                return v.normalize();
            }
        }
    }
}
