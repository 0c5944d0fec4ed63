//! Reports of tests in the form that test servers read.

use std::fmt::Write;
use std::path::{Path, PathBuf};

/// What became of a scene.
#[derive(Debug)]
pub struct Outcome {
    /// Its file.
    pub scene: PathBuf,
    /// How long it took.
    pub seconds: f64,
    /// What to say where it failed.
    pub failure: Option<String>,
}

/// A JUnit report of all scenes of a folder.
pub fn report(folder: &Path, outcomes: &[Outcome]) -> String {
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
