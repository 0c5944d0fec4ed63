//! The files of a scene: its own, and those that it and they import, each read once and parsed alone; those that are imported
//! stand before those that import them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::Reading;
use super::ast::{Import, Item, ItemKind};
use super::items::{Salvage, in_order, salvaged};
use crate::diag::Diagnostic;
use crate::source::{FileId, SourceMap, Span};

/// Files of one scene, at most, and imports within imports.
const MAX_FILES: usize = 1000;
const DEEPEST: usize = 64;

/// A file.
pub struct Module {
    /// What stands in it.
    pub items: Vec<Item>,
    /// What its broken items would have defined.
    pub broken: Vec<String>,
    /// The modules that its `import` items name, in their order.
    pub imports: Vec<usize>,
}

impl Module {
    /// Its imports, and the modules they name.
    pub fn imported(&self) -> impl Iterator<Item = (&Import, usize)> {
        imports(&self.items).zip(self.imports.iter().copied())
    }
}

fn imports(items: &[Item]) -> impl Iterator<Item = &Import> {
    items
        .iter()
        .filter_map(|item| if let ItemKind::Import(import) = &item.kind { Some(import) } else { None })
}

/// Reads a file and what it imports; the file itself is the last. Beside them stand the mistakes in the wording of items that
/// were left out; where it is not known what these would have defined, there is nothing but mistakes.
pub fn load(
    sources: &mut SourceMap,
    file: FileId,
    reading: &Reading,
) -> Result<(Vec<Module>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut loading = Loading {
        sources,
        reading,
        done: Vec::new(),
        known: HashMap::new(),
        errors: Vec::new(),
        told: Vec::new(),
    };
    let path = loading.sources.file(file).path.clone();
    loading.file(file, path.as_deref());
    let Loading { done, mut errors, told, .. } = loading;
    if errors.is_empty() {
        return Ok((done, told));
    }
    errors.extend(told);
    Err(in_order(errors))
}

struct Loading<'s, 'r> {
    sources: &'s mut SourceMap,
    reading: &'r Reading<'r>,
    done: Vec<Module>,
    /// By path: the module, or `None` while it is being read.
    known: HashMap<PathBuf, Option<usize>>,
    /// What ends the reading.
    errors: Vec<Diagnostic>,
    /// What does not.
    told: Vec<Diagnostic>,
}

/// A file whose imports are followed one by one.
struct Open {
    file: FileId,
    path: Option<PathBuf>,
    items: Vec<Item>,
    broken: Vec<String>,
    imports: Vec<usize>,
    next: usize,
}

impl Loading<'_, '_> {
    /// Depth first, with a stack of its own.
    fn file(&mut self, file: FileId, path: Option<&Path>) {
        let Some(first) = self.open(file, path.map(Path::to_owned)) else { return };
        let mut stack = vec![first];
        while let Some(top) = stack.last_mut() {
            let import = imports(&top.items).nth(top.next).map(|i| (i.path.clone(), i.at));
            let Some((written, at)) = import else {
                let Some(Open { path, items, broken, imports, .. }) = stack.pop() else { break };
                self.done.push(Module { items, broken, imports });
                let made = self.done.len() - 1;
                if let Some(path) = path {
                    self.known.insert(path, Some(made));
                }
                if let Some(above) = stack.last_mut() {
                    above.imports.push(made);
                }
                continue;
            };
            top.next += 1;
            let from = top.file;
            if DEEPEST <= stack.len() {
                let error = Diagnostic::error("E0701", format!("imports nest deeper than {DEEPEST}"));
                self.errors.push(error.at(at, "the innermost").help("import fewer files from one another"));
                return;
            }
            let Some(top) = stack.last_mut() else { break };
            match self.resolved(&written, from, at) {
                Ok(path) => match self.known.get(&path) {
                    Some(Some(known)) => top.imports.push(*known),
                    Some(None) => {
                        let error = circle(&stack, &path, at);
                        self.errors.push(error);
                        return;
                    }
                    None => match self.read(&path, at) {
                        Some(opened) => stack.push(opened),
                        None => return,
                    },
                },
                Err(error) => {
                    self.errors.push(error);
                    return;
                }
            }
        }
    }

    fn resolved(&self, written: &str, from: FileId, at: Span) -> Result<PathBuf, Diagnostic> {
        let base = self.sources.file(from).path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        match self.reading.files {
            Some(files) => files.resolve(written, base, at),
            None => {
                let error = Diagnostic::error("E0603", "nothing is imported here").at(at, "a file");
                Err(error.help("write what it holds into the scene itself"))
            }
        }
    }

    fn read(&mut self, path: &Path, at: Span) -> Option<Open> {
        let text = self.reading.files.map(|files| files.read(path, at))?;
        let told = match text {
            Ok(_) if MAX_FILES <= self.known.len() => {
                let error = Diagnostic::error("E0703", format!("more than {MAX_FILES} files are imported"));
                Err(error.at(at, "this one").help("import fewer files"))
            }
            text => text,
        };
        match told {
            Ok(text) => {
                let file = self.sources.add(path.display().to_string(), Some(path.to_owned()), text);
                self.open(file, Some(path.to_owned()))
            }
            Err(error) => {
                self.errors.push(error);
                None
            }
        }
    }

    fn open(&mut self, file: FileId, path: Option<PathBuf>) -> Option<Open> {
        let Salvage { items, errors, broken } = salvaged(&self.sources.file(file).text, file);
        let Some(broken) = broken else {
            self.errors.extend(errors);
            return None;
        };
        self.told.extend(errors);
        if let Some(path) = &path {
            self.known.insert(path.clone(), None);
        }
        Some(Open { file, path, items, broken, imports: Vec::new(), next: 0 })
    }
}

/// The error that a file imports itself, with the imports that lead there.
fn circle(stack: &[Open], path: &Path, at: Span) -> Diagnostic {
    let from = stack.iter().position(|open| open.path.as_deref() == Some(path)).unwrap_or(0);
    let mut error = Diagnostic::error("E0609", "a file is imported by itself").at(at, "closes the circle");
    for open in &stack[from..stack.len().saturating_sub(1)] {
        if let Some(import) = imports(&open.items).nth(open.next - 1) {
            error = error.at(import.at, "imported here");
        }
    }
    error.help("put what both use into a file of its own")
}
