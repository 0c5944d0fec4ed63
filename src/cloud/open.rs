//! Opening the files that scenes name.

use std::fs::{File, Metadata};
use std::path::Path;

use super::CloudError;

/// Opens a file for reading, with its length in bytes. Only regular files: a pipe or a device could hold up the program
/// for ever. `help` says what to name instead.
pub fn open(path: &Path, help: &str) -> Result<(File, u64), CloudError> {
    let missing = |e: std::io::Error| CloudError::missing(format!("cannot open: {e}"));
    regular(&std::fs::metadata(path).map_err(missing)?, help)?;
    let file = File::open(path).map_err(missing)?;
    // Asked again of what was opened: the name may have changed hands.
    let metadata = file.metadata()?;
    regular(&metadata, help)?;
    Ok((file, metadata.len()))
}

fn regular(metadata: &Metadata, help: &str) -> Result<(), CloudError> {
    if metadata.is_file() {
        return Ok(());
    }
    let what = if metadata.is_dir() { "a directory" } else { "no regular file" };
    Err(CloudError::missing(format!("this is {what}")).help(help))
}
