//! Cameras.

/// A camera.
#[derive(Clone, Debug)]
pub struct Camera {}
