//! Quick fixes: the edits that diagnostics bring. Each travels with its diagnostic, so that it is of the text that the
//! diagnostic is of.

use std::collections::{BTreeMap, HashMap};

use lsp_types::{CodeAction, CodeActionKind, CodeActionParams, Range, TextEdit, Uri, WorkspaceEdit};
use serde::{Deserialize, Serialize};

use super::diagnostics::Findings;

/// What a diagnostic keeps in its `data`.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Mending {
    /// The document.
    pub uri: Uri,
    /// What is to be written there.
    pub edit: TextEdit,
}

/// The actions for the diagnostics that a client has at a place; of a client that names none, for what was found there.
pub fn actions(params: CodeActionParams, findings: &BTreeMap<String, Findings>) -> Vec<CodeAction> {
    let mut named = params.context.diagnostics;
    if named.is_empty() {
        let found = findings.values().flat_map(|found| &found.told);
        let here = found.filter(|(uri, _)| *uri == params.text_document.uri).flat_map(|(_, list)| list);
        named.extend(here.filter(|d| touch(d.range, params.range)).cloned());
        named.dedup();
    }
    let diagnostics = named.into_iter();
    let action = |diagnostic: lsp_types::Diagnostic| {
        let Mending { uri, edit } = serde_json::from_value(diagnostic.data.clone()?).ok()?;
        let title = match edit.new_text.trim() {
            "" => "Remove it".to_owned(),
            text => format!("Write `{text}`"),
        };
        // A name of a document is a key like any other here: two that differ are two documents.
        #[allow(clippy::mutable_key_type)]
        let changes = HashMap::from([(uri, vec![edit])]);
        Some(CodeAction {
            title,
            kind: Some(CodeActionKind::QUICKFIX),
            diagnostics: Some(vec![diagnostic]),
            edit: Some(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }),
            is_preferred: Some(true),
            ..CodeAction::default()
        })
    };
    diagnostics.filter_map(action).collect()
}

/// Whether two stretches have a place in common; a cursor is a stretch without length.
fn touch(a: Range, b: Range) -> bool {
    a.start <= b.end && b.start <= a.end
}
