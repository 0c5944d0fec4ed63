//! The scenes of `tests/goldens`: their texts, the files beside them, and how they are read and compared. The folder is also one
//! that `pss test tests/goldens` runs on.
#![allow(dead_code)]

pub mod cases;
pub mod operators;
pub mod primitives;

use std::fs;
use std::path::{Path, PathBuf};

use pss::diag::Diagnostic;
use pss::golden::{Compared, Goldens};
use pss::lang::{MEMORY, Reading};
use pss::measure::Measuring;
use pss::prepare::{self, Imports, Options, Prepared};
use pss::source::SourceMap;

/// How all are seen.
pub const LIGHT: &str = "\
material red(color: #c04030)
material blue(color: #3060c0)
light(direction: [-1, 2, -3], intensity: 2)
light(color: #8090a0, intensity: 0.5)
render(size: [72, 54], samples: 4, integrator: \"direct\", tone: \"none\")
";

/// A scene of the goldens.
pub struct Golden {
    /// Its file below the folder, without the suffix.
    pub name: String,
    pub text: String,
}

impl Golden {
    pub fn new(name: impl Into<String>, text: String) -> Golden {
        Golden { name: name.into(), text }
    }

    /// The scene's file.
    pub fn path(&self) -> PathBuf {
        folder().join(format!("{}.pss", self.name))
    }

    /// What another text, in the place of its own, comes to, with what it expects and is not.
    pub fn read(&self, text: &str, expects: bool) -> (Prepared, Vec<Diagnostic>) {
        read(text, &self.path(), expects).unwrap_or_else(|e| panic!("{}: {e:#?}\n{text}", self.name))
    }

    /// How a text differs from what lies beside the scene.
    pub fn compare(&self, text: &str) -> Compared {
        let goldens = Goldens::read(&self.path()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(goldens.missing().count(), 0, "{}", self.name);
        goldens.compare(&self.read(text, false).0.shot).unwrap()
    }
}

/// All scenes.
pub fn all() -> Vec<Golden> {
    let mut all = operators::scenes();
    all.extend(primitives::scenes());
    all.extend(cases::scenes());
    all
}

/// Where goldens lie.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens")
}

/// Whether goldens are to be written, not compared.
pub fn blessing() -> bool {
    std::env::var_os("PSS_BLESS").is_some()
}

/// Whether a file is what it should be; written where it is not and goldens are.
pub fn holds(path: &Path, bytes: &[u8]) -> bool {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return true;
    }
    if blessing() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    blessing()
}

/// A text as `pss test` reads it from a file.
fn read(text: &str, path: &Path, expects: bool) -> Result<(Prepared, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut sources = SourceMap::default();
    let file = sources.add(path.display().to_string(), Some(path.to_owned()), text);
    let scene_dir = path.parent().unwrap().to_owned();
    let options = Options { measure_all: true, scene_dir, ..Options::default() };
    let imports = Imports {
        scene_dir: &options.scene_dir,
        allow_read: &[],
        limit: 1 << 20,
        inputs: options.inputs.clone(),
    };
    let (measuring, catalog) = (Measuring::new(&options), prepare::catalog());
    let reading = Reading {
        catalog: &catalog,
        defines: &[],
        files: Some(&imports),
        geometry: Some(&measuring),
        expects,
        memory: MEMORY,
    };
    let read = pss::lang::read_with(&mut sources, file, &reading)?;
    Ok((prepare::prepare(&read.scene, &options)?, read.unmet))
}
