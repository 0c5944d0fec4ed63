//! What both targets read a text with.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use pss::diag::Diagnostic;
use pss::lang::{Files, Geometry, Read, Reading};
use pss::scene::Catalog;
use pss::source::{FileId, SourceMap, Span};

/// Bytes that values may take: the rest of the 256 MiB is the fuzzer's, the parser's and the stack's.
const MEMORY: u64 = 64 << 20;

static CATALOG: LazyLock<Catalog> = LazyLock::new(pss::prepare::catalog);

/// Modules that a text may import: one plain, one that imports it, one that is imported by itself.
struct Modules;

impl Files for Modules {
    fn resolve(&self, written: &str, folder: &Path, at: Span) -> Result<PathBuf, Diagnostic> {
        let path = folder.join(written);
        let known = module(&path).is_some();
        known.then_some(path).ok_or_else(|| Diagnostic::error("E0601", "there is no such file").at(at, ""))
    }

    fn read(&self, path: &Path, at: Span) -> Result<String, Diagnostic> {
        let text = module(path).map(str::to_owned);
        text.ok_or_else(|| Diagnostic::error("E0601", "there is no such file").at(at, ""))
    }
}

fn module(path: &Path) -> Option<&'static str> {
    match path.file_name()?.to_str()? {
        "a.pss" => Some(
            "let size = 3\nfn ball(r = size) = sphere(r: r)\nmaterial clay(color: #b8683c)\nlet list = [1, size]\n",
        ),
        "b.pss" => Some(
            "import \"a.pss\" as a\nlet pair = [a.ball(), a.ball(2)]\nfn twice(f, x) = f(f(x))\nprint a.size\n",
        ),
        "c.pss" => Some("import \"c.pss\"\nlet lost = 1\n"),
        _ => None,
    }
}

/// Text as a scene file; `None` where it is none, as bytes that are not UTF-8 are refused before.
pub fn source(data: &[u8]) -> Option<(SourceMap, FileId)> {
    let text = std::str::from_utf8(data).ok()?;
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", Some("/scenes/scene.pss".into()), text);
    Some((sources, file))
}

/// Reads a scene with all that a scene may use, and says what is to be said, both ways.
pub fn read(sources: &mut SourceMap, file: FileId, geometry: &dyn Geometry) -> Option<Read> {
    let reading = Reading {
        catalog: &CATALOG,
        defines: &[],
        files: Some(&Modules),
        geometry: Some(geometry),
        expects: true,
        memory: MEMORY,
    };
    let read = pss::lang::read_with(sources, file, &reading);
    let told = match &read {
        Ok(read) => [&*read.warnings, &*read.unmet].concat(),
        Err(errors) => {
            assert!(errors.iter().any(Diagnostic::is_error), "refused without an error");
            errors.clone()
        }
    };
    pss::report::text(&told, sources, false);
    told.iter().for_each(|d| drop(pss::report::json_line(d, sources)));
    read.ok()
}
