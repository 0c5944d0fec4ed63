//! The surface of points by moving least squares: weight, plane, polynomial, and the scalar field F whose
//! zeros are the surface, with its gradient. Where samples come from and where rays go is left to others.
//!
//! Definition (Adamson and Alexa, Ray Tracing Point Set Surfaces, 2003; Alexa et al. 2003). For a point r let
//! (n, t) be a local minimum, over unit vectors n and numbers t, of the un-normalised energy
//!
//! ```text
//! J(n, t) = sum_i w_i (n . (p_i - r) - t)^2,   w_i = theta(|p_i - r - t n|^2 / h_i^2)
//! ```
//!
//! (form A, [`Form::Free`]: both n and t free; [`Form::Levin`] is form B), q = r + t n, and g a bivariate polynomial fitted over that plane with the same
//! weights. Then F(r) = t + g(0, 0), and the surface is F = 0. Here n points **into** the solid, so F is positive
//! outside and grad F points outward.

mod blocks;
mod field;
mod gradient;
mod levin;
mod neighbours;
mod plane;
mod polynomial;
mod weight;

pub use blocks::Blocks;
pub use field::{Evaluator, Form, Guess, Sample, Stray};
pub use neighbours::Neighbours;
pub use weight::{AnyWay, Compact, Facing, Gaussian, SameWay, Weight};

/// The highest degree of the polynomial.
pub const MAX_DEGREE: usize = 4;
