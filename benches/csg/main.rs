//! Times of constructive solid geometry, each beside what is asked of it: `cargo bench --bench csg`. Words after `--` choose
//! parts by name.

mod clock;
mod commands;
mod rays;
mod table;

use table::Row;

type Part = (&'static str, fn(&mut Vec<Row>));

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
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let mut rows = Vec::new();
    for (name, run) in PARTS {
        if asked.is_empty() || asked.iter().any(|a| name.contains(a.as_str())) {
            eprintln!("{name}");
            run(&mut rows);
        }
    }
    table::print(&rows);
}
