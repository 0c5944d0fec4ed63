//! The safe writer: a temporary file in the same folder, flushed and synced, then renamed over the old one.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::OutputError;

/// Where an encoder writes to.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Writes a file so that its name leads to the old content or to the whole new one, never to a part. On any
/// failure the temporary file is removed.
pub fn write_whole(
    path: &Path,
    encode: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> Result<(), OutputError> {
    let target = follow(path);
    let create = |e: io::Error| OutputError::Create { path: path.to_owned(), why: e.to_string() };
    let failed = |source: io::Error| OutputError::Write { path: path.to_owned(), source };
    let mut file = temporary(&target).map_err(create)?;
    let mut buffered = BufWriter::new(file.as_file_mut());
    encode(&mut buffered).map_err(failed)?;
    // Dropping a buffer hides the errors of its last write.
    buffered.flush().map_err(failed)?;
    drop(buffered);
    file.as_file().sync_all().map_err(failed)?;
    file.persist(&target).map_err(|e| failed(e.error))?;
    // The file is whole and in place; a folder that cannot be synced only risks its old content after a crash.
    let _ = File::open(folder(&target)).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Whether a file can be made beside this one: makes one and removes it.
pub fn try_folder(path: &Path) -> io::Result<()> {
    temporary(&follow(path)).map(drop)
}

/// The file a link leads to: the link itself stays.
fn follow(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A new hidden file beside `path`, open to whom the user's mask lets in.
fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // Names have a limit of 255 bytes; the first letters are enough to recognise a file left by a crash.
    let prefix: String = format!(".{name}").chars().take(40).collect::<String>() + ".";
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder(path)).map_err(|e| io::Error::new(e.kind(), bare(&e)))
}

/// The system's reason without the temporary name, which would only puzzle.
fn bare(e: &io::Error) -> String {
    match e.kind() {
        io::ErrorKind::NotFound => "the folder does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "the folder cannot be written to".to_owned(),
        io::ErrorKind::NotADirectory => "its folder is not a folder".to_owned(),
        _ => e.to_string(),
    }
}
