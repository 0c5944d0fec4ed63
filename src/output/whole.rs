//! The safe writer: a temporary file in the same folder, flushed and synced, looked at again, then renamed over the old one.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::{OutputError, hidden};

/// Where an encoder writes to.
pub trait Sink: Write + Seek + Send {}

impl<T: Write + Seek + Send> Sink for T {}

/// Writes a file so that its name leads to the old content or to the whole new one, never to a part. On any
/// failure the temporary file is removed.
pub fn write_whole(
    path: &Path,
    encode: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> Result<(), OutputError> {
    let mut draft = Draft::begin(path)?;
    let failed = |source: io::Error| OutputError::Write { path: path.to_owned(), source };
    let mut buffered = BufWriter::new(draft.file.as_file_mut());
    encode(&mut buffered).map_err(failed)?;
    // Dropping a buffer hides the errors of its last write.
    buffered.flush().map_err(failed)?;
    drop(buffered);
    draft.keep(Old::Replaced, |_| Ok(()))
}

/// What becomes of a file that has the name already.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Old {
    /// The new one takes its place.
    Replaced,
    /// It stays, and the new one fails.
    Kept,
}

/// A file that has no name of its own yet; it is removed unless it is kept.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    target: PathBuf,
    file: NamedTempFile,
}

impl Draft {
    /// Makes an empty one beside the file that it will be.
    pub fn begin(path: &Path) -> Result<Draft, OutputError> {
        let target = follow(path);
        let file = hidden::create(&target)
            .map_err(|e| OutputError::Create { path: path.to_owned(), why: e.to_string() })?;
        hidden::sweep(&target);
        Ok(Draft { path: path.to_owned(), target, file })
    }

    /// The file it will be, as it was asked for.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file it is for now.
    pub fn temporary(&self) -> &Path {
        self.file.path()
    }

    /// Another handle to write with.
    pub fn handle(&self) -> io::Result<File> {
        self.file.as_file().try_clone()
    }

    /// It shall be another file of the same folder.
    pub fn rename(&mut self, path: &Path) {
        self.path = path.to_owned();
        self.target.set_file_name(path.file_name().unwrap_or_default());
    }

    /// Gives it its name, once all is on the disk and `look`, which gets a fresh handle, finds nothing wrong.
    pub fn keep(self, old: Old, look: impl FnOnce(File) -> io::Result<()>) -> Result<(), OutputError> {
        let Draft { path, target, file } = self;
        let failed = |source: io::Error| OutputError::Write { path: path.clone(), source };
        file.as_file().sync_all().map_err(failed)?;
        file.reopen().and_then(look).map_err(failed)?;
        match old {
            Old::Replaced => file.persist(&target).map_err(|e| failed(e.error))?,
            Old::Kept => file.persist_noclobber(&target).map_err(|e| match e.error.kind() {
                io::ErrorKind::AlreadyExists => super::exists(&path),
                _ => failed(e.error),
            })?,
        };
        // The file is whole and in place; a folder that cannot be synced only risks its old content after a crash.
        let _ = File::open(hidden::folder(&target)).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// Whether a file can be made beside this one: makes one and removes it.
pub fn try_folder(path: &Path) -> io::Result<()> {
    hidden::create(&follow(path)).map(drop)
}

/// Links after one another that are followed; systems take forty at most.
const MOST_LINKS: usize = 40;

/// The file that links lead to, whether it is there or not: the links themselves stay. A link where they lead in a circle.
pub fn follow(path: &Path) -> PathBuf {
    if let Ok(there) = path.canonicalize() {
        return there;
    }
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = std::fs::read_link(&path) else { break };
        path = hidden::folder(&path).join(next);
    }
    path
}
