//! The PLY reader (and, in [`write()`], a small writer): ASCII and binary of both byte orders, any element, any property, streamed so that memory
//! stays near that of the result. An own reader, since a stray `nan` row must be dropped, not end the file,
//! and no count of a header may be believed before it is compared with the length of the file.

mod columns;
mod faces;
mod header;
mod input;
mod vertices;
mod write;

use std::io::{BufRead, BufReader};
use std::path::Path;

pub use write::{Encoding, write};

use super::{Cloud, CloudError, check_extent, open};
pub use faces::{Faces, read as read_faces};

/// What becomes of a file that ends before its last point.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Cut {
    /// It is refused.
    #[default]
    Refused,
    /// Its whole rows are kept, and that is noted.
    Kept,
}

/// Reads a whole PLY file; see [`read_path_as`].
pub fn read_path(path: &Path) -> Result<Cloud, CloudError> {
    read_path_as(path, Cut::Refused)
}

/// Reads a PLY file. Only regular files: a pipe or a device could hold up the program for ever.
pub fn read_path_as(path: &Path, cut: Cut) -> Result<Cloud, CloudError> {
    let (file, length) = open(path, "name a PLY file")?;
    read_from(BufReader::with_capacity(1 << 16, file), length, cut)
}

/// Reads a whole PLY file that is in memory.
pub fn read(bytes: &[u8]) -> Result<Cloud, CloudError> {
    read_from(bytes, bytes.len() as u64, Cut::Refused)
}

/// Reads a PLY file of `length` bytes from a stream.
pub fn read_from(stream: impl BufRead, length: u64, cut: Cut) -> Result<Cloud, CloudError> {
    let mut input = input::Input::new(stream, length);
    let header = header::read(&mut input)?;
    let cloud = vertices::read(&mut input, &header, cut)?;
    check_extent(&cloud.points)?;
    Ok(cloud)
}
