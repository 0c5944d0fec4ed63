//! Scene text to [`crate::scene::Scene`]: grammar, names, units, types, operators. What can be called it
//! reads from a [`Catalog`]; what a sphere is, and what a file holds, it leaves to others.

mod args;
mod arithmetic;
mod ast;
mod builtins;
mod chains;
mod check;
mod copies;
mod defines;
mod eval;
mod formula;
mod formula_functions;
mod half_space;
mod items;
mod literals;
mod maths;
mod methods;
mod order;
mod parse;
mod placing;
mod scan;
mod sets;
mod split;
mod syntax;
mod units;
mod value;

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use crate::diag::Diagnostic;
use crate::scene::{Catalog, Scene};
use crate::source::{FileId, SourceMap, Span};

/// Stack for the deepest nesting allowed, with room to spare; only what is used is ever touched.
const STACK_BYTES: usize = 256 << 20;

/// Reads the scene in `file`. `defines` are the `-D name=value` of the command line; their texts join
/// `sources`, so that a complaint can show them. Warnings stand beside the scene; errors, with the warnings
/// found on the way, stand in the order of the text.
pub fn read(
    sources: &mut SourceMap,
    file: FileId,
    catalog: &Catalog,
    defines: &[(String, String)],
) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    let defines = defines::add(sources, defines);
    let sources = &*sources;
    // Where the stack cannot be had `grow` panics before it calls.
    let mut begun = false;
    let read = AssertUnwindSafe(|| {
        stacker::grow(STACK_BYTES, || {
            begun = true;
            items::read(sources, file, catalog, &defines)
        })
    });
    match catch_unwind(read) {
        Ok(read) => read,
        Err(panic) if begun => resume_unwind(panic),
        Err(_) => Err(vec![
            Diagnostic::error("E0704", "no memory to read the scene")
                .help("close other programs, or allow this one more memory")
                .fault(crate::diag::Fault::Io),
        ]),
    }
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
