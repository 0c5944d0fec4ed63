//! `pss test`: the `expect` items of a folder's scenes, whether each can be prepared, and whether it is what its goldens say.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use pss::diag::{Diagnostic, Fault};
use pss::golden;
use pss::output::write_whole;
use pss::prepare::Options;
use pss::report;

use crate::args::TestArgs;
use crate::console::{Console, Failure};
use crate::goldens;
use crate::junit::{self, Outcome};
use crate::load;

/// Runs all scenes; 0 where all hold, 1 where an expectation or a golden does not, else the code of the first that cannot be read.
pub fn run(args: &TestArgs, console: &Console) -> Result<u8, Failure> {
    let Found { scenes, gone } = found(&args.folder)?;
    let (mut code, mut bare, mut outcomes) = (0, 0, Vec::new());
    let here = scenes.into_iter().map(|scene| (scene, true));
    for (scene, is_here) in here.chain(gone.into_iter().map(|scene| (scene, false))) {
        let start = Instant::now();
        let done = match is_here {
            true => test(&scene, args, console),
            false => Err(Failure::from(goldens::orphans(&scene))),
        };
        let (told, failure) = match done {
            Ok(kept) => {
                bare += usize::from(kept.is_bare);
                (format!("ok{}", kept.told), None)
            }
            Err(failure) => {
                let failed = console.fail(&failure);
                code = if code == 0 { failed } else { code };
                ("FAILED".to_owned(), Some(report::text(&failure.diagnostics, &failure.sources, false)))
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        console.note(&format!("{}: {told}", scene.display()));
        outcomes.push(Outcome { scene, seconds, failure });
    }
    let failed = outcomes.iter().filter(|o| o.failure.is_some()).count();
    console.note(&format!("{} scenes, {failed} failed", outcomes.len()));
    if 0 < bare {
        console.note(&format!("{bare} of them have no golden: `--bless` makes them"));
    }
    if let Some(path) = &args.junit {
        let report = junit::report(&args.folder, &outcomes);
        write_whole(path, |out| out.write_all(report.as_bytes()))?;
    }
    Ok(code)
}

/// Tests a scene: what to say where all holds.
fn test(scene: &Path, args: &TestArgs, console: &Console) -> Result<goldens::Kept, Failure> {
    let options = Options { measure_all: true, ..Options::default() };
    let asks = load::Asks { quiet: true, expects: true, idle: false };
    let mut loaded = load::load_with(scene, &args.read, options, asks, console)?;
    let mut unmet = std::mem::take(&mut loaded.unmet);
    let kept = match args.bless {
        // What does not hold is no example for later.
        true if !unmet.is_empty() => Ok(goldens::Kept::default()),
        true => goldens::bless(scene, &loaded, console),
        false => goldens::compare(scene, &loaded, console),
    };
    let kept = kept.map_err(|more| unmet.extend(more)).unwrap_or_default();
    if unmet.is_empty() { Ok(kept) } else { Err(Failure::new(unmet, loaded.sources)) }
}

/// What a folder holds, in the order of the names.
#[derive(Default)]
struct Found {
    scenes: Vec<PathBuf>,
    /// Scenes that are not there, and whose goldens are.
    gone: BTreeSet<PathBuf>,
}

/// Looks through a folder and the folders in it.
fn found(folder: &Path) -> Result<Found, Failure> {
    if folder.is_file() {
        return Ok(Found { scenes: vec![folder.to_owned()], ..Found::default() });
    }
    let (mut found, mut open) = (Found::default(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).map_err(|e| missing(&next, e))? {
            let entry = entry.map_err(|e| missing(&next, e))?;
            let kind = entry.file_type().map_err(|e| missing(&next, e))?;
            let path = entry.path();
            if kind.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "pss") {
                found.scenes.push(path);
            } else if kind.is_file() && !path.with_extension("pss").exists() {
                found.gone.extend(golden::scene_of(&path));
            }
        }
    }
    found.scenes.sort();
    if found.scenes.is_empty() && found.gone.is_empty() {
        let message = format!("`{}` holds no scenes", folder.display());
        return Err(Failure::from(Diagnostic::error("E0601", message).fault(Fault::Missing)));
    }
    Ok(found)
}

fn missing(path: &Path, e: std::io::Error) -> Failure {
    let error = match e.kind() {
        std::io::ErrorKind::NotFound => {
            Diagnostic::error("E0601", format!("there is no `{}`", path.display()))
                .help("name a scene or a folder of scenes")
        }
        _ => Diagnostic::error("E0601", format!("cannot read `{}`", path.display())).help(e.to_string()),
    };
    Failure::from(error.fault(Fault::Missing))
}
