//! A shot to a film.
