//! Expressions to values. Names are looked up here; operators are left to `arithmetic` and `sets`, calls of
//! declared things to `check`, builtins to their table, items to `items`.

use std::collections::HashMap;

use super::args::{Bound, Callee};
use super::ast::{Args, Expr, ExprKind, InfixOp, PrefixOp, Step, Unit, Word};
use super::builtins::{self, Builtin};
use super::value::{Eval, List, Located, Stop, Val};
use super::{arithmetic, check, sets, units};
use crate::diag::{Diagnostic, nearest};
use crate::scene::{Call, Catalog, Group, MaterialId, Shape, ShapeKind};
use crate::source::{SourceMap, Span};

/// What an evaluation knows and gathers.
pub struct Machine<'a> {
    /// What can be called.
    pub catalog: &'a Catalog,
    /// The texts, for the folders of files and for hints.
    pub sources: &'a SourceMap,
    /// Micrometres in a scene unit.
    pub unit: f64,
    /// The names of the file; `None` for one that failed or is not evaluated yet.
    pub names: HashMap<String, Option<Val>>,
    /// The name of the `let` being evaluated.
    pub binding: Option<String>,
    /// Materials made so far.
    pub materials: Vec<Call>,
    /// Warnings so far.
    pub warnings: Vec<Diagnostic>,
}

impl Machine<'_> {
    /// How a place was written.
    pub fn written(&self, at: Span) -> &str {
        self.sources.text(at)
    }

    /// A material's number.
    pub fn add_material(&mut self, call: Call) -> Val {
        self.materials.push(call);
        Val::Material(MaterialId(self.materials.len() as u32 - 1))
    }

    /// The value of an expression with its place.
    pub fn located(&mut self, expr: &Expr) -> Eval<Located> {
        Ok(Located { value: self.value(expr)?, at: expr.at })
    }

    /// The value of an expression.
    pub fn value(&mut self, expr: &Expr) -> Eval<Val> {
        match &expr.kind {
            ExprKind::Number(x, None) => Ok(Val::Number(*x)),
            ExprKind::Number(x, Some(Unit::Length(um))) => Ok(Val::Number(units::length(*x, *um, self.unit))),
            ExprKind::Number(x, Some(Unit::Angle(unit))) => Ok(Val::Angle(units::degrees(*x, *unit))),
            ExprKind::Color(c) => Ok(Val::Color(*c)),
            ExprKind::Text(text) => Ok(Val::Text(text.as_str().into(), Some(expr.at.file))),
            ExprKind::Bool(b) => Ok(Val::Bool(*b)),
            ExprKind::Name(name) => self.name(name, expr.at),
            ExprKind::List(items) => {
                let items = items.iter().map(|i| self.located(i)).collect::<Eval<Vec<_>>>()?;
                List::value(items, expr.at)
            }
            ExprKind::Paren(inside) => self.value(inside),
            ExprKind::Steps(base, steps) => self.steps(base, steps),
            ExprKind::Prefix(op, sign, operand) => self.prefix(*op, *sign, operand, expr.at),
            ExprKind::Infix(first, rest) => self.infix(first, rest, expr.at),
            ExprKind::Later(what) => Err(later(what, expr.at).into()),
        }
    }

    fn name(&self, name: &str, at: Span) -> Eval<Val> {
        match self.names.get(name) {
            Some(Some(value)) => return Ok(value.clone()),
            Some(None) => return Err(Stop::Quiet),
            None => {}
        }
        if let Some((_, value, _)) = builtins::CONSTANTS.iter().find(|(n, _, _)| *n == name) {
            return Ok(Val::Number(*value));
        }
        if self.callable().any(|w| w == name) {
            return Err(Diagnostic::error("E0410", format!("`{name}` is called with arguments"))
                .at(at, "no arguments")
                .help(format!("write `{name}(...)`"))
                .into());
        }
        if ["nan", "inf", "infinity"].contains(&name.to_ascii_lowercase().as_str()) {
            return Err(Diagnostic::error("E0504", format!("`{name}` is not finite"))
                .at(at, "not a number of a scene")
                .help("scenes have finite numbers only")
                .into());
        }
        Err(self.unknown(name, at).into())
    }

    /// The words that can be called.
    fn callable(&self) -> impl Iterator<Item = &'static str> + '_ {
        let catalog = self.catalog.words(Group::Primitive).chain(self.catalog.words(Group::Material));
        catalog.chain(builtins::functions().map(|b| b.name))
    }

    fn unknown(&self, name: &str, at: Span) -> Diagnostic {
        let mut known: Vec<&str> = self.names.keys().map(String::as_str).collect();
        known.sort_unstable();
        self.callable().for_each(|word| known.push(word));
        builtins::CONSTANTS.iter().for_each(|(word, _, _)| known.push(word));
        let error = Diagnostic::error("E0401", format!("`{name}` is not known")).at(at, "unknown name");
        match nearest(name, known) {
            Some(known) => error.help(format!("did you mean `{known}`?")),
            None => error.help(format!("define it: `let {name} = ...`")),
        }
    }

    fn steps(&mut self, base: &Expr, steps: &[Step]) -> Eval<Val> {
        let mut rest = steps.iter();
        let mut at = base.at;
        let mut value = match (&base.kind, steps.first()) {
            (ExprKind::Name(name), Some(Step::Call(args))) if !self.names.contains_key(name) => {
                rest.next();
                at = at.to(args.at);
                self.call(name, base.at, args)?
            }
            _ => self.value(base)?,
        };
        for step in rest {
            let on = Located { value, at };
            value = match step {
                Step::Call(args) => return Err(self.not_a_function(base, &on, args.at)),
                Step::Method(word, args) => {
                    at = at.to(args.at);
                    self.method(on, word, args)?
                }
                Step::Member(word) => return Err(no_member(&on, word).into()),
                Step::Index(index, place) => {
                    at = at.to(*place);
                    let index = self.located(index)?;
                    element(&on, &index)?
                }
            };
        }
        Ok(value)
    }

    fn not_a_function(&self, base: &Expr, on: &Located, at: Span) -> Stop {
        let kind = on.value.kind();
        let error =
            Diagnostic::error("E0410", format!("{kind} cannot be called")).at(at, "a call").at(on.at, kind);
        match &base.kind {
            ExprKind::Name(name) if self.callable().any(|w| w == name) => {
                error.help(format!("here `{name}` is a name of this file: take another name for it")).into()
            }
            _ => error.help("remove the arguments, or put an operator before the `(`").into(),
        }
    }

    fn call(&mut self, word: &str, word_at: Span, args: &Args) -> Eval<Val> {
        let at = word_at.to(args.at);
        let catalog = self.catalog;
        if let Some(decl) = catalog.find(Group::Primitive, word) {
            let call = check::call(self, decl, args, at)?;
            let name = self.binding.clone().unwrap_or_else(|| word.to_owned());
            return Ok(Val::Shape(Shape::new(ShapeKind::Leaf { call, name }, at)));
        }
        if let Some(decl) = catalog.find(Group::Material, word) {
            let call = check::call(self, decl, args, at)?;
            return Ok(self.add_material(call));
        }
        if let Some(builtin) = builtins::functions().find(|b| b.name == word) {
            return self.builtin(builtin, None, args, at);
        }
        if builtins::LATER.contains(&word) {
            return Err(later(word, word_at).into());
        }
        if let Some(method) = builtins::METHODS.iter().find(|b| b.name == word) {
            return Err(Diagnostic::error("E0401", format!("`{word}` is a method"))
                .at(word_at, "not a function")
                .help(format!("write it after what it changes: `shape.{}(...)`", method.name))
                .into());
        }
        Err(self.unknown(word, word_at).into())
    }

    fn method(&mut self, on: Located, word: &Word, args: &Args) -> Eval<Val> {
        let Some(builtin) = builtins::METHODS.iter().find(|b| b.name == word.text) else {
            return Err(no_member(&on, word).into());
        };
        if !matches!(on.value, Val::Shape(_)) {
            let kind = on.value.kind();
            let error =
                Diagnostic::error("E0501", format!("`.{}` is a method of shapes, not of {kind}", word.text));
            let help = match on.value {
                Val::List(_) => "combine the list first: `union(list)`",
                _ => "call it on a shape",
            };
            return Err(error.at(word.at, "needs a shape").at(on.at, kind).help(help).into());
        }
        let at = on.at.to(args.at);
        self.builtin(builtin, Some(on), args, at)
    }

    fn builtin(&mut self, builtin: &Builtin, receiver: Option<Located>, args: &Args, at: Span) -> Eval<Val> {
        let callee = Callee { word: builtin.name, at, formals: builtin.formals };
        let exprs = callee.bind(args, "")?;
        let values =
            exprs.iter().map(|e| e.map(|e| self.located(e)).transpose()).collect::<Eval<Vec<_>>>()?;
        let value = (builtin.call)(&Bound { callee, receiver, values, sources: self.sources })?;
        arithmetic::finite(&value, builtin.name, at)?;
        Ok(value)
    }

    fn prefix(&mut self, op: PrefixOp, sign: Span, operand: &Expr, at: Span) -> Eval<Val> {
        let on = self.located(operand)?;
        match (op, &on.value) {
            (PrefixOp::Negate, _) => arithmetic::negate(&on, sign),
            (PrefixOp::Not, Val::Bool(b)) => Ok(Val::Bool(!b)),
            (PrefixOp::Complement, Val::Shape(_)) => sets::complement(on, at),
            (PrefixOp::Not, value) => {
                Err(Diagnostic::error("E0203", format!("`not` cannot take {}", value.kind()))
                    .at(on.at, value.kind())
                    .help("`not` takes a condition; the complement of a solid is `!solid`")
                    .into())
            }
            (_, value) => Err(Diagnostic::error("E0203", format!("`!` cannot take {}", value.kind()))
                .at(on.at, value.kind())
                .help("`!` takes a solid; the contrary of a condition is `not condition`")
                .into()),
        }
    }

    fn infix(&mut self, first: &Expr, rest: &[(InfixOp, Span, Expr)], at: Span) -> Eval<Val> {
        let mut left = self.located(first)?;
        if rest[0].0.level() == 3 || matches!(left.value, Val::Shape(_)) && rest[0].0.level() > 3 {
            let mut operands = Vec::with_capacity(rest.len());
            for (op, sign, operand) in rest {
                operands.push((*op, *sign, self.located(operand)?));
            }
            return sets::chain(left, operands, at);
        }
        for (op, sign, operand) in rest {
            let right = self.located(operand)?;
            if matches!(right.value, Val::Shape(_)) && op.level() > 3 {
                return Err(sets::wrong_sign(*op, *sign, &left, &right).into());
            }
            let at = left.at.to(right.at);
            left = Located { value: arithmetic::infix(*op, &left, &right, *sign)?, at };
        }
        Ok(left.value)
    }
}

fn no_member(on: &Located, word: &Word) -> Diagnostic {
    let name = word.text.as_str();
    if builtins::LATER.contains(&name) {
        return later(name, word.at);
    }
    if builtins::METHODS.iter().any(|b| b.name == name) {
        return Diagnostic::error("E0410", format!("`.{name}` is called with arguments"))
            .at(word.at, "no arguments")
            .help(format!("write `.{name}(...)`"));
    }
    let error = Diagnostic::error("E0408", format!("{} has no method `{name}`", on.value.kind()))
        .at(word.at, "unknown method");
    let known = builtins::METHODS.iter().map(|b| b.name);
    match nearest(name, known.clone()) {
        Some(known) => error.help(format!("did you mean `.{known}`?")),
        None => error.help(format!(
            "the methods are {}",
            known.map(|n| format!("`.{n}`")).collect::<Vec<_>>().join(" ")
        )),
    }
}

fn element(on: &Located, index: &Located) -> Eval<Val> {
    let Val::List(list) = &on.value else {
        let told = format!("{} has no elements", on.value.kind());
        let error = Diagnostic::error("E0501", told).at(on.at, on.value.kind());
        return Err(error.help("only lists have elements: `list[0]`").into());
    };
    let i = index.number("index")?;
    let count = list.items.len();
    if i.fract() == 0.0 && i >= 0.0 && i < count as f64 {
        return Ok(list.items[i as usize].value.clone());
    }
    let help = match count {
        0 => "the list is empty".to_owned(),
        _ => format!("the list has {count} elements, from `[0]` to `[{}]`", count - 1),
    };
    Err(Diagnostic::error("E0503", format!("there is no element {i}"))
        .at(index.at, "no such element")
        .help(help)
        .into())
}

/// The error for what is understood but not carried out yet.
pub fn later(what: &str, at: Span) -> Diagnostic {
    let what = if what == "{" { "a block" } else { &format!("`{what}`") };
    Diagnostic::error("E0702", format!("{what} is not supported yet"))
        .at(at, "understood, but not carried out")
        .help("write the scene without it, or wait for a later version")
}
