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
/// A sum of a few products of numbers, none above 1 in size, is off by less than this times `EPS`: some ten roundings
/// and two of sine and cosine, doubled.
pub const NOISE: f64 = 32.0;

/// A root that lies beyond the end of its piece of boundary by less than this share of the piece is still tried: the
/// joint with the next piece may lie a rounding away. What is tried in vain costs time only, so the share is generous.
pub const JOINT: f64 = 1e-6;

/// Default tolerance of a point set surface, relative to the diagonal of its samples.
pub const POINTS: f64 = 1e-9;

/// The clean-up's thickness for lengths up to `scale`, world length.
pub fn cleanup(scale: f64) -> f64 {
    CLEANUP * EPS * scale
}

/// How far along a line a crossing in closed form may be off, world length, by [`cleanup`] across its face; `cosine` is that
/// between line and normal. Where a line grazes a round face no larger than `scale` both its crossings lie within the root
/// of twice the product of that and the scale; so small cosines count as 2^-24.
pub fn rounded(scale: f64, cosine: f64) -> f64 {
    cleanup(scale) / cosine.abs().max((CLEANUP * EPS).sqrt())
}

/// A length from here on has a fourth power, as discriminants have, that keeps all its digits, and so has one some tens of
/// times smaller: 2^-250, where 2^-1022 is the smallest such number.
pub const SMALLEST: f64 = f64::from_bits((1023 - 250) << 52);

/// Round faces of some size that touch at a point stand within a thickness of each other as far from it as the root of its
/// product with the size says; faces that stand so near over sixteen times that do so over an area.
pub fn touch(thickness: f64, size: f64) -> f64 {
    16.0 * (thickness * size).sqrt()
}

/// The sine of the angle below which two faces that stand within a thickness of each other run along each other there: that
/// thickness is not left, then, over so far as [`touch`] asks for. Where round faces of that size touch it is as small at one
/// place in some hundreds of those that are near.
pub fn run_along(thickness: f64, size: f64) -> f64 {
    (thickness / size).sqrt() / 16.0
}

/// What is thinner than this, of shapes of some size, is drawn if the clean-up leaves it, but hardly meant: a user who asks
/// for scans no more exact than [`POINTS`] does not build walls as thin.
pub fn skin(size: f64) -> f64 {
    POINTS * size
}

/// Two faces that are meant to coincide stand apart by less than this, world length: 3.6 units of `EPS` times the scale were
/// seen, a quarter of [`CLEANUP`] is 4. What is thicker and cleaned up all the same is a film that somebody built.
pub fn film(scale: f64) -> f64 {
    0.25 * cleanup(scale)
}

/// How far past its first crossing an object within an object goes on, in thicknesses of its own clean-up: so far that
/// what is around it, of up to this many times its size, need not ask again to see that nothing is near. It costs next to
/// nothing: near things are rare.
pub const AHEAD: f64 = (1u64 << 20) as f64;

/// What roundings can make of a short expression whose terms are up to `scale`.
pub fn noise(scale: f64) -> f64 {
    NOISE * EPS * scale
}
/// How far, in units in the last place, a function of `libm` may be from its value. Its sources give less than one for most
/// and two for `atan2`; four leaves a factor of two.
pub const LIBM_ULPS: u32 = 4;

/// A stretch of a ray so short, against the part of the ray that is asked about, is not divided any more when the roots of
/// an implicit surface are isolated: points on it differ by a few units in the last place.
pub const STRETCH: f64 = 4.0 * EPS;

/// By this share of its size the box in which an implicit surface is traced stands out of the box that holds it, so that
/// no face of the former meets one of the latter. A power of two, so that scaling keeps the bits.
pub const MARGIN: f64 = 1.0 / (1u64 << 20) as f64;

/// Where the values of a formula over a stretch of a ray spread no wider than this many times what rounding spreads its
/// value at one point of it, dividing the stretch tells nothing more.
pub const FLAT: f64 = 8.0;

/// By this share a golden's t or depth may differ from today's: the same operations give the same bits, and another order of them,
/// or another machine, roundings that grow by a few digits on the way. A radius or a place that is wrong is off by far more.
pub const GOLDEN_SHARE: f64 = 1e-9;

/// By this much a component of a golden's unit normal may differ: normals are kept as `f32`, which tells them to 6e-8.
pub const GOLDEN_NORMAL: f32 = 1e-6;

/// The share of pixels that may show the leaf on the other side of an edge, where roundings decide on which side a ray passes.
pub const GOLDEN_STRAYS: f64 = 5e-4;

/// Lines that look for the end of a solid of some size stop where they find nothing farther than this: a round top is found to
/// the square of how near a line comes to it, a corner by some thirty halvings, and nobody builds to a billionth.
pub fn reached(size: f64) -> f64 {
    POINTS * size
}

/// A bar so narrow, as a share, is made of roundings: no more lines tell more.
pub const ROUNDINGS: f64 = 1e-10;
