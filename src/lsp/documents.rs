//! The documents that the client has open, and the files beside them: what an open document holds goes before what lies on
//! the disk.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lsp_types::Uri;

use super::Access;
use super::uri::path_of;
use crate::diag::Diagnostic;
use crate::lang::Files;
use crate::prepare::Imports;
use crate::source::Span;

/// A document.
#[derive(Clone, Debug)]
pub struct Document {
    /// Its name, as the client writes it.
    pub uri: Uri,
    /// Which edition of it this is.
    pub version: i32,
    /// What it holds.
    pub text: String,
    /// The file, if it is one.
    pub path: Option<PathBuf>,
    /// The same file, however it is called.
    pub key: Option<PathBuf>,
}

impl Document {
    /// A document as the client opens it.
    pub fn new(uri: Uri, version: i32, text: String) -> Document {
        let path = path_of(&uri);
        let key = path.as_deref().map(key_of);
        Document { uri, version, text, path, key }
    }

    /// The folder that what it imports is relative to.
    pub fn folder(&self) -> PathBuf {
        let parent = self.path.as_deref().and_then(Path::parent).filter(|p| !p.as_os_str().is_empty());
        parent.unwrap_or(Path::new(".")).to_owned()
    }
}

/// One name for each file, also for one that does not exist yet.
pub fn key_of(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let by_folder = |path: &Path| Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?));
    absolute.canonicalize().ok().or_else(|| by_folder(&absolute)).unwrap_or(absolute)
}

/// All that are open, by the text of their URI.
#[derive(Debug, Default)]
pub struct Documents(BTreeMap<String, Document>);

impl Documents {
    /// Opens one, or takes another edition of it.
    pub fn insert(&mut self, document: Document) {
        self.0.insert(document.uri.as_str().to_owned(), document);
    }

    /// Closes one.
    pub fn remove(&mut self, uri: &Uri) -> Option<Document> {
        self.0.remove(uri.as_str())
    }

    /// The one with a name.
    pub fn get(&self, uri: &str) -> Option<&Document> {
        self.0.get(uri)
    }

    /// The one that is a file.
    pub fn by_key(&self, key: &Path) -> Option<&Document> {
        self.0.values().find(|d| d.key.as_deref() == Some(key))
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &Document> {
        self.0.values()
    }
}

/// Reads what a document imports.
pub struct Texts<'a> {
    documents: &'a Documents,
    folder: PathBuf,
    access: &'a Access,
    /// The files that were asked for, whether or not they could be read.
    pub asked: RefCell<Vec<PathBuf>>,
}

impl<'a> Texts<'a> {
    /// For the imports of a document.
    pub fn new(documents: &'a Documents, document: &Document, access: &'a Access) -> Texts<'a> {
        Texts { documents, folder: document.folder(), access, asked: RefCell::default() }
    }

    fn imports(&self) -> Imports<'_> {
        Imports {
            scene_dir: &self.folder,
            allow_read: &self.access.allow_read,
            limit: self.access.limit,
            inputs: Default::default(),
        }
    }
}

impl Files for Texts<'_> {
    fn resolve(&self, written: &str, folder: &Path, at: Span) -> Result<PathBuf, Diagnostic> {
        self.imports().resolve(written, folder, at)
    }

    fn read(&self, path: &Path, at: Span) -> Result<String, Diagnostic> {
        let key = key_of(path);
        let open = self.documents.by_key(&key).map(|document| document.text.clone());
        self.asked.borrow_mut().push(key);
        open.map_or_else(|| self.imports().read(path, at), Ok)
    }
}
