//! The tree of a scene file as it was written, every node with its place. What the names in it mean is left
//! to `eval`. Chains of operators and of methods are flat, so the tree is no deeper than the text nests.

use crate::source::Span;

/// A word with its place.
#[derive(Clone, Debug)]
pub struct Word {
    /// The letters.
    pub text: String,
    /// The place.
    pub at: Span,
}

/// An item of a file.
#[derive(Debug)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// From its first word to its last character.
    pub at: Span,
}

/// Kinds of item.
#[derive(Debug)]
pub enum ItemKind {
    /// `let name = expr`.
    Let(Word, Expr),
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
    /// An item that is understood but not carried out yet: its keyword.
    Later(&'static str),
}

/// A parameter of the scene.
#[derive(Debug)]
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
#[derive(Debug)]
pub struct Args {
    /// The arguments, in the order written.
    pub list: Vec<Arg>,
    /// With the parentheses.
    pub at: Span,
}

/// One argument.
#[derive(Debug)]
pub struct Arg {
    /// The word before the colon.
    pub name: Option<Word>,
    /// What is given.
    pub value: Expr,
}

/// An expression.
#[derive(Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// The place.
    pub at: Span,
}

/// Kinds of expression.
#[derive(Debug)]
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
    /// An expression that is understood but not carried out yet: its keyword or sign.
    Later(&'static str),
}

/// What follows an atom.
#[derive(Debug)]
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
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)]
pub enum PrefixOp {
    Negate,
    Complement,
    Not,
}

/// Signs between two operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
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
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Unit {
    /// A length: so many micrometres.
    Length(f64),
    /// An angle.
    Angle(AngleUnit),
}

/// Units of angles.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)]
pub enum AngleUnit {
    Degree,
    Radian,
    Turn,
}
