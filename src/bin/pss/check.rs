//! `pss check`: what is wrong, or may be, with scenes; renders nothing.

use std::path::Path;

use pss::prepare::Options;

use crate::args::CheckArgs;
use crate::console::{Console, Failure};
use crate::fix;
use crate::load::{self, Loaded};

/// Runs the command on all scenes; the exit code is that of the first that failed.
pub fn run(args: &CheckArgs, console: &Console) -> u8 {
    let mut code = 0;
    for scene in &args.scenes {
        let mended = if args.fix { fix::mend(scene, &args.read, console) } else { Ok(()) };
        match mended.and_then(|()| check(args, scene, console)) {
            Ok(warnings) => console.note(&summary(scene, warnings)),
            Err(failure) => {
                let failed = console.fail(&failure);
                code = if code == 0 { failed } else { code };
            }
        }
    }
    code
}

/// Shows a scene's warnings and says how many there are.
fn check(args: &CheckArgs, scene: &Path, console: &Console) -> Result<usize, Failure> {
    let options = Options { measure_all: true, write_out: true, ..Options::default() };
    let Loaded { shot, outline, sources, warnings, unmet, .. } =
        load::load_with(scene, &args.read, options, [false, true], console)?;
    let findings = pss::check::findings(&shot, &outline);
    console.show(&findings, &sources);
    if !unmet.is_empty() {
        return Err(Failure::new(unmet, sources));
    }
    Ok(warnings + findings.len())
}

fn summary(scene: &Path, warnings: usize) -> String {
    let s = if warnings == 1 { "" } else { "s" };
    match warnings {
        0 => format!("{}: nothing to complain of", scene.display()),
        n => format!("{}: {n} warning{s}", scene.display()),
    }
}
