//! Triangle meshes from files: PLY, OBJ and STL, told apart by what they begin with. Equal corners are made one,
//! polygons are cut into triangles, and what carries no area is dropped and counted. Rays are left to
//! [`crate::solid::mesh`].

mod obj;
mod stl;
mod weld;

use std::io::{BufReader, Read};
use std::path::Path;

use glam::DVec3;

use crate::cloud::{CloudError, open, ply};

pub use weld::Seams;

/// More bytes of an OBJ or STL file are refused: they are read whole.
const MOST_BYTES: u64 = 4 << 30;

/// A mesh of triangles, in the units of its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners; finite, no two equal.
    pub points: Vec<DVec3>,
    /// Three different corners each, no three the same as another's.
    pub triangles: Vec<[u32; 3]>,
    /// What was dropped or mended on the way, one sentence each.
    pub notes: Vec<String>,
}

/// Polygons as a file gives them.
#[derive(Clone, Debug, Default)]
struct Soup {
    points: Vec<DVec3>,
    /// Corners of triangles.
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// Adds a polygon as a fan about its first corner.
    fn polygon(&mut self, corners: &[u32]) {
        for pair in corners.windows(2).skip(1) {
            self.triangles.push([corners[0], pair[0], pair[1]]);
        }
    }
}

/// Reads a mesh file.
///
/// Fails where it is missing, of no known format, malformed, or has no triangle with an area.
pub fn read_path(path: &Path) -> Result<Mesh, CloudError> {
    let (file, length) = open(path, "name a PLY, OBJ or STL file")?;
    let mut input = BufReader::with_capacity(1 << 16, file);
    let mut head = Vec::new();
    input.by_ref().take(4).read_to_end(&mut head)?;
    if is_ply(&head) {
        return weld::mesh(of_ply(head.chain(input), length)?);
    }
    if MOST_BYTES < length {
        let message = format!("the file has {length} bytes, more than the limit of {MOST_BYTES}");
        return Err(CloudError::bad(message).help("convert it to binary PLY, or simplify the mesh"));
    }
    let mut bytes = head;
    input.take(MOST_BYTES).read_to_end(&mut bytes)?;
    read(&bytes)
}

/// Reads a whole mesh file that is in memory.
pub fn read(bytes: &[u8]) -> Result<Mesh, CloudError> {
    if bytes.is_empty() {
        return Err(CloudError::bad("no mesh: the file is empty"));
    }
    let soup = if is_ply(bytes) {
        of_ply(bytes, bytes.len() as u64)?
    } else if stl::is_binary(bytes) || stl::is_text(bytes) {
        stl::read(bytes)?
    } else {
        obj::read(bytes)?
    };
    weld::mesh(soup)
}

fn is_ply(head: &[u8]) -> bool {
    head.starts_with(b"ply") && head.get(3).is_none_or(u8::is_ascii_whitespace)
}

fn of_ply(stream: impl std::io::BufRead, length: u64) -> Result<Soup, CloudError> {
    let faces = ply::read_faces(stream, length)?;
    let mut soup = Soup { points: faces.points, triangles: Vec::new() };
    let mut rest = faces.corners.as_slice();
    for size in faces.sizes {
        let (polygon, after) = rest.split_at(size as usize);
        soup.polygon(polygon);
        rest = after;
    }
    Ok(soup)
}
