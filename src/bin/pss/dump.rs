//! `pss dump`: a scene as JSON. `items` is what was written, `scene` what it comes to; both read back as they were.

use std::io;

use pss::diag::Diagnostic;
use pss::prepare::Options;
use pss::scene::{MAX_WRITTEN_OUT, Scene};

use crate::args::DumpArgs;
use crate::console::{Console, Failure, print_with};
use crate::load::{self, Understood};

/// Changes where the form does.
const VERSION: u32 = 1;

/// What is shared in a scene is written out in its JSON.
fn check_count(scene: &Scene) -> Result<(), Failure> {
    let count = scene.written_out();
    if count <= MAX_WRITTEN_OUT {
        return Ok(());
    }
    let told = format!("the scene comes to more than {MAX_WRITTEN_OUT} shapes when written out");
    let error = Diagnostic::error("E0703", told);
    Err(Failure::from(error.help("dump a scene that uses its shapes fewer times")))
}

/// Prints the scene: `version`, the names of the texts in `files`, which the `file` of a place counts from 0, `items` and
/// `scene`. Items are read and written one by one, as a long text has hundreds of megabytes of them.
pub fn run(args: &DumpArgs, console: &Console) -> Result<(), Failure> {
    let Understood { read, sources, file, .. } =
        load::understand(&args.scene, &args.read, Options::default(), [false; 2], console)?;
    check_count(&read.scene)?;
    let files: Vec<&str> = sources.files().map(|file| file.name.as_str()).collect();
    let written = print_with(|out| {
        write!(out, "{{\"version\":{VERSION},\"files\":")?;
        serde_json::to_writer(&mut *out, &files)?;
        let mut before = ",\"items\":[";
        pss::lang::each_item(&sources, file, |item| {
            write!(out, "{before}")?;
            before = ",";
            serde_json::to_writer(&mut *out, &item).map_err(io::Error::from)
        })?;
        write!(out, "{}],\"scene\":", if before == "," { "" } else { before })?;
        serde_json::to_writer(&mut *out, &read.scene)?;
        writeln!(out, "}}")
    });
    written.map(drop)
}
