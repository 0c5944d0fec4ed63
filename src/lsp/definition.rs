//! Where a name is bound: in the document, or in a file that it imports.

use std::ops::Range;

use super::hover::{function, labelled};
use super::view::{Imported, View};

/// A place.
pub enum Place {
    /// Bytes of the document.
    Here(Range<usize>),
    /// Bytes of another file.
    There(Box<Imported>, Range<usize>),
}

/// Where the word at a byte is bound; of an imported file's name its beginning.
pub fn definition(view: &View, at: usize) -> Option<Place> {
    let outline = &view.outline;
    let there = |(file, binding): super::view::Foreign| Place::There(Box::new(file), binding.name);
    if let Some(import) = outline.imports.iter().find(|import| import.at.contains(&at)) {
        return Some(Place::There(Box::new(view.imported(import)?), 0..0));
    }
    let i = outline.word_at(at).filter(|_| !outline.in_comment(at))?;
    let word = outline.word(i);
    if outline.before(i) == "." {
        let space = outline.space_at(i.checked_sub(2)?)?;
        return view.member(outline.name(space), word).map(there);
    }
    if let Some(callee) = labelled(outline, i) {
        return formal(view, callee, word);
    }
    match outline.find(word, at) {
        Some(binding) => Some(Place::Here(binding.name.clone())),
        None => view.joined_name(word).map(there),
    }
}

/// The parameter that an argument is given to.
fn formal(view: &View, callee: super::context::Callee, name: &str) -> Option<Place> {
    use super::context::Callee::{Function, Member};
    let (outline, binding) = function(view, callee)?;
    let named = outline.formals(&binding).into_iter().find(|b| outline.name(b) == name)?.name.clone();
    let file = match callee {
        Function(callee) if view.outline.own(callee).is_some() => return Some(Place::Here(named)),
        Function(callee) => view.joined_name(callee)?.0,
        Member(space, _) => view.space(space)?,
        _ => return None,
    };
    Some(Place::There(Box::new(file), named))
}
