//! Mistakes before the value of an item: in its name, its parameters, its `=` or its `(`.

use super::keywords::{self, usage};
use super::scan::{Token, TokenKind};
use super::syntax::Refused;
use crate::diag::{Diagnostic, shown};
use crate::source::Span;

/// An item, and the token where the grammar gave up.
struct Header<'a> {
    item: &'a str,
    all: &'a [Token],
    i: usize,
    refused: &'a Refused<'a>,
    at: Span,
    /// What was found, for messages.
    shown: String,
}

/// The error, where the item's value has not begun.
pub fn header(item: &str, all: &[Token], i: usize, refused: &Refused, at: Span) -> Option<Diagnostic> {
    let found = all.get(i).map(|t| t.text(refused.text));
    let shown = found.map_or(String::new(), |f| format!(", found `{}`", shown(f)));
    let header = Header { item, all, i, refused, at, shown };
    header.name(found).or_else(|| header.function(found)).or_else(|| header.rest())
}

impl Header<'_> {
    fn text(&self, j: usize) -> &str {
        self.all.get(j).map_or("", |t| t.text(self.refused.text))
    }

    fn error(&self, message: String, label: &str) -> Diagnostic {
        Diagnostic::error("E0101", message).at(self.at, label)
    }

    /// The place from here to the token after it.
    fn with_next(&self) -> Span {
        self.all.get(self.i + 1).map_or(self.at, |next| self.at.to(self.refused.place(next)))
    }

    /// The name, and what follows it.
    fn name(&self, found: Option<&str>) -> Option<Diagnostic> {
        let Header { item, i, shown, .. } = self;
        if *i == 1 && matches!(*item, "let" | "fn" | "param" | "material") {
            let error = self.error(format!("expected a name after `{item}`{shown}"), "not a name");
            return Some(match found {
                Some(word) if keywords::is_keyword(word) => {
                    error.help(format!("`{word}` is a keyword: take another name"))
                }
                _ => error.help(format!("write {}", usage(item))),
            });
        }
        if *i != 2 || !matches!(*item, "let" | "param") {
            return None;
        }
        let next = self.text(i + 1);
        let error = self.error(format!("expected `=` after the name{shown}"), "expected `=`");
        Some(match (found, next) {
            (Some("-"), _) if self.all.get(i + 1).is_some_and(|t| t.kind == TokenKind::Word) => {
                let joined = format!("{}_{next}", self.text(1));
                error.help(format!("names are made of letters, digits and `_`: `{joined}`"))
            }
            (Some(":"), "=") => error.fix(self.with_next(), "=").help(format!("write {}", usage(item))),
            (Some(":"), _) if *item == "let" => {
                error.help("a name has the type of its value: `let name = value`; only parameters are typed")
            }
            _ => error.help(format!("write {}", usage(item))),
        })
    }

    /// The parameters of a function, and its `=`.
    fn function(&self, found: Option<&str>) -> Option<Diagnostic> {
        let signed = self.all[..self.i].iter().any(|t| t.text(self.refused.text) == "=");
        let closed = self.i.checked_sub(1).is_some_and(|j| self.text(j) == ")");
        if self.item != "fn" {
            return None;
        }
        if self.i == 2 {
            let error = self.error(format!("expected `(` after the name{}", self.shown), "expected `(`");
            return Some(error.help("write `fn f(x) = value`; without parameters, `fn f() = value`"));
        }
        let error = self.error("a function has `=` before its value".into(), "expected `=`");
        match found {
            Some("{") if !signed => {
                let error = error.fix(Span { end: self.at.start, ..self.at }, "= ");
                Some(error.help("write `fn f(x) = { ... }`"))
            }
            Some("=>") if !signed && closed => Some(error.fix(self.at, "=").help("write `fn f(x) = value`")),
            Some(":") if !signed && closed => {
                Some(error.help("what a function gives has no type: `fn f(x: number) = value`"))
            }
            _ => None,
        }
    }

    /// File names, units and arguments.
    fn rest(&self) -> Option<Diagnostic> {
        let Header { item, i, shown, .. } = self;
        let error = match (*item, *i) {
            ("import", 1) if self.all.get(1).is_some_and(|t| t.kind != TokenKind::Text) => {
                self.error("the name of a file stands in quotes".into(), "expected `\"`")
            }
            ("units", 2) => self.error(format!("expected a unit of length{shown}"), "not a unit"),
            ("render" | "units" | "camera" | "light", 1) | ("material" | "camera" | "light", 2) => {
                self.error(format!("expected `(` after `{item}`{shown}"), "expected `(`")
            }
            _ => return None,
        };
        Some(error.help(format!("write {}", usage(item))))
    }
}
