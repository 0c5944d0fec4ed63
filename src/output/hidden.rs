//! Hidden files beside outputs: what a run writes to until the whole has its name, and what killed runs left there.
//!
//! `.NAME.PID.tmp` is locked by the run that writes it, so one that nobody holds is of a run that is dead. Where the
//! system has no such locks (they are asked for on Unix alone) nothing is taken for dead.

use std::fs::File;
use std::io;
use std::path::Path;

use tempfile::NamedTempFile;

/// A run has a file an output, and numbers those it has beside; a pid is another's too where processes are walled off.
const MOST: u32 = 10_000;

/// What all hidden files of an output begin with. Names have a limit of 255 bytes; the first letters are enough to recognise one.
fn stem(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    format!(".{name}").chars().take(40).collect::<String>() + "."
}

pub fn folder(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A new one beside `target`, open to whom the user's mask lets in.
pub fn create(target: &Path) -> io::Result<NamedTempFile> {
    let (stem, pid) = (stem(target), std::process::id());
    for n in 0..MOST {
        let prefix = if n == 0 { format!("{stem}{pid}") } else { format!("{stem}{pid}.{n}") };
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).rand_bytes(0).suffix(".tmp");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        match builder.tempfile_in(folder(target)) {
            Ok(file) if is_held(&file) => return Ok(file),
            // Another run found it before it was locked.
            Ok(_) => {}
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            Err(e) => return Err(io::Error::new(e.kind(), bare(&e))),
        }
    }
    Err(io::Error::other("its folder is full of hidden files of killed runs"))
}

/// Locks a new file; whether it is there still, and nobody was faster.
#[cfg(unix)]
fn is_held(file: &NamedTempFile) -> bool {
    use std::fs::TryLockError::WouldBlock;
    !matches!(file.as_file().try_lock(), Err(WouldBlock)) && super::is_at(file.as_file(), file.path())
}

#[cfg(not(unix))]
fn is_held(_: &NamedTempFile) -> bool {
    true
}

/// Removes what killed runs left of an output.
#[cfg(unix)]
pub fn sweep(target: &Path) {
    let Ok(entries) = std::fs::read_dir(folder(target)) else { return };
    let stem = stem(target);
    for entry in entries.flatten() {
        let name = entry.file_name();
        // Opening anything but a file may wait for ever.
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && name.to_str().is_some_and(|name| is_hidden(name, &stem)) {
            remove_dead(&entry.path());
        }
    }
}

#[cfg(not(unix))]
pub fn sweep(_: &Path) {}

#[cfg(unix)]
fn remove_dead(path: &Path) {
    let Ok(file) = File::open(path) else { return };
    // While it is locked here, nobody else takes it for theirs.
    if file.try_lock().is_ok() && super::is_at(&file, path) {
        // What is not removed is only litter.
        let _ = std::fs::remove_file(path);
    }
}

/// Whether a name is the stem, a pid, perhaps a number, and the suffix.
fn is_hidden(name: &str, stem: &str) -> bool {
    let numbers = name.strip_prefix(stem).and_then(|rest| rest.strip_suffix(".tmp"));
    numbers.is_some_and(|n| n.split('.').all(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit())))
}

/// The system's reason without the hidden name, which would only puzzle.
fn bare(e: &io::Error) -> String {
    match e.kind() {
        io::ErrorKind::NotFound => "the folder does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "the folder cannot be written to".to_owned(),
        io::ErrorKind::NotADirectory => "its folder is not a folder".to_owned(),
        _ => e.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_a_dead_run_left_goes_and_what_is_held_stays() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("p.exr");
        let held = [create(&target).unwrap(), create(&target).unwrap()];
        let others = [".p.exr.12a.tmp", ".p.exr.tmp", ".q.exr.12.tmp", "p.exr.12.tmp"];
        for name in [".p.exr.12.tmp", ".p.exr.12.3.tmp"].iter().chain(&others) {
            std::fs::write(folder.path().join(name), "left").unwrap();
        }
        sweep(&target);
        let pid = std::process::id();
        assert_eq!(held[0].path(), folder.path().join(format!(".p.exr.{pid}.tmp")));
        assert!(held.iter().all(|file| file.path().exists()));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), held.len() + others.len());
    }
}
