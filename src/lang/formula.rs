//! Conditions on the coordinates of any form, such as `x**2 + y**2 + z**2 <= 1`: read as the steps of a formula. What
//! does not depend on x, y and z is evaluated at once.

use super::angles;
use super::args::Callee;
use super::ast::{Args, Expr, ExprKind, InfixOp, PrefixOp, Step as Follows};
use super::eval::Machine;
use super::formula_functions::{FUNCTIONS, Function};
use super::parts::Parts;
use super::value::{Eval, Val, bounded};
use super::{arithmetic, order};
use crate::diag::{Diagnostic, nearest};
use crate::scene::Formula;
use crate::scene::formula::{Builder, One, Step, Two};
use crate::source::Span;

/// The most steps one formula may have.
const MAX_STEPS: usize = 100_000;

/// What a part of a formula is worth.
#[derive(Clone, Debug)]
pub struct Term {
    /// Its steps.
    pub steps: Parts<u32>,
    /// Whether they are angles, radians.
    pub of_angles: bool,
}

impl Term {
    /// One number.
    pub fn number(step: u32) -> Term {
        Term { steps: Parts::One(step), of_angles: false }
    }

    /// What it is, with its article.
    pub fn kind(&self) -> &'static str {
        match (&self.steps, self.of_angles) {
            (Parts::One(_), false) => "a number",
            (Parts::One(_), true) => "an angle",
            (Parts::Many(_), false) => "a vector",
            (Parts::Many(_), true) => "a list of angles",
        }
    }
}

/// A term with its place.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The term.
    pub term: Term,
    /// Where it was written.
    pub at: Span,
}

/// A formula being read.
pub struct Reader<'m, 'a> {
    pub(super) machine: &'m mut Machine<'a>,
    steps: Builder,
    /// What depends on the coordinates: their names, and in a function that is called its parameters; the innermost last.
    pub(super) symbols: Vec<(String, Term)>,
}

/// Reads a comparison whose sides may use x, y and z.
pub fn read(machine: &mut Machine, expr: &Expr) -> Eval<Formula> {
    let mut inner = expr;
    while let ExprKind::Paren(inside) = &inner.kind {
        inner = inside;
    }
    let (left, op, right) = match &inner.kind {
        ExprKind::Infix(left, rest) if rest[0].0.compares() => (left, rest[0].0, &rest[0].2),
        ExprKind::Infix(_, rest) if matches!(rest[0].0, InfixOp::And | InfixOp::Or) => {
            let error = refuse(expr, "is a condition of several", "one comparison is wanted");
            return Err(error.help("both of two: `max(f, g) <= 0`; any of two: `min(f, g) <= 0`").into());
        }
        ExprKind::Function(_) => {
            let error = refuse(expr, "is a function, not a condition", "expected a comparison");
            return Err(error.help("leave `fn(...) =>` away: `x`, `y` and `z` are known here").into());
        }
        _ => return Err(refuse(expr, "is not a condition", "expected a comparison").into()),
    };
    let mut reader = Reader { machine, steps: Builder::default(), symbols: Vec::new() };
    for (axis, name) in (0..).zip(["x", "y", "z"]) {
        let step = reader.add(Step::Coordinate(axis), expr.at)?;
        reader.symbols.push((name.to_owned(), Term::number(step)));
    }
    let (a, b) = (reader.placed(left)?, reader.placed(right)?);
    let (low, high, closed) = match op {
        InfixOp::Below | InfixOp::AtMost => (a, b, op == InfixOp::AtMost),
        InfixOp::Above | InfixOp::AtLeast => (b, a, op == InfixOp::AtLeast),
        _ => return Err(refuse(expr, "has no inside", "a surface, not a solid").into()),
    };
    let last = match (&low.term.steps, &high.term.steps) {
        (Parts::One(a), Parts::One(b)) if low.term.of_angles == high.term.of_angles => {
            // What is compared with zero is the formula itself.
            let zero = reader.steps.constant(*b) == Some(0.0);
            if zero { *a } else { reader.two(Two::Subtract, *a, *b, expr.at)? }
        }
        _ => return Err(reader.unlike(op, &low, &high, rest_sign(inner)).into()),
    };
    if reader.steps.constant(last).is_some() {
        return Err(refuse(expr, "does not depend on x, y or z", "the same everywhere").into());
    }
    Ok(reader.steps.finish(last, closed))
}

fn rest_sign(expr: &Expr) -> Span {
    match &expr.kind {
        ExprKind::Infix(_, rest) => rest[0].1,
        _ => expr.at,
    }
}

fn refuse(expr: &Expr, what: &str, label: &str) -> Diagnostic {
    Diagnostic::error("E0511", format!("the formula {what}"))
        .at(expr.at, label)
        .help("write a condition on x, y and z: `x**2 + y**2 + z**2 <= 1`")
}

impl Reader<'_, '_> {
    /// A term with its place.
    pub fn placed(&mut self, expr: &Expr) -> Eval<Placed> {
        Ok(Placed { term: self.term(expr)?, at: expr.at })
    }

    /// Whether an expression depends on the coordinates.
    pub fn is_symbolic(&self, expr: &Expr) -> Eval<bool> {
        let names: Vec<&str> = self.symbols.iter().map(|(name, _)| name.as_str()).collect();
        let (uses, steps) = order::uses(expr, &names);
        self.machine.budget.spend(steps, expr.at)?;
        Ok(uses)
    }

    /// The steps of an expression.
    pub fn term(&mut self, expr: &Expr) -> Eval<Term> {
        self.machine.enter(expr.at)?;
        let term = self.read(expr);
        self.machine.depth -= 1;
        term
    }

    fn read(&mut self, expr: &Expr) -> Eval<Term> {
        match &expr.kind {
            ExprKind::Name(n) if self.symbols.iter().any(|(name, _)| name == n) => {
                let symbol = self.symbols.iter().rfind(|(name, _)| name == n);
                symbol.map(|(_, term)| term.clone()).ok_or_else(|| stranger(expr.at).into())
            }
            _ if !self.is_symbolic(expr)? => self.constant(expr),
            ExprKind::Paren(inside) => self.term(inside),
            ExprKind::If(parts) => self.choose(parts),
            ExprKind::Block(bindings, body) => self.block(bindings, body),
            ExprKind::Prefix(PrefixOp::Negate, _, operand) => {
                let Term { steps, of_angles } = self.term(operand)?;
                let steps = steps.try_map(|a| self.one(One::Negate, a, expr.at))?;
                Ok(Term { steps, of_angles })
            }
            ExprKind::Infix(first, rest) if rest[0].0.level() >= 5 => {
                let mut sum = self.placed(first)?;
                for (op, sign, operand) in rest {
                    let next = self.placed(operand)?;
                    let at = sum.at.to(next.at);
                    sum = Placed { term: self.infix(*op, *sign, &sum, &next)?, at };
                }
                Ok(sum.term)
            }
            ExprKind::Infix(first, rest) if rest[0].0 == InfixOp::Exclude => {
                let base = self.machine.written(first.at).split_whitespace().last().unwrap_or_default();
                let told = format!("`{base}^` is the difference of solids, not a power");
                let error = Diagnostic::error("E0511", told);
                let error = error.at(rest[0].1, "in a formula").fix(rest[0].1, "**");
                Err(error.help("a power is written `a ** b`: `x**2 + y**2 + z**2 <= 1`").into())
            }
            ExprKind::List(items) if (2..=4).contains(&items.len()) => {
                let items = items.iter().map(|item| self.placed(item)).collect::<Eval<Vec<_>>>()?;
                let of_angles = items[0].term.of_angles;
                let one = |item| match of_angles {
                    true => self.angle(item, "a list of angles"),
                    false => self.number(item, "a vector"),
                };
                let steps = Parts::Many(items.iter().map(one).collect::<Eval<_>>()?);
                Ok(Term { steps, of_angles })
            }
            ExprKind::Steps(base, steps) => match (&base.kind, steps.as_slice()) {
                (ExprKind::Name(word), [Follows::Call(args), rest @ ..]) => {
                    let called = self.call(word, base.at, args)?;
                    self.indexed(called, rest, expr.at)
                }
                (_, [Follows::Index(..), ..]) => {
                    let vector = self.term(base)?;
                    self.indexed(vector, steps, expr.at)
                }
                _ => Err(stranger(expr.at).into()),
            },
            _ => Err(stranger(expr.at).into()),
        }
    }

    /// A term, or one number of a vector.
    fn indexed(&mut self, term: Term, steps: &[Follows], at: Span) -> Eval<Term> {
        let (index, index_at, v) = match (&term.steps, steps) {
            (_, []) => return Ok(term),
            (Parts::Many(v), [Follows::Index(index, index_at)]) => (index, *index_at, v),
            _ => return Err(stranger(at).into()),
        };
        if self.is_symbolic(index)? {
            let error = Diagnostic::error("E0511", "an index of a formula is the same everywhere");
            return Err(error.at(index.at, "depends on x, y or z").help("write a number").into());
        }
        let given = self.machine.located(index)?;
        let i = given.number("the index")?;
        let Some((_, step)) = v.iter().enumerate().find(|(k, _)| *k as f64 == i) else {
            let last = v.len() - 1;
            let error = Diagnostic::error("E0512", format!("there is no number {i} in this vector"));
            return Err(error.at(index_at, "no such index").help(format!("write 0 to {last}")).into());
        };
        Ok(Term { steps: Parts::One(*step), of_angles: term.of_angles })
    }

    /// What does not depend on the coordinates.
    fn constant(&mut self, expr: &Expr) -> Eval<Term> {
        let given = self.machine.located(expr)?;
        let (parts, of_angles) = match given.value.parts() {
            Some(parts) => parts,
            None => (Parts::One(given.number("the formula")?), false),
        };
        let unit = |x: f64| if of_angles { x.to_radians() } else { x };
        let steps = parts.try_map(|x| self.add(Step::Number(unit(bounded(x, expr.at)?)), expr.at))?;
        Ok(Term { steps, of_angles })
    }

    fn call(&mut self, word: &str, word_at: Span, args: &Args) -> Eval<Term> {
        if let Some(known) = self.machine.defined(word, word_at) {
            return match known? {
                Val::Function(closure) => self.call_function(&closure, args, word_at.to(args.at)),
                Val::Builtin(builtin) => self.call_builtin(builtin.name, word_at, args),
                value => {
                    let kind = value.kind();
                    let error = Diagnostic::error("E0410", format!("{kind} cannot be called"));
                    Err(error
                        .at(word_at, kind)
                        .help("remove the arguments, or put an operator before the `(`")
                        .into())
                }
            };
        }
        self.call_builtin(word, word_at, args)
    }

    /// The steps of a call of a function of the language.
    fn call_builtin(&mut self, word: &str, word_at: Span, args: &Args) -> Eval<Term> {
        let Some(function) = FUNCTIONS.iter().find(|f| f.name == word) else {
            let error = Diagnostic::error("E0511", format!("`{word}` is no function of a formula"));
            let error = error.at(word_at, "not known here");
            return Err(match nearest(word, FUNCTIONS.iter().map(|f| f.name)) {
                Some(near) => error.fix_slip(word_at, word, near).help(format!("did you mean `{near}`?")),
                None => error.help(format!(
                    "the functions are {}",
                    FUNCTIONS.iter().map(|f| format!("`{}`", f.name)).collect::<Vec<_>>().join(" ")
                )),
            }
            .into());
        };
        let Function { name, formals, call } = *function;
        let at = word_at.to(args.at);
        let bound = Callee { word: name, at, formals }.bind(args, "")?;
        let given = bound.into_iter().flatten().map(|e| self.placed(e)).collect::<Eval<Vec<_>>>()?;
        call(self, &given, at)
    }

    /// An operator between two terms.
    pub(super) fn infix(&mut self, op: InfixOp, sign: Span, a: &Placed, b: &Placed) -> Eval<Term> {
        let of_angles = arithmetic::is_angle(op, a.term.of_angles, b.term.of_angles);
        let pairs = a.term.steps.clone().zip(b.term.steps.clone());
        let (Some(of_angles), Some(pairs)) = (of_angles, pairs) else {
            return Err(self.unlike(op, a, b, sign).into());
        };
        let steps = pairs.try_map(|(a, b)| self.numbers(op, a, b, sign))?;
        Ok(Term { steps, of_angles })
    }

    /// An operator between two numbers; the remainder is a - b floor(a / b), as outside formulas.
    fn numbers(&mut self, op: InfixOp, a: u32, b: u32, sign: Span) -> Eval<u32> {
        let two = match op {
            InfixOp::Add => Two::Add,
            InfixOp::Subtract => Two::Subtract,
            InfixOp::Multiply => Two::Multiply,
            InfixOp::Divide => Two::Divide,
            InfixOp::Power => Two::Power,
            _ => {
                let share = self.two(Two::Divide, a, b, sign)?;
                let whole = self.one(One::Floor, share, sign)?;
                let taken = self.two(Two::Multiply, b, whole, sign)?;
                return self.two(Two::Subtract, a, taken, sign);
            }
        };
        self.two(two, a, b, sign)
    }

    fn unlike(&self, op: InfixOp, a: &Placed, b: &Placed, sign: Span) -> Diagnostic {
        let (left, right) = (a.term.kind(), b.term.kind());
        let error = Diagnostic::error("E0203", format!("`{}` cannot take {left} and {right}", op.sign()));
        let error = error.at(sign, "does not fit its operands").at(a.at, left).at(b.at, right);
        match a.term.of_angles || b.term.of_angles {
            true => error.help("divide an angle by a unit to get a number: `angle / 1rad`"),
            false => error.help("numbers are wanted, or vectors of one size"),
        }
    }

    /// A number, or an error that names the function that wants it.
    pub fn number(&self, given: &Placed, of: &str) -> Eval<u32> {
        match given.term {
            Term { steps: Parts::One(a), of_angles: false } => Ok(a),
            _ => {
                let kind = given.term.kind();
                let error = Diagnostic::error("E0501", format!("`{of}` wants a number, found {kind}"));
                Err(error.at(given.at, kind).help("write a number").into())
            }
        }
    }

    /// An angle, radians.
    pub fn angle(&self, given: &Placed, of: &str) -> Eval<u32> {
        match &given.term {
            Term { steps: Parts::One(a), of_angles: true } => Ok(*a),
            Term { steps: Parts::One(_), .. } => {
                let angles::Meant { help, edit } = angles::meant(self.machine.written(given.at), true);
                let error = Diagnostic::error("E0502", format!("`{of}` wants an angle, found a bare number"));
                let error = error.at(given.at, "which unit?").fix_with(given.at, edit.as_deref());
                Err(error.help(help).into())
            }
            other => {
                let kind = other.kind();
                let error = Diagnostic::error("E0501", format!("`{of}` wants an angle, found {kind}"));
                Err(error.at(given.at, kind).help("write an angle, such as `x * 1rad`").into())
            }
        }
    }

    fn add(&mut self, step: Step, at: Span) -> Eval<u32> {
        if self.steps.len() < MAX_STEPS {
            return Ok(self.steps.add(step));
        }
        let error = Diagnostic::error("E0703", format!("a formula of more than {MAX_STEPS} steps"));
        Err(error.at(at, "too long").help("write a shorter formula").into())
    }

    /// A number.
    pub fn literal(&mut self, x: f64, at: Span) -> Eval<u32> {
        self.add(Step::Number(x), at)
    }

    /// A function of a step.
    pub fn one(&mut self, op: One, a: u32, at: Span) -> Eval<u32> {
        match (op, self.steps.constant(a)) {
            (One::Negate, Some(x)) => self.add(Step::Number(-x), at),
            _ => self.add(Step::One(op, a), at),
        }
    }

    /// A function of two steps. What has only numbers in it is a number.
    pub fn two(&mut self, op: Two, a: u32, b: u32, at: Span) -> Eval<u32> {
        let (x, y) = (self.steps.constant(a), self.steps.constant(b));
        let folded = match (op, x, y) {
            (Two::Add, Some(x), Some(y)) => x + y,
            (Two::Subtract, Some(x), Some(y)) => x - y,
            (Two::Multiply, Some(x), Some(y)) => x * y,
            (Two::Divide, Some(x), Some(y)) => x / y,
            (Two::Power, Some(x), Some(y)) => x.powf(y),
            (Two::Power, None, Some(n)) if n.fract() == 0.0 && n.abs() <= 1024.0 => {
                return match n as i32 {
                    0 => self.add(Step::Number(1.0), at),
                    1 => Ok(a),
                    n => self.add(Step::Power(a, n), at),
                };
            }
            _ => return self.add(Step::Two(op, a, b), at),
        };
        self.add(Step::Number(bounded(folded, at)?), at)
    }
}

pub(super) fn stranger(at: Span) -> Diagnostic {
    Diagnostic::error("E0511", "this cannot stand in a formula of x, y and z")
        .at(at, "not a number")
        .help("a formula is made of numbers, operators and functions of numbers")
}
