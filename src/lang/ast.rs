//! The tree of a scene file as it was written, every node with its place. What the names in it mean is left
//! to `eval`. Chains of operators and of methods are flat, so the tree is no deeper than the text nests.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::source::Span;

/// A word with its place.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Word {
    /// The letters.
    pub text: String,
    /// The place.
    pub at: Span,
}

/// An item of a file.
#[derive(Debug, Serialize, Deserialize)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// From its first word to its last character.
    pub at: Span,
}

/// Kinds of item.
#[derive(Debug, Serialize, Deserialize)]
pub enum ItemKind {
    /// `let name = expr`.
    Let(Word, Expr),
    /// `fn name(params) = expr`.
    Function(Word, Arc<Function>),
    /// `import "file" [as name]`.
    Import(Import),
    /// `print expr`.
    Print(Expr),
    /// `expect expr`.
    Expect(Box<Expect>),
    /// `param name: type = default in allowed "doc"`.
    Param(Box<Param>),
    /// `material name(...)`.
    Material(Word, Args),
    /// `camera [name](...)`.
    Camera(Option<Word>, Args),
    /// `light [name](...)`.
    Light(Option<Word>, Args),
    /// `render(...)`.
    Render(Args),
    /// `units(mm)`.
    Units(Word),
    /// `@word draw expr`.
    Draw(Vec<Word>, Expr),
}

/// A function as it was written: what it takes, and what it gives.
#[derive(Debug, Serialize, Deserialize)]
pub struct Function {
    /// Its parameters, names all different.
    pub params: Vec<Formal>,
    /// What it is worth.
    pub body: Expr,
}

/// A parameter of a function.
#[derive(Debug, Serialize, Deserialize)]
pub struct Formal {
    /// Its name.
    pub name: Word,
    /// The type, if it was written.
    pub kind: Option<Word>,
    /// What it is where no argument is given.
    pub default: Option<Expr>,
}

/// A file whose names are used.
#[derive(Debug, Serialize, Deserialize)]
pub struct Import {
    /// The file, as it was written.
    pub path: String,
    /// The place of the string.
    pub at: Span,
    /// The name space.
    pub space: Option<Word>,
}

/// What must hold.
#[derive(Debug, Serialize, Deserialize)]
pub struct Expect {
    /// A condition, or what is compared.
    pub left: Expr,
    /// What it shall be: the right side, and whether nearly.
    pub right: Option<(bool, Expr)>,
    /// By how much it may differ, and whether that is in percent.
    pub within: Option<(Expr, bool)>,
}

/// A parameter of the scene.
#[derive(Debug, Serialize, Deserialize)]
pub struct Param {
    /// The name that `-D` sets.
    pub name: Word,
    /// The type, if it was written.
    pub kind: Option<Word>,
    /// What it is without `-D`.
    pub default: Expr,
    /// A range or a list of choices.
    pub allowed: Option<Expr>,
}

/// The parenthesised arguments of a call.
#[derive(Debug, Serialize, Deserialize)]
pub struct Args {
    /// The arguments, in the order written.
    pub list: Vec<Arg>,
    /// With the parentheses.
    pub at: Span,
}

/// One argument.
#[derive(Debug, Serialize, Deserialize)]
pub struct Arg {
    /// The word before the colon.
    pub name: Option<Word>,
    /// What is given.
    pub value: Expr,
}

/// An expression.
#[derive(Debug, Serialize, Deserialize)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// The place.
    pub at: Span,
}

/// Kinds of expression.
#[derive(Debug, Serialize, Deserialize)]
pub enum ExprKind {
    /// A number and the unit that touches it.
    Number(f64, Option<Unit>),
    /// A colour, linear.
    Color([f32; 3]),
    /// Text, its escapes resolved.
    Text(String),
    /// `true` or `false`.
    Bool(bool),
    /// A name.
    Name(String),
    /// `[a, b]`.
    List(Vec<Expr>),
    /// `(a)`.
    Paren(Box<Expr>),
    /// What follows an atom: calls, members, indices, left to right.
    Steps(Box<Expr>, Vec<Step>),
    /// A sign before an operand, and the place of the sign.
    Prefix(PrefixOp, Span, Box<Expr>),
    /// Operators of one precedence, left to right, with the places of their signs.
    Infix(Box<Expr>, Vec<(InfixOp, Span, Expr)>),
    /// `if a { b } else { c }`.
    If(Box<[Expr; 3]>),
    /// `for a in b, c in d { e }`; names all different.
    For(Vec<(Word, Expr)>, Box<Expr>),
    /// `fn(a) => b`.
    Function(Arc<Function>),
    /// `{ let a = b  c }`; names all different.
    Block(Vec<(Word, Expr)>, Box<Expr>),
}

/// What follows an atom.
#[derive(Debug, Serialize, Deserialize)]
pub enum Step {
    /// `(...)`.
    Call(Args),
    /// `.word(...)`.
    Method(Word, Args),
    /// `.word`.
    Member(Word),
    /// `[i]`.
    Index(Expr, Span),
}

/// Signs before an operand.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum PrefixOp {
    Negate,
    Complement,
    Not,
}

/// Signs between two operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum InfixOp {
    Or,
    And,
    Equal,
    Unequal,
    AtMost,
    AtLeast,
    Below,
    Above,
    Union,
    Intersect,
    Exclude,
    Range,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
}

impl InfixOp {
    /// As it is written.
    pub fn sign(self) -> &'static str {
        match self {
            InfixOp::Or => "or",
            InfixOp::And => "and",
            InfixOp::Equal => "==",
            InfixOp::Unequal => "!=",
            InfixOp::AtMost => "<=",
            InfixOp::AtLeast => ">=",
            InfixOp::Below => "<",
            InfixOp::Above => ">",
            InfixOp::Union => "|",
            InfixOp::Intersect => "&",
            InfixOp::Exclude => "^",
            InfixOp::Range => "..",
            InfixOp::Add => "+",
            InfixOp::Subtract => "-",
            InfixOp::Multiply => "*",
            InfixOp::Divide => "/",
            InfixOp::Remainder => "%",
            InfixOp::Power => "**",
        }
    }

    /// How tightly it binds; operators of one level form one chain.
    pub fn level(self) -> u8 {
        match self {
            InfixOp::Or => 0,
            InfixOp::And => 1,
            InfixOp::Equal
            | InfixOp::Unequal
            | InfixOp::AtMost
            | InfixOp::AtLeast
            | InfixOp::Below
            | InfixOp::Above => 2,
            InfixOp::Union | InfixOp::Intersect | InfixOp::Exclude => 3,
            InfixOp::Range => 4,
            InfixOp::Add | InfixOp::Subtract => 5,
            InfixOp::Multiply | InfixOp::Divide | InfixOp::Remainder => 6,
            InfixOp::Power => 7,
        }
    }

    /// Whether it orders or equates.
    pub fn compares(self) -> bool {
        self.level() == 2
    }

    /// Whether it may combine solids.
    pub fn combines_solids(self) -> bool {
        self.level() == 3 || self == InfixOp::Subtract
    }
}

/// Units a number can carry.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub enum Unit {
    /// A length: so many micrometres.
    Length(f64),
    /// An angle.
    Angle(AngleUnit),
}

/// Units of angles.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum AngleUnit {
    Degree,
    Radian,
    Turn,
}
