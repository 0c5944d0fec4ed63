//! Times of constructive solid geometry, each beside what is asked of it: `cargo bench --bench csg`. Words after `--` choose
//! parts by name.

mod clock;
mod commands;
mod rays;
mod table;

use table::Part;

const PARTS: [Part; 7] = [
    ("two_leaves", rays::two_leaves),
    ("chain", rays::chain),
    ("lattice", rays::lattice),
    ("polytope", rays::polytope),
    ("plates", commands::plates),
    ("instances", commands::instances),
    ("peers", commands::peers),
];

fn main() {
    table::run(&PARTS);
}
