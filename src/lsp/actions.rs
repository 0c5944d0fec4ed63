//! Quick fixes: the edits that diagnostics bring. Each travels with its diagnostic, so that it is of the text that the
//! diagnostic is of.

use std::collections::HashMap;

use lsp_types::{CodeAction, CodeActionKind, CodeActionParams, TextEdit, Uri, WorkspaceEdit};
use serde::{Deserialize, Serialize};

/// What a diagnostic keeps in its `data`.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Mending {
    /// The document.
    pub uri: Uri,
    /// What is to be written there.
    pub edit: TextEdit,
}

/// The actions for the diagnostics that a client has at a place.
pub fn actions(params: CodeActionParams) -> Vec<CodeAction> {
    let diagnostics = params.context.diagnostics.into_iter();
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
