//! Times of constructive solid geometry, each beside what is asked of it: `cargo bench --bench csg`. Words after `--` choose
//! parts by name.

mod clock;
mod commands;
mod pixels;
mod rays;
mod table;

use table::Part;

const PARTS: [Part; 9] = [
    ("two_leaves", rays::two_leaves),
    ("chain", rays::chain),
    ("lattice", rays::lattice),
    ("polytope", rays::polytope),
    ("plates", commands::plates),
    ("instances", commands::instances),
    ("peers", commands::peers),
    ("scales", pixels::scales),
    ("artefacts", pixels::artefacts),
];

fn main() {
    table::run(&PARTS);
}
