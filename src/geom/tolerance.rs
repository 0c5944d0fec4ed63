//! Every tolerance of the program, each relative and with its reason. No other file holds one.

/// Half the distance from 1 to the next `f64` is the rounding error of one operation; `EPS` is that distance.
pub const EPS: f64 = f64::EPSILON;

/// The clean-up at the root of a CSG tree drops spans and fills gaps whose thickness along the normal is at
/// most this times `EPS` times the largest length in play. One face reached through two transforms was seen
/// to differ by at most 3.6 of these units over 3.8 million rays; 16 leaves a factor of four.
pub const CLEANUP: f64 = 16.0;

/// How many units of `EPS` times the sum of its terms' sizes rounding leaves in a quadratic form of three
/// coordinates: nine products summed, each with two roundings and at most five additions, halved on the mean.
pub const FORM: f64 = 4.0;

/// Default tolerance of a point set surface, relative to the diagonal of its samples.
pub const POINTS: f64 = 1e-9;

/// The clean-up's thickness for lengths up to `scale`, world length.
pub fn cleanup(scale: f64) -> f64 {
    CLEANUP * EPS * scale
}
