//! What a request looks at: a document, its names, and what it imports.

use lsp_types::Uri;

use super::Access;
use super::documents::{Document, Documents, Texts, key_of};
use super::names::{Binding, Import, Outline};
use super::uri::uri_of;
use crate::lang::Files;
use crate::lang::reference::{Chapter, Word};
use crate::source::Span;

/// What a request looks at.
pub struct View<'s> {
    /// All words of the language.
    pub words: &'s [Word],
    /// The document.
    pub document: &'s Document,
    /// Its names.
    pub outline: Outline,
    documents: &'s Documents,
    access: &'s Access,
}

/// A file that the document imports.
pub struct Imported {
    /// Its name, as the client writes it where it has it open.
    pub uri: Uri,
    /// Its names.
    pub outline: Outline,
}

/// A name that the document does not bind itself: the file that does, and its place there.
pub type Foreign = (Imported, Binding);

impl<'s> View<'s> {
    /// A view of a document.
    pub fn new(
        words: &'s [Word],
        document: &'s Document,
        documents: &'s Documents,
        access: &'s Access,
    ) -> View<'s> {
        View { words, document, outline: Outline::new(&document.text), documents, access }
    }

    /// Reads an imported file; `None` where that fails, of which the diagnostics tell.
    pub fn imported(&self, import: &Import) -> Option<Imported> {
        let texts = Texts::new(self.documents, self.document, self.access);
        let path = texts.resolve(&import.path, &self.document.folder(), Span::default()).ok()?;
        let text = texts.read(&path, Span::default()).ok()?;
        let open = self.documents.by_key(&key_of(&path));
        let uri = open.map_or_else(|| uri_of(&path), |document| Some(document.uri.clone()))?;
        Some(Imported { uri, outline: Outline::new(&text) })
    }

    /// The file behind a name space.
    pub fn space(&self, space: &str) -> Option<Imported> {
        let named = |import: &&Import| import.space.as_deref() == Some(space);
        self.imported(self.outline.imports.iter().find(named)?)
    }

    /// The files whose names are known without a name space.
    pub fn joined(&self) -> impl Iterator<Item = Imported> {
        let joins = self.outline.imports.iter().filter(|import| import.space.is_none());
        joins.filter_map(|import| self.imported(import))
    }

    /// A name of a name space.
    pub fn member(&self, space: &str, name: &str) -> Option<Foreign> {
        self.space(space).and_then(|file| owned(file, name))
    }

    /// A name of the files that are imported without a name space.
    pub fn joined_name(&self, name: &str) -> Option<Foreign> {
        self.joined().find_map(|file| owned(file, name))
    }

    /// The words of the language with a name, methods or all others.
    pub fn words(&self, name: &str, methods: bool) -> impl Iterator<Item = &'s Word> {
        let words = self.words.iter().filter(move |word| is_method(word) == methods);
        words.filter(move |word| word.is(name))
    }
}

fn owned(file: Imported, name: &str) -> Option<Foreign> {
    let binding = file.outline.own(name)?.clone();
    Some((file, binding))
}

/// Whether a word stands after a point.
pub fn is_method(word: &Word) -> bool {
    word.chapter == Chapter::Methods
}

/// Whether a word begins an item, or is written between others.
pub fn is_keyword(word: &Word) -> bool {
    matches!(word.chapter, Chapter::Items | Chapter::Keywords)
}

/// Whether a word is a material.
pub fn is_material(word: &Word) -> bool {
    word.chapter == Chapter::Materials
}
