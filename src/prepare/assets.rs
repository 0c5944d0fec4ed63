//! Meshes and height fields from the files that calls name.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use super::build::{Builder, Built, file_complaint};
use crate::cloud::CloudError;
use crate::diag::Diagnostic;
use crate::heights;
use crate::mesh::{self, Seams};
use crate::scene::{Call, Value};
use crate::shot::Environment;
use crate::sky;
use crate::solid::heightfield;
use crate::solid::mesh::TriangleMesh;

impl Builder<'_> {
    /// What `read` makes of the file that a call names as `name`; `usual` is the way out of most errors.
    fn read<T>(
        &mut self,
        call: &Call,
        name: &str,
        usual: &str,
        read: impl FnOnce(&Path) -> Result<(T, Vec<String>), CloudError>,
    ) -> Result<T, Diagnostic> {
        let Some(Value::Path { text, base, from_command_line }) = call.get(name) else {
            return Err(Diagnostic::error("E0900", "this call names no file").at(call.at, ""));
        };
        let at = call.place(name);
        let path = self.input(text, base, *from_command_line, at)?;
        let begin = Instant::now();
        let (made, notes) = read(&path).map_err(|e| file_complaint(at, &format!("`{text}`"), e, usual))?;
        self.loading += begin.elapsed();
        self.noted(text, &notes, at);
        Ok(made)
    }

    /// The mesh that a call names.
    pub fn mesh(&mut self, call: &Call) -> Result<Built, Diagnostic> {
        let usual = "a mesh is a PLY, OBJ or STL file with triangles or polygons";
        let solid = self.read(call, "file", usual, |path| {
            let mut mesh = mesh::read_path(path)?;
            let mut notes = std::mem::take(&mut mesh.notes);
            let solid = TriangleMesh::new(mesh);
            let Seams { open, unlike, .. } = solid.seams();
            if open == 0 && 0 < unlike {
                notes.push(format!(
                    "faces disagree at {unlike} edges about which side is out; crossings were counted"
                ));
            }
            Ok((solid, notes))
        })?;
        Ok(Built::Exact(Arc::new(solid)))
    }

    /// The height field that a call names.
    pub fn heights(&mut self, call: &Call) -> Result<Built, Diagnostic> {
        let usual = "heights are a PNG or EXR image of at least 2 x 2 pixels";
        let heights = self.read(call, "file", usual, |path| {
            let mut heights = heights::read_path(path)?;
            let notes = std::mem::take(&mut heights.notes);
            Ok((heights, notes))
        })?;
        Ok(Built::Exact(heightfield::build(call, heights)))
    }

    /// The picture of a sky that a light names; `None` where it names none, or it is black.
    pub fn environment(&mut self, call: &Call) -> Result<Option<Arc<Environment>>, Diagnostic> {
        if call.get("image").is_none() {
            return Ok(None);
        }
        let usual = "a sky is an EXR, HDR or PNG image, twice as wide as high";
        let map = self.read(call, "image", usual, |path| {
            let sky = sky::read_path(path)?;
            Ok((Environment::new(sky.size, sky.pixels), sky.notes))
        })?;
        Ok(map.map(Arc::new))
    }
}
