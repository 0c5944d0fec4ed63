//! Materials.

/// A material.
#[derive(Clone, Debug)]
pub struct Material {}
