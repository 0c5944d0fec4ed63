//! The life of a server: what it was told, which documents are to be read again, and who answers which request.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{
    DidChangeTextDocument, DidChangeWatchedFiles, DidCloseTextDocument, DidOpenTextDocument,
    DidSaveTextDocument, Exit, Notification as _, PublishDiagnostics,
};
use lsp_types::request::{CodeActionRequest, Initialize, Request as _, Shutdown};
use lsp_types::{
    CodeActionProviderCapability, CompletionOptions, Diagnostic, DidChangeTextDocumentParams,
    DidCloseTextDocumentParams, DidOpenTextDocumentParams, HoverProviderCapability, InitializeParams,
    InitializeResult, OneOf, PublishDiagnosticsParams, ServerCapabilities, ServerInfo,
    TextDocumentSyncCapability, TextDocumentSyncKind, TextDocumentSyncOptions, Uri,
};
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::answers::{Answered, Desk};
use super::diagnostics::{Client, Findings, find};
use super::documents::{Document, Documents};
use super::{Access, Sent};
use crate::lang::reference::{self, Word};
use crate::scene::Catalog;

/// How far the protocol has come.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Stage {
    New,
    Running,
    ShutDown,
    /// Whether it was shut down before.
    Exited(bool),
}

/// A server.
pub struct Server {
    stage: Stage,
    client: Client,
    access: Access,
    catalog: Catalog,
    words: Vec<Word>,
    documents: Documents,
    /// The documents to read again, by their URI.
    stale: BTreeSet<String>,
    /// What was found last about each.
    findings: BTreeMap<String, Findings>,
    outbox: Vec<Sent>,
}

impl Server {
    /// A server that knows nothing of its client yet.
    pub fn new(access: Access) -> Server {
        let catalog = crate::prepare::catalog();
        Server {
            stage: Stage::New,
            client: Client::default(),
            access,
            words: reference::words(&catalog),
            catalog,
            documents: Documents::default(),
            stale: BTreeSet::new(),
            findings: BTreeMap::new(),
            outbox: Vec::new(),
        }
    }

    /// Whether it was told to exit.
    pub fn exits(&self) -> bool {
        matches!(self.stage, Stage::Exited(_))
    }

    /// Whether it was shut down before it was left.
    pub fn was_shut_down(&self) -> bool {
        matches!(self.stage, Stage::ShutDown | Stage::Exited(true))
    }

    /// Whether all documents are read as they stand.
    pub fn is_settled(&self) -> bool {
        self.stale.is_empty()
    }

    /// What is to be sent.
    pub fn outbox(&mut self) -> Vec<Sent> {
        std::mem::take(&mut self.outbox)
    }

    /// Takes a message.
    pub fn take(&mut self, message: Message) {
        match message {
            Message::Request(request) => {
                let id = request.id.clone();
                let response = match self.guarded(|server| server.answer(request)) {
                    Ok(value) => Response::new_ok(id, value),
                    Err((code, message)) => Response::new_err(id, code as i32, message),
                };
                self.send(response);
            }
            // What is wrong with a notification there is no one to tell.
            Message::Notification(notification) => drop(self.guarded(|server| server.hear(notification))),
            Message::Response(_) => {}
        }
    }

    /// Answers what could not be read.
    pub fn refuse(&mut self, id: Option<RequestId>, code: ErrorCode, message: String) {
        match id {
            Some(id) => self.send(Response::new_err(id, code as i32, message)),
            None => self.outbox.push(Sent::Unaddressed { code: code as i32, message }),
        }
    }

    /// Reads one of the documents that changed, and publishes what is found.
    pub fn diagnose(&mut self) {
        let Some(name) = self.stale.pop_first() else { return };
        let found = self.guarded(|server| {
            let Server { documents, access, catalog, client, .. } = server;
            Ok(documents.get(&name).map(|document| find(document, documents, access, catalog, *client)))
        });
        if let Ok(Some(found)) = found {
            self.publish(name, Some(found));
        }
    }

    /// Replaces what is known about a document, and sends anew what that touches.
    fn publish(&mut self, name: String, found: Option<Findings>) {
        let mut touched: Vec<Uri> = Vec::new();
        let old = self.findings.remove(&name);
        for (uri, _) in old.iter().chain(&found).flat_map(|findings| &findings.told) {
            if !touched.contains(uri) {
                touched.push(uri.clone());
            }
        }
        self.findings.extend(found.map(|found| (name, found)));
        for uri in touched {
            let diagnostics = self.all_about(&uri);
            let version = self.documents.get(uri.as_str()).map(|document| document.version);
            let params = PublishDiagnosticsParams { uri, diagnostics, version };
            self.send(Notification::new(PublishDiagnostics::METHOD.to_owned(), params));
        }
    }

    /// What is wrong with a file: as it is read by itself where it is open, and what else comes to light where it is imported.
    fn all_about(&self, uri: &Uri) -> Vec<Diagnostic> {
        let own = self.findings.get(uri.as_str()).into_iter();
        let others = self.findings.iter().filter(|(name, _)| *name != uri.as_str()).map(|(_, f)| f);
        let mut out: Vec<Diagnostic> = Vec::new();
        for findings in own.chain(others) {
            let found = findings.told.iter().filter(|(of, _)| of == uri).flat_map(|(_, list)| list);
            let new =
                |d: &&Diagnostic| !out.iter().any(|known| known.range == d.range && known.code == d.code);
            let new: Vec<Diagnostic> = found.filter(new).cloned().collect();
            out.extend(new);
        }
        out
    }

    fn send(&mut self, message: impl Into<Message>) {
        self.outbox.push(Sent::Message(message.into()));
    }

    /// Does something; a panic costs the one message it was for.
    fn guarded<T>(&mut self, work: impl FnOnce(&mut Server) -> Answered<T>) -> Answered<T> {
        catch_unwind(AssertUnwindSafe(|| work(self)))
            .unwrap_or_else(|_| Err((ErrorCode::InternalError, "the server went wrong".to_owned())))
    }

    fn answer(&mut self, request: Request) -> Answered<Value> {
        match (self.stage, request.method.as_str()) {
            (Stage::New, Initialize::METHOD) => self.initialize(params(request.params)?),
            (Stage::New, _) => Err((ErrorCode::ServerNotInitialized, "`initialize` comes first".to_owned())),
            (Stage::Running, Shutdown::METHOD) => {
                self.stage = Stage::ShutDown;
                Ok(Value::Null)
            }
            (Stage::Running, Initialize::METHOD) => {
                Err((ErrorCode::InvalidRequest, "`initialize` was said before".to_owned()))
            }
            (Stage::Running, _) => {
                // What was found in an older text has edits for that text.
                while !self.is_settled() && request.method == CodeActionRequest::METHOD {
                    self.diagnose();
                }
                let Server { words, documents, access, findings, client, .. } = self;
                Desk { words, documents, access, findings, encoding: client.encoding }.answer(request)
            }
            _ => Err((ErrorCode::InvalidRequest, "the server was shut down".to_owned())),
        }
    }

    fn initialize(&mut self, params: InitializeParams) -> Answered<Value> {
        let capabilities = params.capabilities;
        let offered = capabilities.general.and_then(|general| general.position_encodings);
        let published = capabilities.text_document.and_then(|document| document.publish_diagnostics);
        self.client = Client {
            encoding: super::positions::Encoding::chosen(&offered.unwrap_or_default()),
            related: published.and_then(|published| published.related_information).unwrap_or(false),
        };
        self.stage = Stage::Running;
        let server_info =
            ServerInfo { name: "pss".to_owned(), version: Some(env!("CARGO_PKG_VERSION").to_owned()) };
        let result = InitializeResult { capabilities: self.capabilities(), server_info: Some(server_info) };
        serde_json::to_value(result).map_err(|e| (ErrorCode::InternalError, e.to_string()))
    }

    fn capabilities(&self) -> ServerCapabilities {
        let sync = TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(TextDocumentSyncKind::FULL),
            save: Some(true.into()),
            ..TextDocumentSyncOptions::default()
        };
        let triggers = [".", "(", ",", "@", "\""].map(str::to_owned).into();
        ServerCapabilities {
            position_encoding: Some(self.client.encoding.kind()),
            text_document_sync: Some(TextDocumentSyncCapability::Options(sync)),
            hover_provider: Some(HoverProviderCapability::Simple(true)),
            completion_provider: Some(CompletionOptions {
                trigger_characters: Some(triggers),
                ..CompletionOptions::default()
            }),
            definition_provider: Some(OneOf::Left(true)),
            document_symbol_provider: Some(OneOf::Left(true)),
            document_formatting_provider: Some(OneOf::Left(true)),
            code_action_provider: Some(CodeActionProviderCapability::Simple(true)),
            ..ServerCapabilities::default()
        }
    }

    fn hear(&mut self, notification: Notification) -> Answered<()> {
        let Notification { method, params: given } = notification;
        match (self.stage, method.as_str()) {
            (stage, Exit::METHOD) => self.stage = Stage::Exited(stage == Stage::ShutDown),
            (Stage::Running, DidOpenTextDocument::METHOD) => {
                let DidOpenTextDocumentParams { text_document: opened } = params(given)?;
                self.opened(Document::new(opened.uri, opened.version, opened.text));
            }
            (Stage::Running, DidChangeTextDocument::METHOD) => {
                let DidChangeTextDocumentParams { text_document, content_changes } = params(given)?;
                // The whole text is sent; of several the last counts.
                if let Some(change) = content_changes.into_iter().next_back() {
                    self.opened(Document::new(text_document.uri, text_document.version, change.text));
                }
            }
            (Stage::Running, DidCloseTextDocument::METHOD) => {
                let DidCloseTextDocumentParams { text_document } = params(given)?;
                self.closed(&text_document.uri);
            }
            // What lies on the disk may be imported by any document.
            (Stage::Running, DidSaveTextDocument::METHOD | DidChangeWatchedFiles::METHOD) => {
                self.stale.extend(self.documents.iter().map(|document| document.uri.as_str().to_owned()));
            }
            _ => {}
        }
        Ok(())
    }

    fn opened(&mut self, document: Document) {
        self.stale.insert(document.uri.as_str().to_owned());
        self.disturb(&document);
        self.documents.insert(document);
    }

    fn closed(&mut self, uri: &Uri) {
        self.stale.remove(uri.as_str());
        if let Some(document) = self.documents.remove(uri) {
            self.publish(uri.as_str().to_owned(), None);
            self.disturb(&document);
        }
    }

    /// The documents that import a file are to be read again.
    fn disturb(&mut self, changed: &Document) {
        let imports =
            |findings: &Findings| changed.key.as_ref().is_some_and(|key| findings.inputs.contains(key));
        let touched = self.findings.iter().filter(|(_, findings)| imports(findings));
        self.stale.extend(touched.map(|(name, _)| name.clone()));
    }
}

/// The parameters of a message.
pub fn params<P: DeserializeOwned>(given: Value) -> Answered<P> {
    serde_json::from_value(given).map_err(|e| (ErrorCode::InvalidParams, e.to_string()))
}
