//! `pss test`: the `expect` items of a folder's scenes, and whether each can be prepared.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use pss::diag::{Diagnostic, Fault};
use pss::output::write_whole;
use pss::prepare::Options;
use pss::report;

use crate::args::TestArgs;
use crate::console::{Console, Failure};
use crate::load;

/// What became of a scene.
struct Outcome {
    scene: PathBuf,
    seconds: f64,
    /// What to say where it failed.
    failure: Option<String>,
}

/// Runs all scenes; 0 where all hold, 1 where an expectation does not, else the code of the first that cannot be read.
pub fn run(args: &TestArgs, console: &Console) -> Result<u8, Failure> {
    let scenes = scenes(&args.folder)?;
    let (mut code, mut outcomes) = (0, Vec::new());
    for scene in scenes {
        let start = Instant::now();
        let options = Options { measure_all: true, ..Options::default() };
        let asks = load::Asks { quiet: true, expects: true, idle: false };
        let done = load::load_with(&scene, &args.read, options, asks, console);
        let done = done.and_then(|loaded| match loaded.unmet.is_empty() {
            true => Ok(()),
            false => Err(Failure::new(loaded.unmet, loaded.sources)),
        });
        let failure = done.err().map(|failure| {
            let failed = console.fail(&failure);
            code = if code == 0 { failed } else { code };
            report::text(&failure.diagnostics, &failure.sources, false)
        });
        let seconds = start.elapsed().as_secs_f64();
        let told = if failure.is_some() { "FAILED" } else { "ok" };
        console.note(&format!("{}: {told}", scene.display()));
        outcomes.push(Outcome { scene, seconds, failure });
    }
    let failed = outcomes.iter().filter(|o| o.failure.is_some()).count();
    console.note(&format!("{} scenes, {failed} failed", outcomes.len()));
    if let Some(path) = &args.junit {
        write_whole(path, |out| out.write_all(junit(&args.folder, &outcomes).as_bytes()))?;
    }
    Ok(code)
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

/// A report in the form that test servers read.
fn junit(folder: &Path, outcomes: &[Outcome]) -> String {
    let failed = outcomes.iter().filter(|o| o.failure.is_some()).count();
    let total: f64 = outcomes.iter().map(|o| o.seconds).sum();
    let suite = escaped(&folder.display().to_string());
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        out,
        "<testsuite name=\"{suite}\" tests=\"{}\" failures=\"{failed}\" errors=\"0\" time=\"{total:.3}\">",
        outcomes.len()
    );
    for Outcome { scene, seconds, failure } in outcomes {
        let name = escaped(&scene.display().to_string());
        let _ = write!(out, "  <testcase classname=\"{suite}\" name=\"{name}\" time=\"{seconds:.3}\"");
        let _ = match failure {
            None => writeln!(out, "/>"),
            Some(text) => {
                let first = escaped(text.lines().next().unwrap_or_default());
                writeln!(
                    out,
                    ">\n    <failure message=\"{first}\">{}</failure>\n  </testcase>",
                    escaped(text)
                )
            }
        };
    }
    out.push_str("</testsuite>\n");
    out
}

/// Text within XML.
fn escaped(text: &str) -> String {
    let keep = |c: char| match c {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        c if c.is_control() && c != '\n' && c != '\t' => "?".to_owned(),
        c => c.to_string(),
    };
    text.chars().map(keep).collect()
}
