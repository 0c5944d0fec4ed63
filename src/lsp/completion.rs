//! What may be written at a place: words of the language, names, arguments of the call around it.

use lsp_types::{CompletionItem, CompletionItemKind, Documentation, MarkupContent, MarkupKind};

use super::context::Callee;
use super::hover::{callees, function, line};
use super::names::{Binding, Kind, Outline};
use super::parts::{self, What};
use super::view::{View, is_keyword, is_material, is_method};
use crate::lang::reference::{Chapter, Word};
use crate::lang::{ATTRIBUTES, ITEM_WORDS, LENGTHS, TYPES};

/// What may be written at a byte.
pub fn complete(view: &View, at: usize) -> Vec<CompletionItem> {
    let outline = &view.outline;
    if let Some(text) = outline.text_at(at) {
        return choices(view, text);
    }
    if outline.is_literal_at(at) {
        return Vec::new();
    }
    // The token that is being written, or the one after the place.
    let i = outline.word_at(at).unwrap_or_else(|| outline.tokens.partition_point(|t| t.start() < at));
    let open = outline.open_before(i);
    match outline.before(i) {
        "." => after_point(view, i),
        "@" => ATTRIBUTES.iter().map(|word| plain(word, CompletionItemKind::KEYWORD)).collect(),
        // What follows is a new name.
        "let" | "fn" | "param" | "material" | "camera" | "light" | "as" | "for" => Vec::new(),
        ":" if outline.is_type(i) => types(),
        _ if begins_item(outline, i, open, at) => items(view),
        before => {
            let callee = open.and_then(|open| outline.callee(open));
            match callee.filter(|_| matches!(before, "(" | ",")) {
                Some(Callee::Formals) => Vec::new(),
                Some(Callee::Item("units")) => units(),
                Some(callee) => arguments(view, callee, open).into_iter().chain(values(view, at)).collect(),
                None => values(view, at),
            }
        }
    }
}

/// The words that may stand in the quotes of a token: alone after an argument's name, or in a list.
fn choices(view: &View, text: usize) -> Vec<CompletionItem> {
    let outline = &view.outline;
    let Some(mut open) = outline.open_before(text) else { return Vec::new() };
    let mut colon = text.checked_sub(1);
    if outline.word(open) == "[" {
        colon = open.checked_sub(1);
        let Some(around) = outline.open_before(open) else { return Vec::new() };
        open = around;
    }
    let label = colon.filter(|i| outline.word(*i) == ":").and_then(|i| i.checked_sub(1));
    let (Some(label), Some(callee)) = (label.map(|i| outline.word(i)), outline.callee(open)) else {
        return Vec::new();
    };
    let words = |word: &Word| match (callee, label) {
        (Callee::Item("material"), "kind") => vec![word.name.clone()],
        _ => {
            let of_label = word.choices.iter().filter(|(name, _)| *name == label);
            of_label.flat_map(|(_, words)| words.iter().map(|w| (*w).to_owned())).collect()
        }
    };
    let mut all: Vec<String> = callees(view, callee).into_iter().flat_map(words).collect();
    let mut seen = std::collections::HashSet::new();
    all.retain(|word| seen.insert(word.clone()));
    all.iter().map(|word| plain(word, CompletionItemKind::ENUM_MEMBER)).collect()
}

fn after_point(view: &View, i: usize) -> Vec<CompletionItem> {
    let space = i.checked_sub(2).and_then(|i| view.outline.space_at(i));
    match space.and_then(|space| view.space(view.outline.name(space))) {
        Some(file) => file.outline.owned().map(|b| named(&file.outline, b)).collect(),
        None => {
            let what = i.checked_sub(1).map_or(What::Unknown, |point| parts::before(view, point));
            let part = |(name, doc): &(&str, &str)| CompletionItem {
                detail: Some((*doc).to_owned()),
                ..plain(name, CompletionItemKind::FIELD)
            };
            let methods = view.words.iter().filter(|word| what.has_methods() && is_method(word));
            what.parts().iter().map(part).chain(methods.map(known)).collect()
        }
    }
}

/// Whether a new item may begin: at the start of a line, after something that is whole.
fn begins_item(outline: &Outline, i: usize, open: Option<usize>, at: usize) -> bool {
    let start = outline.tokens.get(i).map_or(at, |t| t.start().min(at));
    let leads = outline.text[..start].trim_end_matches([' ', '\t']).ends_with(['\n', '\r']);
    match i.checked_sub(1).map(|before| &outline.tokens[before]) {
        None => true,
        Some(before) => leads && open.is_none() && before.ends_operand(&outline.text),
    }
}

fn items(view: &View) -> Vec<CompletionItem> {
    let begins = |word: &&Word| is_keyword(word) && ITEM_WORDS.contains(&word.name.as_str());
    view.words.iter().filter(begins).map(known).collect()
}

fn types() -> Vec<CompletionItem> {
    TYPES.iter().map(|word| plain(word, CompletionItemKind::TYPE_PARAMETER)).collect()
}

fn units() -> Vec<CompletionItem> {
    LENGTHS.iter().map(|(word, _)| plain(word, CompletionItemKind::UNIT)).collect()
}

/// All that is a value, and the words between values.
fn values(view: &View, at: usize) -> Vec<CompletionItem> {
    let outline = &view.outline;
    let mut out: Vec<CompletionItem> = Vec::new();
    let mut nearest: Vec<&Binding> = outline.known(at).collect();
    nearest.sort_by_key(|b| std::cmp::Reverse(b.scope.start));
    out.extend(nearest.into_iter().map(|b| named(outline, b)));
    for file in view.joined() {
        out.extend(file.outline.owned().map(|b| named(&file.outline, b)));
    }
    let begins_item = |word: &Word| {
        is_keyword(word) && ITEM_WORDS.contains(&word.name.as_str()) && !matches!(&*word.name, "let" | "fn")
    };
    let is_sign = |word: &Word| word.chapter == Chapter::Signs;
    let words = view.words.iter().filter(|word| !is_method(word) && !begins_item(word) && !is_sign(word));
    out.extend(words.map(known));
    let mut seen = std::collections::HashSet::new();
    out.retain(|item| seen.insert(item.label.clone()));
    out
}

/// The arguments of a call that are not given yet.
fn arguments(view: &View, callee: Callee, open: Option<usize>) -> Vec<CompletionItem> {
    let given = open.map_or(Vec::new(), |open| given(&view.outline, open));
    if let Some((outline, binding)) = function(view, callee) {
        let formals = outline.formals(&binding).into_iter().map(|b| outline.name(b).to_owned());
        return formals.filter(|name| !given.contains(name)).map(|name| argument(&name, None)).collect();
    }
    let kind = (callee == Callee::Item("material")).then(|| ("kind".to_owned(), None));
    let words = callees(view, callee).into_iter();
    let of = |word: &'_ Word| {
        let doc = |name: &str| word.args.iter().find(|row| row[0] == name).cloned();
        word.names.iter().map(|name| (name.clone(), doc(name))).collect::<Vec<_>>()
    };
    let mut seen = given;
    let mut out = Vec::new();
    for (name, doc) in kind.into_iter().chain(words.flat_map(of)) {
        if !seen.contains(&name) {
            out.push(argument(&name, doc));
            seen.push(name);
        }
    }
    out
}

/// The arguments that a call names already.
fn given(outline: &Outline, open: usize) -> Vec<String> {
    let depth = outline.depth(open);
    let within = (open + 1..outline.tokens.len()).take_while(|i| depth < outline.depth(*i));
    let label = within.filter(|i| outline.depth(*i) == depth + 1 && outline.word(i + 1) == ":");
    label.map(|i| outline.word(i).to_owned()).collect()
}

fn argument(name: &str, row: Option<[String; 3]>) -> CompletionItem {
    let [_, kind, doc] = row.unwrap_or_default();
    CompletionItem {
        insert_text: Some(format!("{name}: ")),
        detail: (!kind.is_empty()).then_some(kind),
        documentation: (!doc.is_empty()).then_some(Documentation::String(doc)),
        // Before everything else: that is what a call is short of.
        sort_text: Some(format!(" {name}")),
        ..plain(&format!("{name}:"), CompletionItemKind::FIELD)
    }
}

fn named(outline: &Outline, binding: &Binding) -> CompletionItem {
    let kind = match binding.kind {
        Kind::Function => CompletionItemKind::FUNCTION,
        Kind::Param => CompletionItemKind::PROPERTY,
        Kind::Space => CompletionItemKind::MODULE,
        _ => CompletionItemKind::VARIABLE,
    };
    CompletionItem {
        detail: Some(line(&outline.text, binding.name.start)),
        ..plain(outline.name(binding), kind)
    }
}

/// A word of the language.
fn known(word: &Word) -> CompletionItem {
    let kind = match word {
        _ if is_method(word) => CompletionItemKind::METHOD,
        _ if is_keyword(word) => CompletionItemKind::KEYWORD,
        _ if is_material(word) => CompletionItemKind::CLASS,
        _ if word.chapter == Chapter::Constants => CompletionItemKind::CONSTANT,
        _ => CompletionItemKind::FUNCTION,
    };
    let page = MarkupContent { kind: MarkupKind::Markdown, value: word.markdown() };
    CompletionItem {
        detail: Some(word.call.clone()),
        documentation: Some(Documentation::MarkupContent(page)),
        ..plain(&word.name, kind)
    }
}

fn plain(label: &str, kind: CompletionItemKind) -> CompletionItem {
    CompletionItem { label: label.to_owned(), kind: Some(kind), ..CompletionItem::default() }
}
