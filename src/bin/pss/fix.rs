//! `pss check --fix`: mistakes that have an edit, mended in the file.

use std::path::Path;

use pss::diag::{self, Diagnostic, Fault};
use pss::output::write_whole;
use pss::prepare::Options;
use pss::source::FileId;

use crate::args::ReadArgs;
use crate::console::{Console, Failure};
use crate::load;

/// A mistake may hide others: so often is a scene read again at most.
const ROUNDS: usize = 100;

/// Puts the edits of a scene's errors into its file until it has none that has an edit. Files that it imports are left
/// alone. What cannot be mended is left for the check to tell.
pub fn mend(scene: &Path, args: &ReadArgs, console: &Console) -> Result<(), Failure> {
    if load::is_stdin(scene) {
        let message = "`--fix` wants a file, not standard input";
        return Err(Failure::from(Diagnostic::error("E0001", message).fault(Fault::Usage)));
    }
    let mut edits = 0;
    for _ in 0..ROUNDS {
        let read = load::understand(scene, args, Options::default(), [true, false], &Console::silent());
        let Err(failure) = read else { break };
        // The scene's own text is the first.
        let Some(file) = failure.sources.files().next() else { break };
        let (text, count) = diag::mended(&file.text, FileId::default(), &failure.diagnostics);
        if count == 0 || text == file.text {
            break;
        }
        write_whole(scene, |out| out.write_all(text.as_bytes()))?;
        edits += count;
    }
    if 0 < edits {
        let s = if edits == 1 { "" } else { "s" };
        console.note(&format!("{}: {edits} edit{s} made", scene.display()));
    }
    Ok(())
}
