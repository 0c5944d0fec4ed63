//! A picture's file that grows while the picture is made, and appears under its name when it is whole.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use super::exr::{ExrRows, exr_size};
use super::png::{PngRows, png_size};
use super::rows::{Encode, Picture};
use super::whole::{Draft, Old, follow};
use super::{Format, OutputError};
use crate::film::Film;

/// A file without its name yet; dropped, it is gone.
pub struct Growing {
    draft: Draft,
    encoder: Box<dyn Encode>,
    format: Format,
    size: [u32; 2],
}

impl Growing {
    /// Begins a file in the format that its suffix names.
    pub fn begin(path: &Path, picture: &Picture) -> Result<Growing, OutputError> {
        let format = Format::of(path).ok_or_else(|| OutputError::Suffix { path: path.to_owned() })?;
        let draft = Draft::begin(path)?;
        let begun = draft.handle().map(BufWriter::new).and_then(|sink| encoder(format, sink, picture));
        let encoder = begun.map_err(|source| OutputError::Write { path: path.to_owned(), source })?;
        Ok(Growing { draft, encoder, format, size: picture.size })
    }

    /// Adds the next rows.
    pub fn rows(&mut self, rows: &Film) -> Result<(), OutputError> {
        self.encoder.rows(rows).map_err(|source| OutputError::Write { path: self.path().to_owned(), source })
    }

    /// The file that it will be.
    pub fn path(&self) -> &Path {
        self.draft.path()
    }

    /// The file that it is for now.
    pub fn temporary(&self) -> &Path {
        self.draft.temporary()
    }

    /// Gives the whole picture its name.
    pub fn finish(self, old: Old) -> Result<(), OutputError> {
        let Growing { draft, encoder, format, size } = self;
        let ended = encoder.finish();
        ended.map_err(|source| OutputError::Write { path: draft.path().to_owned(), source })?;
        draft.keep(old, |file| check(file, format, size))
    }

    /// Gives a picture of which parts are missing another name, and tells it.
    pub fn finish_partial(mut self) -> Result<PathBuf, OutputError> {
        let path = partial(self.path());
        self.draft.rename(&path);
        self.finish(Old::Replaced)?;
        Ok(path)
    }
}

/// The name of a picture that is not whole.
pub fn partial(path: &Path) -> PathBuf {
    let suffix = path.extension().unwrap_or_default().to_string_lossy();
    path.with_extension(format!("partial.{suffix}"))
}

/// Removes what a stopped run left of a picture, now that it is whole. Fails quietly: one that stays is only litter.
pub fn remove_partial(path: &Path) {
    let there = follow(path).with_file_name(partial(path).file_name().unwrap_or_default());
    if there.symlink_metadata().is_ok_and(|meta| meta.is_file()) {
        let _ = std::fs::remove_file(there);
    }
}

fn encoder(format: Format, sink: BufWriter<File>, picture: &Picture) -> io::Result<Box<dyn Encode>> {
    Ok(match format {
        Format::Png => Box::new(PngRows::begin(sink, picture)?),
        Format::Exr => Box::new(ExrRows::begin(sink, picture)?),
    })
}

/// Reads the head back: disks that are full or gone were seen to take writes and keep nothing.
fn check(file: File, format: Format, size: [u32; 2]) -> io::Result<()> {
    let found = match format {
        Format::Png => png_size(file),
        Format::Exr => exr_size(file),
    };
    if found? == size { Ok(()) } else { Err(io::Error::other("what was written does not read back")) }
}
