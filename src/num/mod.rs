//! Small numeric routines: roots, powers, 3x3 eigenvectors, small solves, hashes, lanes, medians, monomials.
pub mod cholesky;
pub mod convex;
pub mod eigen;
pub mod enclosure;
pub mod hash;
pub mod lanes;
pub mod median;
pub mod monomials;
pub mod power;
pub mod roots;
pub mod srgb;
