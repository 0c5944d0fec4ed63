//! Slips that have a name: what other languages write here, and what is left out in a hurry. Each is told with its repair, and
//! with the edit that makes it where there is one.

use super::habits;
use super::keywords::is_keyword;
use super::scan::TokenKind;
use super::syntax::Slip;
use super::units;
use crate::diag::Diagnostic;
use crate::source::Span;

/// Message, label and help.
pub(super) fn told(message: impl Into<String>, label: &str, help: impl Into<String>) -> Option<[String; 3]> {
    Some([message.into(), label.to_owned(), help.into()])
}

/// What to say of a number that ends with its point.
pub fn ends_with_point(number: &str) -> [String; 3] {
    ["a number ends with its point".into(), "digits are missing".into(), format!("write `{number}.0`")]
}

const LOOP: &str = "a loop is a list already: `for i in 0..3 { value }`";
const TWO: &str = "a block has one value: two make a list, `[a, b]`, or a union, `a | b`";

impl Slip<'_> {
    /// The error, if the slip has a name.
    pub fn named(&self, word: &str, after_value: bool) -> Option<Diagnostic> {
        let all = [
            Slip::number,
            Slip::foreign,
            Slip::chosen,
            Slip::looped,
            Slip::comma,
            Slip::sign,
            Slip::brought,
            Slip::listed,
        ];
        let found = all.iter();
        let [message, label, help] = found.filter_map(|of| of(self, word, after_value)).next()?;
        let at = self.refused.place(self.found);
        let error = Diagnostic::error("E0101", message).at(at, label).help(help);
        let edit = self.foreign_edit(word, at, after_value).or_else(|| self.mending(word, at, after_value));
        Some(match edit {
            Some((span, text)) => error.fix(span, text),
            None => error,
        })
    }

    pub(super) fn before(&self) -> &str {
        self.before.map_or("", |t| self.text(t))
    }

    fn after_number(&self) -> bool {
        self.before.is_some_and(|t| t.kind == TokenKind::Number)
    }

    pub(super) fn opened_by(&self, bracket: &str) -> bool {
        self.bracket.is_some_and(|(open, _)| self.text(open) == bracket)
    }

    /// The edit that mends it, where there is one way and it means what was meant.
    fn mending(&self, word: &str, at: Span, after_value: bool) -> Option<(Span, String)> {
        let before = self.before.map(|token| self.refused.place(token));
        let next = self.all.get(self.i + 1);
        match word {
            "." if !after_value
                && self.before() != ".."
                && next.is_some_and(|t| t.kind == TokenKind::Number) =>
            {
                Some((Span { end: at.start, ..at }, "0".to_owned()))
            }
            "." if self.after_number() => Some((Span { start: at.end, ..at }, "0".to_owned())),
            _ if self.ends_in_a_point() => {
                Some((Span { start: before?.end, end: before?.end, ..at }, "0".to_owned()))
            }
            "=" if self.before() == ".." => None,
            "=" if after_value && self.labels() => Some((at, ":".to_owned())),
            "=" if after_value && self.is_asked() => Some((at, "==".to_owned())),
            "&" if self.before() == "&" && self.compares() => Some((before?.to(at), "and".to_owned())),
            "|" if self.before() == "|" && self.compares() => Some((before?.to(at), "or".to_owned())),
            // After a `%` it may be the sign of a sum.
            "+" if !after_value && self.before() != "%" && next.is_some_and(|t| t.begins_operand()) => {
                Some((at, String::new()))
            }
            // What follows may be read as part of what stands before.
            "," if self.opened_by("{") && next.is_some_and(|t| t.kind == TokenKind::Word) => {
                Some((at, " ".to_owned()))
            }
            _ if self.after_number() && units::names().any(|name| name == word) => {
                Some((Span { start: before?.end, end: at.start, ..at }, String::new()))
            }
            _ => None,
        }
    }

    /// Whether a `=` stands after the name of an argument: a word of its own in the parentheses of a call.
    fn labels(&self) -> bool {
        let token =
            |back: usize| self.i.checked_sub(back).and_then(|j| self.all.get(j)).map_or("", |t| self.text(t));
        let is_word = self.before.is_some_and(|t| t.kind == TokenKind::Word);
        let callee = self.bracket.and_then(|(_, j)| self.all.get(j.checked_sub(1)?));
        let called = callee.is_some_and(|t| t.ends_operand(self.refused.text));
        is_word
            && matches!(token(2), "(" | ",")
            && self.opened_by("(")
            && called
            && !self.opened_by_condition()
    }

    /// Whether what stands before is a condition: solids take other operators.
    fn compares(&self) -> bool {
        const SIGNS: [&str; 9] = ["==", "!=", "<", "<=", ">", ">=", "true", "false", "not"];
        let start = self.bracket.map_or(0, |(_, j)| j + 1);
        self.is_asked() || self.all[start..self.i].iter().any(|t| SIGNS.contains(&self.text(t)))
    }

    /// Whether a condition is wanted: in an expectation, or before the `{` of a choice.
    fn is_asked(&self) -> bool {
        let start = self.bracket.map_or(0, |(_, j)| j + 1);
        let promised = self.bracket.is_none() && self.all.first().is_some_and(|t| self.text(t) == "expect");
        promised || self.choosing(start)
    }

    /// Whether the token before is the point of a number that ends with it.
    fn ends_in_a_point(&self) -> bool {
        let number = self.i.checked_sub(2).and_then(|j| self.all.get(j));
        self.before() == "." && number.is_some_and(|t| t.kind == TokenKind::Number)
    }

    /// Numbers and their points, signs and units.
    fn number(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        let before = self.before();
        let next = self.all.get(self.i + 1);
        let digits = next.filter(|t| t.kind == TokenKind::Number && t.start() == self.found.end());
        match (word, digits) {
            (".", _) if before == ".." => told(
                "a range has two points",
                "one point too many",
                "write `1..5`: its end is left out, `1..6` is 1, 2, 3, 4, 5",
            ),
            (".", Some(digits)) if !after_value => {
                let help = format!("write `0.{}`", self.text(digits));
                told("a number begins with its point", "digits are missing", help)
            }
            (".", _) if self.after_number() => Some(ends_with_point(before)),
            _ if self.ends_in_a_point() => Some(ends_with_point(self.text(&self.all[self.i - 2]))),
            ("+", _) if !after_value && before == "%" => {
                told("percentages are not added", "expected the end", "write one: `within 2%`")
            }
            ("+", _) if !after_value => {
                told("`+` is no sign of a number", "expected a value", "remove the `+`")
            }
            (unit, _) if self.after_number() && units::names().any(|name| name == unit) => {
                told("a unit touches its number", "a space before it", format!("write `{before}{unit}`"))
            }
            _ => None,
        }
    }

    /// Loops without braces, with steps, or with ends of other languages.
    fn looped(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        let start = self.bracket.map_or(0, |(_, j)| j + 1);
        let loops = self.all[start..self.i].iter().any(|t| self.text(t) == "for");
        match word {
            "step" | "by" if after_value => told(
                "ranges have no steps",
                "does not fit here",
                "multiply in the loop: `for i in 0..4 { 10 * i }`",
            ),
            "=" if self.before() == ".." => told(
                "a range leaves its end out",
                "does not fit here",
                "write one more at the end: `0..4` is 0, 1, 2, 3",
            ),
            ":" if after_value && self.opened_by("[") => told(
                "`:` makes no range",
                "expected `,` or `]`",
                "a range is `0..5`, its end left out; steps are a loop: `for i in 0..5 { 0.5 * i }`",
            ),
            "(" if self.before() == "for" => told("a loop has no parentheses", "expected a name", LOOP),
            "{" => None,
            _ if after_value && word != "then" && self.choosing(start) => told(
                "the values of a choice stand in braces",
                "expected `{`",
                "write `if a { b } else { c }`",
            ),
            _ if loops && after_value => told("the value of a loop stands in braces", "expected `{`", LOOP),
            _ => None,
        }
    }

    /// Blocks: one without a value, and what follows that of an `if` or a `for`.
    fn chosen(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        let opens = self.bracket.filter(|_| word == "}" && after_value && self.opened_by("{"));
        if opens.is_some_and(|(_, j)| self.text(&self.all[j + 1]) == "let") {
            return told(
                "a block without a value",
                "expected a value",
                "a block ends with its value: `{ let a = 3  2 * a }`",
            );
        }
        // The grammar may give up at the end of the block, before what follows it.
        let i = self.i + usize::from(opens.is_some());
        let sign = self.all.get(i).filter(|t| t.kind == TokenKind::Sign).map(|t| self.text(t))?;
        if self.text(&self.all[i.checked_sub(1)?]) != "}" || matches!(sign, "," | ":" | "=") {
            return None;
        }
        let begins = self.value_begins(i)?;
        let (article, whole) = match begins {
            "for" => ("a", "(for i in 0..3 { i })"),
            _ => ("an", "(if a { b } else { c })"),
        };
        told(
            format!("`{sign}` follows the last block of {article} `{begins}`"),
            "the value ends here",
            format!("put parentheses around all of it: `{whole} {sign} d`"),
        )
    }

    /// The `if` or the `for` whose last block ends right before a token.
    fn value_begins(&self, i: usize) -> Option<&'static str> {
        let mut depth = 0usize;
        for j in (0..i).rev() {
            let token = &self.all[j];
            match (token.kind, self.text(token)) {
                (TokenKind::Close, _) => depth += 1,
                (TokenKind::Open, _) if depth == 0 => return None,
                (TokenKind::Open, _) => depth -= 1,
                (_, "if") if depth == 0 => return Some("if"),
                (_, "for") if depth == 0 => return Some("for"),
                (_, "=" | "draw" | "print" | "expect") if depth == 0 => return None,
                _ => {}
            }
        }
        None
    }

    /// Whether an `if` has not come to its `{` yet.
    fn choosing(&self, start: usize) -> bool {
        let before = &self.all[start..self.i];
        let last = before.iter().rposition(|t| matches!(self.text(t), "if" | "else" | "{"));
        last.is_some_and(|i| {
            self.text(&before[i]) == "if" || self.text(&before[i]) == "else" && i + 1 == before.len()
        })
    }

    /// A comma that does not fit.
    fn comma(&self, word: &str, _: bool) -> Option<[String; 3]> {
        if word != "," {
            return None;
        }
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
            Some((open, _)) if self.text(open) == "{" => {
                told("nothing stands between what a block holds", "remove it", TWO)
            }
            Some(_) => None,
        }
    }

    /// Signs of other languages.
    fn sign(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        match word {
            "=" if after_value => self.equals(),
            // C and its heirs.
            "&" | "|" if self.before() == word => {
                let meant = if word == "&" { "and" } else { "or" };
                let help = format!("solids take `{word}`, conditions `{meant}`");
                told(format!("`{word}{word}` is no operator"), "one sign too many", help)
            }
            "(" | "[" if after_value && self.found.leads_line => told(
                format!("`{word}` stands on a line of its own"),
                "what does it belong to?",
                format!("the `{word}` of a call or an index stands on the line of what it follows"),
            ),
            "<" if !after_value => {
                told("a vector stands in square brackets", "not a value", "write `[x, y, z]`")
            }
            _ => None,
        }
    }

    /// One `=` after a value.
    fn equals(&self) -> Option<[String; 3]> {
        if self.opened_by_condition() {
            return told(
                "a condition compares",
                "one `=` does not",
                "a solid is where a condition holds: `x**2 + y**2 <= 1`, `z < 60`",
            );
        }
        if self.labels() {
            let callee = self.bracket.and_then(|(_, j)| self.all.get(j.checked_sub(1)?));
            let habit = callee.and_then(|t| called(self.text(t)));
            let habit = habit.or_else(|| habits::instead(self.before(), habits::Place::Argument));
            let help = match habit {
                Some(help) => format!("arguments are named with a colon; {help}"),
                None => format!("an argument is named with a colon: `{}: value`", self.before()),
            };
            return told("`=` has no place in arguments", "expected `:`", help);
        }
        if self.is_asked() {
            return told("a condition compares by `==`", "one `=` does not", "write `a == b`");
        }
        told(
            "one `=` too many",
            "does not fit here",
            "a name is bound once, `let a = 3`; values are compared by `==`",
        )
    }

    /// Habits of other languages.
    fn brought(&self, word: &str, after_value: bool) -> Option<[String; 3]> {
        let next = self.all.get(self.i + 1).map_or("", |t| self.text(t));
        let is_word = self.found.kind == TokenKind::Word && !self.found.leads_line;
        match word {
            "then" => told("`then` is not needed", "expected `{`", "write `if a { b } else { c }`"),
            "=>" if after_value => told(
                "a function without a name begins with `fn`",
                "what are its parameters?",
                "write `fn(x) => value`",
            ),
            "{" if self.before() == ")" => told(
                "a call is not followed by `{`",
                "does not fit here",
                self.callee().and_then(called).unwrap_or(
                    "operands stand in a list: `difference(base, [a, b])`, or between signs: `base - a`",
                ),
            ),
            "{" if self.before.is_some_and(|t| t.kind == TokenKind::Word && !is_keyword(self.text(t))) => {
                told(
                    "a call has parentheses",
                    "does not fit here",
                    called(self.before()).map_or_else(
                        || {
                            format!(
                                "arguments stand in parentheses, with their names: `{}(...)`",
                                self.before()
                            )
                        },
                        str::to_owned,
                    ),
                )
            }
            _ if after_value && self.bracket.is_none() && next == ":" => {
                told("arguments stand in parentheses", "does not fit here", "write `sphere(r: 1)`")
            }
            _ if self.before() == ")"
                && is_word
                && next == "("
                && self.bracket.is_none()
                && self.callee().and_then(called).is_none() =>
            {
                told(
                    format!("`{word}` does not fit after the value"),
                    "expected an operator or the end of the item",
                    "every shape is drawn by itself, `draw a` and `draw b`, or as one: `draw a | b`",
                )
            }
            _ if self.before() == ")" && is_word => match (self.callee().and_then(called), self.bracket) {
                (Some(help), _) => told(
                    format!("`{word}` does not fit after the value"),
                    "expected an operator or the end of the item",
                    help,
                ),
                (None, None) => told(
                    format!("`{word}` does not fit after the value"),
                    "expected an operator or the end of the item",
                    "what changes a shape is written after it: `shape.move([x, y, z])`, `shape.with(material)`",
                ),
                (None, Some(_)) => None,
            },
            _ => None,
        }
    }

    /// Whether the bracket that is open is that of a call that takes a condition, and something else than a name stands before.
    fn opened_by_condition(&self) -> bool {
        let word = self.bracket.and_then(|(_, j)| self.all.get(j.checked_sub(1)?)).map(|t| self.text(t));
        matches!(word, Some("implicit" | "half_space")) && matches!(self.before(), "x" | "y" | "z")
            || matches!(word, Some("implicit")) && self.before.is_some_and(|t| t.kind == TokenKind::Number)
    }

    /// The word whose call ends right before.
    fn callee(&self) -> Option<&str> {
        let mut depth = 0usize;
        for j in (0..self.i).rev() {
            match self.all[j].kind {
                TokenKind::Close => depth += 1,
                TokenKind::Open if depth == 1 => return Some(self.text(self.all.get(j.checked_sub(1)?)?)),
                TokenKind::Open => depth -= 1,
                _ if depth == 0 => return None,
                _ => {}
            }
        }
        None
    }

    /// Two values where one is meant: the grammar gave up at the first, as what follows it is no part of it.
    fn listed(&self, _: &str, after_value: bool) -> Option<[String; 3]> {
        if after_value {
            let second = self.found.begins_operand() && self.opened_by("{");
            return if second { told("a second value in a block", "one too many", TWO) } else { None };
        }
        let comma = self.found.begins_operand() && self.comma_follows();
        match () {
            () if comma && self.opened_by("{") => told("a block of two values", "these", TWO),
            () if comma => told(
                "values with a comma between them and no list",
                "these",
                "a list stands in `[` and `]`: `[a, b]`",
            ),
            () => None,
        }
    }

    /// Whether a comma follows before the bracket that is open closes.
    fn comma_follows(&self) -> bool {
        let mut depth = 0usize;
        for token in &self.all[self.i..] {
            match token.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close if depth == 0 => return false,
                TokenKind::Close => depth -= 1,
                _ if depth <= usize::from(self.text(self.found) == "(") && self.text(token) == "," => {
                    return true;
                }
                _ => {}
            }
        }
        false
    }
}

/// What to write instead of a call of another language.
fn called(word: &str) -> Option<&'static str> {
    habits::instead(word, habits::Place::Item).or_else(|| habits::instead(word, habits::Place::Name))
}
