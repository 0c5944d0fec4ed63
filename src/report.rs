//! Diagnostics as text for people and as JSON for programs. What they say is decided where they are made.

use std::borrow::Cow;
use std::ops::Range;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Renderer, Snippet};
use serde::Serialize;

use crate::diag::{Diagnostic, Fix, Label, Severity};
use crate::source::{FileId, SourceMap};

/// A sentence or a name longer than so many bytes is cut.
const LONGEST: usize = 1000;

/// Errors shown before the rest is only counted.
const MAX_ERRORS: usize = 20;

/// Diagnostics as a person reads them: each with its source lines, a blank line between two. Of errors the
/// first twenty are shown.
pub fn text(diagnostics: &[Diagnostic], sources: &SourceMap, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let mut out = String::new();
    let mut errors = 0;
    for diagnostic in diagnostics {
        errors += usize::from(diagnostic.is_error());
        if diagnostic.is_error() && errors > MAX_ERRORS {
            continue;
        }
        if !out.is_empty() {
            out.push('\n');
        }
        out.push_str(&one(diagnostic, sources, &renderer));
        out.push('\n');
    }
    if errors > MAX_ERRORS {
        out.push_str(&format!("\nerror: {} more errors are not shown\n", errors - MAX_ERRORS));
    }
    out
}

fn one(diagnostic: &Diagnostic, sources: &SourceMap, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Remark => Level::NOTE,
    };
    let title = level.primary_title(clean(&diagnostic.message)).id(diagnostic.code);
    let mut files: Vec<FileId> = Vec::new();
    for label in &diagnostic.labels {
        if !files.contains(&label.span.file) {
            files.push(label.span.file);
        }
    }
    let texts: Vec<Visible> =
        files.iter().map(|f| Visible::new(&sources.file(*f).text, diagnostic, *f)).collect();
    let mut group = Group::with_title(title);
    for (file, text) in files.iter().zip(&texts) {
        let labels = diagnostic.labels.iter().enumerate().filter(|(_, l)| l.span.file == *file);
        let snippet = Snippet::source(text.text.as_str())
            .line_start(text.first_line)
            .path(clean(&sources.file(*file).name))
            .annotations(labels.map(|(i, label)| annotation(label, i == 0, text)));
        group = group.element(snippet);
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(clean(help)));
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(clean(note)));
    }
    without_gap(&renderer.render(&[group]))
}

/// The same without the empty line of the margin that the renderer puts before help and notes.
fn without_gap(rendered: &str) -> String {
    let lines: Vec<&str> = rendered.lines().collect();
    let plain: Vec<String> = lines.iter().map(|l| uncolored(l)).collect();
    let is_gap = |i: usize| {
        plain[i].trim() == "|" && plain.get(i + 1).is_some_and(|next| next.trim_start().starts_with("= "))
    };
    let kept = (0..lines.len()).filter(|i| !is_gap(*i)).map(|i| lines[i]);
    kept.collect::<Vec<_>>().join("\n")
}

/// A line without its colours.
fn uncolored(line: &str) -> String {
    let mut parts = line.split('\u{1b}');
    let first = parts.next().unwrap_or("").to_owned();
    parts.fold(first, |plain, part| plain + part.split_once('m').map_or("", |(_, rest)| rest))
}

fn annotation<'a>(label: &'a Label, main: bool, text: &Visible) -> Annotation<'a> {
    let kind = if main { AnnotationKind::Primary } else { AnnotationKind::Context };
    let annotation = kind.span(text.place(label.span.start as usize..label.span.end as usize));
    if label.text.is_empty() { annotation } else { annotation.label(clean(&label.text)) }
}

/// What a scene prints, for the terminal: its line breaks and tabs stay, all else that is hidden becomes escapes.
pub fn printable(text: &str) -> String {
    text.chars().fold(String::new(), |mut out, c| {
        if matches!(c, '\n' | '\t') {
            out.push(c)
        } else {
            push_clean(&mut out, c)
        }
        out
    })
}

/// A word for the terminal: control characters, and those that turn the direction of writing, as escapes.
fn clean(text: &str) -> Cow<'_, str> {
    if LONGEST < text.len() {
        // A name of a million letters is told by where it begins.
        let begin: String = text.chars().take(LONGEST / 4).collect();
        return Cow::Owned(format!("{}...", clean(&begin)));
    }
    if !text.chars().any(is_hidden) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().fold(String::new(), |mut out, c| {
        push_clean(&mut out, c);
        out
    }))
}

fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

fn push_clean(out: &mut String, c: char) {
    if is_hidden(c) { out.extend(c.escape_unicode()) } else { out.push(c) }
}

/// The lines of a text around the places of a diagnostic, with hidden characters made visible.
struct Visible {
    text: String,
    first_line: usize,
    /// For each changed character: its place in the file, and the bytes gained up to its end.
    gained: Vec<(usize, usize)>,
    range: Range<usize>,
}

impl Visible {
    fn new(source: &str, diagnostic: &Diagnostic, file: FileId) -> Visible {
        let spans = || diagnostic.labels.iter().map(|l| l.span).filter(|s| s.file == file);
        let boundary = |mut at: usize| {
            at = at.min(source.len());
            while !source.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let low = boundary(spans().map(|s| s.start as usize).min().unwrap_or(0));
        let high = boundary(spans().map(|s| s.end as usize).max().unwrap_or(0).max(low));
        let start = source[..low].rfind('\n').map_or(0, |i| i + 1);
        let start = if start == 0 && source.starts_with('\u{feff}') { 3.min(low) } else { start };
        let end = source[high..].find('\n').map_or(source.len(), |i| high + i);
        let end = if end > high && source[..end].ends_with('\r') { end - 1 } else { end };
        let mut out = Visible {
            text: String::with_capacity(end - start),
            first_line: source[..start].matches('\n').count() + 1,
            gained: Vec::new(),
            range: start..end,
        };
        let mut chars = source[start..end].char_indices().peekable();
        while let Some((i, c)) = chars.next() {
            let line_end = c == '\r' && chars.peek().is_none_or(|(_, next)| *next == '\n');
            if !is_hidden(c) || c == '\n' || c == '\t' || line_end {
                out.text.push(c);
                continue;
            }
            push_clean(&mut out.text, c);
            let shown = out.text.len();
            out.gained.push((start + i, shown - (i + c.len_utf8())));
        }
        out
    }

    /// A place of the file in the visible text.
    fn place(&self, range: Range<usize>) -> Range<usize> {
        let one = |at: usize| {
            let at = at.clamp(self.range.start, self.range.end);
            let before = self.gained.partition_point(|(place, _)| *place < at);
            let gained = before.checked_sub(1).map_or(0, |i| self.gained[i].1);
            let mut at = (at - self.range.start + gained).min(self.text.len());
            while !self.text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        one(range.start)..one(range.end).max(one(range.start))
    }
}

/// A diagnostic as one line of JSON, without the line's end. Lines and columns count from 1, columns count
/// characters; they and the file are null where there is no place. `fix` is there where an edit mends it.
pub fn json_line(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let place = diagnostic.labels.first().map(|l| l.span);
    let start = place.map(|s| sources.locate(s.file, s.start));
    let end = place.map(|s| sources.locate(s.file, s.end.max(s.start)));
    let line = Line {
        severity: diagnostic.severity.word(),
        code: diagnostic.code,
        message: &diagnostic.message,
        file: place.map(|s| sources.file(s.file).name.as_str()),
        line: start.map(|l| l.line),
        column: start.map(|l| l.column),
        end_line: end.map(|l| l.line),
        end_column: end.map(|l| l.column),
        help: diagnostic.help.as_deref(),
        notes: &diagnostic.notes,
        fix: diagnostic.fix.as_deref().map(|fix| Edit::new(fix, sources)),
    };
    serde_json::to_string(&line).unwrap_or_default()
}

/// The fields of a line, in their order.
#[derive(Serialize)]
struct Line<'a> {
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    file: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
    end_line: Option<usize>,
    end_column: Option<usize>,
    help: Option<&'a str>,
    notes: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    fix: Option<Edit<'a>>,
}

/// An edit that mends it: what stands between the places becomes the text.
#[derive(Serialize)]
struct Edit<'a> {
    file: &'a str,
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
    text: &'a str,
}

impl<'a> Edit<'a> {
    fn new(fix: &'a Fix, sources: &'a SourceMap) -> Edit<'a> {
        let Fix { span, text } = fix;
        let (start, end) = (sources.locate(span.file, span.start), sources.locate(span.file, span.end));
        Edit {
            file: &sources.file(span.file).name,
            line: start.line,
            column: start.column,
            end_line: end.line,
            end_column: end.column,
            text,
        }
    }
}
