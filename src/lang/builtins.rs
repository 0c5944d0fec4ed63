//! The table of functions, methods and constants that the language itself knows: adding one is one line here
//! or in the table of its room. What a scene can build is in the catalogue instead.

use super::args::{Bound, Formal};
use super::value::{Eval, Val};
use super::{lists, maths, methods, queries, sets};

/// A function or a method.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// The word.
    pub name: &'static str,
    /// What it takes.
    pub formals: &'static [Formal<'static>],
    /// One sentence.
    pub doc: &'static str,
    /// What it does.
    pub call: fn(&Bound) -> Eval<Val>,
}

/// A line of a table.
pub const fn line(
    name: &'static str,
    formals: &'static [Formal<'static>],
    doc: &'static str,
    call: fn(&Bound) -> Eval<Val>,
) -> Builtin {
    Builtin { name, formals, doc, call }
}

/// Names of numbers: name, value, meaning.
pub const CONSTANTS: [(&str, f64, &str); 2] = [
    ("pi", std::f64::consts::PI, "half the circumference of a unit circle"),
    ("tau", std::f64::consts::TAU, "the circumference of a unit circle"),
];

/// Methods of shapes.
pub const METHODS: &[Builtin] = methods::TABLE;

/// All functions.
pub fn functions() -> impl Iterator<Item = &'static Builtin> {
    sets::TABLE.iter().chain(maths::TABLE).chain(lists::TABLE).chain(queries::TABLE)
}

/// Those that are values too, by their names: functions of numbers.
pub fn values() -> impl Iterator<Item = &'static Builtin> {
    maths::TABLE.iter()
}
