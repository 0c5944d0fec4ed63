//! Functions that a scene defines: values that remember the names around them; calling one.

use std::sync::Arc;

use super::args::Callee;
use super::ast::{Args, Formal, Function};
use super::defines;
use super::eval::Machine;
use super::scope::Locals;
use super::value::{Eval, Located, Stop, Val};
use crate::diag::Diagnostic;
use crate::source::Span;

/// Calls within calls, at most.
const DEEPEST: usize = 1000;
/// Stack that is left when more is taken, and how much then: a body may nest as deep as the grammar allows.
pub const RED_ZONE: usize = 16 << 20;
pub const MORE_STACK: usize = 64 << 20;
/// The innermost calls named in an error; the outermost is named too.
const TOLD: usize = 6;

/// A function as a value.
#[derive(Clone, Debug)]
pub struct Closure {
    /// What was written.
    pub function: Arc<Function>,
    /// Its name, if it has one.
    pub name: Option<Arc<str>>,
    /// The names around it.
    pub locals: Locals,
    /// The module it was written in.
    pub module: usize,
}

impl Closure {
    /// Its name for messages.
    pub fn word(&self) -> &str {
        self.name.as_deref().unwrap_or("fn")
    }
}

impl Machine<'_> {
    /// The value of a call.
    pub fn call_function(&mut self, closure: &Closure, args: &Args, at: Span) -> Eval<Val> {
        if DEEPEST <= self.calls {
            let told = format!("`{}` is called more than {DEEPEST} calls deep", closure.word());
            return Err(Diagnostic::error("E0706", told)
                .at(at, "the innermost call")
                .help("does the recursion come to an end? A list is made by `for`, without recursion")
                .into());
        }
        let given = self.bound(closure, args, at)?;
        self.calls += 1;
        let value = stacker::maybe_grow(RED_ZONE, MORE_STACK, || self.within(closure, given, at));
        self.calls -= 1;
        value.map_err(|stop| self.with_call(stop, closure, at))
    }

    /// The arguments, evaluated where the call stands.
    fn bound(&mut self, closure: &Closure, args: &Args, at: Span) -> Eval<Vec<Option<Located>>> {
        let params = &closure.function.params;
        let formals: Vec<_> = params.iter().map(formal).collect();
        let exprs = Callee { word: closure.word(), at, formals: &formals }.bind(args, "")?;
        exprs.into_iter().map(|e| e.map(|e| self.located(e)).transpose()).collect()
    }

    /// The body's value among the names around the function.
    fn within(&mut self, closure: &Closure, given: Vec<Option<Located>>, at: Span) -> Eval<Val> {
        let outside = std::mem::replace(&mut self.locals, closure.locals.clone());
        let module = std::mem::replace(&mut self.module, closure.module);
        // Shapes are called by what they were written in.
        let named = closure.name.as_deref().map(str::to_owned);
        let binding = self.binding.clone();
        self.binding = named.or(self.binding.take());
        let value = self.body(closure, given, at);
        (self.locals, self.module, self.binding) = (outside, module, binding);
        value
    }

    fn body(&mut self, closure: &Closure, given: Vec<Option<Located>>, at: Span) -> Eval<Val> {
        let around = self.locals.clone();
        let mut inside = around.clone();
        for (param, given) in closure.function.params.iter().zip(given) {
            let given = match (given, &param.default) {
                (Some(given), _) => given,
                // A default may use the parameters before it.
                (None, Some(default)) => {
                    self.locals = inside.clone();
                    self.located(default)?
                }
                (None, None) => return Err(Stop::Quiet),
            };
            if let Some(kind) = &param.kind {
                let written = self.written(given.at).to_owned();
                let typed = defines::typed_as(&given, &param.name.text, kind, &written);
                typed.map_err(|stop| told_at(stop, param.name.at, "the parameter"))?;
            }
            inside = inside.with(&param.name.text, given.value);
        }
        self.locals = inside;
        self.budget.spend(1, at)?;
        self.value(&closure.function.body)
    }

    /// An error in a body, with the call that led there.
    pub fn with_call(&self, stop: Stop, closure: &Closure, at: Span) -> Stop {
        let Stop::Told(mut error) = stop else { return stop };
        let calls = error.notes.iter().filter(|note| note.starts_with(CALLED)).count();
        let outermost = || format!("{CALLED}`{}`, called at {}", closure.word(), self.sources.place(at));
        match calls {
            ..TOLD => error.notes.push(outermost()),
            TOLD => error.notes.extend([format!("{CALLED}more calls"), outermost()]),
            _ => {
                // The last is replaced: in the end it is where the chain begins.
                error.notes.pop();
                error.notes.push(outermost());
            }
        }
        Stop::Told(error)
    }
}

/// How the notes of a call chain begin.
const CALLED: &str = "in ";

/// A parameter as an argument that may be given.
pub fn formal(param: &Formal) -> super::args::Formal<'_> {
    super::args::Formal { name: &param.name.text, by_place: true, required: param.default.is_none(), doc: "" }
}

fn told_at(stop: Stop, at: Span, label: &str) -> Stop {
    match stop {
        Stop::Told(error) => Stop::Told(Box::new(error.at(at, label))),
        Stop::Quiet => Stop::Quiet,
    }
}
