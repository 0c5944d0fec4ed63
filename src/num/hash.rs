//! Hashes that stand in for random numbers: pure functions, so nothing depends on the order of calls.

/// Mixes 64 bits (the finaliser of SplitMix64, Steele, Lea and Flood 2014).
pub fn mix(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A number in [0, 1) from a seed and an index.
pub fn unit(seed: u64, index: u64) -> f64 {
    (mix(mix(seed) ^ index) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A stream of hashes: the `k`-th draw depends on the seed and on `k` alone.
#[derive(Clone, Debug)]
pub struct Stream {
    seed: u64,
    next: u64,
}

impl Stream {
    /// Starts a stream.
    pub fn new(seed: u64) -> Stream {
        Stream { seed, next: 0 }
    }

    /// The next number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.next += 1;
        unit(self.seed, self.next)
    }

    /// The next number of the standard normal distribution (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    /// The next unit vector, even over the sphere.
    pub fn direction(&mut self) -> glam::DVec3 {
        let z = 1.0 - 2.0 * self.unit();
        let (sin, cos) = (std::f64::consts::TAU * self.unit()).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        glam::DVec3::new(r * cos, r * sin, z)
    }
}
