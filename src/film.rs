//! Pixels in memory.
