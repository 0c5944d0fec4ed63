//! Which files a scene may read: those below its own folder and below the folders that the command line allows, and
//! those that the command line names. Everything else is refused before anything is learned about it.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::diag::{Diagnostic, Fault};
use crate::lang::Files;
use crate::source::Span;

/// The path to open for a name written in a scene.
pub(super) fn resolve(
    text: &str,
    base: &Path,
    from_command_line: bool,
    scene_dir: &Path,
    allowed: &[PathBuf],
    at: Span,
) -> Result<PathBuf, Diagnostic> {
    let written = Path::new(text);
    if text.contains('\0') {
        return Err(Diagnostic::error("E0602", "a file name holds no zero byte")
            .at(at, "")
            .help("write the name of a file"));
    }
    if from_command_line {
        return Ok(written.to_owned());
    }
    let path = base.join(written);
    let refused = || {
        Diagnostic::error("E0603", format!("`{text}` lies outside what this scene may read"))
            .at(at, "")
            .help("put the file below the scene's folder, allow its folder with `--allow-read DIR`, or name it with `-D`")
            .fault(Fault::Refused)
    };
    let roots: Vec<PathBuf> = std::iter::once(scene_dir)
        .chain(allowed.iter().map(PathBuf::as_path))
        .filter_map(|root| std::path::absolute(root).ok().map(|r| normal(&r)))
        .collect();
    let absolute = std::path::absolute(&path).map(|p| normal(&p)).map_err(|_| refused())?;
    if !roots.iter().any(|root| absolute.starts_with(root)) {
        return Err(refused());
    }
    // A link may lead out again; what does not exist is reported by whoever opens it.
    if let Ok(real) = absolute.canonicalize() {
        let real_roots = roots.iter().filter_map(|r| r.canonicalize().ok());
        if !real_roots.into_iter().any(|root| real.starts_with(root)) {
            return Err(refused());
        }
    }
    Ok(path)
}

/// The files that a scene asks for, whether they can be read or not; copies share one list.
#[derive(Clone, Debug, Default)]
pub struct Inputs(Arc<Mutex<BTreeSet<PathBuf>>>);

impl Inputs {
    /// Adds one.
    pub fn note(&self, path: &Path) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
    }

    /// All so far, in the order of their names.
    pub fn list(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
}

/// Reads what scenes import, by the same rules.
#[derive(Clone, Debug)]
pub struct Imports<'a> {
    /// The folder of the scene.
    pub scene_dir: &'a Path,
    /// Other folders below which files may be read.
    pub allow_read: &'a [PathBuf],
    /// The longest text, bytes.
    pub limit: u64,
    /// Where the names of what is asked for are left.
    pub inputs: Inputs,
}

impl Files for Imports<'_> {
    fn resolve(&self, written: &str, folder: &Path, at: Span) -> Result<PathBuf, Diagnostic> {
        let path = resolve(written, folder, false, self.scene_dir, self.allow_read, at)?;
        // One file by two names is one file.
        let path = path.canonicalize().map_or(path.clone(), |real| {
            let here = std::env::current_dir().and_then(|here| here.canonicalize()).unwrap_or_default();
            real.strip_prefix(here).map_or(path, Path::to_owned)
        });
        self.inputs.note(&path);
        Ok(path)
    }

    fn read(&self, path: &Path, at: Span) -> Result<String, Diagnostic> {
        let told = |why: &str| {
            Diagnostic::error("E0601", format!("cannot read `{}`: {why}", path.display()))
                .at(at, "imported here")
        };
        let missing = |e: std::io::Error| {
            let none = e.kind() == std::io::ErrorKind::NotFound;
            told(&if none { "there is no such file".to_owned() } else { e.kind().to_string() })
                .help("is the name right? It is relative to the file that imports it")
                .fault(Fault::Missing)
        };
        let meta = std::fs::metadata(path).map_err(missing)?;
        if !meta.is_file() {
            return Err(told("it is not a regular file").help("name a scene file").fault(Fault::Missing));
        }
        if self.limit < meta.len() {
            return Err(told("it is too long").help("keep points in files of their own: `points(\"a.ply\")`"));
        }
        let bytes = std::fs::read(path).map_err(missing)?;
        String::from_utf8(bytes).map_err(|_| told("it is not UTF-8 text").help("name a scene file"))
    }
}

/// Resolves `.` and `..` by name alone, without asking the file system.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                out.pop();
            }
            part => out.push(part),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn try_read(text: &str) -> Result<PathBuf, u8> {
        let dir = Path::new("/scenes/a");
        let allowed = [PathBuf::from("/clouds")];
        let resolved = resolve(text, dir, false, dir, &allowed, Span::default());
        resolved.map_err(|d| d.fault.exit_code())
    }

    #[test]
    fn a_scene_reads_below_its_folder_and_below_allowed_ones_only() {
        assert!(try_read("x.ply").is_ok());
        assert!(try_read("sub/../x.ply").is_ok());
        assert!(try_read("/clouds/b.ply").is_ok());
        for text in
            ["../x.ply", "/etc/passwd", "sub/../../x.ply", "/clouds/../etc/passwd", "/scenes/ab/x.ply"]
        {
            assert_eq!(try_read(text), Err(77), "{text}");
        }
    }

    #[test]
    fn the_command_line_may_name_any_file() {
        let path = resolve("../x.ply", Path::new(""), true, Path::new("/s"), &[], Span::default());
        assert_eq!(path.unwrap(), PathBuf::from("../x.ply"));
    }
}
