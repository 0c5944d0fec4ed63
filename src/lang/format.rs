//! The house style of scene files: `pss fmt`. Words, signs and comments stay as they are and in their order; what changes is
//! the space between them. Lines are broken where the writer broke them, and before each item.
//!
//! A line is indented by four spaces for each line that has opened brackets around it, and once more where it goes on with
//! the line above. At most one empty line in a row is kept.

use super::scan::{Token, TokenKind, tokens};
use super::split::{self, ITEM_WORDS};
use crate::source::FileId;

/// One step of indentation.
const STEP: &str = "    ";

/// A text in the house style; the text must hold items only, as it does where it can be parsed.
pub fn format(text: &str, file: FileId) -> String {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let begins: Vec<usize> = split::cut(text, file).items.iter().map(|item| item.range.start).collect();
    let mut writer = Writer {
        text,
        out: String::new(),
        open: Vec::new(),
        line: [0; 2],
        opened: false,
        fresh: true,
        begun: false,
    };
    let all = tokens(text);
    let mut end = 0;
    for (i, token) in all.iter().enumerate() {
        let begins_item = begins.binary_search(&token.start()).is_ok();
        let before = i.checked_sub(1).map(|i| &all[i]);
        let second = i.checked_sub(2).map(|i| &all[i]);
        writer.gap(&text[end..token.start()], begins_item, token);
        let space = before.is_some_and(|before| is_spaced(text, second, before, token, all.get(i + 1)));
        let run = all[i..].iter().take_while(|t| t.kind == TokenKind::Close);
        let closers = run.enumerate().take_while(|(k, t)| *k == 0 || !t.leads_line).count();
        writer.token(token, space, begins_item, closers);
        end = token.end();
    }
    writer.rest(&text[end..]);
    writer.out
}

struct Writer<'t> {
    text: &'t str,
    out: String,
    /// For each open bracket, where its line begins in `out`; of those of one line the first indents.
    open: Vec<usize>,
    /// Where the last line begins in `out`, and up to where it was looked for: a line may have a million brackets.
    line: [usize; 2],
    /// Whether the last word was a bracket that opens.
    opened: bool,
    /// Whether nothing stands on the line yet.
    fresh: bool,
    /// Whether the item has a line above this one.
    begun: bool,
}

impl Writer<'_> {
    /// Comments and ends of lines before a token.
    fn gap(&mut self, gap: &str, begins_item: bool, next: &Token) {
        let (mut lines, mut rest) = (0, gap);
        while let Some(at) = rest.find(['\n', '/']) {
            let found = &rest[at..];
            if let Some(after) = found.strip_prefix('\n') {
                lines += 1;
                rest = after;
                continue;
            }
            let line = found.starts_with("//");
            let length = match line {
                true => found.find('\n').unwrap_or(found.len()),
                false => {
                    found.get(2..).and_then(|inside| inside.find("*/")).map_or(found.len(), |end| end + 4)
                }
            };
            self.breaks(lines, false);
            self.comment(found[..length].trim_end(), begins_item);
            rest = &found[length..];
            lines = 0;
            if line {
                // The end of its line belongs to it.
                rest = rest.strip_prefix('\n').unwrap_or(rest);
                self.newline();
                lines = usize::from(rest.trim_start_matches([' ', '\t', '\r']).starts_with('\n'));
                self.blank_if(lines);
                lines = 0;
            }
        }
        let closes = next.kind == TokenKind::Close;
        self.breaks(lines, begins_item);
        if closes && self.out.ends_with("\n\n") {
            self.out.pop();
        }
    }

    /// Ends the line if one was ended here, or must be.
    fn breaks(&mut self, lines: usize, must: bool) {
        if self.out.is_empty() {
            return;
        }
        if 0 < lines || must {
            self.newline();
        }
        if 1 < lines {
            self.blank_if(1);
        }
    }

    fn newline(&mut self) {
        if !self.fresh {
            self.out.push('\n');
            self.fresh = true;
        }
    }

    fn blank_if(&mut self, lines: usize) {
        if 0 < lines && !self.out.is_empty() && !self.out.ends_with("\n\n") && !self.opened {
            self.newline();
            self.out.push('\n');
        }
    }

    fn comment(&mut self, comment: &str, outside: bool) {
        if self.fresh {
            self.indent(outside || self.open.is_empty() && !self.begun);
        } else {
            self.out.push(' ');
        }
        self.out.push_str(&comment.replace('\r', ""));
        self.opened = false;
        self.fresh = false;
    }

    fn indent(&mut self, outside: bool) {
        let depth = self.open.chunk_by(|a, b| a == b).count();
        let onward = usize::from(self.open.is_empty() && !outside);
        (0..depth + onward).for_each(|_| self.out.push_str(STEP));
        self.fresh = false;
    }

    /// The next token; `closers` brackets close in a row from there on its line.
    fn token(&mut self, token: &Token, space: bool, begins_item: bool, closers: usize) {
        if begins_item {
            self.begun = false;
        }
        if token.kind == TokenKind::Close {
            self.open.pop();
        }
        if self.fresh {
            // A line that begins with brackets that close stands as the line that opened the last of them.
            let kept = self.open.len().saturating_sub(closers.saturating_sub(1));
            let inner = self.open.split_off(kept);
            self.indent(begins_item || 0 < closers);
            self.open.extend(inner);
        } else if space {
            self.out.push(' ');
        }
        self.out.push_str(token.text(self.text));
        self.begun = true;
        self.opened = token.kind == TokenKind::Open;
        if self.opened {
            let [begins, seen] = self.line;
            let begins = self.out[seen..].rfind('\n').map_or(begins, |at| seen + at + 1);
            self.line = [begins, self.out.len()];
            self.open.push(begins);
        }
        self.fresh = false;
    }

    /// Comments after the last token.
    fn rest(&mut self, gap: &str) {
        self.begun = false;
        let end = Token { kind: TokenKind::Sign, start: 0, end: 0, leads_line: true };
        self.gap(gap, true, &end);
        let length = self.out.trim_end().len();
        self.out.truncate(length);
        if !self.out.is_empty() {
            self.out.push('\n');
        }
    }
}

/// Whether a space stands between two tokens on one line.
fn is_spaced(
    text: &str,
    second: Option<&Token>,
    before: &Token,
    token: &Token,
    next: Option<&Token>,
) -> bool {
    let (a, b) = (before.text(text), token.text(text));
    let is_sign = |second: Option<&Token>, sign: &Token| {
        // A sign is one of an operand where no operand ends before it.
        ["-", "!"].contains(&sign.text(text))
            && !second.is_some_and(|s| s.ends_operand(text) && !begins_only(s.text(text)))
    };
    match (a, b) {
        ("{", "}") | ("(", _) | ("[", _) | (_, ")" | "]" | "," | ":") | (".", _) | ("@", _) => false,
        ("{", _) | (_, "}" | "{") => true,
        ("..", _) | (_, "..") => false,
        (_, ".") => false,
        ("," | ":", _) => true,
        (_, "(") => {
            begins_only(a) && a != "fn"
                || !before.ends_operand(text) && before.kind == TokenKind::Sign && !is_sign(second, before)
        }
        (_, "[") => begins_only(a) || before.kind == TokenKind::Sign && !is_sign(second, before),
        (_, "%") => {
            next.is_some_and(|n| n.begins_operand() && !n.leads_line && !ITEM_WORDS.contains(&n.text(text)))
        }
        ("-" | "!", _) if is_sign(second, before) => false,
        _ => true,
    }
}

/// Keywords after which an operand begins.
fn begins_only(word: &str) -> bool {
    const WORDS: [&str; 16] = [
        "let", "draw", "print", "expect", "in", "is", "within", "if", "else", "and", "or", "not", "import",
        "as", "fn", "for",
    ];
    WORDS.contains(&word)
}
