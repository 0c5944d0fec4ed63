//! What to say of a name that is not known: the nearest that is, what other languages call so, or how to define it.

use std::collections::HashSet;

use super::ast::Word;
use super::budget::Budget;
use super::builtins;
use super::eval::Machine;
use super::habits;
use super::units;
use super::value::{Located, Stop, Val};
use crate::diag::{Diagnostic, listed, nearest};
use crate::scene::{Catalog, Group};
use crate::source::Span;

/// What the language itself calls something, with what a catalogue adds.
pub fn words(catalog: &Catalog) -> HashSet<&'static str> {
    callable(catalog).chain(builtins::CONSTANTS.iter().map(|(word, _, _)| *word)).collect()
}

/// The words that can be called.
pub fn callable(catalog: &Catalog) -> impl Iterator<Item = &'static str> + '_ {
    let declared = catalog.words(Group::Primitive).chain(catalog.words(Group::Material));
    declared.chain(builtins::functions().map(|b| b.name))
}

impl Machine<'_> {
    /// The names of imported files that have this name, in order.
    fn imported_with(&self, name: &str) -> Vec<&str> {
        let has = |value: &Option<Val>| matches!(value, Some(Val::Record(r)) if r.get(name).is_some());
        let files = self.names[self.module].iter().filter(|(_, value)| has(value));
        let mut files: Vec<&str> = files.map(|(file, _)| file.as_str()).collect();
        files.sort_unstable();
        files
    }

    /// All names that are known here, those of the scene first.
    fn known(&self) -> Vec<&str> {
        let mut known: Vec<&str> = self.names[self.module].keys().map(String::as_str).collect();
        known.extend(self.locals.names());
        known.sort_unstable();
        callable(self.catalog).for_each(|word| known.push(word));
        known.extend(builtins::CONSTANTS.iter().map(|(word, _, _)| *word));
        known
    }

    /// The error that a name is not known; nothing is told where it may stand in a file that could not be read.
    pub(super) fn unknown(&self, name: &str, at: Span) -> Stop {
        if self.partly[self.module] {
            return Stop::Quiet;
        }
        let error = Diagnostic::error("E0401", format!("`{name}` is not known")).at(at, "unknown name");
        let lower = name.to_ascii_lowercase();
        for name in [name, &lower] {
            if let Some(help) = habits::instead(name, habits::Place::Name) {
                return error.fix_with(at, habits::same(name, habits::Place::Name)).help(help).into();
            }
        }
        if units::find(name).is_some() {
            let help =
                format!("a unit touches its number: `90{name}`; a value is multiplied by one: `a * 1{name}`");
            return error.help(help).into();
        }
        let undefined = format!("define it: `let {name} = ...`");
        if !self.budget.may_look(self.names[self.module].len()) {
            return error.help(undefined).into();
        }
        let files = self.imported_with(name);
        if let Some(file) = files.first() {
            let whole = format!("{file}.{name}");
            let only = (files.len() == 1).then_some(whole.as_str());
            return error.fix_with(at, only).help(format!("it is `{whole}`, of an imported file")).into();
        }
        let near = nearest(name, self.known());
        match near {
            Some(near) => error.fix_slip(at, name, near).help(format!("did you mean `{near}`?")),
            None => error.help(undefined),
        }
        .into()
    }

    /// The error for a material's argument that is the name of a colour: an edit would have to make a material of it.
    pub(super) fn worn(method: &str, stop: Stop) -> Stop {
        match stop {
            Stop::Told(mut error) if matches!(method, "with" | "cut") => {
                if let Some(fix) = error.fix.as_deref_mut().filter(|fix| fix.text.starts_with('#')) {
                    fix.text = format!("matte({})", fix.text);
                    error.help = Some(format!("a material of a colour is `{}`", fix.text).into());
                }
                Stop::Told(error)
            }
            stop => stop,
        }
    }
}

/// The error that something has no part, or no method, of a name.
pub fn no_member(on: &Located, word: &Word, budget: &Budget) -> Diagnostic {
    let (name, kind) = (word.text.as_str(), on.value.kind());
    if let Val::Record(record) = &on.value {
        let error = Diagnostic::error("E0408", format!("{kind} has no `{name}`")).at(word.at, "unknown part");
        let near = nearest(
            name,
            record.names().take(if budget.may_look(record.fields.len()) { usize::MAX } else { 0 }),
        );
        return match near {
            Some(near) => error.fix_slip(word.at, name, near).help(format!("did you mean `.{near}`?")),
            None => error.help(format!("it has {}", listed(record.names(), |n| format!("`.{n}`")))),
        };
    }
    // Of `.union(b)` more can be said than that it is a function.
    let habit = habits::instead(name, habits::Place::Method);
    if let Some(function) = builtins::functions().find(|b| b.name == name && habit.is_none()) {
        let error = Diagnostic::error("E0408", format!("`{name}` is a function, not a part of {kind}"));
        let of = if matches!(on.value, Val::Shape(_)) { "shape" } else { "value" };
        let rest = if function.formals.len() > 1 { ", ..." } else { "" };
        return error.at(word.at, "a function").help(format!("write `{name}({of}{rest})`"));
    }
    if let Val::Shape(_) = on.value { no_method(word) } else { no_part(on, word) }
}

/// The error that what is no shape has no part of a name.
fn no_part(on: &Located, word: &Word) -> Diagnostic {
    let (name, kind) = (word.text.as_str(), on.value.kind());
    if builtins::METHODS.iter().any(|b| b.name == name) {
        let error = Diagnostic::error("E0501", format!("`.{name}` is a method of shapes, not of {kind}"));
        let error = error.at(word.at, "needs a shape").at(on.at, kind);
        return error.help("call it on a shape");
    }
    let error = Diagnostic::error("E0408", format!("{kind} has no `{name}`")).at(word.at, "unknown part");
    if let Some(help) =
        habits::instead(name, habits::Place::Method).filter(|_| matches!(name, "len" | "size"))
    {
        return error.help(help);
    }
    match &on.value {
        Val::List(_) => error.help("the parts of a vector are `.x` `.y` `.z`, or `v[0]` `v[1]` `v[2]`"),
        Val::Color(_) => error.help("colours have no parts; write the channels: `rgb(r, g, b)`"),
        _ => error.help(format!("{kind} has no parts and no methods")),
    }
}

/// The error that a shape has no method of a name.
fn no_method(word: &Word) -> Diagnostic {
    let name = word.text.as_str();
    if builtins::METHODS.iter().any(|b| b.name == name) {
        return Diagnostic::error("E0410", format!("`.{name}` is called with arguments"))
            .at(word.at, "no arguments")
            .help(format!("write `.{name}(...)`"));
    }
    let error = Diagnostic::error("E0408", format!("a shape has no method `{name}`"));
    let error = error.at(word.at, "unknown method");
    if let Some(help) = habits::instead(name, habits::Place::Method) {
        return error.fix_with(word.at, habits::same(name, habits::Place::Method)).help(help);
    }
    let known = builtins::METHODS.iter().map(|b| b.name);
    match nearest(name, known.clone()) {
        Some(near) => error.fix_slip(word.at, name, near).help(format!("did you mean `.{near}`?")),
        None => error.help(format!("the methods are {}", listed(known, |n| format!("`.{n}`")))),
    }
}
