//! Sample points: an Owen-scrambled Sobol sequence for each pixel, chosen by hashes, so that a sample depends
//! on seed, pixel and index alone.

use crate::num::hash::mix;

/// The sequence of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct PixelSampler {
    seed: u64,
}

/// One sample: as many pairs of numbers as one asks for.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    seed: u64,
    index: u32,
}

impl PixelSampler {
    /// The sequence of a pixel of the whole picture.
    pub fn new(seed: u64, x: u32, y: u32) -> PixelSampler {
        PixelSampler { seed: mix(mix(seed) ^ (u64::from(x) << 32 | u64::from(y))) }
    }

    /// A sample by its number, from zero.
    pub fn sample(self, index: u32) -> Sample {
        Sample { seed: self.seed, index }
    }
}

impl Sample {
    /// Two numbers in [0, 1): the `k`-th pair; pair 0 is the place in the pixel. Two pairs share a
    /// four-dimensional sequence; a new seed pads it to as many as needed (Burley 2020, section 4).
    pub fn pair(self, k: u32) -> [f64; 2] {
        let padded = mix(self.seed ^ u64::from(k / 2)) as u32;
        let four = sobol_burley::sample_4d(self.index, 0, padded);
        let first = 2 * (k % 2) as usize;
        [f64::from(four[first]), f64::from(four[first + 1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_samples_hit_every_cell_of_a_four_by_four_grid() {
        let mut hit = [false; 16];
        for i in 0..16 {
            let [x, y] = PixelSampler::new(7, 3, 4).sample(i).pair(0);
            hit[4 * (4.0 * y) as usize + (4.0 * x) as usize] = true;
        }
        assert_eq!(hit, [true; 16]);
    }
}
