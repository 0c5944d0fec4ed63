//! `pss fmt`: scene files in the house style.

use std::path::Path;

use pss::output::write_whole;

use crate::args::FmtArgs;
use crate::console::{Console, Failure, print};
use crate::load;

/// Formats all files; the exit code is 1 where `--check` found one that would change, else that of the first that failed.
pub fn run(args: &FmtArgs, console: &Console) -> Result<u8, Failure> {
    let mut code = 0;
    for scene in &args.scenes {
        let done = match one(scene, args.check, console) {
            Ok(changes) => u8::from(changes && args.check),
            Err(failure) => console.fail(&failure),
        };
        code = if code == 0 { done } else { code };
    }
    Ok(code)
}

/// Whether a file was not in the style.
fn one(scene: &Path, check: bool, console: &Console) -> Result<bool, Failure> {
    let (sources, file) = load::source(scene)?;
    let formatted = match pss::lang::formatted(&sources, file) {
        Ok(formatted) => formatted,
        Err(errors) => return Err(Failure::new(errors, sources)),
    };
    let changes = formatted != sources.file(file).text;
    if check {
        if changes {
            console.note(&format!("{}: not in the house style", scene.display()));
        }
    } else if load::is_stdin(scene) {
        print(formatted.as_bytes())?;
    } else if changes {
        write_whole(scene, |out| out.write_all(formatted.as_bytes()))?;
        console.note(&format!("{}: formatted", scene.display()));
    }
    Ok(changes)
}
