//! Recursion over what a scene nests, however deep: a chain of ten thousand operators is a shape ten thousand deep.

/// Runs one step of a recursion, on a new piece of stack where the present one is nearly used up.
pub fn step<R>(run: impl FnOnce() -> R) -> R {
    /// More than any step and what it calls outside the recursion needs.
    const LEFT: usize = 128 << 10;
    const PIECE: usize = 4 << 20;
    stacker::maybe_grow(LEFT, PIECE, run)
}
