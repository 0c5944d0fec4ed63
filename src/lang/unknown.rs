//! What to say of a name that is not known: the nearest that is, what other languages call so, or how to define it.

use std::collections::HashSet;

use super::ast::Word;
use super::builtins;
use super::eval::Machine;
use super::habits;
use super::value::{Located, Val};
use crate::diag::{Diagnostic, nearest};
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
    /// The name of an imported file that has this name, the first in the order of names.
    fn imported_with(&self, name: &str) -> Option<&str> {
        let has = |value: &Option<Val>| matches!(value, Some(Val::Record(r)) if r.get(name).is_some());
        let files = self.names[self.module].iter().filter(|(_, value)| has(value));
        files.map(|(file, _)| file.as_str()).min()
    }

    /// The error that a name is not known.
    pub(super) fn unknown(&self, name: &str, at: Span) -> Diagnostic {
        let mut known: Vec<&str> = self.names[self.module].keys().map(String::as_str).collect();
        known.extend(self.locals.names());
        known.sort_unstable();
        callable(self.catalog).for_each(|word| known.push(word));
        builtins::CONSTANTS.iter().for_each(|(word, _, _)| known.push(word));
        let error = Diagnostic::error("E0401", format!("`{name}` is not known")).at(at, "unknown name");
        let lower = name.to_ascii_lowercase();
        for name in [name, &lower] {
            if let Some(help) = habits::instead(name, habits::Place::Name) {
                return error.fix_with(at, habits::same(name, habits::Place::Name)).help(help);
            }
        }
        if let Some(file) = self.imported_with(name) {
            let error = error.fix(at, format!("{file}.{name}"));
            return error.help(format!("it is `{file}.{name}`, of an imported file"));
        }
        match nearest(name, known) {
            Some(known) => error.fix(at, known).help(format!("did you mean `{known}`?")),
            None => error.help(format!("define it: `let {name} = ...`")),
        }
    }
}

/// The error that something has no part, or no method, of a name.
pub fn no_member(on: &Located, word: &Word) -> Diagnostic {
    let name = word.text.as_str();
    if let Val::Record(record) = &on.value {
        let names: Vec<String> = record.names().map(|n| format!("`.{n}`")).collect();
        let error = Diagnostic::error("E0408", format!("{} has no `{name}`", on.value.kind()));
        let error = error.at(word.at, "unknown part");
        return match nearest(name, record.names()) {
            Some(known) => error.fix(word.at, known).help(format!("did you mean `.{known}`?")),
            None => error.help(format!("it has {}", names.join(" "))),
        };
    }
    if let (Val::List(_), "x" | "y" | "z" | "w" | "r" | "g" | "b") = (&on.value, name) {
        let error = Diagnostic::error("E0408", format!("{} has no `{name}`", on.value.kind()));
        return error
            .at(word.at, "unknown part")
            .help("the parts of a vector are `.x` `.y` `.z`, or `v[0]` `v[1]` `v[2]`");
    }
    if builtins::METHODS.iter().any(|b| b.name == name) {
        return Diagnostic::error("E0410", format!("`.{name}` is called with arguments"))
            .at(word.at, "no arguments")
            .help(format!("write `.{name}(...)`"));
    }
    let error = Diagnostic::error("E0408", format!("{} has no method `{name}`", on.value.kind()))
        .at(word.at, "unknown method");
    if let Some(help) = habits::instead(name, habits::Place::Method) {
        return error.fix_with(word.at, habits::same(name, habits::Place::Method)).help(help);
    }
    let known = builtins::METHODS.iter().map(|b| b.name);
    match nearest(name, known.clone()) {
        Some(known) => error.fix(word.at, known).help(format!("did you mean `.{known}`?")),
        None => error.help(format!(
            "the methods are {}",
            known.map(|n| format!("`.{n}`")).collect::<Vec<_>>().join(" ")
        )),
    }
}
