//! The files of a scene: its own, and those that it and they import, each read once and parsed alone; those that are imported
//! stand before those that import them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::Reading;
use super::ast::{Import, Item, ItemKind};
use super::salvage::{Salvage, in_order, salvaged};
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
    /// Whether nobody knows all the names that are known in it, or that it has.
    pub partly: bool,
    /// The modules that its `import` items name, in their order.
    pub imports: Vec<usize>,
}

/// The files of a scene, and what is wrong with them.
pub struct Loaded {
    /// The modules; the scene's own is the last.
    pub modules: Vec<Module>,
    /// What could not be read or is written wrong.
    pub errors: Vec<Diagnostic>,
    /// By file: where it was imported first.
    pub importers: Importers,
}

/// By file: where it was imported first.
pub type Importers = HashMap<FileId, Span>;

/// Links of a chain of imports that are told.
const TOLD: usize = 6;

/// Tells of what lies in imported files by which imports they were reached.
pub fn with_imports(all: &mut [Diagnostic], importers: &Importers, sources: &SourceMap) {
    for diagnostic in all {
        let mut file = diagnostic.labels.first().map(|label| label.span.file);
        for _ in 0..TOLD {
            let Some((id, at)) = file.and_then(|id| Some((id, importers.get(&id)?))) else { break };
            let name = &sources.file(id).name;
            diagnostic.notes.push(format!("`{name}` is imported at {}", sources.place(*at)));
            file = Some(at.file);
        }
    }
}

impl Module {
    /// Whether names may be known in it that nobody could read: its own, or those of what it imports without a name space.
    pub fn is_partly_known(&self, all: &[Module]) -> bool {
        self.partly || self.imported().any(|(import, from)| import.space.is_none() && all[from].partly)
    }

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

/// Reads a file and what it imports. Of a file that cannot be read it is not known what it defines: the others are read
/// all the same. Where imports have no end there are errors and no modules.
pub fn load(sources: &mut SourceMap, file: FileId, reading: &Reading) -> Loaded {
    let mut loading = Loading {
        sources,
        reading,
        done: Vec::new(),
        known: HashMap::new(),
        importers: HashMap::new(),
        endless: false,
        errors: Vec::new(),
    };
    let path = loading.sources.file(file).path.clone();
    loading.file(file, path.as_deref());
    let Loading { done, errors, importers, endless, .. } = loading;
    Loaded { modules: if endless { Vec::new() } else { done }, errors: in_order(errors), importers }
}

struct Loading<'s, 'r> {
    sources: &'s mut SourceMap,
    reading: &'r Reading<'r>,
    done: Vec<Module>,
    /// By path: the module, or `None` while it is being read.
    known: HashMap<PathBuf, Option<usize>>,
    importers: Importers,
    /// Whether imports have no end: nothing is evaluated then.
    endless: bool,
    errors: Vec<Diagnostic>,
}

/// A file whose imports are followed one by one.
struct Open {
    file: FileId,
    path: Option<PathBuf>,
    items: Vec<Item>,
    broken: Vec<String>,
    partly: bool,
    imports: Vec<usize>,
    next: usize,
}

impl Loading<'_, '_> {
    /// Depth first, with a stack of its own.
    fn file(&mut self, file: FileId, path: Option<&Path>) {
        let mut stack = vec![self.open(file, path.map(Path::to_owned))];
        while let Some(top) = stack.last_mut() {
            let import = imports(&top.items).nth(top.next).map(|i| (i.path.clone(), i.at));
            let Some((written, at)) = import else {
                let Some(done) = stack.pop() else { break };
                let made = self.close(done);
                if let Some(above) = stack.last_mut() {
                    above.imports.push(made);
                }
                continue;
            };
            top.next += 1;
            let from = top.file;
            if DEEPEST <= stack.len() {
                let error = Diagnostic::error("E0701", format!("imports nest deeper than {DEEPEST}"));
                return self
                    .give_up(error.at(at, "the innermost").help("import fewer files from one another"));
            }
            match self.resolved(&written, from, at) {
                Ok(path) => match self.known.get(&path) {
                    Some(Some(known)) => {
                        stack.last_mut().into_iter().for_each(|top| top.imports.push(*known))
                    }
                    Some(None) => return self.give_up(circle(&stack, &path, at)),
                    None => match self.read(path, at) {
                        Some(opened) => stack.push(opened),
                        None if self.endless => return,
                        None => self.lost(stack.last_mut()),
                    },
                },
                Err(error) => {
                    self.errors.push(error);
                    self.lost(stack.last_mut());
                }
            }
        }
    }

    fn give_up(&mut self, error: Diagnostic) {
        self.errors.push(error);
        self.endless = true;
    }

    /// A file all of whose imports are read.
    fn close(&mut self, Open { path, items, broken, partly, imports, .. }: Open) -> usize {
        self.done.push(Module { items, broken, partly, imports });
        let made = self.done.len() - 1;
        if let Some(path) = path {
            self.known.insert(path, Some(made));
        }
        made
    }

    /// What stands for a file that cannot be read.
    fn lost(&mut self, importer: Option<&mut Open>) {
        self.done.push(Module { items: Vec::new(), broken: Vec::new(), partly: true, imports: Vec::new() });
        importer.into_iter().for_each(|importer| importer.imports.push(self.done.len() - 1));
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

    /// `None` where it cannot be read, which is told.
    fn read(&mut self, path: PathBuf, at: Span) -> Option<Open> {
        if MAX_FILES <= self.known.len() {
            let error = Diagnostic::error("E0703", format!("more than {MAX_FILES} files are imported"));
            self.give_up(error.at(at, "this one").help("import fewer files"));
            return None;
        }
        match self.reading.files.map(|files| files.read(&path, at))? {
            Ok(text) => {
                let file = self.sources.add(path.display().to_string(), Some(path.clone()), text);
                self.importers.insert(file, at);
                Some(self.open(file, Some(path)))
            }
            Err(error) => {
                self.errors.push(error);
                None
            }
        }
    }

    fn open(&mut self, file: FileId, path: Option<PathBuf>) -> Open {
        let Salvage { items, errors, broken } = salvaged(&self.sources.file(file).text, file);
        self.errors.extend(errors);
        if let Some(path) = &path {
            self.known.insert(path.clone(), None);
        }
        let partly = broken.is_none();
        Open { file, path, items, broken: broken.unwrap_or_default(), partly, imports: Vec::new(), next: 0 }
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
