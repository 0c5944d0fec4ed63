//! Source texts and places in them. Everything a user wrote keeps its [`Span`], so that every later
//! complaint can point at it; who prints the complaint is not known here.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// Which text of a [`SourceMap`] a [`Span`] lies in.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default, PartialOrd, Ord, Serialize, Deserialize)]
pub struct FileId(pub u32);

/// A half-open range of bytes of one source text.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Span {
    /// The text.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The smallest span that holds both; both lie in one file.
    pub fn to(self, other: Span) -> Span {
        Span { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// One source text.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// The name shown to the user.
    pub name: String,
    /// Where it was read from; `None` for standard input and for texts that a program made.
    pub path: Option<PathBuf>,
    /// The whole text.
    pub text: String,
}

/// A line and a column, both from 1; columns count characters, not bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LineColumn {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, in characters.
    pub column: usize,
}

/// All texts read in one run.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

impl SourceMap {
    /// Adds a text and returns its name for spans.
    pub fn add(&mut self, name: impl Into<String>, path: Option<PathBuf>, text: impl Into<String>) -> FileId {
        self.files.push(SourceFile { name: name.into(), path, text: text.into() });
        FileId(self.files.len() as u32 - 1)
    }

    /// The text with this id.
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[id.0 as usize]
    }

    /// All texts, in the order they were added.
    pub fn files(&self) -> impl Iterator<Item = &SourceFile> {
        self.files.iter()
    }

    /// The characters of a span.
    pub fn text(&self, span: Span) -> &str {
        &self.file(span.file).text[span.start as usize..span.end as usize]
    }

    /// Where a span begins, as `file:line:column`.
    pub fn place(&self, span: Span) -> String {
        let LineColumn { line, column } = self.locate(span.file, span.start);
        format!("{}:{line}:{column}", self.file(span.file).name)
    }

    /// Where a byte lies.
    pub fn locate(&self, file: FileId, byte: u32) -> LineColumn {
        let text = &self.file(file).text;
        let mut byte = (byte as usize).min(text.len());
        while !text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &text[..byte];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        LineColumn {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_start_at_one() {
        let mut map = SourceMap::default();
        let file = map.add("a.pss", None, "äb\ncd");
        assert_eq!(map.locate(file, 0), LineColumn { line: 1, column: 1 });
        assert_eq!(map.locate(file, 2), LineColumn { line: 1, column: 2 });
        assert_eq!(map.locate(file, 4), LineColumn { line: 2, column: 1 });
        assert_eq!(map.locate(file, 99), LineColumn { line: 2, column: 3 });
    }
}
