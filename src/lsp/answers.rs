//! Requests about documents, and their answers: positions become bytes here, and bytes positions.

use std::collections::BTreeMap;

use lsp_server::{ErrorCode, Request};
use lsp_types::request::{
    CodeActionRequest, Completion, DocumentSymbolRequest, Formatting, GotoDefinition, HoverRequest,
    Request as _,
};
use lsp_types::{
    CompletionParams, CompletionResponse, DocumentFormattingParams, DocumentSymbolParams,
    DocumentSymbolResponse, GotoDefinitionParams, GotoDefinitionResponse, Hover, HoverContents, HoverParams,
    Location, MarkupContent, MarkupKind, TextDocumentPositionParams, TextEdit, Uri,
};
use serde::Serialize;
use serde_json::Value;

use super::Access;
use super::actions::actions;
use super::completion::complete;
use super::definition::{Place, definition};
use super::diagnostics::Findings;
use super::documents::{Document, Documents};
use super::hover::hover;
use super::positions::{Encoding, Lines};
use super::server::params;
use super::symbols::symbols;
use super::view::View;
use crate::lang::reference::Word;
use crate::source::SourceMap;

/// An answer, or what is wrong with the question.
pub type Answered<T> = Result<T, (ErrorCode, String)>;

/// Who answers.
pub struct Desk<'s> {
    /// All words of the language.
    pub words: &'s [Word],
    /// What is open.
    pub documents: &'s Documents,
    /// What may be read.
    pub access: &'s Access,
    /// What was found about them as they stand.
    pub findings: &'s BTreeMap<String, Findings>,
    /// What columns count.
    pub encoding: Encoding,
}

impl<'s> Desk<'s> {
    /// Answers a request.
    pub fn answer(&self, request: Request) -> Answered<Value> {
        let Request { method, params: given, .. } = request;
        match method.as_str() {
            HoverRequest::METHOD => written(self.hover(params(given)?)?),
            Completion::METHOD => written(self.completion(params(given)?)?),
            GotoDefinition::METHOD => written(self.definition(params(given)?)?),
            DocumentSymbolRequest::METHOD => written(self.symbols(params(given)?)?),
            CodeActionRequest::METHOD => written(actions(params(given)?, self.findings)),
            Formatting::METHOD => written(self.formatting(params(given)?)?),
            _ => Err((ErrorCode::MethodNotFound, format!("`{method}` is not known"))),
        }
    }

    fn document(&self, uri: &Uri) -> Answered<&'s Document> {
        let closed = || (ErrorCode::InvalidParams, format!("`{}` is not open", uri.as_str()));
        self.documents.get(uri.as_str()).ok_or_else(closed)
    }

    fn lines<'t>(&self, text: &'t str) -> Lines<'t> {
        Lines::new(text, self.encoding)
    }

    /// A document, its lines and a byte of it.
    fn place(&self, at: TextDocumentPositionParams) -> Answered<(View<'s>, Lines<'s>, usize)> {
        let document = self.document(&at.text_document.uri)?;
        let lines = self.lines(&document.text);
        let byte = lines.byte(at.position);
        Ok((View::new(self.words, document, self.documents, self.access), lines, byte))
    }

    fn hover(&self, params: HoverParams) -> Answered<Option<Hover>> {
        let (view, lines, at) = self.place(params.text_document_position_params)?;
        Ok(hover(&view, at).map(|(value, bytes)| Hover {
            contents: HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value }),
            range: Some(lines.range(bytes)),
        }))
    }

    fn completion(&self, params: CompletionParams) -> Answered<CompletionResponse> {
        let (view, _, at) = self.place(params.text_document_position)?;
        Ok(CompletionResponse::Array(complete(&view, at)))
    }

    fn definition(&self, params: GotoDefinitionParams) -> Answered<Option<GotoDefinitionResponse>> {
        let (view, lines, at) = self.place(params.text_document_position_params)?;
        let location = definition(&view, at).map(|place| match place {
            Place::Here(bytes) => Location { uri: view.document.uri.clone(), range: lines.range(bytes) },
            Place::There(file, bytes) => {
                let range = self.lines(&file.outline.text).range(bytes);
                Location { uri: file.uri, range }
            }
        });
        Ok(location.map(GotoDefinitionResponse::Scalar))
    }

    fn symbols(&self, params: DocumentSymbolParams) -> Answered<DocumentSymbolResponse> {
        let document = self.document(&params.text_document.uri)?;
        let view = View::new(self.words, document, self.documents, self.access);
        Ok(DocumentSymbolResponse::Nested(symbols(&view.outline, &self.lines(&document.text))))
    }

    /// The edit that puts a document into the house style; none where it is, null where it cannot be read: the diagnostics
    /// say why.
    fn formatting(&self, params: DocumentFormattingParams) -> Answered<Option<Vec<TextEdit>>> {
        let document = self.document(&params.text_document.uri)?;
        let mut sources = SourceMap::default();
        let file = sources.add(document.uri.as_str(), None, document.text.as_str());
        let Ok(new_text) = crate::lang::formatted(&sources, file) else { return Ok(None) };
        let edit = TextEdit { range: self.lines(&document.text).all(), new_text };
        Ok(Some(if edit.new_text == document.text { Vec::new() } else { vec![edit] }))
    }
}

fn written(answer: impl Serialize) -> Answered<Value> {
    serde_json::to_value(answer).map_err(|e| (ErrorCode::InternalError, e.to_string()))
}
