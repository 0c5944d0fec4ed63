//! Cuts a file into items, so that each is parsed alone and one mistake hides no other. What cannot be cut is
//! told here: brackets that do not match, strangers among the characters, nesting without end. What an item
//! says is left to `parse`.

use std::ops::Range;

use super::scan::{Token, TokenKind, tokens};
use super::{habits, span};
use crate::diag::{Diagnostic, nearest, shown};
use crate::source::{FileId, Span};

/// The words that begin an item.
pub const ITEM_WORDS: [&str; 12] = [
    "let", "fn", "param", "import", "material", "camera", "light", "render", "units", "draw", "print",
    "expect",
];

/// How deep brackets, signs and branches may nest together.
pub const MAX_NESTING: usize = 1000;

/// The items of a text and what stood in the way.
pub struct Cut {
    /// The items that are worth parsing.
    pub items: Vec<Sound>,
    /// Bytes of all items; each ends where the next begins.
    pub all: Vec<Range<usize>>,
    /// Whether it could be cut at all.
    pub whole: bool,
    /// What is wrong with the others.
    pub errors: Vec<Diagnostic>,
}

/// Cuts a text.
pub fn cut(text: &str, file: FileId) -> Cut {
    let tokens = tokens(text);
    let mut cutter = Cutter {
        text,
        file,
        tokens: &tokens,
        open: Vec::new(),
        item: None,
        in_attributes: false,
        out: Cut { items: Vec::new(), all: Vec::new(), whole: true, errors: Vec::new() },
    };
    for i in 0..tokens.len() {
        cutter.take(i);
    }
    cutter.finish();
    let mut out = cutter.out;
    if let Some(at) = too_deep(text, &tokens) {
        let told = format!("expressions nest deeper than {MAX_NESTING}");
        let error = Diagnostic::error("E0701", told)
            .at(span(file, at), "this is too deep")
            .help("name the inner parts with `let`, or list the operands, as in `union([a, b])`");
        out = Cut { items: Vec::new(), all: Vec::new(), whole: false, errors: vec![error] };
    }
    out
}

/// Whether a text is shallow enough to be parsed.
pub fn is_shallow(text: &str) -> bool {
    too_deep(text, &tokens(text)).is_none()
}

/// The item being collected.
struct Open {
    start: usize,
    sound: bool,
    /// Whether it begins with no word of an item.
    stray: bool,
    /// The first character of it that no scene holds.
    stranger: Option<Diagnostic>,
}

/// An item that is worth parsing.
pub struct Sound {
    /// Its bytes, up to its last token.
    pub range: Range<usize>,
    /// Which of all items it is.
    pub which: usize,
    /// The first character of it that no scene holds: to be told where the grammar comes so far.
    pub stranger: Option<Diagnostic>,
}

struct Cutter<'a> {
    text: &'a str,
    file: FileId,
    tokens: &'a [Token],
    /// Brackets that are open, as indices of tokens.
    open: Vec<usize>,
    item: Option<Open>,
    in_attributes: bool,
    out: Cut,
}

impl Cutter<'_> {
    fn take(&mut self, i: usize) {
        let begins = self.begins_item(i);
        if begins {
            if !self.open.is_empty() {
                self.unclosed(Some(i));
            }
            self.close_item(i);
            self.item = Some(Open { start: i, sound: true, stray: false, stranger: None });
        }
        if !begins && self.begins_stray(i) {
            self.close_item(i);
        }
        let is_at =
            |i: usize| self.tokens[i].kind == TokenKind::Sign && self.tokens[i].text(self.text) == "@";
        self.in_attributes =
            (begins || self.in_attributes) && is_at(i) || self.in_attributes && i > 0 && is_at(i - 1);
        let open = matches!(self.tokens[i].kind, TokenKind::OpenText | TokenKind::OpenComment);
        if self.item.is_none() && !open {
            self.no_item(i);
            self.item = Some(Open { start: i, sound: false, stray: true, stranger: None });
        }
        match self.tokens[i].kind {
            TokenKind::Open => self.open.push(i),
            TokenKind::Close => self.close_bracket(i),
            TokenKind::OpenText | TokenKind::OpenComment | TokenKind::Stranger => self.strange(i),
            _ => {}
        }
    }

    fn finish(&mut self) {
        if !self.open.is_empty() {
            self.unclosed(None);
        }
        self.close_item(self.tokens.len());
    }

    /// Whether an item begins at a token. Inside brackets only what can stand nowhere else does, so that one
    /// forgotten bracket costs one item.
    fn begins_item(&self, i: usize) -> bool {
        let token = &self.tokens[i];
        if !matches!(token.kind, TokenKind::Sign | TokenKind::Word) {
            return false;
        }
        let near = |j: Option<usize>| j.and_then(|j| self.tokens.get(j)).map(|t| (t.kind, t.text(self.text)));
        let (before, after) = (near(i.checked_sub(1)), near(Some(i + 1)));
        let word = token.text(self.text);
        if self.in_attributes || before.is_some_and(|(_, t)| t == "." || t == "@") {
            return false;
        }
        let starts = match token.kind {
            TokenKind::Sign => word == "@",
            TokenKind::Word if word == "fn" => after.is_some_and(|(k, _)| k == TokenKind::Word),
            TokenKind::Word => ITEM_WORDS.contains(&word),
            _ => false,
        };
        if before.is_some() && !token.leads_line && self.is_name(i) {
            return false;
        }
        let Some(innermost) = self.open.last() else {
            // What stands on the line of a `for` of another language is its body.
            let stray = self.item.as_ref().is_some_and(|item| item.stray);
            return starts && (token.leads_line || !stray);
        };
        let in_block = self.tokens[*innermost].text(self.text) == "{";
        starts && token.leads_line && after.is_none_or(|(_, t)| t != ":") && !(word == "let" && in_block)
    }

    /// Whether a word of an item is meant as a name, `let light = 3`, or as what other languages have in expressions,
    /// `print let(a = 3) a`.
    fn is_name(&self, i: usize) -> bool {
        let text = |j: usize| self.tokens.get(j).map_or("", |t| t.text(self.text));
        let named = self.item.as_ref().is_some_and(|item| item.start + 1 == i)
            && matches!(text(i - 1), "let" | "fn" | "param" | "material");
        named || text(i) == "let" && text(i + 1) == "("
    }

    /// Whether a statement of another language begins at a token, after one that is no item either.
    fn begins_stray(&self, i: usize) -> bool {
        let token = &self.tokens[i];
        let text = |j: usize| self.tokens.get(j).map_or("", |t| t.text(self.text));
        let ends = i > 0 && matches!(text(i - 1), ";" | "}");
        let gives = text(i + 1) == "=" && i > 0 && self.tokens[i - 1].ends_operand(self.text);
        self.item.as_ref().is_some_and(|item| item.stray)
            && self.open.is_empty()
            && token.leads_line
            && matches!(token.kind, TokenKind::Word | TokenKind::Sign)
            && !matches!(text(i), "else" | "}" | ";")
            && (ends || gives)
    }

    /// Ends the item before a token.
    fn close_item(&mut self, next: usize) {
        if let Some(item) = self.item.take() {
            let start = self.tokens[item.start].start();
            let end = self.tokens.get(next).map_or(self.text.len(), Token::start);
            if item.sound {
                // Blanks and comments that follow are no part of it.
                let last = next.checked_sub(1).map_or(end, |last| self.tokens[last].end());
                let which = self.out.all.len();
                self.out.items.push(Sound { range: start..last, which, stranger: item.stranger });
            }
            self.out.all.push(start..end);
        }
    }

    fn spoil(&mut self, error: Diagnostic) {
        if let Some(item) = &mut self.item
            && std::mem::take(&mut item.sound)
        {
            self.out.errors.push(error);
        }
    }

    fn place(&self, i: usize) -> Span {
        span(self.file, self.tokens[i].range())
    }

    fn close_bracket(&mut self, i: usize) {
        let closing = self.tokens[i].text(self.text);
        let Some(opening) = self.open.pop() else {
            let error = Diagnostic::error("E0102", format!("`{closing}` closes nothing"))
                .at(self.place(i), "no bracket is open here")
                .help("remove it, or open a bracket before");
            return self.spoil(error);
        };
        let opener = self.tokens[opening].text(self.text);
        let wanted = closing_of(opener);
        if closing != wanted {
            let error = Diagnostic::error("E0102", format!("`{closing}` does not close `{opener}`"))
                .at(self.place(i), format!("expected `{wanted}`"))
                .at(self.place(opening), "opened here")
                .help(format!("put `{wanted}` before `{closing}`"));
            self.spoil(error);
        }
    }

    /// The innermost open bracket has no partner: everything open is forgotten.
    fn unclosed(&mut self, before: Option<usize>) {
        let Some(opening) = self.open.last().copied() else { return };
        self.open.clear();
        let opener = self.tokens[opening].text(self.text);
        let wanted = closing_of(opener);
        let mut error = Diagnostic::error("E0102", format!("`{opener}` is not closed"))
            .at(self.place(opening), "opened here")
            .help(format!("add the missing `{wanted}`"));
        if let Some(i) = before {
            error = error.at(self.place(i), format!("expected `{wanted}` before this"));
        }
        self.spoil(error);
    }

    fn strange(&mut self, i: usize) {
        let error = stranger(self.text, &self.tokens[i], self.place(i));
        match &mut self.item {
            Some(item) if self.tokens[i].kind == TokenKind::Stranger => {
                item.stranger.get_or_insert(error);
            }
            Some(_) => self.spoil(error),
            None => self.out.errors.push(error),
        }
    }

    fn no_item(&mut self, i: usize) {
        let error = not_an_item(self.text, self.tokens, i, self.place(i));
        self.out.errors.push(error);
    }
}

fn closing_of(opener: &str) -> &'static str {
    match opener {
        "(" => ")",
        "[" => "]",
        _ => "}",
    }
}

/// Whether the parentheses that open at a token hold more than one thing.
fn holds_several(text: &str, tokens: &[Token], open: usize) -> bool {
    let mut depth = 0usize;
    for token in tokens.iter().skip(open) {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth = depth.saturating_sub(1),
            TokenKind::Sign if depth == 1 && token.text(text) == "," => return true,
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    false
}

/// The error that the token with a number stands where an item should begin.
pub fn not_an_item(text: &str, tokens: &[Token], i: usize, at: Span) -> Diagnostic {
    let word = tokens[i].text(text);
    let next = tokens.get(i + 1).map_or("", |t| t.text(text));
    let error = Diagnostic::error("E0106", format!("`{}` begins no item", shown(word)));
    let habit =
        if word.starts_with('#') && word.len() > 1 && habits::instead(word, habits::Place::Item).is_none() {
            "#"
        } else {
            word
        };
    // `x = 3` names a value, whatever the name is elsewhere.
    let names = next == "=" && habits::instead(habit, habits::Place::Item).is_none();
    if let Some(help) = habits::instead_of_item(habit).filter(|_| !names) {
        // `print` and `expect` take one value.
        let takes_one = matches!(word, "echo" | "assert");
        let fits = !(takes_one && holds_several(text, tokens, i + 1));
        // `union() { a b }` has its operands elsewhere.
        let empty = next == "(" && tokens.get(i + 2).is_some_and(|t| t.text(text) == ")");
        let same = habits::same(word, habits::Place::Item).filter(|_| fits && !empty && next != "{");
        return error.at(at, "not an item").fix_with(at, same).help(help);
    }
    if word == "fn" {
        return error.at(at, "a function without a name").help("write `fn name(a, b = 1) = value`");
    }
    match nearest(word, ITEM_WORDS) {
        _ if next == "=" => {
            let error = error.at(at, "not an item").fix(at, format!("let {word}"));
            error.help(format!("a name is given once, by `let {word} = ...`"))
        }
        Some(known) => error.at(at, "not a keyword").fix_slip(at, word, known).help(format!("did you mean `{known}`?")),
        None if next == "{" => error.at(at, "not an item").help(format!(
            "arguments stand in parentheses, with their names, and what is to be seen is drawn: `draw {word}(...)`"
        )),
        None if next == "(" => {
            let error = error.at(at, "not an item").fix(at, format!("draw {word}"));
            error.help(format!("what is to be seen is drawn: `draw {word}(...)`"))
        }
        None => error
            .at(at, "expected an item")
            .help(format!("an item begins with one of {}", ITEM_WORDS.map(|w| format!("`{w}`")).join(" "))),
    }
}

/// What stands instead of a `;` where nothing is needed: a blank if it keeps two words apart. None where what follows it
/// would be read as a part of what stands before.
fn without(text: &str, token: &Token) -> Option<&'static str> {
    let rest = &text[token.end()..];
    match rest.trim_start().chars().next() {
        None | Some('}' | '@' | ';' | '/') => Some(""),
        Some(c) if c.is_ascii_alphabetic() || c == '_' => {
            Some(if rest.starts_with(char::is_whitespace) { "" } else { " " })
        }
        // The lines of a `(` and a `[` are their own.
        Some('(' | '[') if rest[..rest.len() - rest.trim_start().len()].contains('\n') => Some(""),
        Some(_) => None,
    }
}

fn stranger(text: &str, token: &Token, at: Span) -> Diagnostic {
    match token.kind {
        TokenKind::OpenText => Diagnostic::error("E0104", "the string does not end")
            .at(at, "no closing `\"` on this line")
            .help("strings end on their line; a line break inside is written `\\n`"),
        TokenKind::OpenComment => Diagnostic::error("E0108", "the comment does not end")
            .at(Span { end: at.start + 2, ..at }, "opened here")
            .help("add the missing `*/`"),
        _ => {
            let found = token.text(text);
            let help = match found {
                "$" => "surfaces are exact: there is no `$fn`, and no number of facets to set",
                ";" => "items and expressions need nothing between them: remove it",
                "'" => "strings stand in double quotes",
                "µ" | "μ" => "micrometres are written `um`",
                "°" => "an angle has a unit of letters: `30deg`",
                "?" => "a choice is written `if a { b } else { c }`",
                _ if found.chars().all(char::is_alphabetic) => {
                    "names are made of ASCII letters, digits and `_`"
                }
                _ => "outside of strings and comments only ASCII letters, digits and signs are used",
            };
            let edit = match found {
                ";" => without(text, token),
                "°" if text[..token.start()].ends_with(|c: char| c.is_ascii_digit()) => Some("deg"),
                _ => None,
            };
            Diagnostic::error("E0103", format!("`{}` has no meaning here", found.escape_debug()))
                .at(at, "unexpected character")
                .fix_with(at, edit)
                .help(help)
        }
    }
}

/// Where the text nests too deep: open brackets, signs before operands, `**`, `else` and `=>` count alike.
fn too_deep(text: &str, tokens: &[Token]) -> Option<Range<usize>> {
    /// What one pair of brackets holds: signs last until the next operator, tails until the next comma.
    #[derive(Default)]
    struct Level {
        signs: usize,
        tails: usize,
    }
    let mut levels = vec![Level::default()];
    let mut total = 0;
    let mut after_operand = false;
    for token in tokens {
        if matches!(token.kind, TokenKind::Number | TokenKind::Text | TokenKind::Color) {
            after_operand = true;
            continue;
        }
        let word = token.text(text);
        let inside = levels.len() > 1;
        let top = levels.last_mut()?;
        match word {
            "(" | "[" | "{" => {
                levels.push(Level::default());
                total += 1;
            }
            ")" | "]" | "}" if inside => {
                total -= 1 + levels.pop().map_or(0, |l| l.signs + l.tails);
            }
            "!" | "not" | "**" => (top.signs, total) = (top.signs + 1, total + 1),
            "-" if !after_operand => (top.signs, total) = (top.signs + 1, total + 1),
            "=>" | "else" => (top.tails, total) = (top.tails + 1, total + 1),
            "," => {
                total -= top.signs + top.tails;
                *top = Level::default();
            }
            _ if token.kind == TokenKind::Word && ITEM_WORDS.contains(&word)
                || token.kind == TokenKind::Sign && word != "." =>
            {
                total -= std::mem::take(&mut top.signs);
            }
            _ => {}
        }
        after_operand = token.ends_operand(text);
        if total > MAX_NESTING {
            return Some(token.range());
        }
    }
    None
}
