//! A film to files. A file appears under its name only when it is whole; whatever goes wrong before, an old
//! file of that name stays as it was.

mod exr;
mod growing;
mod hidden;
mod png;
mod rows;
pub mod state;
pub mod tone;
mod whole;

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

pub use self::exr::{Channel, Channels, ExrRows, exr_size, read_channels, read_exr, write_exr};
pub use self::png::{Pixels, PngRows, png_note, read_png, write_png, write_rgb, write_rgb_noted};
pub use growing::{Growing, partial, remove_partial};
pub use rows::{Encode, Picture, about, settings_line};
pub use whole::{Old, Sink, write_whole};

use crate::film::Film;
use crate::shot::Settings;

/// Kinds of file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// 8-bit sRGB, exposed and toned: to look at.
    Png,
    /// Linear floats with all layers: to work on.
    Exr,
}

impl Format {
    /// The format that a file's suffix names, in small or capital letters.
    pub fn of(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(Format::Png),
            "exr" => Some(Format::Exr),
            _ => None,
        }
    }
}

/// Why a file was not written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// Its suffix names no format.
    #[error("`{}` does not end in .png or .exr", path.display())]
    Suffix {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be created.
    #[error("cannot create `{}`: {why}", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// The reason.
        why: String,
    },
    /// Writing failed on the way.
    #[error("cannot write `{}`: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

/// Makes sure, before any work, that a file can be made here and is none of the inputs.
pub fn check(path: &Path, inputs: &[PathBuf]) -> Result<(), OutputError> {
    let refused = |why: String| OutputError::Create { path: path.to_owned(), why };
    if let Some(input) = inputs.iter().find(|input| same_file(input, path)) {
        return Err(refused(format!("it is the input `{}`", input.display())));
    }
    if path.file_name().is_none() {
        return Err(refused("it names no file".to_owned()));
    }
    match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => return Err(refused("it is a folder".to_owned())),
        Ok(meta) if !meta.is_file() => return Err(refused("it is not a regular file".to_owned())),
        _ => {}
    }
    if whole::follow(path).is_symlink() {
        return Err(refused("its links lead in a circle".to_owned()));
    }
    whole::try_folder(path).map_err(|e| refused(e.to_string()))
}

/// Writes a film in the format that the suffix names.
pub fn write(film: &Film, settings: &Settings, path: &Path) -> Result<(), OutputError> {
    let aovs = film.layers.iter().map(|layer| layer.aov).collect();
    let mut file = Growing::begin(path, &Picture { size: film.size, aovs, ..Picture::new(settings) })?;
    file.rows(film)?;
    file.finish(Old::Replaced)
}

/// Makes sure that no file has this name.
pub fn check_free(path: &Path) -> Result<(), OutputError> {
    // A link that leads nowhere has the name, too.
    if path.symlink_metadata().is_ok() { Err(exists(path)) } else { Ok(()) }
}

fn exists(path: &Path) -> OutputError {
    OutputError::Create { path: path.to_owned(), why: "it exists, and `--no-clobber` keeps it".to_owned() }
}

/// Whether what was told of two files is of one.
#[cfg(unix)]
fn is_one(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Whether a file is the one that a name leads to.
fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    if let (Ok(a), Ok(b)) = (file.metadata(), fs::metadata(path)) {
        return is_one(&a, &b);
    }
    cfg!(not(unix)) && file.metadata().is_ok() && path.exists()
}

/// Whether two names lead to one file.
fn same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    if let (Ok(a), Ok(b)) = (fs::metadata(a), fs::metadata(b)) {
        return is_one(&a, &b);
    }
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}
