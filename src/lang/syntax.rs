//! What to say where an item stops being one: the token that does not fit, what would, and the slip that is
//! the likely cause. The grammar's own words are never shown.

use super::headers::header;
use super::keywords::{self, usage};
use super::scan::{Token, TokenKind, tokens};
use super::split::not_an_item;
use super::{habits, slips, span};
use crate::diag::{Diagnostic, shown};
use crate::source::{FileId, Span};

/// An item that the grammar refused at byte `stop` of `text`.
pub struct Refused<'a> {
    /// The text of the item.
    pub text: &'a str,
    /// The file.
    pub file: FileId,
    /// Where the item begins in the file.
    pub base: usize,
    /// How far the grammar came, from the item's start.
    pub stop: usize,
}

impl Refused<'_> {
    /// The error to show.
    pub fn explain(&self) -> Diagnostic {
        let all = tokens(self.text);
        let i = all.iter().position(|t| t.end() > self.stop).unwrap_or(all.len());
        let before = i.checked_sub(1).and_then(|j| all.get(j));
        let Some(found) = all.get(i) else {
            return self.ended(&all);
        };
        let scene = Slip { refused: self, all: &all, i, found, before, bracket: innermost(&all[..i]) };
        scene.explain()
    }

    pub(super) fn place(&self, token: &Token) -> Span {
        span(self.file, self.base + token.start()..self.base + token.end())
    }

    /// Whether the block that ends the item is that of an `if`, and no `else` has come.
    fn lacks_else(&self, all: &[Token]) -> bool {
        let mut depth = 0usize;
        let opening = (0..all.len()).rev().find(|j| {
            match all[*j].kind {
                TokenKind::Close => depth += 1,
                TokenKind::Open => depth -= 1,
                _ => {}
            }
            depth == 0
        });
        let before = &all[..opening.unwrap_or(0)];
        let last = before
            .iter()
            .rev()
            .map(|t| t.text(self.text))
            .find(|w| matches!(*w, "if" | "else" | "for" | "fn"));
        let is_else = before.last().is_some_and(|t| t.text(self.text) == "else");
        last == Some("if") && !is_else
    }

    fn ended(&self, all: &[Token]) -> Diagnostic {
        let Some(last) = all.last() else {
            return Diagnostic::error("E0101", "the text is empty")
                .at(span(self.file, self.base..self.base), "expected a value")
                .help("write a value");
        };
        let word = last.text(self.text);
        let at = span(self.file, self.base + last.end()..self.base + last.end());
        let item = all.first().map_or("", |t| t.text(self.text));
        if let Some(error) = header(item, all, all.len(), self, at) {
            return error;
        }
        if let [.., number, point] = all
            && number.kind == TokenKind::Number
            && word == "."
        {
            let [message, label, help] = slips::ends_with_point(number.text(self.text));
            return Diagnostic::error("E0101", message).at(self.place(point), label).help(help);
        }
        if word == "}" && self.lacks_else(all) {
            return Diagnostic::error("E0101", "an `if` without an `else` has no value")
                .at(at, "expected `else`")
                .help("write `if a { b } else { c }`; a list of nothing is `[]`");
        }
        let error = Diagnostic::error("E0101", format!("the item ends after `{word}`"));
        if last.ends_operand(self.text) {
            return error
                .at(at, "something is missing here")
                .help(format!("`{item}` needs more than this: {}", usage(item)));
        }
        error
            .at(at, format!("expected a value after `{word}`"))
            .help("write the missing value, or remove the sign")
    }
}

/// The innermost bracket left open.
fn innermost(before: &[Token]) -> Option<(&Token, usize)> {
    let mut open = Vec::new();
    for (i, token) in before.iter().enumerate() {
        match token.kind {
            TokenKind::Open => open.push((token, i)),
            TokenKind::Close => drop(open.pop()),
            _ => {}
        }
    }
    open.pop()
}

/// The place of a mistake and what stands around it.
pub(super) struct Slip<'a> {
    pub refused: &'a Refused<'a>,
    /// The tokens of the item.
    pub all: &'a [Token],
    /// The one that does not fit.
    pub i: usize,
    pub found: &'a Token,
    pub before: Option<&'a Token>,
    /// The innermost bracket that is open there, and its token.
    pub bracket: Option<(&'a Token, usize)>,
}

impl Slip<'_> {
    pub fn text(&self, token: &Token) -> &str {
        token.text(self.refused.text)
    }

    fn explain(&self) -> Diagnostic {
        let at = self.refused.place(self.found);
        let word = self.text(self.found);
        let item = self.text(&self.all[0]);
        if let Some(error) = header(item, self.all, self.i, self.refused, at) {
            return error;
        }
        if item == "@" && !self.all[..self.i].iter().any(|t| self.text(t) == "draw") {
            let error = Diagnostic::error("E0101", "an attribute stands before `draw`");
            let error = error.at(at, "expected `draw`").fix(Span { end: at.start, ..at }, "draw ");
            let attribute = self.all.get(1).map_or("only", |t| self.text(t));
            return error.help(format!("write `@{} draw shape`", shown(attribute)));
        }
        let after_value = self.before.is_some_and(|t| t.ends_operand(self.refused.text));
        if let Some(error) = self.named(word, after_value) {
            return error;
        }
        if self.bracket.is_none()
            && after_value
            && self.found.leads_line
            && self.found.kind == TokenKind::Word
        {
            return not_an_item(self.refused.text, self.all, self.i, at);
        }
        if after_value { self.after_value(word, at) } else { self.want_value(word, at) }
    }

    fn after_value(&self, word: &str, at: Span) -> Diagnostic {
        let shown = shown(word);
        let Some((open, _)) = self.bracket else {
            return Diagnostic::error("E0101", format!("`{shown}` does not fit after the value"))
                .at(at, "expected an operator or the end of the item")
                .help("if two values are meant, put an operator or a comma between them");
        };
        let (open_text, closing) = match self.text(open) {
            "(" => ("(", ")"),
            "[" => ("[", "]"),
            _ => ("{", "}"),
        };
        let error = Diagnostic::error("E0101", format!("expected `,` or `{closing}`, found `{shown}`"))
            .at(at, "does not fit here")
            .at(self.refused.place(open), format!("inside this `{open_text}`"));
        if self.found.begins_operand() {
            return error.help(format!("put a comma before `{shown}`"));
        }
        error.help(format!("remove `{shown}`, or close the bracket before it"))
    }

    fn want_value(&self, word: &str, at: Span) -> Diagnostic {
        let shown = shown(word);
        let after = self.before.map_or("", |t| self.text(t));
        let error = Diagnostic::error("E0101", format!("expected a value after `{after}`, found `{shown}`"))
            .at(at, "not a value");
        if let Some(help) = habits::instead(word, habits::Place::Item).filter(|_| after == "draw") {
            return error.help(help);
        }
        if after == "." {
            return error.help("after `.` stands the name of a method");
        }
        match word {
            "if" | "for" | "fn" | "not" => {
                error.help(format!("`{shown}` begins a value of its own: put parentheses around all of it"))
            }
            _ if keywords::is_keyword(word) => {
                error.help(format!("`{shown}` is a keyword: take another name"))
            }
            _ => error.help("a value is a number, a colour, a string, a list, a name or a call"),
        }
    }
}
