//! A text to the items that can be read, and every mistake in the wording of the others.

use super::ast::Item;
use super::{parse, resolve, span, split};
use crate::diag::Diagnostic;
use crate::source::FileId;

/// The largest file that is read.
const MAX_BYTES: usize = 256 << 20;

/// What of a text could be read.
pub struct Salvage {
    /// The items without a mistake in their wording.
    pub items: Vec<Item>,
    /// The mistakes in the others.
    pub errors: Vec<Diagnostic>,
    /// What the others would have defined; `None` where nobody knows.
    pub broken: Option<Vec<String>>,
}

/// The items, or every mistake in their wording.
pub fn parsed(text: &str, file: FileId) -> Result<Vec<Item>, Vec<Diagnostic>> {
    let Salvage { items, errors, .. } = salvaged(text, file);
    if errors.is_empty() { Ok(items) } else { Err(errors) }
}

/// The items that can be read, and every mistake in the wording of the others.
pub fn salvaged(text: &str, file: FileId) -> Salvage {
    if let Err(error) = readable(text, file) {
        return Salvage { items: Vec::new(), errors: vec![error], broken: None };
    }
    let cut = split::cut(text, file);
    let mut errors = cut.errors;
    let mut items = Vec::with_capacity(cut.items.len());
    let mut broken = cut.whole.then(Vec::new);
    let mut sound = cut.items.into_iter().peekable();
    for (i, range) in cut.all.into_iter().enumerate() {
        let item = sound.next_if(|item| item.which == i).map(|item| {
            let parsed = parse::item(text, file, item.range);
            parsed.map_err(|error| first_of(error, item.stranger))
        });
        match item {
            Some(Ok(item)) => items.push(item),
            failed => {
                errors.extend(failed.and_then(Result::err).map(|error| *error));
                broken = broken.and_then(|mut names| {
                    names.extend(resolve::names_in(&text[range])?);
                    Some(names)
                });
            }
        }
    }
    Salvage { items, errors: in_order(errors), broken }
}

/// Of what the grammar refused and a character that no scene holds what stands first.
fn first_of(refused: Box<Diagnostic>, stranger: Option<Diagnostic>) -> Box<Diagnostic> {
    let place = |error: &Diagnostic| error.labels.first().map(|label| label.span.start);
    match stranger {
        Some(stranger) if place(&stranger) <= place(&refused) => Box::new(stranger),
        _ => refused,
    }
}

/// Refuses what no scene can be.
fn readable(text: &str, file: FileId) -> Result<(), Diagnostic> {
    if text.len() > MAX_BYTES {
        let told = format!("the scene is larger than {} MB", MAX_BYTES >> 20);
        return Err(
            Diagnostic::error("E0705", told).help("keep points in files of their own: `points(\"a.ply\")`")
        );
    }
    if let Some(at) = text.find('\0') {
        return Err(Diagnostic::error("E0103", "the text holds a NUL character")
            .at(span(file, at..at + 1), "not text")
            .help("is this a scene file?"));
    }
    Ok(())
}

/// In the order of the text.
pub fn in_order(mut all: Vec<Diagnostic>) -> Vec<Diagnostic> {
    all.sort_by_key(|d| d.labels.first().map(|l| (l.span.file, l.span.start)));
    all
}
