//! Small numeric routines: roots, 3x3 eigenvectors, small solves, hashes, lanes.
pub mod cholesky;
pub mod eigen;
pub mod enclosure;
pub mod hash;
pub mod lanes;
pub mod roots;
