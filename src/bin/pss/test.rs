//! `pss test`: the `expect` items of a folder's scenes, whether each can be prepared, and whether it is what its goldens say.

use std::path::{Path, PathBuf};
use std::time::Instant;

use pss::diag::{Diagnostic, Fault};
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
    let scenes = scenes(&args.folder)?;
    let (mut code, mut bare, mut outcomes) = (0, 0, Vec::new());
    for scene in scenes {
        let start = Instant::now();
        let done = test(&scene, args, console);
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
        false => goldens::compare(scene, &loaded),
    };
    let kept = kept.map_err(|more| unmet.extend(more)).unwrap_or_default();
    if unmet.is_empty() { Ok(kept) } else { Err(Failure::new(unmet, loaded.sources)) }
}

/// The scenes of a folder and the folders in it, in the order of their names.
fn scenes(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let missing = |path: &Path, e: std::io::Error| {
        let error = match e.kind() {
            std::io::ErrorKind::NotFound => {
                Diagnostic::error("E0601", format!("there is no `{}`", path.display()))
                    .help("name a scene or a folder of scenes")
            }
            _ => Diagnostic::error("E0601", format!("cannot read `{}`", path.display())).help(e.to_string()),
        };
        Failure::from(error.fault(Fault::Missing))
    };
    if folder.is_file() {
        return Ok(vec![folder.to_owned()]);
    }
    let (mut scenes, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).map_err(|e| missing(&next, e))? {
            let entry = entry.map_err(|e| missing(&next, e))?;
            let kind = entry.file_type().map_err(|e| missing(&next, e))?;
            let path = entry.path();
            if kind.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "pss") {
                scenes.push(path);
            }
        }
    }
    scenes.sort();
    if scenes.is_empty() {
        let message = format!("`{}` holds no scenes", folder.display());
        return Err(Failure::from(Diagnostic::error("E0601", message).fault(Fault::Missing)));
    }
    Ok(scenes)
}
