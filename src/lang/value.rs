//! Values while a scene is evaluated, and reading one as what is wanted: a mistake of type is told here.
//! Which argument wants what, the tables of `builtins` and of the catalogue say.

use std::sync::Arc;

use glam::DVec3;

use super::angles;
use super::budget::{Budget, Held, weight};
use super::builtins::Builtin;
use super::estimate::Estimate;
use super::functions::Closure;
use super::parts::Parts;
use crate::diag::Diagnostic;
use crate::scene::{MaterialId, Shape};
use crate::source::{FileId, Span};

/// The largest number a scene may use, in scene units: squares and cubes of it stay finite.
pub const MAX_NUMBER: f64 = 1e18;

/// How deep lists may hold lists.
const MAX_LIST_DEPTH: u32 = 1000;

/// Why an evaluation ends.
pub enum Stop {
    /// Something to tell.
    Told(Box<Diagnostic>),
    /// It needs something that failed and was told already.
    Quiet,
}

impl From<Diagnostic> for Stop {
    fn from(d: Diagnostic) -> Stop {
        Stop::Told(Box::new(d))
    }
}

impl From<Box<Diagnostic>> for Stop {
    fn from(d: Box<Diagnostic>) -> Stop {
        Stop::Told(d)
    }
}

/// The outcome of an evaluation.
pub type Eval<T> = Result<T, Stop>;

/// A value.
#[derive(Clone, Debug)]
pub enum Val {
    /// A number, or a length in scene units.
    Number(f64),
    /// A number that comes of what was measured.
    Measured(Arc<Estimate>),
    /// An angle, degrees.
    Angle(f64),
    /// A colour, linear.
    Color([f32; 3]),
    /// Text and the file that wrote it; `None`: the command line.
    Text(Arc<str>, Option<FileId>),
    /// True or false.
    Bool(bool),
    /// A list.
    List(Arc<List>),
    /// `a..b`; whether of angles (degrees).
    Range(f64, f64, bool),
    /// A shape.
    Shape(Shape),
    /// A material.
    Material(MaterialId),
    /// A function that the scene defines.
    Function(Arc<Closure>),
    /// A function of the language, by its name.
    Builtin(&'static Builtin),
    /// Named values.
    Record(Arc<Record>),
}

/// Named values, such as the bounds of a solid.
#[derive(Debug)]
pub struct Record {
    /// What it is, with its article.
    pub kind: &'static str,
    /// The values with their names, in the order of these where there are more than a few.
    pub fields: Vec<(String, Val)>,
    /// Names whose values failed, in their order: what is wrong is told where they are defined.
    pub failed: Vec<String>,
}

impl Record {
    /// The value of a name.
    pub fn get(&self, name: &str) -> Option<&Val> {
        const FEW: usize = 8;
        let found = match self.fields.len() {
            ..=FEW => self.fields.iter().position(|(n, _)| n == name),
            _ => self.fields.binary_search_by(|(n, _)| n.as_str().cmp(name)).ok(),
        };
        found.map(|i| &self.fields[i].1)
    }

    /// Whether a name is there and its value failed.
    pub fn is_failed(&self, name: &str) -> bool {
        self.failed.binary_search_by(|n| n.as_str().cmp(name)).is_ok()
    }

    /// The names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.fields.iter().map(|(name, _)| name.as_str())
    }
}

/// Values in a row.
#[derive(Debug)]
pub struct List {
    /// The values.
    pub items: Vec<Located>,
    depth: u32,
    _held: Option<Held>,
}

impl List {
    /// The value of a list; the error says that lists nest too deep, or take too much.
    pub fn value(items: Vec<Located>, budget: &Budget, at: Span) -> Eval<Val> {
        let mut held = budget.hold();
        budget.grow(&mut held, items.iter().map(weight).sum(), at)?;
        List::held(items, held, at)
    }

    /// The same where the budget holds the elements already.
    pub fn held(items: Vec<Located>, held: Held, at: Span) -> Eval<Val> {
        let depth = |i: &Located| if let Val::List(l) = &i.value { l.depth + 1 } else { 1 };
        let depth = items.iter().map(depth).max().unwrap_or(1);
        if depth > MAX_LIST_DEPTH {
            return Err(Diagnostic::error("E0701", format!("lists nest deeper than {MAX_LIST_DEPTH}"))
                .at(at, "this list")
                .help("make one flat list")
                .into());
        }
        Ok(Val::List(Arc::new(List { items, depth, _held: Some(held) })))
    }
}

/// A value with the place of its expression.
#[derive(Clone, Debug)]
pub struct Located {
    /// The value.
    pub value: Val,
    /// The place.
    pub at: Span,
}

impl Val {
    /// A vector.
    pub fn vector(numbers: impl IntoIterator<Item = f64>, at: Span) -> Val {
        Val::row(numbers, false, at)
    }

    /// A vector of numbers, or a row of angles (degrees).
    pub fn row(parts: impl IntoIterator<Item = f64>, of_angles: bool, at: Span) -> Val {
        let part = |x| Located { value: if of_angles { Val::Angle(x) } else { Val::Number(x) }, at };
        Val::List(Arc::new(List { items: parts.into_iter().map(part).collect(), depth: 1, _held: None }))
    }

    /// What an operator of numbers acts on, and whether these are angles (degrees).
    pub fn parts(&self) -> Option<(Parts<f64>, bool)> {
        match self {
            Val::Number(x) => Some((Parts::One(*x), false)),
            Val::Angle(x) => Some((Parts::One(*x), true)),
            Val::List(list) if matches!(list.items.first()?.value, Val::Angle(_)) => {
                let angle = |i: &Located| if let Val::Angle(x) = i.value { Some(x) } else { None };
                let angles = (2..=4).contains(&list.items.len()).then(|| list.items.iter().map(angle))?;
                Some((Parts::Many(angles.collect::<Option<_>>()?), true))
            }
            _ => Some((Parts::Many(self.numbers()?), false)),
        }
    }

    /// A vector of numbers, measured or not.
    pub fn vector_of(items: Vec<Located>) -> Val {
        Val::List(Arc::new(List { items, depth: 1, _held: None }))
    }

    /// A number, measured or not.
    pub fn plain(&self) -> Option<f64> {
        match self {
            Val::Number(x) => Some(*x),
            Val::Measured(estimate) => Some(estimate.value),
            _ => None,
        }
    }

    /// The numbers of a vector: a list of two to four numbers.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let Val::List(list) = self else { return None };
        if !(2..=4).contains(&list.items.len()) {
            return None;
        }
        list.items.iter().map(|item| item.value.plain()).collect()
    }

    /// What it is, with its article.
    pub fn kind(&self) -> &'static str {
        match self {
            Val::Number(_) | Val::Measured(_) => "a number",
            Val::Angle(_) => "an angle",
            Val::Color(_) => "a colour",
            Val::Text(..) => "a string",
            Val::Bool(_) => "a truth value",
            Val::List(_) => self.numbers().map_or("a list", |_| "a vector"),
            Val::Range(..) => "a range",
            Val::Shape(_) => "a shape",
            Val::Material(_) => "a material",
            Val::Function(_) | Val::Builtin(_) => "a function",
            Val::Record(record) => record.kind,
        }
    }
}

/// A number that the limits allow.
pub fn bounded(x: f64, at: Span) -> Eval<f64> {
    if !x.is_finite() {
        return Err(Diagnostic::error("E0504", "the number is not finite")
            .at(at, "infinite or undefined")
            .help("look for a division by zero or a root of a negative number")
            .into());
    }
    if x.abs() > MAX_NUMBER { Err(too_large(at).into()) } else { Ok(x) }
}

/// The error for a number beyond [`MAX_NUMBER`].
pub fn too_large(at: Span) -> Diagnostic {
    Diagnostic::error("E0505", format!("the number is beyond the limit of {MAX_NUMBER:e}"))
        .at(at, "too large")
        .help("choose larger units, such as `units(m)`")
}

impl Located {
    /// The error that something else was wanted as `name`.
    pub fn unlike(&self, name: &str, wanted: &str) -> Diagnostic {
        let found = self.value.kind();
        Diagnostic::error("E0501", format!("`{name}` wants {wanted}, found {found}")).at(self.at, found)
    }

    /// A number.
    pub fn number(&self, name: &str) -> Eval<f64> {
        self.as_number(name, "a number")
    }

    /// A number that is called `wanted` in errors.
    pub fn as_number(&self, name: &str, wanted: &str) -> Eval<f64> {
        match &self.value {
            Val::Number(x) => bounded(*x, self.at),
            Val::Measured(estimate) => bounded(estimate.value, self.at),
            Val::Angle(_) => {
                Err(self.unlike(name, wanted).help("divide by a unit to get a number: `angle / 1deg`").into())
            }
            _ => Err(self.unlike(name, wanted).help(format!("write {wanted}, such as `10`")).into()),
        }
    }

    /// An angle, degrees.
    pub fn angle(&self, name: &str, written: &str) -> Eval<f64> {
        match &self.value {
            Val::Angle(x) => bounded(*x, self.at),
            Val::Number(_) | Val::Measured(_) => {
                let angles::Meant { help, edit } = angles::meant(written, false);
                Err(Diagnostic::error("E0502", format!("`{name}` wants an angle, found a bare number"))
                    .at(self.at, "which unit?")
                    .fix_with(self.at, edit.as_deref())
                    .help(help)
                    .into())
            }
            _ => Err(self.unlike(name, "an angle").help("write an angle, such as `30deg`").into()),
        }
    }

    /// So many numbers.
    pub fn vector(&self, name: &str, count: usize) -> Eval<Vec<f64>> {
        let example = ["x", "y", "z", "w"][..count.min(4)].join(", ");
        let Val::List(list) = &self.value else {
            let wanted = format!("a vector of {count} numbers");
            return Err(self.unlike(name, &wanted).help(format!("write `[{example}]`")).into());
        };
        if list.items.len() != count {
            let found = list.items.len();
            let told = format!("`{name}` wants {count} numbers, found {found}");
            return Err(Diagnostic::error("E0501", told)
                .at(self.at, format!("{found} given"))
                .help(format!("write `[{example}]`"))
                .into());
        }
        list.items.iter().map(|i| i.number(name)).collect()
    }

    /// A point or direction.
    pub fn vec3(&self, name: &str) -> Eval<DVec3> {
        let v = self.vector(name, 3)?;
        Ok(DVec3::new(v[0], v[1], v[2]))
    }

    /// A shape.
    pub fn shape(&self, name: &str) -> Eval<&Shape> {
        match &self.value {
            Val::Shape(shape) => Ok(shape),
            Val::List(_) => Err(self.unlike(name, "one shape").help("combine a list: `union(list)`").into()),
            _ => Err(self.unlike(name, "a shape").help("write a shape, such as `sphere(r: 10)`").into()),
        }
    }
}
