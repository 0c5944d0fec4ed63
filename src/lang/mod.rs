//! Scene text to [`crate::scene::Scene`]: grammar, names, units, types, operators. What can be called it
//! reads from a [`Catalog`]; what a sphere is, and what a file holds, it leaves to others.

mod angles;
mod args;
mod arithmetic;
pub mod ast;
mod budget;
mod builtins;
mod chains;
mod check;
pub mod codes;
mod copies;
mod defines;
mod estimate;
mod eval;
mod expect;
mod flow;
mod foreign;
mod format;
mod formula;
mod formula_calls;
mod formula_functions;
mod functions;
mod habits;
mod half_space;
mod headers;
mod items;
mod keywords;
mod lists;
mod literals;
mod maths;
mod methods;
mod modules;
mod nearly;
mod order;
mod parse;
mod parts;
mod placing;
mod print;
mod queries;
pub mod reference;
mod resolve;
mod salvage;
mod scan;
mod scope;
mod sets;
mod signs;
mod slips;
mod split;
mod syntax;
mod units;
mod unknown;
mod value;
mod verdict;

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};

use crate::diag::Diagnostic;
use crate::scene::{Catalog, Draw, Scene};
use crate::source::{FileId, SourceMap, Span};

pub(crate) use defines::TYPES;
pub(crate) use items::ATTRIBUTES;
pub(crate) use keywords::is_keyword;
pub(crate) use literals::text as unquoted;
pub use queries::{Answer, Asked, Extent, Geometry, Measured, RayHit};
pub(crate) use scan::{Token, TokenKind, tokens};
pub(crate) use split::ITEM_WORDS;
pub(crate) use units::LENGTHS;

/// Stack for the deepest nesting allowed, with room to spare; only what is used is ever touched.
const STACK_BYTES: usize = 256 << 20;

/// Bytes that the values of a scene may take, about, where nothing else is said.
pub const MEMORY: u64 = 4 << 30;

/// What reading a scene may use.
#[derive(Clone, Copy)]
pub struct Reading<'a> {
    /// What can be called.
    pub catalog: &'a Catalog,
    /// The `-D name=value` of the command line.
    pub defines: &'a [(String, String)],
    /// Who reads what is imported; nothing is without.
    pub files: Option<&'a dyn Files>,
    /// Who measures shapes; they are not without.
    pub geometry: Option<&'a dyn Geometry>,
    /// Whether `expect` items are evaluated.
    pub expects: bool,
    /// Bytes that its values may take, about; parsing takes some seventy times the text beside.
    pub memory: u64,
}

/// Reads imported files.
pub trait Files {
    /// The path to open for a name written in a file of a folder; the error says that it may not be opened.
    fn resolve(&self, written: &str, folder: &Path, at: Span) -> Result<PathBuf, Diagnostic>;
    /// The text of a file.
    fn read(&self, path: &Path, at: Span) -> Result<String, Diagnostic>;
}

/// A scene that was read.
#[derive(Debug)]
pub struct Read {
    /// The scene.
    pub scene: Scene,
    /// In the order of the text.
    pub warnings: Vec<Diagnostic>,
    /// Expectations that are not met, where they were evaluated: errors.
    pub unmet: Vec<Diagnostic>,
    /// The shapes that `let` items of the scene's own file name.
    pub named: Vec<Draw>,
}

/// Reads the scene in `file`, which imports nothing and asks nothing of its shapes. `defines` are the `-D name=value` of the
/// command line; their texts join `sources`, so that a complaint can show them. Warnings stand beside the scene; errors, with
/// the warnings found on the way, stand in the order of the text.
pub fn read(
    sources: &mut SourceMap,
    file: FileId,
    catalog: &Catalog,
    defines: &[(String, String)],
) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    let reading = Reading { catalog, defines, files: None, geometry: None, expects: false, memory: MEMORY };
    read_with(sources, file, &reading).map(|read| (read.scene, read.warnings))
}

/// The same with all that a scene may use. The texts of imported files join `sources`.
pub fn read_with(sources: &mut SourceMap, file: FileId, reading: &Reading) -> Result<Read, Vec<Diagnostic>> {
    let defines = defines::add(sources, reading.defines);
    // Where the stack cannot be had `grow` panics before it calls.
    let mut begun = false;
    let read = AssertUnwindSafe(|| {
        stacker::grow(STACK_BYTES, || {
            begun = true;
            items::read(sources, file, reading, &defines)
        })
    });
    match catch_unwind(read) {
        Ok(read) => read,
        Err(panic) if begun => resume_unwind(panic),
        Err(_) => {
            let wanted = format!("no memory to read the scene: {} MiB are wanted", STACK_BYTES >> 20);
            let error = Diagnostic::error("E0704", wanted).fault(crate::diag::Fault::Memory);
            Err(vec![error.help("close other programs, or allow this one more memory")])
        }
    }
}

/// The items of a text as they were written, each with its place; or every mistake in their wording.
pub fn items(sources: &SourceMap, file: FileId) -> Result<Vec<ast::Item>, Vec<Diagnostic>> {
    stacker::grow(STACK_BYTES, || salvage::parsed(&sources.file(file).text, file))
}

/// The items of a text one after the other, as they were written; those with a mistake in their wording are left out.
pub fn each_item<E>(
    sources: &SourceMap,
    file: FileId,
    mut take: impl FnMut(ast::Item) -> Result<(), E>,
) -> Result<(), E> {
    let text = &sources.file(file).text;
    stacker::grow(STACK_BYTES, || {
        let cut = split::cut(text, file).items.into_iter();
        cut.filter_map(|item| parse::item(text, file, item.range).ok()).try_for_each(&mut take)
    })
}

/// Bytes of all items of a text, those that cannot be read among them; each ends where the next begins.
pub(crate) fn item_ranges(text: &str) -> Vec<Range<usize>> {
    split::cut(text, FileId::default()).all
}

/// A text in the house style; every mistake in its wording, where there are some.
pub fn formatted(sources: &SourceMap, file: FileId) -> Result<String, Vec<Diagnostic>> {
    items(sources, file)?;
    Ok(format::format(&sources.file(file).text, file))
}

/// What the language itself knows beside the catalogue: how it is written, and one sentence. Functions first,
/// then methods (with their point), then constants.
pub fn builtins() -> Vec<(String, &'static str)> {
    let functions = builtins::functions().map(|b| (args::signature(b.name, b.formals), b.doc));
    let methods =
        builtins::METHODS.iter().map(|b| (format!(".{}", args::signature(b.name, b.formals)), b.doc));
    let constants = builtins::CONSTANTS.iter().map(|(name, _, doc)| ((*name).to_owned(), *doc));
    functions.chain(methods).chain(constants).collect()
}

fn span(file: FileId, range: Range<usize>) -> Span {
    Span { file, start: range.start as u32, end: range.end as u32 }
}
