//! `pss dump`: a scene as JSON. `items` is what was written, `scene` what it comes to; both read back as they were.

use std::path::PathBuf;

use pss::lang::ast::Item;
use pss::measure::Measuring;
use pss::prepare::Options;
use pss::scene::Scene;
use pss::source::SourceMap;
use serde::Serialize;

use crate::args::DumpArgs;
use crate::console::{Console, Failure, print};
use crate::load;

/// Changes where the form does.
const VERSION: u32 = 1;

#[derive(Serialize)]
struct Dump<'a> {
    version: u32,
    items: &'a [Item],
    scene: &'a Scene,
}

/// Prints the scene.
pub fn run(args: &DumpArgs, console: &Console) -> Result<(), Failure> {
    let mut sources = SourceMap::default();
    let stdin = load::is_stdin(&args.scene);
    let name = if stdin { "<stdin>".to_owned() } else { args.scene.display().to_string() };
    let text = load::read_scene(&args.scene)?;
    let file = sources.add(name, (!stdin).then(|| args.scene.clone()), text);
    let options = Options {
        scene_dir: if stdin { PathBuf::from(".") } else { load::folder(&args.scene) },
        allow_read: args.read.allow_read.clone(),
        ..Options::default()
    };
    let measuring = Measuring::new(&options);
    let read = load::understand(&mut sources, file, &args.read, &options, &measuring, false);
    let (read, items) = match read.and_then(|read| Ok((read, pss::lang::items(&sources, file)?))) {
        Ok(read) => read,
        Err(errors) => return Err(Failure::new(errors, sources)),
    };
    console.show(&read.warnings, &sources);
    let dump = Dump { version: VERSION, items: &items, scene: &read.scene };
    let json = serde_json::to_string(&dump).map_err(|e| Failure::internal(e.to_string()))?;
    print(format!("{json}\n").as_bytes()).map(drop)
}
