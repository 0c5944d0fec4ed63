//! Moving least squares.

/// Room for one thread's evaluations.
#[derive(Default, Debug)]
pub struct Scratch {}
