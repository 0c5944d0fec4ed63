//! Choices, loops and blocks.

use std::borrow::Cow;

use super::ast::{Expr, Word};
use super::budget::{Budget, Held, weight};
use super::eval::Machine;
use super::value::{Eval, List, Located, Val};
use crate::diag::Diagnostic;
use crate::source::Span;

/// Elements of one list, at most.
const MAX_ELEMENTS: usize = 1_000_000;

impl Machine<'_> {
    /// `if a { b } else { c }`: of b and c one is evaluated.
    pub fn choose(&mut self, [asked, then, otherwise]: &[Expr; 3]) -> Eval<Val> {
        if self.condition(asked)? { self.value(then) } else { self.value(otherwise) }
    }

    /// What an `if` asks.
    pub fn condition(&mut self, asked: &Expr) -> Eval<bool> {
        let condition = self.located(asked)?;
        match condition.value {
            Val::Bool(holds) => Ok(holds),
            _ => Err(condition
                .unlike("if", "a condition")
                .help("compare something: `if n > 3 { ... }`")
                .into()),
        }
    }

    /// `{ let a = b  c }`: each name is known from its line on.
    pub fn block(&mut self, bindings: &[(Word, Expr)], body: &Expr) -> Eval<Val> {
        let outside = self.locals.clone();
        let value = self.bind(bindings).and_then(|()| self.value(body));
        self.locals = outside;
        value
    }

    fn bind(&mut self, bindings: &[(Word, Expr)]) -> Eval<()> {
        for (name, expr) in bindings {
            let value = self.named(&name.text, expr)?;
            self.hides_builtin(name);
            self.locals = self.locals.with(&name.text, value);
        }
        Ok(())
    }

    /// `for a in b, c in d { e }`: one flat list, the last name fastest.
    pub fn repeat(&mut self, loops: &[(Word, Expr)], body: &Expr, at: Span) -> Eval<Val> {
        loops.iter().for_each(|(name, _)| self.hides_builtin(name));
        let outside = self.locals.clone();
        let mut out = (Vec::new(), self.budget.hold());
        let done = self.turns(loops, body, at, &mut out);
        self.locals = outside;
        done?;
        List::held(out.0, out.1, at)
    }

    fn turns(
        &mut self,
        loops: &[(Word, Expr)],
        body: &Expr,
        at: Span,
        out: &mut (Vec<Located>, Held),
    ) -> Eval<()> {
        let Some(((name, over), rest)) = loops.split_first() else {
            room(out.0.len(), at)?;
            let item = self.located(body)?;
            self.budget.grow(&mut out.1, weight(&item), at)?;
            out.0.push(item);
            return Ok(());
        };
        let over = self.located(over)?;
        let outside = self.locals.clone();
        let mut turn = |machine: &mut Self, value: Val| {
            machine.budget.spend(1, at)?;
            machine.locals = outside.with(&name.text, value);
            machine.turns(rest, body, at, out)
        };
        match &over.value {
            Val::List(list) => list.items.iter().try_for_each(|item| turn(self, item.value.clone())),
            Val::Range(lo, hi, of_angles) => {
                let steps = range_count(*lo, *hi);
                (0..steps).try_for_each(|i| turn(self, range_value(*lo, i, *of_angles)))
            }
            _ => Err(over
                .unlike("for", "a list or a range")
                .help(format!("write `for {} in 0..5 {{ ... }}`", name.text))
                .into()),
        }
    }
}

/// How many values `lo..hi` has: lo, lo + 1, ... below hi.
pub fn range_count(lo: f64, hi: f64) -> u64 {
    (hi - lo).ceil().max(0.0) as u64
}

/// One of the values of a range.
pub fn range_value(lo: f64, i: u64, of_angles: bool) -> Val {
    let x = lo + i as f64;
    if of_angles { Val::Angle(x) } else { Val::Number(x) }
}

/// The elements of a list or a range; each is a step.
pub fn elements<'a>(given: &'a Located, name: &str, budget: &Budget) -> Eval<Cow<'a, [Located]>> {
    match &given.value {
        Val::List(list) => {
            budget.spend(list.items.len(), given.at)?;
            Ok(Cow::Borrowed(&list.items))
        }
        Val::Range(lo, hi, of_angles) => {
            let count = range_count(*lo, *hi);
            let at = given.at;
            room((count as usize).saturating_sub(1), at)?;
            budget.spend(count as usize, at)?;
            Ok((0..count).map(|i| Located { value: range_value(*lo, i, *of_angles), at }).collect())
        }
        _ => Err(given.unlike(name, "a list").help("write a list: `[a, b]`").into()),
    }
}

/// Refuses one element more in a list of so many.
pub fn room(count: usize, at: Span) -> Eval<()> {
    if count < MAX_ELEMENTS {
        return Ok(());
    }
    Err(Diagnostic::error("E0703", format!("more than {MAX_ELEMENTS} elements in one list"))
        .at(at, "too many")
        .help("make shorter lists")
        .into())
}
