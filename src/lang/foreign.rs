//! Words and signs inside of values that other languages have: told with what is written here.

use super::builtins;
use super::keywords::is_keyword;
use super::scan::TokenKind;
use super::slips::told;
use super::syntax::Slip;
use crate::source::Span;

/// Operators of other languages that are words, and ours.
const WORDS: &[(&[&str], &str)] = &[
    (&["mod", "MOD", "rem"], "%"),
    (&["div", "DIV"], "/"),
    (&["pow"], "**"),
    (&["AND", "And"], "and"),
    (&["OR", "Or"], "or"),
    (&["eq"], "=="),
    (&["ne"], "!="),
];

/// Ways to write `else if`.
const ELSE_IF: [&str; 4] = ["elif", "elsif", "elseif", "elsewhen"];

fn operator(word: &str) -> Option<&'static str> {
    WORDS.iter().find(|(words, _)| words.contains(&word)).map(|(_, ours)| *ours)
}

impl Slip<'_> {
    /// The message, if the token is of another language.
    pub(super) fn foreign(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        self.foreign_word(word, after_value).or_else(|| self.foreign_sign(word, after_value))
    }

    fn foreign_word(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        if self.found.leads_line && !ELSE_IF.contains(&word) {
            return None;
        }
        match word {
            _ if ELSE_IF.contains(&word) && self.before() == "}" => told(
                format!("`{word}` is written `else if`"),
                "does not fit here",
                "write `if a { b } else if c { d } else { e }`",
            ),
            "let" if !after_value => {
                told("`let` stands in a block", "not a value", "write `{ let a = 3  a + 1 }`")
            }
            "if" if after_value && self.before() != "}" => {
                told("a choice begins with its `if`", "does not fit here", "write `if a { b } else { c }`")
            }
            _ if after_value && operator(word).is_some() => {
                let ours = operator(word)?;
                told(
                    format!("`{word}` is written `{ours}`"),
                    "does not fit here",
                    format!("write `a {ours} b`"),
                )
            }
            _ if self.calls_without_brackets() => {
                let called = self.before();
                let unit = if matches!(called, "sin" | "cos" | "tan") && word.parse::<f64>().is_ok() {
                    "deg"
                } else {
                    ""
                };
                told("a call has parentheses", "does not fit here", format!("write `{called}({word}{unit})`"))
            }
            _ => None,
        }
    }

    /// Whether the token is a value right after the name of a function.
    fn calls_without_brackets(&self) -> bool {
        let before = self.before.filter(|t| t.kind == TokenKind::Word).map_or("", |t| self.text(t));
        let is_value = matches!(self.found.kind, TokenKind::Number | TokenKind::Text)
            || self.found.kind == TokenKind::Word && !is_keyword(self.text(self.found));
        is_value && builtins::functions().any(|b| b.name == before)
    }

    fn foreign_sign(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        match word {
            ">" if !after_value && self.before() == "<" => {
                told("`<>` is written `!=`", "does not fit here", "write `a != b`")
            }
            "=" if self.names_of_loop() => {
                told("a loop takes its values by `in`", "expected `in`", "write `for i in 0..3 { value }`")
            }
            "," if self.names_of_loop() => told(
                "each name of a loop has values of its own",
                "expected `in`",
                "write `for i in 0..3, j in 0..3 { value }`",
            ),
            ":" if after_value && self.bracket.is_none() && self.text(&self.all[0]) == "param" => told(
                "`:` makes no range",
                "expected `..`",
                "write `param a = 5 in 1..10`: both ends are allowed",
            ),
            ":" if after_value
                && self.opened_by("{")
                && self.bracket.is_some_and(|(_, j)| j + 2 == self.i) =>
            {
                told(
                    "a block is no record",
                    "does not fit here",
                    "values are named one by one, `let a = 1`; a vector has parts: `let v = [1, 2]`, `v.x`",
                )
            }
            _ => None,
        }
    }

    /// Whether the name before is one of a `for` that waits for its `in`.
    fn names_of_loop(&self) -> bool {
        let named = self.before.is_some_and(|t| t.kind == TokenKind::Word);
        let text =
            |back: usize| self.i.checked_sub(back).and_then(|j| self.all.get(j)).map_or("", |t| self.text(t));
        named && text(2) == "for"
    }

    /// The edit that mends it.
    pub(super) fn foreign_edit(&self, word: &str, at: Span, after_value: bool) -> Option<(Span, String)> {
        let before = self.before.map(|token| self.refused.place(token));
        self.foreign(word, after_value)?;
        match word {
            _ if ELSE_IF.contains(&word) => Some((at, "else if".to_owned())),
            ">" => Some((before?.to(at), "!=".to_owned())),
            "=" => Some((at, "in".to_owned())),
            ":" if self.bracket.is_none() => Some((at, "..".to_owned())),
            _ => operator(word).filter(|_| after_value).map(|ours| (at, ours.to_owned())),
        }
    }
}
