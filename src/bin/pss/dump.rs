//! `pss dump`: a scene as JSON. `items` is what was written, `scene` what it comes to; both read back as they were.

use pss::diag::Diagnostic;
use pss::lang::ast::Item;
use pss::prepare::Options;
use pss::scene::{MAX_WRITTEN_OUT, Scene};
use serde::Serialize;

use crate::args::DumpArgs;
use crate::console::{Console, Failure, print};
use crate::load::{self, Understood};

/// Changes where the form does.
const VERSION: u32 = 1;

#[derive(Serialize)]
struct Dump<'a> {
    version: u32,
    items: &'a [Item],
    scene: &'a Scene,
}

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

/// Prints the scene.
pub fn run(args: &DumpArgs, console: &Console) -> Result<(), Failure> {
    let Understood { read, sources, file, .. } =
        load::understand(&args.scene, &args.read, Options::default(), [false; 2], console)?;
    let items = match pss::lang::items(&sources, file) {
        Ok(items) => items,
        Err(errors) => return Err(Failure::new(errors, sources)),
    };
    check_count(&read.scene)?;
    let dump = Dump { version: VERSION, items: &items, scene: &read.scene };
    let json = serde_json::to_string(&dump).map_err(|e| Failure::internal(e.to_string()))?;
    print(format!("{json}\n").as_bytes()).map(drop)
}
