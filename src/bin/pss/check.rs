//! `pss check`: what is wrong, or may be, with scenes; renders nothing.

use std::path::Path;

use pss::diag::{Diagnostic, Severity};
use pss::prepare::Options;
use pss::source::FileId;

use crate::args::CheckArgs;
use crate::console::{Console, Failure};
use crate::fix;
use crate::load::{self, Asks, Loaded};

/// Runs the command on all scenes; the exit code is that of the first that failed.
pub fn run(args: &CheckArgs, console: &Console) -> u8 {
    let mut code = 0;
    for scene in &args.scenes {
        let mended = if args.fix { fix::mend(scene, &args.read, console) } else { Ok(()) };
        match mended.and_then(|()| check(args, scene, console)) {
            Ok(told) => console.note(&summary(scene, told)),
            Err(failure) => {
                let failed = console.fail(&failure);
                code = if code == 0 { failed } else { code };
            }
        }
    }
    code
}

/// Shows what is to be said of a scene; gives how many warnings and how many notes there are.
fn check(args: &CheckArgs, scene: &Path, console: &Console) -> Result<[usize; 2], Failure> {
    let options = Options { ghosts: true, measure_all: true, write_out: true, ..Options::default() };
    let asks = Asks { quiet: false, expects: true, idle: true };
    let Loaded { shot, outline, sources, warnings, unmet, idle, draws, .. } =
        load::load_with(scene, &args.read, options, asks, console)?;
    let mut findings = pss::check::findings(&shot, &outline);
    // The scene is made without what it does not draw: no error, but to be known.
    findings.extend(idle.into_iter().map(|error| Diagnostic { severity: Severity::Warning, ..error }));
    // A file of names alone is there to be imported.
    if draws == 0 && pss::lang::items(&sources, FileId::default()).is_ok_and(|items| items.is_empty()) {
        let warning = Diagnostic::warning("W0203", "the scene is empty: nothing is drawn");
        findings.push(warning.help("draw something: `draw sphere(r: 1)`"));
    }
    console.show(&findings, &sources);
    if !unmet.is_empty() {
        return Err(Failure::new(unmet, sources));
    }
    let notes = findings.iter().filter(|finding| finding.severity == Severity::Remark).count();
    Ok([warnings + findings.len() - notes, notes])
}

fn summary(scene: &Path, [warnings, notes]: [usize; 2]) -> String {
    let many = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    let told = match (warnings, notes) {
        (0, 0) => "nothing to complain of".to_owned(),
        (0, n) => format!("nothing to complain of, {}", many(n, "note")),
        (n, 0) => many(n, "warning"),
        (n, notes) => format!("{}, {}", many(n, "warning"), many(notes, "note")),
    };
    format!("{}: {told}", scene.display())
}
