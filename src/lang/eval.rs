//! Expressions to values. Names are looked up here; operators are left to `arithmetic` and `sets`, calls of
//! declared things to `check`, builtins to their table, items to `items`.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::Arc;

use super::args::{Bound, Callee};
use super::ast::{Args, Expr, ExprKind, Function, InfixOp, PrefixOp, Step, Unit, Word};
use super::builtins::{self, Builtin};
use super::flow::{range_count, range_value};
use super::functions::Closure;
use super::queries::Geometry;
use super::scope::Locals;
use super::value::{Eval, List, Located, Stop, Val};
use super::{arithmetic, check, habits, sets, units};
use crate::diag::{Diagnostic, nearest};
use crate::scene::{Call, Catalog, Group, MaterialId, Shape, ShapeKind};
use crate::source::{SourceMap, Span};

/// Calls and turns of loops, at most.
const MAX_STEPS: usize = 5_000_000;

/// What an evaluation knows and gathers.
pub struct Machine<'a> {
    /// What can be called.
    pub catalog: &'a Catalog,
    /// The texts, for the folders of files and for hints.
    pub sources: &'a SourceMap,
    /// Micrometres in a scene unit.
    pub unit: f64,
    /// The names of each file; `None` for one that failed or is not evaluated yet.
    pub names: Vec<HashMap<String, Option<Val>>>,
    /// The file being evaluated.
    pub module: usize,
    /// The names around the expression being evaluated.
    pub locals: Locals,
    /// Calls of functions that are open.
    pub calls: usize,
    /// Calls and turns of loops so far.
    pub steps: usize,
    /// The name of the `let` being evaluated.
    pub binding: Option<String>,
    /// Materials made so far.
    pub materials: Vec<Call>,
    /// Warnings so far.
    pub warnings: Vec<Diagnostic>,
    /// Who measures shapes.
    pub geometry: Option<&'a dyn Geometry>,
    /// The widest bar of what was measured since it was last set to zero.
    pub bars: Cell<f64>,
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

    /// Counts a call or a turn of a loop.
    pub fn step(&mut self, at: Span) -> Eval<()> {
        self.steps += 1;
        if self.steps <= MAX_STEPS {
            return Ok(());
        }
        Err(Diagnostic::error(
            "E0709",
            format!("the scene takes more than {MAX_STEPS} calls and turns of loops"),
        )
        .at(at, "here it is given up")
        .help("does a loop or a recursion come to an end?")
        .into())
    }

    /// Warns of a name that is one of the language.
    pub fn hides_builtin(&mut self, name: &Word) {
        let word = name.text.as_str();
        let constant = builtins::CONSTANTS.iter().any(|(n, _, _)| *n == word);
        if constant || self.callable().any(|known| known == word) {
            let warning = Diagnostic::warning("W0201", format!("`{word}` hides what the language calls so"))
                .at(name.at, "defined here")
                .help("take another name");
            // A block may be evaluated many times.
            if !self.warnings.iter().any(|w| w.labels.first().is_some_and(|l| l.span == name.at)) {
                self.warnings.push(warning);
            }
        }
    }

    /// The value of what a name is given; shapes made there are called so.
    pub fn named(&mut self, name: &str, expr: &Expr) -> Eval<Val> {
        let outside = self.binding.replace(name.to_owned());
        let value = self.value(expr);
        self.binding = outside;
        Ok(match value? {
            Val::Function(closure) if closure.name.is_none() => {
                Val::Function(Arc::new(Closure { name: Some(name.into()), ..(*closure).clone() }))
            }
            value => value,
        })
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
            ExprKind::If(parts) => self.choose(parts),
            ExprKind::For(loops, body) => self.repeat(loops, body, expr.at),
            ExprKind::Block(bindings, body) => self.block(bindings, body),
            ExprKind::Function(function) => Ok(self.function(function, None)),
        }
    }

    /// A function of the names around it.
    pub fn function(&self, function: &Arc<Function>, name: Option<&str>) -> Val {
        Val::Function(Arc::new(Closure {
            function: function.clone(),
            name: name.map(Into::into),
            locals: self.locals.clone(),
            module: self.module,
        }))
    }

    /// What the scene itself calls so.
    pub fn defined(&self, name: &str) -> Option<Eval<Val>> {
        if let Some(value) = self.locals.get(name) {
            return Some(Ok(value.clone()));
        }
        let known = self.names[self.module].get(name)?;
        Some(known.clone().ok_or(Stop::Quiet))
    }

    fn name(&self, name: &str, at: Span) -> Eval<Val> {
        if let Some(value) = self.defined(name) {
            return value;
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
        let mut known: Vec<&str> = self.names[self.module].keys().map(String::as_str).collect();
        known.extend(self.locals.names());
        known.sort_unstable();
        self.callable().for_each(|word| known.push(word));
        builtins::CONSTANTS.iter().for_each(|(word, _, _)| known.push(word));
        let error = Diagnostic::error("E0401", format!("`{name}` is not known")).at(at, "unknown name");
        if let Some(help) = habits::instead(name, habits::Place::Name) {
            return error.help(help);
        }
        match nearest(name, known) {
            Some(known) => error.help(format!("did you mean `{known}`?")),
            None => error.help(format!("define it: `let {name} = ...`")),
        }
    }

    fn steps(&mut self, base: &Expr, steps: &[Step]) -> Eval<Val> {
        let mut rest = steps.iter();
        let mut at = base.at;
        let mut value = match (&base.kind, steps.first()) {
            (ExprKind::Name(name), Some(Step::Call(args))) if self.defined(name).is_none() => {
                rest.next();
                at = at.to(args.at);
                self.call(name, base.at, args)?
            }
            _ => self.value(base)?,
        };
        for step in rest {
            let on = Located { value, at };
            value = match step {
                Step::Call(args) => {
                    let Val::Function(closure) = &on.value else {
                        return Err(self.not_a_function(base, &on, args.at));
                    };
                    at = at.to(args.at);
                    self.call_function(closure, args, at)?
                }
                Step::Method(word, args) => {
                    at = at.to(args.at);
                    match member(&on, &word.text)? {
                        Some(Val::Function(closure)) => self.call_function(&closure, args, at)?,
                        _ => self.method(on, word, args)?,
                    }
                }
                Step::Member(word) => match member(&on, &word.text)? {
                    Some(value) => {
                        at = at.to(word.at);
                        value
                    }
                    None => return Err(no_member(&on, word).into()),
                },
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
        let value = (builtin.call)(&Bound {
            callee,
            receiver,
            values,
            sources: self.sources,
            geometry: self.geometry,
            materials: &self.materials,
            bars: &self.bars,
        })?;
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
        let decides = |left: &Located, op: InfixOp| match (op, &left.value) {
            (InfixOp::Or, Val::Bool(b)) => *b,
            (InfixOp::And, Val::Bool(b)) => !*b,
            _ => false,
        };
        if rest[0].0.level() == 3 || matches!(left.value, Val::Shape(_)) && rest[0].0.level() > 3 {
            let mut operands = Vec::with_capacity(rest.len());
            for (op, sign, operand) in rest {
                operands.push((*op, *sign, self.located(operand)?));
            }
            return sets::chain(left, operands, at);
        }
        for (op, sign, operand) in rest {
            // What the left side decides is not asked of the right: it may hold only where the left does.
            if decides(&left, *op) {
                continue;
            }
            let right = self.located(operand)?;
            if matches!(right.value, Val::Shape(_)) && op.level() > 3 {
                return Err(sets::wrong_sign(*op, *sign, &left, &right).into());
            }
            let at = left.at.to(right.at);
            if let (InfixOp::Equal | InfixOp::Unequal, Val::Shape(a), Val::Shape(b)) =
                (op, &left.value, &right.value)
            {
                let same = self.same_solid(a, b, at)?;
                left = Located { value: Val::Bool(same == (*op == InfixOp::Equal)), at };
                continue;
            }
            left = Located { value: arithmetic::infix(*op, &left, &right, *sign)?, at };
        }
        Ok(left.value)
    }
}

fn no_member(on: &Located, word: &Word) -> Diagnostic {
    let name = word.text.as_str();
    if let Val::Record(record) = &on.value {
        let names: Vec<String> = record.names().map(|n| format!("`.{n}`")).collect();
        let error = Diagnostic::error("E0408", format!("{} has no `{name}`", on.value.kind()));
        let error = error.at(word.at, "unknown part");
        return match nearest(name, record.names()) {
            Some(known) => error.help(format!("did you mean `.{known}`?")),
            None => error.help(format!("it has {}", names.join(" "))),
        };
    }
    if builtins::METHODS.iter().any(|b| b.name == name) {
        return Diagnostic::error("E0410", format!("`.{name}` is called with arguments"))
            .at(word.at, "no arguments")
            .help(format!("write `.{name}(...)`"));
    }
    let error = Diagnostic::error("E0408", format!("{} has no method `{name}`", on.value.kind()))
        .at(word.at, "unknown method");
    if let Some(help) = habits::instead(name, habits::Place::Method) {
        return error.help(help);
    }
    let known = builtins::METHODS.iter().map(|b| b.name);
    match nearest(name, known.clone()) {
        Some(known) => error.help(format!("did you mean `.{known}`?")),
        None => error.help(format!(
            "the methods are {}",
            known.map(|n| format!("`.{n}`")).collect::<Vec<_>>().join(" ")
        )),
    }
}

/// A part of a vector or a record, or a name of a file.
fn member(on: &Located, word: &str) -> Eval<Option<Val>> {
    Ok(match &on.value {
        Val::Record(record) if record.failed.iter().any(|name| name == word) => return Err(Stop::Quiet),
        Val::Record(record) => record.get(word).cloned(),
        Val::List(_) => {
            let axis = ["x", "y", "z", "w"].iter().position(|axis| *axis == word);
            axis.and_then(|axis| on.value.numbers()?.get(axis).map(|x| Val::Number(*x)))
        }
        _ => None,
    })
}

fn element(on: &Located, index: &Located) -> Eval<Val> {
    let count = match &on.value {
        Val::List(list) => list.items.len() as u64,
        Val::Range(lo, hi, _) => range_count(*lo, *hi),
        value => {
            let told = format!("{} has no elements", value.kind());
            let error = Diagnostic::error("E0501", told).at(on.at, value.kind());
            return Err(error.help("only lists have elements: `list[0]`").into());
        }
    };
    let i = index.number("index")?;
    if i.fract() == 0.0 && i >= 0.0 && i < count as f64 {
        return Ok(match &on.value {
            Val::List(list) => list.items[i as usize].value.clone(),
            Val::Range(lo, _, of_angles) => range_value(*lo, i as u64, *of_angles),
            _ => Val::Number(i),
        });
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
