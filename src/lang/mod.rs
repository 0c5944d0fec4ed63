//! Scene text to [`crate::scene::Scene`].
