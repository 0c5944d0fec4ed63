//! `pss render --watch`: the picture again whenever a file changes that it was made from.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, SystemTime};

use notify_debouncer_full::notify::event::{AccessKind, AccessMode};
use notify_debouncer_full::notify::{self, EventKind, RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};
use pss::diag::{Diagnostic, Fault};
use pss::prepare::Inputs;

use crate::args::RenderArgs;
use crate::console::{Console, Failure};
use crate::render;

/// Editors write in several steps: so long must be quiet before a change counts.
const QUIET: Duration = Duration::from_millis(100);

/// Folders that are looked at. Files are not, as editors save by putting another in their place.
struct Watch {
    debouncer: Debouncer<RecommendedWatcher, RecommendedCache>,
    events: Receiver<DebounceEventResult>,
    folders: BTreeSet<PathBuf>,
}

/// Makes the picture, waits for a change, and makes it again, until it is interrupted. What is wrong with a scene is shown, and
/// waited for to be mended; what is wrong with the command line or the output ends it.
pub fn run(args: &RenderArgs, console: &Console) -> Result<(), Failure> {
    let mut watch = Watch::new().map_err(refused)?;
    let mut files = BTreeSet::new();
    loop {
        let (begun, inputs) = (SystemTime::now(), Inputs::default());
        match render::once(args, &inputs, console) {
            Err(failure) if !can_be_mended(&failure) => return Err(failure),
            Err(failure) => {
                console.fail(&failure);
            }
            // What was read last does not matter once a picture is made without it.
            Ok(()) => files.clear(),
        }
        files.extend(names(&args.scene.scene));
        files.extend(inputs.list().iter().flat_map(|path| names(path)));
        watch.look_at(&files).map_err(refused)?;
        if !args.quiet {
            console.note(&format!("waiting for a change of {}", counted(files.len())));
        }
        if !files.iter().any(|file| changed_since(file, begun)) {
            watch.wait(&files).map_err(refused)?;
        }
    }
}

impl Watch {
    fn new() -> notify::Result<Watch> {
        let (send, events) = mpsc::channel();
        let debouncer = new_debouncer(QUIET, None, send)?;
        Ok(Watch { debouncer, events, folders: BTreeSet::new() })
    }

    /// Looks at the folders of these files, and no others. A folder that is not there cannot be looked at; its nearest that is
    /// will tell when it comes.
    fn look_at(&mut self, files: &BTreeSet<PathBuf>) -> notify::Result<()> {
        let there =
            |file: &PathBuf| file.ancestors().skip(1).find(|folder| folder.is_dir()).map(Path::to_owned);
        let folders: BTreeSet<PathBuf> = files.iter().filter_map(there).collect();
        for gone in self.folders.difference(&folders) {
            // One that was removed is not looked at any more.
            let _ = self.debouncer.unwatch(gone);
        }
        for new in folders.difference(&self.folders) {
            self.debouncer.watch(new, RecursiveMode::NonRecursive)?;
        }
        self.folders = folders;
        Ok(())
    }

    /// Returns once one of the files, or a folder on the way to it, changes.
    fn wait(&self, files: &BTreeSet<PathBuf>) -> notify::Result<()> {
        let touches = |path: &PathBuf| files.iter().any(|file| file.starts_with(path));
        for events in &self.events {
            let events = events.map_err(|mut errors| errors.swap_remove(0))?;
            if events.iter().any(|e| e.need_rescan() || changes(&e.kind) && e.paths.iter().any(touches)) {
                return Ok(());
            }
        }
        Ok(())
    }
}

/// Whether an event is more than somebody reading.
fn changes(kind: &EventKind) -> bool {
    !matches!(kind, EventKind::Access(access) if *access != AccessKind::Close(AccessMode::Write))
}

/// A file by its full names: as it is called, and where links lead.
fn names(path: &Path) -> Vec<PathBuf> {
    let absolute = std::path::absolute(path).ok();
    // The folder's links are followed as the system does that tells of changes.
    let called =
        absolute.as_ref().and_then(|path| Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?)));
    [called.or(absolute), path.canonicalize().ok()].into_iter().flatten().collect()
}

/// Whether a file was written after a time, before anybody looked at its folder.
fn changed_since(file: &Path, time: SystemTime) -> bool {
    file.metadata().and_then(|meta| meta.modified()).is_ok_and(|modified| time <= modified)
}

/// Whether a change of a file may help.
fn can_be_mended(failure: &Failure) -> bool {
    let first = failure.diagnostics.iter().find(|d| d.is_error()).map(|d| d.fault);
    matches!(first, Some(Fault::Input | Fault::Missing | Fault::Refused | Fault::Unmet))
}

fn counted(files: usize) -> String {
    format!("{files} file{}", if files == 1 { "" } else { "s" })
}

fn refused(e: notify::Error) -> Failure {
    let message = format!("cannot wait for changes: {e}");
    Failure::from(Diagnostic::error("E0608", message).fault(Fault::Io))
}
