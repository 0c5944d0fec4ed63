//! What a word means: of the language its page, of a name the line that binds it.

use std::ops::Range;

use super::context::Callee;
use super::names::{Binding, Kind, Outline};
use super::view::{View, is_material};
use crate::lang::reference::Word;
use crate::lang::{TokenKind, unquoted};
use crate::source::Span;

/// The longest line shown, characters.
const MAX_LINE: usize = 200;

/// The page of the word at a byte, in Markdown, and the bytes of the word.
pub fn hover(view: &View, at: usize) -> Option<(String, Range<usize>)> {
    let outline = &view.outline;
    let i = outline.word_at(at)?;
    let word = outline.word(i);
    let page = if outline.is_type(i) {
        None
    } else if outline.before(i) == "." {
        after_point(view, i)
    } else if let Some(callee) = labelled(outline, i) {
        argument(view, callee, word)
    } else {
        plain(view, i)
    };
    page.map(|page| (page, outline.tokens[i].range()))
}

/// The call that a word is the label of an argument of.
pub fn labelled(outline: &Outline, word: usize) -> Option<Callee<'_>> {
    let open = outline.open_before(word).filter(|_| outline.word(word + 1) == ":")?;
    outline.callee(open).filter(|callee| *callee != Callee::Formals)
}

fn after_point(view: &View, i: usize) -> Option<String> {
    let word = view.outline.word(i);
    if let Some(space) = i.checked_sub(2).and_then(|i| view.outline.space_at(i)) {
        let (file, binding) = view.member(view.outline.name(space), word)?;
        return Some(bound(&file.outline, &binding));
    }
    pages(view.words(word, true))
}

fn plain(view: &View, i: usize) -> Option<String> {
    let (outline, word) = (&view.outline, view.outline.word(i));
    let at = outline.tokens[i].start();
    let label = outline.bindings.iter().find(|b| b.kind == Kind::Label && b.token == i);
    if let Some(binding) = label.or_else(|| outline.find(word, at)) {
        return Some(bound(outline, binding));
    }
    if let Some((file, binding)) = view.joined_name(word) {
        return Some(bound(&file.outline, &binding));
    }
    pages(view.words(word, false))
}

/// What an argument is, of whatever is called.
fn argument(view: &View, callee: Callee, name: &str) -> Option<String> {
    if let Some((outline, binding)) = function(view, callee) {
        let formal = outline.formals(&binding).into_iter().find(|b| outline.name(b) == name)?.clone();
        return Some(bound(&outline, &formal));
    }
    let mut rows = callees(view, callee).into_iter().flat_map(|word| &word.args);
    let [name, kind, doc] = rows.find(|row| row[0] == name)?;
    let sign = if doc.is_empty() { "" } else { ": " };
    Some(format!("`{name}`: {kind}{sign}{doc}"))
}

/// The function of a scene that is called, with the text it stands in.
pub fn function(view: &View, callee: Callee) -> Option<(Outline, Binding)> {
    match callee {
        Callee::Function(name) => {
            let own = view.outline.own(name).map(|binding| (view.outline.clone(), binding.clone()));
            own.or_else(|| view.joined_name(name).map(|(file, binding)| (file.outline, binding)))
        }
        Callee::Member(space, name) => {
            view.member(space, name).map(|(file, binding)| (file.outline, binding))
        }
        _ => None,
    }
}

/// The words of the language that are called: of a material all kinds.
pub fn callees<'v>(view: &View<'v>, callee: Callee) -> Vec<&'v Word> {
    match callee {
        Callee::Function(name) => view.words(name, false).collect(),
        Callee::Method(name) => view.words(name, true).collect(),
        Callee::Item("material") => view.words.iter().filter(|word| is_material(word)).collect(),
        Callee::Item(name) => view.words(name, false).collect(),
        Callee::Member(..) | Callee::Formals => Vec::new(),
    }
}

fn pages<'w>(words: impl Iterator<Item = &'w Word>) -> Option<String> {
    let page = |word: &Word| format!("```pss\n{}\n```\n{}", word.call, word.markdown().trim_end());
    let pages: Vec<String> = words.map(page).collect();
    (!pages.is_empty()).then(|| pages.join("\n\n---\n\n"))
}

/// The line that binds a name, and what a parameter of the scene may be.
fn bound(outline: &Outline, binding: &Binding) -> String {
    let line = format!("```pss\n{}\n```", line(&outline.text, binding.name.start));
    let more = if binding.kind == Kind::Param { parameter(outline, binding) } else { String::new() };
    line + &more
}

/// The line around a byte, without what is around its text.
pub fn line(text: &str, at: usize) -> String {
    let is_end = ['\n', '\r'];
    let start = text[..at].rfind(is_end).map_or(0, |i| i + 1);
    let end = text[at..].find(is_end).map_or(text.len(), |i| at + i);
    let whole = text[start..end].trim();
    match whole.char_indices().nth(MAX_LINE) {
        Some((cut, _)) => format!("{} ...", &whole[..cut]),
        None => whole.to_owned(),
    }
}

/// Type, range and description of a parameter.
fn parameter(outline: &Outline, binding: &Binding) -> String {
    let item = outline.items[binding.item].tokens.clone();
    let text = |tokens: Range<usize>| {
        let (first, last) = (&outline.tokens[tokens.start], &outline.tokens[tokens.end - 1]);
        &outline.text[first.start()..last.end()]
    };
    let mut end = item.end;
    let mut out = String::new();
    let typed = outline.word(binding.token + 1) == ":";
    let second = Some(binding.token + 2).filter(|i| *i < end);
    let kind = second.map_or("", |i| if typed { outline.word(i) } else { kind_of(outline, i) });
    if !kind.is_empty() {
        out += &format!("\n\n- type: {kind}");
    }
    let described = outline.tokens[end - 1].kind == TokenKind::Text
        && outline.tokens[end - 2].ends_operand(&outline.text);
    end -= usize::from(described);
    let allowed = (item.start..end).find(|i| outline.word(*i) == "in" && outline.depth(*i) == 0);
    if let Some(allowed) = allowed.filter(|i| i + 1 < end) {
        out += &format!("\n- allowed: `{}`", text(allowed + 1..end));
    }
    if described {
        out += &format!("\n- {}", unquoted(text(end..end + 1), Span::default()).unwrap_or_default());
    }
    out
}

/// The type of a parameter whose default begins with a token; empty where it takes more than a look.
fn kind_of(outline: &Outline, value: usize) -> &'static str {
    let Some(token) = outline.tokens.get(value) else { return "" };
    let word = token.text(&outline.text);
    match token.kind {
        TokenKind::Number if ["deg", "rad", "turn"].iter().any(|unit| word.ends_with(unit)) => "angle",
        TokenKind::Number => "number",
        TokenKind::Text => "string",
        TokenKind::Color => "color",
        TokenKind::Word if matches!(word, "true" | "false") => "bool",
        TokenKind::Open if word == "[" => "vector",
        _ => "",
    }
}
