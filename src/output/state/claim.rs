//! The claim to an output: its state file, locked, so that no two runs make one picture.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::head::{self, Identity, Layout, Part, Reading};
use super::{Found, State};
use crate::output::is_at;
use crate::output::whole::follow;

/// Why an output cannot be claimed, or its state not be resumed.
#[derive(Debug, thiserror::Error)]
pub enum ClaimError {
    /// Another run makes it.
    #[error("another run is making `{}`", path.display())]
    Taken {
        /// The output.
        path: PathBuf,
    },
    /// The state file cannot be made or read.
    #[error("cannot keep `{}`: {source}", path.display())]
    Io {
        /// The state file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// The state is of another picture.
    #[error("`{}` was begun with another picture in mind", path.display())]
    Other {
        /// The output.
        path: PathBuf,
        /// What is not the same.
        parts: Vec<Part>,
    },
}

/// An output that this run makes, and no other. Dropped, it goes without a trace unless something was kept.
#[derive(Debug)]
pub struct Claim {
    output: PathBuf,
    path: PathBuf,
    file: File,
    /// Bytes that an earlier run left.
    left: u64,
}

/// The state file of an output: hidden, beside the file that it leads to.
pub fn state_path(output: &Path) -> PathBuf {
    let target = follow(output);
    let mut name = OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(".pss-state");
    target.with_file_name(name)
}

impl Claim {
    /// Claims an output; what an earlier run left is not touched.
    pub fn new(output: &Path) -> Result<Claim, ClaimError> {
        let path = state_path(output);
        let io = |source: io::Error| ClaimError::Io { path: path.clone(), source };
        loop {
            let open = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
            let file = open.map_err(io)?;
            match file.try_lock() {
                // Where there are no locks, nobody can be kept out.
                Ok(()) | Err(TryLockError::Error(_)) => {}
                Err(TryLockError::WouldBlock) => return Err(ClaimError::Taken { path: output.to_owned() }),
            }
            // Whoever had it may have removed it between the two.
            if is_at(&file, &path) {
                let left = file.metadata().map_err(io)?.len();
                return Ok(Claim { output: output.to_owned(), path, file, left });
            }
        }
    }

    /// Whether an earlier run left something.
    pub fn has_state(&self) -> bool {
        0 < self.left
    }

    /// Begins a state, in place of what an earlier run left.
    pub fn begin(&mut self, identity: &Identity, layout: Layout) -> Result<State, ClaimError> {
        let begun = self.file.try_clone().and_then(|file| State::begin(file, identity, layout));
        self.left = 1;
        begun.map_err(|source| ClaimError::Io { path: self.path.clone(), source })
    }

    /// Goes on with what an earlier run left; `None` where it left nothing that can be read.
    pub fn resume(
        &mut self,
        identity: &Identity,
        layout: Layout,
    ) -> Result<Option<(State, Found)>, ClaimError> {
        let io = |source: io::Error| ClaimError::Io { path: self.path.clone(), source };
        let mut file = self.file.try_clone().map_err(io)?;
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(0)).map_err(io)?;
        (&file).take(head::LENGTH as u64).read_to_end(&mut bytes).map_err(io)?;
        match head::read(&bytes, identity, &layout) {
            Reading::Same => State::resume(file, layout).map(Some).map_err(io),
            Reading::Other(parts) => Err(ClaimError::Other { path: self.output.clone(), parts }),
            Reading::Damaged => Ok(None),
        }
    }

    /// Removes the state: the picture is made.
    pub fn remove(mut self) {
        self.left = 0;
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        if self.left == 0 {
            // One that stays is empty or complete, and harms nobody.
            let _ = fs::remove_file(&self.path);
        }
    }
}
