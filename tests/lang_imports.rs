//! Files that import others: what is missing or broken in one hides nothing in the rest, and is told with the way to it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use pss::diag::{Diagnostic, Fault};
use pss::lang::{Files, Reading};
use pss::source::{SourceMap, Span};

/// Files by name, without a disk.
struct Texts(HashMap<&'static str, &'static str>);

impl Files for Texts {
    fn resolve(&self, written: &str, folder: &Path, _: Span) -> Result<PathBuf, Diagnostic> {
        Ok(folder.join(written))
    }

    fn read(&self, path: &Path, at: Span) -> Result<String, Diagnostic> {
        let text = path.to_str().and_then(|name| self.0.get(name)).map(|text| (*text).to_owned());
        text.ok_or_else(|| Diagnostic::error("E0601", "no such file").at(at, "").fault(Fault::Missing))
    }
}

/// What is told of a scene that imports some files.
fn told(text: &str, files: &[(&'static str, &'static str)]) -> String {
    let mut sources = SourceMap::default();
    let file = sources.add("m.pss", Some("m.pss".into()), text);
    let texts = Texts(files.iter().copied().collect());
    let catalog = pss::prepare::catalog();
    let reading = Reading {
        catalog: &catalog,
        defines: &[],
        files: Some(&texts),
        geometry: None,
        expects: true,
        memory: pss::lang::MEMORY,
    };
    let all = match pss::lang::read_with(&mut sources, file, &reading) {
        Ok(read) => read.warnings.into_iter().chain(read.unmet).collect(),
        Err(errors) => errors,
    };
    pss::report::text(&all, &sources, false)
}

#[test]
fn an_error_in_an_imported_file_is_told_with_the_imports_that_lead_there() {
    let files = [("x/mid.pss", "import \"bad.pss\""), ("x/bad.pss", "let a = 3\nlet b = sphere(rr: 1)")];
    let said = told("import \"x/mid.pss\"", &files);
    assert!(said.contains(" --> x/bad.pss:2:16"), "{said}");
    assert!(said.contains("`x/bad.pss` is imported at x/mid.pss:1:8"), "{said}");
    assert!(said.contains("`x/mid.pss` is imported at m.pss:1:8"), "{said}");
    let said = told("import \"x/bad.pss\"", &[("x/bad.pss", "let a = (1")]);
    assert!(said.contains("`x/bad.pss` is imported at m.pss:1:8"), "{said}");
    assert!(!told("let a = (1", &[]).contains("imported"));
}

#[test]
fn a_missing_file_hides_no_other_mistake() {
    let said =
        told("import \"a.pss\"\nimport \"b.pss\" as b\nlet c = b.x\ndraw sphere(rr: 1)\nlet d = (1", &[]);
    assert_eq!(said.matches("no such file").count(), 2, "{said}");
    assert!(said.contains("no argument `rr`") && said.contains("E0102"), "{said}");
    assert_eq!(said.matches("error").count(), 4, "{said}");
    // What is unknown may stand in the file that is missing: nothing is said of it.
    assert!(!told("import \"a.pss\"\nlet c = zz", &[]).contains("zz` is not known"));
    assert!(told("import \"a.pss\" as a\nlet c = zz", &[]).contains("`zz` is not known"));
}

#[test]
fn a_broken_import_of_a_file_hides_none_of_its_mistakes() {
    let said = told("import x\nlet a = 3deg + 1", &[]);
    assert!(said.contains("stands in quotes") && said.contains("E0203"), "{said}");
}

#[test]
fn a_file_that_imports_itself_is_told_once() {
    let said = told("import \"a.pss\"", &[("a.pss", "import \"m.pss\"\nlet a = zz")]);
    assert_eq!(said.matches("error").count(), 1, "{said}");
}
