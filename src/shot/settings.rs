//! What a picture is a function of, beside the scene itself.

/// Settings.
#[derive(Clone, Debug)]
pub struct Settings {}
