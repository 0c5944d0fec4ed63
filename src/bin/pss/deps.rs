//! What a picture depends on, as a rule for `make`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A rule that the outputs depend on the inputs, and one without a recipe for each input, so that one that is gone makes the
/// picture again and not an error.
pub fn rule(outputs: &[PathBuf], inputs: &[PathBuf]) -> String {
    let names = |paths: &[PathBuf], between: &str| {
        paths.iter().map(|path| escaped(path)).collect::<Vec<_>>().join(between)
    };
    let mut out = format!("{}: {}\n", names(outputs, " "), names(inputs, " \\\n  "));
    for input in inputs {
        let _ = write!(out, "\n{}:\n", escaped(input));
    }
    out
}

/// A name as makefiles write it. One with a line break cannot be written there; it is given as it is.
fn escaped(path: &Path) -> String {
    let mut out = String::new();
    for c in path.to_string_lossy().chars() {
        match c {
            ' ' | '#' | ':' | '%' => out.extend(['\\', c]),
            '$' => out.push_str("$$"),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped_for_make() {
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let rule = rule(&paths(&["a b.png", "c.exr"]), &paths(&["s#1.pss", "x$.ply"]));
        assert_eq!(rule, "a\\ b.png c.exr: s\\#1.pss \\\n  x$$.ply\n\ns\\#1.pss:\n\nx$$.ply:\n");
    }
}
