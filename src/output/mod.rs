//! A film to files.
