//! `pss explain`: what a word of the language means, or what the code of a message tells, how it comes about and what helps.

use pss::diag::{Diagnostic, Fault, nearest};
use pss::lang::{codes, reference};

use crate::args::ExplainArgs;
use crate::console::{Failure, print};

/// Prints the page.
pub fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let catalog = pss::prepare::catalog();
    let words = reference::words(&catalog);
    let Some(word) = &args.word else {
        let lines: Vec<String> = words.iter().map(|w| format!("{}\n    {}\n", w.call, w.doc)).collect();
        return print(lines.concat().as_bytes()).map(drop);
    };
    // Methods are called with a point before them, and messages name them so.
    let word = word.strip_prefix('.').unwrap_or(word);
    let found: Vec<String> = words.iter().filter(|w| w.is(word)).map(reference::Word::page).collect();
    if !found.is_empty() {
        return print(found.join("\n").as_bytes()).map(drop);
    }
    if let Some(code) = codes::all().find(|c| c.code.eq_ignore_ascii_case(word)) {
        return print(code.page().as_bytes()).map(drop);
    }
    let instead = reference::instead(word);
    if !instead.is_empty() {
        let lines: Vec<String> =
            instead.iter().map(|help| format!("{word} is not of this language: {help}\n")).collect();
        return print(lines.concat().as_bytes()).map(drop);
    }
    let known = words.iter().flat_map(|w| w.name.split(' ')).chain(codes::all().map(|c| c.code));
    let error = Diagnostic::error("E0001", format!("`{word}` is no word of the language and no code"))
        .fault(Fault::Usage);
    Err(Failure::from(match nearest(word, known) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => error.help("`pss explain` lists all words"),
    }))
}
