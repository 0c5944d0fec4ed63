//! Lights.

/// A light.
#[derive(Clone, Debug)]
pub struct Light {}
