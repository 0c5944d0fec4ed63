//! The words and signs of a text, with strings and comments recognised: enough to cut a file into items, to
//! count how deep it nests and to say what stands at a place. What they mean together is left to the grammar.

use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum TokenKind {
    /// Letters, digits and `_`.
    Word,
    /// A number with whatever touches it.
    Number,
    /// `"..."`.
    Text,
    /// `#...`.
    Color,
    /// `(`, `[` or `{`.
    Open,
    /// `)`, `]` or `}`.
    Close,
    /// Any other sign.
    Sign,
    /// A string without its closing quote.
    OpenText,
    /// A comment without its `*/`.
    OpenComment,
    /// A character that no scene may hold here.
    Stranger,
}

/// A token and its bytes, which are told in 32 bits as those of a [`Span`](crate::source::Span): long scenes have millions.
#[derive(Clone, Copy, Debug)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Whether it is the first on its line.
    pub leads_line: bool,
    pub(super) start: u32,
    pub(super) end: u32,
}

impl Token {
    /// Where it begins, in bytes of the text.
    pub fn start(&self) -> usize {
        self.start as usize
    }

    /// Where it ends, in bytes of the text.
    pub fn end(&self) -> usize {
        self.end as usize
    }

    /// Its bytes in the text.
    pub fn range(&self) -> Range<usize> {
        self.start()..self.end()
    }

    /// Its characters.
    pub fn text<'a>(&self, text: &'a str) -> &'a str {
        &text[self.range()]
    }

    /// Whether an operand can end with it.
    pub fn ends_operand(&self, text: &str) -> bool {
        match self.kind {
            TokenKind::Word => !matches!(
                self.text(text),
                "or" | "and"
                    | "not"
                    | "in"
                    | "is"
                    | "within"
                    | "if"
                    | "else"
                    | "let"
                    | "draw"
                    | "print"
                    | "expect"
            ),
            TokenKind::Number | TokenKind::Text | TokenKind::Color | TokenKind::Close => true,
            _ => false,
        }
    }

    /// Whether an operand can begin with it.
    pub fn begins_operand(&self) -> bool {
        use TokenKind::{Color, Number, Open, Text, Word};
        matches!(self.kind, Word | Number | Text | Color | Open)
    }
}

/// All tokens of a text.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut out = Vec::new();
    let mut at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut leads_line = true;
    while let Some(c) = text[at..].chars().next() {
        if c.is_ascii_whitespace() && c != '\u{c}' {
            leads_line |= c == '\n';
            at += 1;
            continue;
        }
        let (kind, len) = token(&text[at..], c);
        if let Some(kind) = kind {
            out.push(Token { kind, leads_line, start: at as u32, end: (at + len) as u32 });
            leads_line = false;
        } else {
            leads_line |= text[at..at + len].contains('\n');
        }
        at += len;
    }
    out
}

/// The kind (`None` for a comment) and the bytes of the token that `rest` begins with.
fn token(rest: &str, c: char) -> (Option<TokenKind>, usize) {
    let run = |accept: fn(char) -> bool| rest.find(|c| !accept(c)).unwrap_or(rest.len());
    let is_letter: fn(char) -> bool = |c| c.is_ascii_alphanumeric() || c == '_';
    if rest.starts_with("//") {
        return (None, rest.find('\n').unwrap_or(rest.len()));
    }
    if let Some(comment) = rest.strip_prefix("/*") {
        return match comment.find("*/") {
            Some(end) => (None, end + 4),
            None => (Some(TokenKind::OpenComment), rest.len()),
        };
    }
    match c {
        '"' => text_token(rest),
        '#' => (Some(TokenKind::Color), 1 + rest[1..].find(|c| !is_letter(c)).unwrap_or(rest.len() - 1)),
        '(' | '[' | '{' => (Some(TokenKind::Open), 1),
        ')' | ']' | '}' => (Some(TokenKind::Close), 1),
        '0'..='9' => (Some(TokenKind::Number), number_len(rest)),
        _ if is_letter(c) => (Some(TokenKind::Word), run(is_letter)),
        _ if ",.:=<>!|&^+-*/%@~".contains(c) => (Some(TokenKind::Sign), sign_len(rest)),
        _ => (Some(TokenKind::Stranger), c.len_utf8()),
    }
}

fn sign_len(rest: &str) -> usize {
    const PAIRS: [&str; 8] = ["==", "!=", "<=", ">=", "..", "**", "=>", "~="];
    if PAIRS.iter().any(|p| rest.starts_with(p)) { 2 } else { 1 }
}

fn text_token(rest: &str) -> (Option<TokenKind>, usize) {
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        match c {
            '\n' => return (Some(TokenKind::OpenText), i),
            '"' if !escaped => return (Some(TokenKind::Text), i + 1),
            _ => escaped = c == '\\' && !escaped,
        }
    }
    (Some(TokenKind::OpenText), rest.len())
}

/// Digits, a fraction, an exponent and the letters that touch them.
fn number_len(rest: &str) -> usize {
    past(rest.as_bytes(), digits_len(rest), |b| b.is_ascii_alphanumeric() || *b == b'_')
}

/// Where the first byte stands, from `i` on, that is not accepted.
fn past(bytes: &[u8], mut i: usize, accept: fn(&u8) -> bool) -> usize {
    while bytes.get(i).is_some_and(accept) {
        i += 1;
    }
    i
}

/// Bytes of a number at the start of a text, without a unit: digits, a fraction, an exponent.
pub fn digits_len(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let is_digit: fn(&u8) -> bool = u8::is_ascii_digit;
    let mut end = past(bytes, 0, is_digit);
    if bytes.get(end) == Some(&b'.') && bytes.get(end + 1).is_some_and(is_digit) {
        end = past(bytes, end + 1, is_digit);
    }
    if bytes.get(end).is_some_and(|b| b.eq_ignore_ascii_case(&b'e')) {
        let sign = usize::from(bytes.get(end + 1).is_some_and(|b| b"+-".contains(b)));
        if bytes.get(end + 1 + sign).is_some_and(is_digit) {
            end = past(bytes, end + 1 + sign, is_digit);
        }
    }
    end
}
