//! What to say where an item stops being one: the token that does not fit, what would, and the slip that is
//! the likely cause. The grammar's own words are never shown.

use super::keywords::{self, usage};
use super::scan::{Token, TokenKind, tokens};
use super::split::{ITEM_WORDS, not_an_item};
use super::{span, units};
use crate::diag::Diagnostic;
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
        let i = all.iter().position(|t| t.range.end > self.stop).unwrap_or(all.len());
        let before = i.checked_sub(1).and_then(|j| all.get(j));
        let Some(found) = all.get(i) else {
            return self.ended(&all);
        };
        let scene = Slip { refused: self, all: &all, i, found, before, bracket: innermost(&all[..i]) };
        scene.explain()
    }

    fn place(&self, token: &Token) -> Span {
        span(self.file, self.base + token.range.start..self.base + token.range.end)
    }

    fn ended(&self, all: &[Token]) -> Diagnostic {
        let Some(last) = all.last() else {
            return Diagnostic::error("E0101", "the text is empty")
                .at(span(self.file, self.base..self.base), "expected a value")
                .help("write a value");
        };
        let word = last.text(self.text);
        let at = span(self.file, self.base + last.range.end..self.base + last.range.end);
        let item = all.first().map_or("", |t| t.text(self.text));
        if let Some(error) = header(item, all, all.len(), self, at) {
            return error;
        }
        if let [.., number, point] = all
            && number.kind == TokenKind::Number
            && word == "."
        {
            return Diagnostic::error("E0101", "a number ends with its point")
                .at(self.place(point), "digits are missing")
                .help(format!("write `{}.0`", number.text(self.text)));
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

/// Mistakes before the value of an item: its name, its `=`, its `(`.
fn header(item: &str, all: &[Token], i: usize, refused: &Refused, at: Span) -> Option<Diagnostic> {
    let found = all.get(i).map(|t| t.text(refused.text));
    let shown = found.map_or(String::new(), |f| format!(", found `{}`", f.escape_debug()));
    if i == 1 && matches!(item, "let" | "fn" | "param" | "material") {
        let error = Diagnostic::error("E0101", format!("expected a name after `{item}`{shown}"));
        let help = match found {
            Some(word) if keywords::is_keyword(word) => format!("`{word}` is a keyword: take another name"),
            _ => format!("write {}", usage(item)),
        };
        return Some(error.at(at, "not a name").help(help));
    }
    if i == 2 && matches!(item, "let" | "param") {
        return Some(
            Diagnostic::error("E0101", format!("expected `=` after the name{shown}"))
                .at(at, "expected `=`")
                .help(format!("write {}", usage(item))),
        );
    }
    let wants_arguments = matches!(
        (item, i),
        ("render" | "units" | "camera" | "light", 1) | ("material" | "camera" | "light", 2)
    );
    if wants_arguments {
        return Some(
            Diagnostic::error("E0101", format!("expected `(` after `{item}`{shown}"))
                .at(at, "expected `(`")
                .help(format!("write {}", usage(item))),
        );
    }
    None
}

/// The place of a mistake and what stands around it.
struct Slip<'a> {
    refused: &'a Refused<'a>,
    all: &'a [Token],
    i: usize,
    found: &'a Token,
    before: Option<&'a Token>,
    bracket: Option<(&'a Token, usize)>,
}

impl Slip<'_> {
    fn text(&self, token: &Token) -> &str {
        token.text(self.refused.text)
    }

    fn explain(&self) -> Diagnostic {
        let at = self.refused.place(self.found);
        let word = self.text(self.found);
        let item = self.text(&self.all[0]);
        if let Some(error) = header(item, self.all, self.i, self.refused, at) {
            return error;
        }
        let after_value = self.before.is_some_and(|t| t.ends_operand(self.refused.text));
        if let Some((message, label, help)) = self.common(word, after_value) {
            return Diagnostic::error("E0101", message).at(at, label).help(help);
        }
        if self.bracket.is_none()
            && after_value
            && self.found.leads_line
            && self.found.kind == TokenKind::Word
        {
            let next = self.all.get(self.i + 1).map_or("", |t| self.text(t));
            return not_an_item(word, next, at);
        }
        if after_value { self.after_value(word, at) } else { self.want_value(word, at) }
    }

    /// Slips that have a name: message, label and help.
    fn common(&self, word: &str, after_value: bool) -> Option<(String, String, String)> {
        let before = self.before.map_or("", |t| self.text(t));
        let next = self.all.get(self.i + 1);
        let number_next =
            next.filter(|t| t.kind == TokenKind::Number && t.range.start == self.found.range.end);
        let told = |a: String, b: &str, c: String| Some((a, b.to_owned(), c));
        match word {
            "." if !after_value && number_next.is_some() => {
                let digits = next.map_or("", |t| self.text(t));
                told(
                    "a number begins with its point".into(),
                    "digits are missing",
                    format!("write `0.{digits}`"),
                )
            }
            "." if self.before.is_some_and(|t| t.kind == TokenKind::Number) => told(
                "a number ends with its point".into(),
                "digits are missing",
                format!("write `{before}.0`"),
            ),
            "=" if self.bracket.is_some() && after_value => told(
                "`=` has no place in arguments".into(),
                "expected `:`",
                format!("an argument is named with a colon: `{before}: value`"),
            ),
            "&" | "|" if before == word => {
                let meant = if word == "&" { "and" } else { "or" };
                told(
                    format!("`{word}{word}` is no operator"),
                    "one sign too many",
                    format!("solids take `{word}`, conditions `{meant}`"),
                )
            }
            "+" if !after_value => {
                told("`+` is no sign of a number".into(), "expected a value", "remove the `+`".into())
            }
            "(" | "[" if after_value && self.found.leads_line => told(
                format!("`{word}` stands on a line of its own"),
                "what does it belong to?",
                format!("the `{word}` of a call or an index stands on the line of what it follows"),
            ),
            "," => self.comma(),
            _ => self.brought(word, before, after_value),
        }
    }

    /// Habits of other languages.
    fn brought(&self, word: &str, before: &str, after_value: bool) -> Option<(String, String, String)> {
        let told = |a: String, b: &str, c: String| Some((a, b.to_owned(), c));
        let number = self.before.is_some_and(|t| t.kind == TokenKind::Number);
        let in_list = self.bracket.is_some_and(|(open, _)| self.text(open) == "[");
        match word {
            unit if number && units::names().any(|name| name == unit) => told(
                "a unit touches its number".into(),
                "a space before it",
                format!("write `{before}{unit}`"),
            ),
            "then" => told("`then` is not needed".into(), "expected `{`", "write `if a { b } else { c }`".into()),
            "=>" if after_value => told(
                "a function without a name begins with `fn`".into(),
                "what are its parameters?",
                "write `fn(x) => value`".into(),
            ),
            ":" if in_list && after_value => told(
                "`:` makes no range".into(),
                "expected `,` or `]`",
                "a range is `0..5`, its end left out; steps are a loop: `for i in 0..5 { 0.5 * i }`".into(),
            ),
            "{" if before == ")" => told(
                "a call is not followed by `{`".into(),
                "does not fit here",
                "operands stand in a list: `difference(base, [a, b])`, or between signs: `base - a`".into(),
            ),
            "<" if !after_value => told(
                "a vector stands in square brackets".into(),
                "not a value",
                "write `[x, y, z]`".into(),
            ),
            "=" if after_value && self.bracket.is_none() => told(
                "one `=` too many".into(),
                "does not fit here",
                "a name is bound once, `let a = 3`; values are compared by `==`".into(),
            ),
            _ if after_value
                && self.bracket.is_none()
                && self.all.get(self.i + 1).is_some_and(|t| self.text(t) == ":") => told(
                "arguments stand in parentheses".into(),
                "does not fit here",
                "write `sphere(r: 1)`".into(),
            ),
            _ if before == ")" && self.found.kind == TokenKind::Word && !self.found.leads_line && self.bracket.is_none() => {
                told(
                    format!("`{word}` does not fit after the value"),
                    "expected an operator or the end of the item",
                    "what changes a shape is written after it: `shape.move([x, y, z])`, `shape.with(material)`".into(),
                )
            }
            _ => None,
        }
    }

    /// A comma that does not fit.
    fn comma(&self) -> Option<(String, String, String)> {
        let told = |a: &str, b: &str, c: &str| Some((a.to_owned(), b.to_owned(), c.to_owned()));
        match self.bracket {
            None => {
                told("a comma outside of brackets", "nothing is listed here", "lists stand in `[` and `]`")
            }
            Some((open, j))
                if self.text(open) == "[" && j > 0 && self.all[j - 1].ends_operand(self.refused.text) =>
            {
                told(
                    "an index is one number",
                    "a second one",
                    "if a list is meant, put a comma before its `[`",
                )
            }
            Some((open, _)) if self.text(open) == "(" => told(
                "a value is missing before `,`",
                "or is a list meant?",
                "lists stand in `[` and `]`: `[1, 2, 3]`",
            ),
            Some(_) => None,
        }
    }

    fn after_value(&self, word: &str, at: Span) -> Diagnostic {
        let shown = word.escape_debug();
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
        let shown = word.escape_debug();
        let after = self.before.map_or("", |t| self.text(t));
        let error = Diagnostic::error("E0101", format!("expected a value after `{after}`, found `{shown}`"))
            .at(at, "not a value");
        if after == "." {
            return error.help("after `.` stands the name of a method");
        }
        if keywords::is_keyword(word) && !ITEM_WORDS.contains(&word) {
            return error.help(format!(
                "`{shown}` is a keyword; to use it inside a value, put parentheses around it"
            ));
        }
        error.help("a value is a number, a colour, a string, a list, a name or a call")
    }
}
