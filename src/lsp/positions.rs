//! Bytes of a text as the lines and columns of editors, and back. Lines count from 0 and end at `\n`, `\r\n` or `\r`; columns
//! count the units that client and server agreed on.

use std::ops;

use lsp_types::{Position, PositionEncodingKind, Range};

/// What a column counts.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, of which a character outside the basic plane has two.
    #[default]
    Utf16,
}

impl Encoding {
    /// The first of those a client offers that is known; they stand in the order of its liking.
    pub fn chosen(offered: &[PositionEncodingKind]) -> Encoding {
        let known = |kind: &PositionEncodingKind| match kind.as_str() {
            "utf-8" => Some(Encoding::Utf8),
            "utf-16" => Some(Encoding::Utf16),
            _ => None,
        };
        offered.iter().find_map(known).unwrap_or_default()
    }

    /// Its name in the protocol.
    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
        }
    }

    fn length(self, c: char) -> usize {
        match self {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
        }
    }
}

/// The lines of a text.
pub struct Lines<'t> {
    text: &'t str,
    encoding: Encoding,
    /// Where each begins, bytes.
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    /// The lines of a text.
    pub fn new(text: &'t str, encoding: Encoding) -> Lines<'t> {
        let bytes = text.as_bytes();
        let ends = |i: &usize| bytes[*i] == b'\n' || bytes[*i] == b'\r' && bytes.get(i + 1) != Some(&b'\n');
        let starts = std::iter::once(0).chain((0..bytes.len()).filter(ends).map(|i| i + 1)).collect();
        Lines { text, encoding, starts }
    }

    /// Bytes of a line without its end.
    fn line(&self, line: usize) -> ops::Range<usize> {
        let start = self.starts[line];
        let next = self.starts.get(line + 1).copied().unwrap_or(self.text.len());
        let ended = line + 1 < self.starts.len();
        let kept = self.text[start..next].trim_end_matches(['\n', '\r']).len();
        start..if ended { start + kept } else { next }
    }

    /// The position of a byte; within a character it is that of the character, within the end of a line that of the end.
    pub fn position(&self, byte: usize) -> Position {
        let byte = byte.min(self.text.len());
        let line = self.starts.partition_point(|start| *start <= byte) - 1;
        let of = self.line(line);
        let chars = self.text[of.clone()].char_indices();
        let before = chars.take_while(|(i, c)| of.start + i + c.len_utf8() <= byte);
        let column: usize = before.map(|(_, c)| self.encoding.length(c)).sum();
        Position { line: line as u32, character: column as u32 }
    }

    /// The byte at a position; past the end of a line it is the end, past the last line that of the text, within a character
    /// the byte where it begins.
    pub fn byte(&self, position: Position) -> usize {
        let line = position.line as usize;
        if self.starts.len() <= line {
            return self.text.len();
        }
        let of = self.line(line);
        let mut left = position.character as usize;
        for (i, c) in self.text[of.clone()].char_indices() {
            if left < self.encoding.length(c) {
                return of.start + i;
            }
            left -= self.encoding.length(c);
        }
        of.end
    }

    /// The range of some bytes.
    pub fn range(&self, bytes: ops::Range<usize>) -> Range {
        Range { start: self.position(bytes.start), end: self.position(bytes.end) }
    }

    /// The range of the whole text.
    pub fn all(&self) -> Range {
        self.range(0..self.text.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_and_bytes_agree_whatever_the_characters_and_the_ends_of_lines() {
        for text in ["", "a", "ab\r\ncd", "ä\n\n😀x\r\n", "\ry\r", "😀😀\r\r\n é"] {
            for encoding in [Encoding::Utf8, Encoding::Utf16] {
                let lines = Lines::new(text, encoding);
                let within_end = |i: &usize| text[..*i].ends_with('\r') && text[*i..].starts_with('\n');
                for byte in (0..=text.len()).filter(|i| text.is_char_boundary(*i) && !within_end(i)) {
                    assert_eq!(lines.byte(lines.position(byte)), byte, "{text:?} {byte} {encoding:?}");
                }
            }
        }
    }

    #[test]
    fn columns_count_units_and_stay_within_their_line() {
        let at = |line, character| Position { line, character };
        let lines = Lines::new("😀ab\r\nc", Encoding::Utf16);
        assert_eq!(lines.position(5), at(0, 3));
        assert_eq!(
            [at(0, 1), at(0, 2), at(0, 99), at(1, 0), at(9, 9)].map(|p| lines.byte(p)),
            [0, 4, 6, 8, 9]
        );
        assert_eq!(Lines::new("😀ab", Encoding::Utf8).position(5), at(0, 5));
    }
}
