//! The names of a file as editors list them.

use lsp_types::{DocumentSymbol, SymbolKind};

use super::hover::line;
use super::names::{Binding, Kind, Outline};
use super::positions::Lines;

/// All names of the file, and the labels of its cameras and lights.
pub fn symbols(outline: &Outline, lines: &Lines) -> Vec<DocumentSymbol> {
    outline.bindings.iter().filter(|b| b.of_file).map(|b| symbol(outline, lines, b)).collect()
}

// The type has no other way to be made, and one of its fields is deprecated.
#[allow(deprecated)]
fn symbol(outline: &Outline, lines: &Lines, binding: &Binding) -> DocumentSymbol {
    DocumentSymbol {
        name: outline.name(binding).to_owned(),
        detail: Some(line(&outline.text, binding.name.start)),
        kind: kind(outline, binding),
        tags: None,
        deprecated: None,
        range: lines.range(outline.items[binding.item].range.clone()),
        selection_range: lines.range(binding.name.clone()),
        children: None,
    }
}

fn kind(outline: &Outline, binding: &Binding) -> SymbolKind {
    match binding.kind {
        Kind::Let if !outline.formals(binding).is_empty() => SymbolKind::FUNCTION,
        Kind::Let | Kind::Variable | Kind::Formal(_) => SymbolKind::VARIABLE,
        Kind::Function => SymbolKind::FUNCTION,
        Kind::Param => SymbolKind::PROPERTY,
        Kind::Material | Kind::Label => SymbolKind::OBJECT,
        Kind::Space => SymbolKind::NAMESPACE,
    }
}
