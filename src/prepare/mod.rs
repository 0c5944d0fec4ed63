//! A scene made ready to trace.
