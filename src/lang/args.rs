//! Which argument is which: by place, by name, missing, unknown, given twice. What a value must be is left
//! to `check` and to the builtins themselves.

use std::cell::RefCell;

use super::ast::{Args, Expr, ExprKind};
use super::budget::Budget;
use super::habits;
use super::queries::Geometry;
use super::value::{Eval, Located};
use crate::diag::{Diagnostic, is_slip, nearest};
use crate::scene::{Call, Decl, Kind};
use crate::source::{SourceMap, Span};

/// An argument that may be given.
#[derive(Clone, Copy, Debug)]
pub struct Formal<'a> {
    /// The name before the colon.
    pub name: &'a str,
    /// Whether it may be given by place.
    pub by_place: bool,
    /// Whether the call is wrong without it.
    pub required: bool,
    /// What it must be and what it does, for the reference.
    pub doc: &'a str,
}

impl<'a> Formal<'a> {
    /// A needed argument, by place or by name.
    pub const fn place(name: &'a str) -> Formal<'a> {
        Formal { name, by_place: true, required: true, doc: "" }
    }

    /// A needed argument, by name.
    pub const fn named(name: &'a str) -> Formal<'a> {
        Formal { name, by_place: false, required: true, doc: "" }
    }

    /// The same, but it may be left out.
    pub const fn optional(self) -> Formal<'a> {
        Formal { required: false, ..self }
    }

    /// The same with what it is.
    pub const fn is(self, doc: &'a str) -> Formal<'a> {
        Formal { doc, ..self }
    }
}

/// The formal arguments of a declaration.
pub fn formals(decl: &Decl) -> Vec<Formal<'_>> {
    decl.params
        .iter()
        .map(|p| Formal { name: p.name, by_place: p.by_place, required: p.required, doc: p.doc })
        .collect()
}

/// Arguments, or words, that a message lists.
const SHOWN: usize = 40;

/// How a call is written: `sphere(r:, at:)`, arguments by place without a colon.
pub fn signature(word: &str, formals: &[Formal]) -> String {
    let one = |f: &Formal| if f.by_place { f.name.to_owned() } else { format!("{}:", f.name) };
    let more = if SHOWN < formals.len() { ", ..." } else { "" };
    format!("{word}({}{more})", formals.iter().take(SHOWN).map(one).collect::<Vec<_>>().join(", "))
}

/// What is called and where.
#[derive(Clone, Copy)]
pub struct Callee<'a> {
    /// The word, with its point for a method.
    pub word: &'a str,
    /// The place of the whole call.
    pub at: Span,
    /// What it takes.
    pub formals: &'a [Formal<'a>],
}

impl<'a> Callee<'a> {
    fn signature(&self) -> String {
        signature(self.word, self.formals)
    }

    /// The expression of each formal argument; the one named `known` was read already.
    pub fn bind<'e>(&self, args: &'e Args, known: &str) -> Eval<Vec<Option<&'e Expr>>> {
        let mut bound: Vec<Option<&Expr>> = vec![None; self.formals.len()];
        let mut places = (0..self.formals.len()).filter(|i| self.formals[*i].by_place);
        for arg in args.list.iter().filter(|a| a.name.as_ref().is_none_or(|n| n.text != known)) {
            let i = match &arg.name {
                Some(name) => self.formals.iter().position(|f| f.name == name.text).ok_or_else(|| {
                    // Of a function of thousands of arguments the first are looked at.
                    let names = self.formals.iter().take(SHOWN).map(|f| f.name);
                    let known = nearest(&name.text, names);
                    let told = format!("`{}` has no argument `{}`", self.word, name.text);
                    let error = Diagnostic::error("E0403", told).at(name.at, "unknown argument");
                    let habit = habits::instead_of_argument(self.word, &name.text);
                    // Another spelling of an argument that is there says more than a habit.
                    if let Some(help) = habit.filter(|help| known.is_none() || *help != habits::WEAR) {
                        let same = habits::same(&name.text, habits::Place::Argument);
                        let same = same.filter(|same| self.formals.iter().any(|f| f.name == *same));
                        // A centre is a point, not a question.
                        let same = same.filter(|_| !matches!(arg.value.kind, ExprKind::Bool(_)));
                        return error
                            .fix_with(name.at, same)
                            .help(format!("{help}; it is `{}`", self.signature()));
                    }
                    let sure = known.filter(|known| is_slip(&name.text, known));
                    error.fix_with(name.at, sure).help(match known {
                        Some(known) => format!("did you mean `{known}`? It is `{}`", self.signature()),
                        None => format!("it is `{}`", self.signature()),
                    })
                })?,
                None => places.next().ok_or_else(|| self.too_many(arg.value.at))?,
            };
            if let Some(first) = bound[i].replace(&arg.value) {
                let told = format!("`{}` is given twice", self.formals[i].name);
                return Err(Diagnostic::error("E0405", told)
                    .at(arg.value.at, "the second time")
                    .at(first.at, "the first time")
                    .help("remove one of them")
                    .into());
            }
        }
        match self.formals.iter().zip(&bound).find(|(f, b)| f.required && b.is_none()) {
            Some((missing, _)) => Err(self.missing(missing.name).into()),
            None => Ok(bound),
        }
    }

    /// The error that a needed argument was left out.
    pub fn missing(&self, name: &str) -> Diagnostic {
        Diagnostic::error("E0404", format!("`{}` needs `{name}`", self.word))
            .at(self.at, format!("`{name}` is missing"))
            .help(format!("it is `{}`", self.signature()))
    }

    fn too_many(&self, at: Span) -> Diagnostic {
        let by_place = self.formals.iter().filter(|f| f.by_place).count();
        let told = match by_place {
            0 => format!("the arguments of `{}` are given by name", self.word),
            1 => format!("`{}` takes one argument by place", self.word),
            n => format!("`{}` takes {n} arguments by place", self.word),
        };
        let unnamed = if self.formals.is_empty() { "no argument is wanted" } else { "which one is this?" };
        let list = self.formals.iter().position(|f| f.name == "list");
        Diagnostic::error("E0406", told).at(at, unnamed).help(match list {
            Some(0) => format!("put the operands in a list: `{}([a, b])`", self.word),
            Some(_) => format!("put all but the first in a list: `{}(a, [b, c])`", self.word),
            None if self.word == "rotate" => "turn around one axis after the other: \
                `.rotate_x(90deg).rotate_z(45deg)`, or around any: `.rotate(axis: [1, 1, 0], by: 45deg)`"
                .to_owned(),
            None if self.formals.first().is_some_and(|f| matches!(f.name, "by" | "factor")) => {
                format!("it is `{}`; a vector stands in square brackets: `[x, y, z]`", self.signature())
            }
            None if matches!(self.word, "min" | "max") => {
                format!("it is `{}`; of three it is `{1}(a, {1}(b, c))`", self.signature(), self.word)
            }
            None => format!("it is `{}`", self.signature()),
        })
    }
}

/// The arguments of a builtin, evaluated.
pub struct Bound<'a> {
    /// What is called.
    pub callee: Callee<'a>,
    /// What a method is called on.
    pub receiver: Option<Located>,
    /// One for each formal argument.
    pub values: Vec<Option<Located>>,
    /// The texts, for hints.
    pub sources: &'a SourceMap,
    /// Who measures shapes.
    pub geometry: Option<&'a dyn Geometry>,
    /// The materials made so far.
    pub materials: &'a [Call],
    /// What is left of time and memory.
    pub budget: &'a Budget,
    /// What it warns of.
    pub warnings: &'a RefCell<Vec<Diagnostic>>,
}

impl Bound<'_> {
    fn index(&self, name: &str) -> Option<usize> {
        self.callee.formals.iter().position(|f| f.name == name)
    }

    /// An argument, if it was given.
    pub fn get(&self, name: &str) -> Option<&Located> {
        self.values.get(self.index(name)?)?.as_ref()
    }

    /// An argument that the call needs.
    pub fn need(&self, name: &str) -> Eval<&Located> {
        self.get(name).ok_or_else(|| self.callee.missing(name).into())
    }

    /// An angle, degrees.
    pub fn angle(&self, name: &str) -> Eval<f64> {
        let given = self.need(name)?;
        given.angle(name, self.sources.text(given.at))
    }

    /// What a method is called on.
    pub fn receiver(&self) -> Eval<&Located> {
        self.receiver.as_ref().ok_or_else(|| self.callee.missing("shape").into())
    }
}

/// A kind of value in words, with its article.
pub fn wanted(kind: Kind) -> String {
    match kind {
        Kind::Number => "a number".into(),
        Kind::Int(lo, hi) => format!("a whole number from {lo} to {hi}"),
        Kind::Length | Kind::Size => "a length".into(),
        Kind::Width => "a length above zero".into(),
        Kind::SizeOrVector => "a length or a vector of 3 lengths".into(),
        Kind::Positive => "a number above zero".into(),
        Kind::Angle => "an angle".into(),
        Kind::Color => "a colour".into(),
        Kind::Vector(n) => format!("a vector of {n} numbers"),
        Kind::Points => "a list of points".into(),
        Kind::Choice(words) => format!("one of {}", quoted(words)),
        Kind::Choices(words) => format!("a list of {}", quoted(words)),
        Kind::Bool => "`true` or `false`".into(),
        Kind::Path => "the name of a file".into(),
        Kind::PathOrSolid => "the name of a file or a solid".into(),
        Kind::Outline => "a list of points, or a list of such lists".into(),
        Kind::NumberOrPair => "a number or a vector of 2 numbers".into(),
        Kind::HalfSpace | Kind::Condition => "a condition on x, y and z".into(),
        Kind::Solid => "a solid".into(),
        Kind::LengthOr(words) => format!("a length or one of {}", quoted(words)),
    }
}

/// Words as they are written in a scene.
pub fn quoted(words: &[&str]) -> String {
    let more = if SHOWN < words.len() { ", ..." } else { "" };
    words.iter().take(SHOWN).map(|w| format!("\"{w}\"")).collect::<Vec<_>>().join(", ") + more
}
