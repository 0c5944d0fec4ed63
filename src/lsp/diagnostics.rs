//! What is wrong with a document and the files it imports, each complaint at its place. The text is read and evaluated; shapes
//! are not measured, and what depends on their measures is not judged.

use std::path::{Path, PathBuf};

use lsp_types::{
    Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Range, TextEdit,
    Uri,
};

use super::Access;
use super::actions::Mending;
use super::documents::{Document, Documents, Texts, key_of};
use super::positions::{Encoding, Lines};
use super::uri::uri_of;
use crate::diag;
use crate::lang::{Files, Reading, read_with};
use crate::scene::Catalog;
use crate::source::{FileId, SourceMap, Span};

/// The code of what cannot be told because shapes are not measured here.
const UNMEASURED: &str = "E0708";

/// What a client understands.
#[derive(Clone, Copy, Debug, Default)]
pub struct Client {
    /// What columns count.
    pub encoding: Encoding,
    /// Whether other places may stand beside a message.
    pub related: bool,
}

/// What was found about a document.
#[derive(Debug, Default)]
pub struct Findings {
    /// By file.
    pub told: Vec<(Uri, Vec<Diagnostic>)>,
    /// The files it imports, whether or not they could be read.
    pub inputs: Vec<PathBuf>,
}

/// Reads a document as a scene.
pub fn find(
    document: &Document,
    documents: &Documents,
    access: &Access,
    catalog: &Catalog,
    client: Client,
) -> Findings {
    let texts = Texts::new(documents, document, access);
    let mut sources = SourceMap::default();
    let name = document.path.as_ref().map_or(document.uri.as_str().to_owned(), |p| p.display().to_string());
    let file = sources.add(name, root_path(&texts, document), document.text.as_str());
    let all = read(&mut sources, file, &texts, catalog, access.limit);
    let page = Page { sources: &sources, root: document, documents, client };
    let mut told: Vec<(Uri, Vec<Diagnostic>)> = vec![(document.uri.clone(), Vec::new())];
    for diagnostic in all.iter().filter(|d| d.code != UNMEASURED) {
        let (uri, diagnostic) = page.diagnostic(diagnostic);
        match told.iter_mut().find(|(known, _)| *known == uri) {
            Some((_, list)) => list.push(diagnostic),
            None => told.push((uri, vec![diagnostic])),
        }
    }
    Findings { told, inputs: texts.asked.into_inner() }
}

/// The path by which an import would find the document, so that a circle is seen where it closes.
fn root_path(texts: &Texts, document: &Document) -> Option<PathBuf> {
    let path = document.path.clone()?;
    let found = path.to_str().and_then(|text| texts.resolve(text, Path::new(""), Span::default()).ok());
    Some(found.unwrap_or(path))
}

/// Everything there is to say about a scene.
fn read(
    sources: &mut SourceMap,
    file: FileId,
    texts: &Texts,
    catalog: &Catalog,
    limit: u64,
) -> Vec<diag::Diagnostic> {
    if limit < sources.file(file).text.len() as u64 {
        let told = format!("the scene is longer than {} MiB", limit >> 20);
        return vec![
            diag::Diagnostic::error("E0701", told)
                .help("keep points in files of their own: `points(\"a.ply\")`"),
        ];
    }
    let reading = Reading {
        catalog,
        defines: &[],
        files: Some(texts),
        geometry: None,
        expects: true,
        memory: crate::lang::MEMORY,
    };
    match read_with(sources, file, &reading) {
        Ok(read) => read.warnings.into_iter().chain(read.unmet).collect(),
        Err(all) => all,
    }
}

/// The texts that diagnostics point into.
struct Page<'a> {
    sources: &'a SourceMap,
    root: &'a Document,
    documents: &'a Documents,
    client: Client,
}

impl Page<'_> {
    /// A diagnostic as editors take it, and the document it belongs to.
    fn diagnostic(&self, diagnostic: &diag::Diagnostic) -> (Uri, Diagnostic) {
        let mut labels = diagnostic.labels.iter();
        let main = labels.next();
        let mut message = diagnostic.message.clone();
        if let Some(label) = main.filter(|label| !label.text.is_empty()) {
            message += &format!(": {}", label.text);
        }
        let mut related = Vec::new();
        for label in labels {
            match self.location(label.span) {
                Some(location) if self.client.related => {
                    related.push(DiagnosticRelatedInformation { location, message: label.text.clone() });
                }
                _ => message += &format!("\n{}: {}", self.sources.place(label.span), label.text),
            }
        }
        let help = diagnostic.help.iter().map(|help| format!("\nhelp: {help}"));
        let notes = diagnostic.notes.iter().map(|note| format!("\nnote: {note}"));
        message.extend(help.chain(notes));
        let place = main.and_then(|label| self.location(label.span));
        let place = place.unwrap_or(Location { uri: self.root.uri.clone(), range: Range::default() });
        let out = Diagnostic {
            range: place.range,
            severity: Some(severity(diagnostic)),
            code: Some(NumberOrString::String(diagnostic.code.to_owned())),
            source: Some("pss".to_owned()),
            message,
            related_information: (!related.is_empty()).then_some(related),
            data: diagnostic.fix.as_deref().and_then(|fix| self.mending(fix)),
            ..Diagnostic::default()
        };
        (place.uri, out)
    }

    /// The edit that mends it, as a client gives it back.
    fn mending(&self, fix: &diag::Fix) -> Option<serde_json::Value> {
        let Location { uri, range } = self.location(fix.span)?;
        let edit = TextEdit { range, new_text: fix.text.clone() };
        serde_json::to_value(Mending { uri, edit }).ok()
    }

    fn location(&self, span: Span) -> Option<Location> {
        let file = self.sources.file(span.file);
        let lines = Lines::new(&file.text, self.client.encoding);
        let range = lines.range(span.start as usize..span.end.max(span.start) as usize);
        let of_root = span.file == FileId(0);
        let uri = if of_root { self.root.uri.clone() } else { self.uri(file.path.as_deref()?)? };
        Some(Location { uri, range })
    }

    /// The name of a file, as the client writes it where it has it open.
    fn uri(&self, path: &Path) -> Option<Uri> {
        let open = self.documents.by_key(&key_of(path));
        open.map_or_else(|| uri_of(path), |document| Some(document.uri.clone()))
    }
}

fn severity(diagnostic: &diag::Diagnostic) -> DiagnosticSeverity {
    match diagnostic.severity {
        diag::Severity::Error => DiagnosticSeverity::ERROR,
        diag::Severity::Warning => DiagnosticSeverity::WARNING,
        diag::Severity::Remark => DiagnosticSeverity::INFORMATION,
    }
}
