//! Small numeric routines: roots, 3x3 eigenvectors, small solves, hashes.
pub mod eigen;
pub mod hash;
pub mod roots;
