//! Times of point set surfaces, each with its error and beside what is asked of it: `cargo bench --bench surface`. Words after
//! `--` choose parts by name. `PSS_LONG=1` adds clouds of ten million points.

#[path = "../csg/clock.rs"]
mod clock;
#[path = "../../tests/common/mod.rs"]
mod common;
mod cut;
mod evaluation;
mod frames;
#[path = "../csg/table.rs"]
mod table;

use table::Part;

const PARTS: [Part; 3] = [("evaluation", evaluation::rows), ("frames", frames::rows), ("cut", cut::rows)];

fn main() {
    table::run(&PARTS);
}
