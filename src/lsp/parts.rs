//! What stands before a point, as far as the tokens show: whether methods, parts or nothing may follow it.

use super::names::{Kind, Outline};
use super::view::View;
use crate::lang::TokenKind;
use crate::lang::reference::Chapter;

/// What a value is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum What {
    /// A shape.
    Shape,
    /// Two to four numbers.
    Vector,
    /// The bounds of a shape.
    Bounds,
    /// Crossings of a ray.
    Crossings,
    /// One of them.
    Crossing,
    /// What has neither parts nor methods.
    Plain,
    /// The tokens do not tell.
    Unknown,
}

/// Names that are followed before it is given up: `let a = b`, `let b = c`, ...
const DEEPEST: usize = 8;

impl What {
    /// Its parts, and what each is.
    pub fn parts(self) -> &'static [(&'static str, &'static str)] {
        match self {
            What::Vector => &[("x", "a number"), ("y", "a number"), ("z", "a number")],
            What::Bounds => &[
                ("min", "the corner with the least coordinates"),
                ("max", "the corner with the greatest"),
                ("size", "its extents"),
                ("center", "its middle"),
            ],
            What::Crossing => &[
                ("t", "in multiples of the ray's direction"),
                ("point", "where it is"),
                ("normal", "outward, of length 1"),
                ("entering", "whether the ray goes in"),
            ],
            _ => &[],
        }
    }

    /// Whether methods may follow.
    pub fn has_methods(self) -> bool {
        matches!(self, What::Shape | What::Unknown)
    }
}

/// What the term is that ends before a token.
pub fn before(view: &View, end: usize) -> What {
    term(view, end, 0).map_or(What::Unknown, |(_, what)| what)
}

/// The first token of the term that ends before a token, and what the term is.
fn term(view: &View, end: usize, depth: usize) -> Option<(usize, What)> {
    let outline = &view.outline;
    let last = end.checked_sub(1)?;
    match (outline.tokens[last].kind, outline.word(last)) {
        (TokenKind::Number | TokenKind::Text | TokenKind::Color, _) => Some((last, What::Plain)),
        (TokenKind::Word, word) if outline.before(last) == "." => {
            let (start, of) = term(view, last - 1, depth)?;
            Some((start, part(of, word)))
        }
        (TokenKind::Word, _) => Some((last, named(view, last, depth))),
        (TokenKind::Close, ")") => called(view, opening(outline, last)?, depth),
        (TokenKind::Close, "]") => {
            let open = opening(outline, last)?;
            match open.checked_sub(1).filter(|i| outline.tokens[*i].ends_operand(&outline.text)) {
                None => Some((open, list(outline, open, last))),
                Some(_) => {
                    let (start, of) = term(view, open, depth)?;
                    let what = match of {
                        What::Crossings => What::Crossing,
                        What::Vector => What::Plain,
                        _ => What::Unknown,
                    };
                    Some((start, what))
                }
            }
        }
        _ => None,
    }
}

/// A part of something.
fn part(of: What, word: &str) -> What {
    match (of, word) {
        (What::Bounds, _) | (What::Crossing, "point" | "normal") => What::Vector,
        (What::Vector | What::Crossing, _) => What::Plain,
        _ => What::Unknown,
    }
}

/// What a name stands for.
fn named(view: &View, token: usize, depth: usize) -> What {
    let outline = &view.outline;
    let Some(binding) = outline.find(outline.word(token), outline.tokens[token].start()) else {
        return What::Unknown;
    };
    if binding.kind != Kind::Let || !binding.of_file || DEEPEST <= depth {
        return if binding.kind == Kind::Material { What::Plain } else { What::Unknown };
    }
    let value = binding.token + 2..outline.items[binding.item].tokens.end;
    if value.len() == 1 && outline.tokens[value.start].kind != TokenKind::Word {
        return What::Plain;
    }
    match term(view, value.end, depth + 1) {
        Some((start, what)) if start == value.start => what,
        _ => What::Unknown,
    }
}

/// What a call gives; `open` is its parenthesis.
fn called(view: &View, open: usize, depth: usize) -> Option<(usize, What)> {
    let outline = &view.outline;
    let callee = open.checked_sub(1).filter(|i| outline.tokens[*i].kind == TokenKind::Word);
    let Some(callee) = callee else { return Some((open, What::Unknown)) };
    let word = outline.word(callee);
    if outline.before(callee) == "." {
        let (start, _) = term(view, callee - 1, depth)?;
        let method = view.words(word, true).next().is_some();
        return Some((start, if method { What::Shape } else { What::Unknown }));
    }
    let own = outline.find(word, outline.tokens[callee].start()).is_some();
    let what = match word {
        _ if own => What::Unknown,
        "bounds" => What::Bounds,
        "raycast" => What::Crossings,
        "centroid" | "normalize" | "cross" => What::Vector,
        "union" | "intersection" | "difference" | "xor" => What::Shape,
        "volume" | "area" | "count" | "length" | "dot" | "rand" | "inside" | "empty" | "solid" => What::Plain,
        _ if view.words(word, false).any(|w| w.chapter == Chapter::Solids) => What::Shape,
        _ => What::Unknown,
    };
    Some((callee, what))
}

/// A list of two to four things that are no lists is a vector.
fn list(outline: &Outline, open: usize, close: usize) -> What {
    let depth = outline.depth(open) + 1;
    let inside = || (open + 1..close).filter(|i| outline.depth(*i) == depth);
    let commas = inside().filter(|i| outline.word(*i) == ",").count();
    let nested = inside().any(|i| outline.word(i) == "[" && matches!(outline.before(i), "[" | ","));
    if (1..=3).contains(&commas) && !nested { What::Vector } else { What::Plain }
}

/// The token of the bracket that another closes.
fn opening(outline: &Outline, close: usize) -> Option<usize> {
    let depth = outline.depth(close);
    let opens = |i: &usize| outline.tokens[*i].kind == TokenKind::Open && outline.depth(*i) == depth;
    (0..close).rev().find(opens)
}
