//! Expressions to values. Names are looked up here; operators are left to `arithmetic` and `sets`, calls of
//! declared things to `check`, builtins to their table, items to `items`.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::args::{Bound, Callee};
use super::ast::{Args, Expr, ExprKind, Function, InfixOp, PrefixOp, Step, Unit, Word};
use super::budget::{self, Budget, CHEAP};
use super::builtins::{self, Builtin};
use super::estimate::components;
use super::flow::{range_count, range_value};
use super::functions::Closure;
use super::queries::Geometry;
use super::scope::Locals;
use super::unknown::{callable, no_member};
use super::value::{Eval, List, Located, Stop, Val};
use super::verdict::Doubts;
use super::{arithmetic, check, literals, sets, units};
use crate::diag::Diagnostic;
use crate::scene::{Call, Catalog, Group, MaterialId, Shape, ShapeKind};
use crate::source::{SourceMap, Span};

/// Expressions that are evaluated within one another, at most, those of functions that are called among them: a thousand
/// calls of a body that nests a thousand brackets would take gigabytes of stack.
const DEEPEST: usize = 50_000;

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
    /// Of each file, whether names may be known in it that nobody could read.
    pub partly: Vec<bool>,
    /// The file being evaluated.
    pub module: usize,
    /// The names around the expression being evaluated.
    pub locals: Locals,
    /// Calls of functions that are open.
    pub calls: usize,
    /// Expressions that are open.
    pub depth: usize,
    /// What is left of time and memory.
    pub budget: Budget,
    /// The name of the `let` being evaluated.
    pub binding: Option<String>,
    /// What the language itself calls something.
    pub words: HashSet<&'static str>,
    /// Materials made so far.
    pub materials: Vec<Call>,
    /// Warnings so far.
    pub warnings: Vec<Diagnostic>,
    /// What was warned of where.
    pub warned: HashSet<(&'static str, Option<Span>)>,
    /// Who measures shapes.
    pub geometry: Option<&'a dyn Geometry>,
    /// What comparisons of what was measured left open.
    pub doubts: Doubts,
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

    /// Counts a step, and goes one expression deeper; whoever comes back takes one from `depth`.
    pub fn enter(&mut self, at: Span) -> Eval<()> {
        self.budget.spend(1, at)?;
        if DEEPEST <= self.depth {
            let told = format!("calls and brackets nest deeper than {DEEPEST}");
            return Err(Diagnostic::error("E0706", told)
                .at(at, "the innermost")
                .help("name parts of the function with `let`, or make a list by `for`, without recursion")
                .into());
        }
        self.depth += 1;
        Ok(())
    }

    /// A warning; a loop may give the same many times.
    pub fn warn(&mut self, warning: Diagnostic) {
        if self.warned.insert((warning.code, warning.labels.first().map(|l| l.span))) {
            self.warnings.push(warning);
        }
    }

    /// Warns of a name that is one of the language.
    pub fn hides_builtin(&mut self, name: &Word) {
        let word = name.text.as_str();
        if self.words.contains(word) {
            let warning = Diagnostic::warning("W0201", format!("`{word}` hides what the language calls so"))
                .at(name.at, "defined here")
                .help("take another name");
            self.warn(warning);
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
        self.enter(expr.at)?;
        let value = self.evaluated(expr);
        self.depth -= 1;
        value
    }

    fn evaluated(&mut self, expr: &Expr) -> Eval<Val> {
        match &expr.kind {
            ExprKind::Number(x, unit) => {
                if *x == 0.0 {
                    let lost = literals::lost(self.written(expr.at), expr.at);
                    lost.into_iter().for_each(|warning| self.warn(warning));
                }
                Ok(match unit {
                    None => Val::Number(*x),
                    Some(Unit::Length(um)) => Val::Number(units::length(*x, *um, self.unit)),
                    Some(Unit::Angle(unit)) => Val::Angle(units::degrees(*x, *unit)),
                })
            }
            ExprKind::Color(c) => Ok(Val::Color(*c)),
            ExprKind::Text(text) => Ok(Val::Text(text.as_str().into(), Some(expr.at.file))),
            ExprKind::Bool(b) => Ok(Val::Bool(*b)),
            ExprKind::Name(name) => self.name(name, expr.at),
            ExprKind::List(items) => {
                let items = items.iter().map(|i| self.located(i)).collect::<Eval<Vec<_>>>()?;
                List::value(items, &self.budget, expr.at)
            }
            ExprKind::Paren(inside) => self.value(inside),
            ExprKind::Steps(base, steps) => self.steps(base, steps),
            ExprKind::Prefix(op, sign, operand) => self.prefix(*op, *sign, operand, expr.at),
            ExprKind::Infix(first, rest) => self.infix(first, rest, expr.at),
            ExprKind::If(parts) => self.choose(parts),
            ExprKind::For(loops, body) => self.repeat(loops, body, expr.at),
            ExprKind::Block(bindings, body) => self.block(bindings, body),
            ExprKind::Function(function) => {
                self.budget.keep(budget::CLOSURE, expr.at)?;
                Ok(self.function(function, None))
            }
        }
    }

    /// A function of the names around it.
    pub fn function(&mut self, function: &Arc<Function>, name: Option<&str>) -> Val {
        function.params.iter().for_each(|param| self.hides_builtin(&param.name));
        Val::Function(Arc::new(Closure {
            function: function.clone(),
            name: name.map(Into::into),
            locals: self.locals.clone(),
            module: self.module,
        }))
    }

    /// What the scene itself calls so.
    pub fn defined(&self, name: &str, at: Span) -> Option<Eval<Val>> {
        let (local, seen) = self.locals.get(name);
        if let Err(stop) = self.budget.spend(seen / CHEAP, at) {
            return Some(Err(stop));
        }
        if let Some(value) = local {
            return Some(Ok(value.clone()));
        }
        let known = self.names[self.module].get(name)?;
        Some(known.clone().ok_or(Stop::Quiet))
    }

    /// What a name is worth.
    pub fn name(&self, name: &str, at: Span) -> Eval<Val> {
        if let Some(value) = self.defined(name, at) {
            return value;
        }
        if let Some((_, value, _)) = builtins::CONSTANTS.iter().find(|(n, _, _)| *n == name) {
            return Ok(Val::Number(*value));
        }
        if let Some(function) = builtins::values().find(|b| b.name == name) {
            return Ok(Val::Builtin(function));
        }
        if callable(self.catalog).any(|w| w == name) {
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
        Err(self.unknown(name, at))
    }

    fn steps(&mut self, base: &Expr, steps: &[Step]) -> Eval<Val> {
        let mut rest = steps.iter();
        let mut at = base.at;
        let mut value = match (&base.kind, steps.first()) {
            (ExprKind::Name(name), Some(Step::Call(args))) if self.defined(name, at).is_none() => {
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
                    at = at.to(args.at);
                    match &on.value {
                        Val::Function(closure) => self.call_function(closure, args, at)?,
                        Val::Builtin(builtin) => self.builtin(builtin, None, args, at)?,
                        _ => return Err(self.not_a_function(base, &on, args.at)),
                    }
                }
                Step::Method(word, args) => {
                    at = at.to(args.at);
                    match member(&on, &word.text)? {
                        Some(Val::Function(closure)) => self.call_function(&closure, args, at)?,
                        Some(Val::Builtin(builtin)) => self.builtin(builtin, None, args, at)?,
                        _ => self.method(on, word, args)?,
                    }
                }
                Step::Member(word) => match member(&on, &word.text)? {
                    Some(value) => {
                        at = at.to(word.at);
                        value
                    }
                    None => return Err(no_member(&on, word, &self.budget).into()),
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
            ExprKind::Name(name)
                if callable(self.catalog).any(|w| w == name) && self.defined(name, at).is_some() =>
            {
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
            self.budget.keep(budget::NODE + budget::call(&call), at)?;
            return Ok(Val::Shape(Shape::new(ShapeKind::Leaf { call, name }, at)));
        }
        if let Some(decl) = catalog.find(Group::Material, word) {
            let call = check::call(self, decl, args, at)?;
            self.budget.keep(budget::call(&call), at)?;
            return Ok(self.add_material(call));
        }
        if let Some(builtin) = builtins::functions().find(|b| b.name == word) {
            return self.builtin(builtin, None, args, at);
        }
        self.refuse_call(word, word_at)
    }

    /// The error that nothing of this name can be called.
    pub fn refuse_call<T>(&self, word: &str, word_at: Span) -> Eval<T> {
        if let Some(method) = builtins::METHODS.iter().find(|b| b.name == word) {
            return Err(Diagnostic::error("E0401", format!("`{word}` is a method"))
                .at(word_at, "not a function")
                .help(format!("write it after what it changes: `shape.{}(...)`", method.name))
                .into());
        }
        Err(self.unknown(word, word_at))
    }

    fn method(&mut self, on: Located, word: &Word, args: &Args) -> Eval<Val> {
        let Some(builtin) = builtins::METHODS.iter().find(|b| b.name == word.text) else {
            return Err(no_member(&on, word, &self.budget).into());
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
        let values = exprs.iter().map(|e| e.map(|e| self.located(e)).transpose()).collect::<Eval<Vec<_>>>();
        let values = values.map_err(|stop| Machine::worn(builtin.name, stop))?;
        let warnings = RefCell::default();
        let value = (builtin.call)(&Bound {
            callee,
            receiver,
            values,
            sources: self.sources,
            geometry: self.geometry,
            materials: &self.materials,
            budget: &self.budget,
            warnings: &warnings,
        })?;
        warnings.into_inner().into_iter().for_each(|warning| self.warn(warning));
        self.budget.keep(budget::made(&value), at)?;
        arithmetic::finite(&value, builtin.name, at)?;
        Ok(value)
    }

    fn prefix(&mut self, op: PrefixOp, sign: Span, operand: &Expr, at: Span) -> Eval<Val> {
        let on = self.located(operand)?;
        match (op, &on.value) {
            (PrefixOp::Negate, _) => arithmetic::negate(&on, sign),
            (PrefixOp::Not, Val::Bool(b)) => Ok(Val::Bool(!b)),
            (PrefixOp::Complement, Val::Shape(_)) => {
                self.budget.keep(budget::NODE + budget::OPERAND, at)?;
                sets::complement(on, at)
            }
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
            self.budget.keep(budget::NODE + budget::OPERAND * (rest.len() + 1), at)?;
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
            if let Some(holds) = self.compare(*op, &left.value, &right.value) {
                self.warn_of_open(at);
                left = Located { value: Val::Bool(holds), at };
                continue;
            }
            left = Located { value: arithmetic::infix(*op, &left, &right, *sign, &self.budget)?, at };
        }
        Ok(left.value)
    }
}

/// A part of a vector or a record, or a name of a file.
fn member(on: &Located, word: &str) -> Eval<Option<Val>> {
    Ok(match &on.value {
        Val::Record(record) if record.is_failed(word) => return Err(Stop::Quiet),
        Val::Record(record) => record.get(word).cloned(),
        Val::List(_) => {
            let axis = ["x", "y", "z", "w"].iter().position(|axis| *axis == word);
            axis.and_then(|axis| components(&on.value)?.get(axis).cloned())
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
