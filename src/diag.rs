//! Diagnostics: what is wrong with something a user wrote, where, and the way out. One type with three
//! readers: the terminal, `--format json`, and editors. How it is printed is left to [`crate::report`].

use crate::source::{FileId, Span};

/// How much a diagnostic weighs.
#[derive(Clone, Copy, PartialEq, Eq, Debug, PartialOrd, Ord)]
pub enum Severity {
    /// Nothing is made.
    Error,
    /// Something is made, perhaps not what was meant. Never changes an exit code.
    Warning,
    /// Nothing is wrong, but it is good to know.
    Remark,
}

impl Severity {
    /// As it is printed.
    pub fn word(self) -> &'static str {
        match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Remark => "note",
        }
    }
}

/// Which kind of failure an error is: it chooses the exit code.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault {
    /// What is stated does not hold (1).
    Unmet,
    /// The command line is wrong (2).
    Usage,
    /// A scene, a cloud or a value in them is wrong (65).
    Input,
    /// A file is missing or cannot be read (66).
    Missing,
    /// This program is wrong (70).
    Internal,
    /// There is not enough memory (71).
    Memory,
    /// An output cannot be created (73).
    Output,
    /// Reading or writing failed on the way (74).
    Io,
    /// Stopped, with a state that goes on (75).
    Stopped,
    /// Something the settings do not allow (77).
    Refused,
    /// Stopped by a signal of this number, with nothing kept (128 and the number).
    Signal(u8),
}

impl Fault {
    /// The process exit code (`sysexits.h`).
    pub fn exit_code(self) -> u8 {
        match self {
            Fault::Unmet => 1,
            Fault::Usage => 2,
            Fault::Input => 65,
            Fault::Missing => 66,
            Fault::Internal => 70,
            Fault::Memory => 71,
            Fault::Output => 73,
            Fault::Io => 74,
            Fault::Stopped => 75,
            Fault::Refused => 77,
            Fault::Signal(number) => 128 + number,
        }
    }
}

/// A place and what it has to do with the matter.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// A few words beside the place; may be empty.
    pub text: String,
}

/// What may be written instead of a part of a text, so that a program can mend it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// What is replaced; empty where something is put in.
    pub span: Span,
    /// By what.
    pub text: String,
}

/// Something to tell the user.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The code, such as `E0301`.
    pub code: &'static str,
    /// One sentence, no final stop.
    pub message: String,
    /// The first is where it is; the others help to understand it. Empty where there is no place.
    pub labels: Vec<Label>,
    /// The way out.
    pub help: Option<Box<str>>,
    /// The way out as an edit, where there is one way and no word of the user's is missing in it.
    pub fix: Option<Box<Fix>>,
    /// Facts beside the matter.
    pub notes: Vec<String>,
    /// The kind of failure; of no meaning for a warning.
    pub fault: Fault,
}

impl Diagnostic {
    /// An error about something the user wrote.
    pub fn error(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            code,
            message: message.into(),
            labels: Vec::new(),
            help: None,
            fix: None,
            notes: Vec::new(),
            fault: Fault::Input,
        }
    }

    /// A warning.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, message) }
    }

    /// What is good to know and nothing is wrong with.
    pub fn remark(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Remark, ..Diagnostic::error(code, message) }
    }

    /// Adds a place; the first added is the main one.
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// Sets the way out.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into().into());
        self
    }

    /// Sets the way out as an edit.
    pub fn fix(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.fix = Some(Box::new(Fix { span, text: text.into() }));
        self
    }

    /// The same with a word that may be none.
    pub fn fix_with(self, span: Span, word: Option<&str>) -> Diagnostic {
        match word {
            Some(word) => self.fix(span, word),
            None => self,
        }
    }

    /// Sets the way out as an edit, where a word is surely another one, mistyped.
    pub fn fix_slip(self, span: Span, word: &str, meant: &str) -> Diagnostic {
        if is_slip(word, meant) { self.fix(span, meant) } else { self }
    }

    /// Adds a fact.
    pub fn note(mut self, note: impl Into<String>) -> Diagnostic {
        self.notes.push(note.into());
        self
    }

    /// Sets the kind of failure.
    pub fn fault(mut self, fault: Fault) -> Diagnostic {
        self.fault = fault;
        self
    }

    /// Whether it stops the run.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// A text with the fixes of diagnostics in it: those of this file that do not touch each other, the earlier first. How many there
/// were stands beside it.
pub fn mended(text: &str, file: FileId, diagnostics: &[Diagnostic]) -> (String, usize) {
    let mut fixes: Vec<&Fix> = diagnostics.iter().filter_map(|d| d.fix.as_deref()).collect();
    fixes.retain(|fix| fix.span.file == file);
    fixes.sort_by_key(|fix| (fix.span.start, fix.span.end));
    let (mut out, mut done, mut count) = (String::with_capacity(text.len()), 0, 0);
    for fix in fixes {
        let (start, end) = (fix.span.start as usize, fix.span.end as usize);
        let touches = count > 0 && start <= done;
        if let (false, Some(kept)) = (touches || end < start, text.get(done..start)) {
            out.push_str(kept);
            out.push_str(&fix.text);
            (done, count) = (end, count + 1);
        }
    }
    out.push_str(text.get(done..).unwrap_or_default());
    (out, count)
}

/// A word of a text as messages show it: characters that are not to be seen by their numbers.
pub fn shown(word: &str) -> String {
    let each = word.chars().map(|c| match c {
        '"' | '\'' | '\\' => c.to_string(),
        c => c.escape_debug().to_string(),
    });
    each.collect()
}

/// Letters of a name that has a nearest one, at most: what is longer is no slip of the hand.
const LONGEST_NAME: usize = 64;

/// The known name nearest to `name`, for "did you mean": at most a third of its letters wrong, missing,
/// too many or in each other's place (optimal string alignment), the first of several; none for a name of more than
/// 64 letters. Its time grows with the number of names: whoever has many of them looks seldom.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if LONGEST_NAME < name.len() {
        return None;
    }
    let letters = name.chars().count();
    let limit = (letters / 3).max(1);
    known
        .into_iter()
        .filter(|k| k.len() <= 4 * LONGEST_NAME)
        .map(|k| (k, k.chars().count()))
        .filter(|(_, others)| others.abs_diff(letters) <= limit)
        .map(|(k, others)| (strsim::osa_distance(name, k), others, k))
        // A name all of whose letters differ is not near.
        .filter(|(d, others, _)| *d <= limit && *d < letters.max(*others))
        .min_by_key(|(d, ..)| *d)
        .map(|(.., k)| k)
}

/// Whether a name is surely another one, mistyped: one letter within it is missing, too many, or has changed places with
/// the next. What begins or ends otherwise, or has another letter or digit, may be meant as it stands: `acosh`, `legs`, `wall2`.
pub fn is_slip(name: &str, known: &str) -> bool {
    let (a, b): (Vec<char>, Vec<char>) = (name.chars().collect(), known.chars().collect());
    let (short, long) = if a.len() <= b.len() { (&a, &b) } else { (&b, &a) };
    let same = short.iter().zip(long).take_while(|(x, y)| x == y).count();
    if short.len() < 4 || long.len() < 5 || same == 0 {
        return false;
    }
    match long.len() - short.len() {
        0 => {
            let swapped =
                same + 1 < long.len() && short[same] == long[same + 1] && short[same + 1] == long[same];
            swapped
                && short[same + 2..] == long[same + 2..]
                && short[same].is_alphabetic()
                && long[same].is_alphabetic()
        }
        1 => same < short.len() && short[same..] == long[same + 1..] && long[same].is_alphabetic(),
        _ => false,
    }
}

/// So many of some names, each as a message shows it, and how many there are beside.
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>, show: impl Fn(&str) -> String) -> String {
    const MOST: usize = 40;
    let mut names = names.into_iter();
    let first: Vec<String> = names.by_ref().take(MOST).map(show).collect();
    match names.count() {
        0 => first.join(" "),
        more => format!("{} and {more} more", first.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_found_and_far_ones_are_not() {
        let known = ["sphere", "box", "cylinder"];
        assert_eq!(nearest("shpere", known), Some("sphere"));
        assert_eq!(nearest("bux", known), Some("box"));
        assert_eq!(nearest("obx", known), Some("box"));
        assert_eq!(nearest("torus", known), None);
        assert_eq!(nearest(&"a".repeat(100_000), ["a"]), None);
    }

    #[test]
    fn only_slips_of_the_hand_are_sure() {
        for (name, known) in
            [("spere", "sphere"), ("raduis", "radius"), ("spheere", "sphere"), ("shpere", "sphere")]
        {
            assert!(is_slip(name, known), "{name}");
        }
        let unsure = [
            ("sqr", "sqrt"),
            ("sign", "sin"),
            ("i", "pi"),
            ("acosh", "acos"),
            ("wall1", "wall2"),
            ("legs1", "legs"),
        ];
        for (name, known) in
            unsure.into_iter().chain([("wheel", "wheels"), ("point_a", "point_b"), ("a12b3", "a21b3")])
        {
            assert!(!is_slip(name, known), "{name}");
        }
    }
}
