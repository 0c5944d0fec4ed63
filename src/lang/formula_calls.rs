//! Functions of the scene, blocks and choices in a formula: a function's body is read with its parameters as the terms that
//! are given. What does not depend on the coordinates is evaluated at once, as everywhere.

use super::args::Callee;
use super::ast::{Args, Expr, Word};
use super::formula::{Reader, Term};
use super::functions::{Closure, formal};
use super::scope::Locals;
use super::value::{Eval, Stop, Val};
use crate::diag::Diagnostic;
use crate::source::Span;

/// Calls within calls, at most: a recursion in a formula ends by what is known before tracing.
const DEEPEST: usize = 1000;

impl Reader<'_, '_> {
    /// The steps of a call.
    pub(super) fn call_function(&mut self, closure: &Closure, args: &Args, at: Span) -> Eval<Term> {
        if DEEPEST <= self.machine.calls {
            let told = format!("`{}` is called more than {DEEPEST} calls deep in a formula", closure.word());
            let error = Diagnostic::error("E0706", told).at(at, "the innermost call");
            return Err(error.help("does the recursion come to an end?").into());
        }
        let params = &closure.function.params;
        let formals: Vec<_> = params.iter().map(formal).collect();
        let exprs = Callee { word: closure.word(), at, formals: &formals }.bind(args, "")?;
        let mut bound = Vec::new();
        for (param, expr) in params.iter().zip(exprs) {
            bound.push((&param.name, expr.map(|expr| self.part(expr)).transpose()?, param.default.as_ref()));
        }
        let symbols = std::mem::take(&mut self.symbols);
        let locals = std::mem::replace(&mut self.machine.locals, closure.locals.clone());
        let module = std::mem::replace(&mut self.machine.module, closure.module);
        self.machine.calls += 1;
        let term = self.body(closure, bound, at);
        self.machine.calls -= 1;
        (self.symbols, self.machine.locals, self.machine.module) = (symbols, locals, module);
        term.map_err(|stop| self.machine.with_call(stop, closure, at))
    }

    fn body(
        &mut self,
        closure: &Closure,
        bound: Vec<(&Word, Option<Part>, Option<&Expr>)>,
        at: Span,
    ) -> Eval<Term> {
        for (name, part, default) in bound {
            let part = match (part, default) {
                (Some(part), _) => part,
                (None, Some(default)) => self.part(default)?,
                (None, None) => return Err(Stop::Quiet),
            };
            self.bind(&name.text, part);
        }
        self.machine.budget.spend(1, at)?;
        stacker::maybe_grow(super::functions::RED_ZONE, super::functions::MORE_STACK, || {
            self.term(&closure.function.body)
        })
    }

    /// A term where the expression depends on the coordinates, else its value.
    fn part(&mut self, expr: &Expr) -> Eval<Part> {
        if self.is_symbolic(expr)? {
            self.term(expr).map(Part::Term)
        } else {
            self.machine.value(expr).map(Part::Value)
        }
    }

    fn bind(&mut self, name: &str, part: Part) {
        match part {
            Part::Term(term) => self.symbols.push((name.to_owned(), term)),
            Part::Value(value) => {
                // The inner name hides an outer one that depends on the coordinates.
                self.symbols.retain(|(known, _)| known != name);
                self.machine.locals = self.machine.locals.with(name, value);
            }
        }
    }

    /// `{ let a = b  c }`.
    pub(super) fn block(&mut self, bindings: &[(Word, Expr)], body: &Expr) -> Eval<Term> {
        let (symbols, locals): (_, Locals) = (self.symbols.clone(), self.machine.locals.clone());
        let mut inside = || {
            for (name, expr) in bindings {
                let part = self.part(expr)?;
                self.bind(&name.text, part);
            }
            self.term(body)
        };
        let term = inside();
        (self.symbols, self.machine.locals) = (symbols, locals);
        term
    }

    /// `if a { b } else { c }` where a is the same everywhere.
    pub(super) fn choose(&mut self, [asked, then, otherwise]: &[Expr; 3]) -> Eval<Term> {
        if self.is_symbolic(asked)? {
            let error = Diagnostic::error("E0511", "a formula has no choice that depends on x, y or z");
            return Err(error
                .at(asked.at, "depends on them")
                .help("both of two: `max(f, g) <= 0`; any of two: `min(f, g) <= 0`")
                .into());
        }
        if self.machine.condition(asked)? { self.term(then) } else { self.term(otherwise) }
    }
}

/// What a name in a formula stands for.
enum Part {
    Term(Term),
    Value(Val),
}
