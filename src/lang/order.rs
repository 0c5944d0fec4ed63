//! The names of a file: each defined once, none by itself, in an order in which every one is known before it
//! is used. What they are worth is left to `items`.

use std::collections::HashMap;

use super::ast::{Args, Expr, ExprKind, Function, Item, ItemKind, Step, Word};
use super::budget::CHEAP;
use crate::diag::Diagnostic;

/// The name that an item defines in the file.
pub fn defined(item: &Item) -> Option<&Word> {
    match &item.kind {
        ItemKind::Let(name, _) | ItemKind::Material(name, _) | ItemKind::Function(name, _) => Some(name),
        ItemKind::Import(import) => import.space.as_ref(),
        ItemKind::Param(param) => Some(&param.name),
        _ => None,
    }
}

/// Names that are defined twice, with both places.
pub fn redefinitions<'a>(names: impl IntoIterator<Item = &'a Word>) -> Vec<Diagnostic> {
    let mut first: HashMap<&str, &Word> = HashMap::new();
    let mut errors = Vec::new();
    for name in names {
        if let Some(known) = first.get(name.text.as_str()) {
            let error = Diagnostic::error("E0402", format!("`{}` is defined twice", name.text))
                .at(name.at, "the second time")
                .at(known.at, "the first time")
                .help("take another name for one of them");
            errors.push(error);
        } else {
            first.insert(&name.text, name);
        }
    }
    errors
}

/// Indices of the items that define names, each after those it needs; and the cycles, as errors.
/// `takes_condition` tells which calls take a condition on the coordinates: there x, y and z are not names of
/// the file.
pub fn sorted(items: &[Item], takes_condition: &dyn Fn(&str) -> bool) -> (Vec<usize>, Vec<Diagnostic>) {
    let index: HashMap<&str, usize> = items
        .iter()
        .enumerate()
        .rev()
        .filter_map(|(i, item)| Some((defined(item)?.text.as_str(), i)))
        .collect();
    let needs: Vec<Vec<usize>> = items
        .iter()
        .map(|item| needed(item, takes_condition).into_iter().filter_map(|n| index.get(n).copied()).collect())
        .collect();
    let mut walk =
        Walk { items, needs, state: vec![State::New; items.len()], order: Vec::new(), errors: Vec::new() };
    for (i, item) in items.iter().enumerate() {
        if defined(item).is_some() {
            walk.visit(i);
        }
    }
    (walk.order, walk.errors)
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}

struct Walk<'a> {
    items: &'a [Item],
    needs: Vec<Vec<usize>>,
    state: Vec<State>,
    order: Vec<usize>,
    errors: Vec<Diagnostic>,
}

impl Walk<'_> {
    /// Depth first, with a stack of its own: chains of definitions may be long.
    fn visit(&mut self, start: usize) {
        let mut path = vec![(start, 0)];
        while let Some((i, next)) = path.last_mut() {
            let i = *i;
            if *next == 0 && self.state[i] != State::New {
                path.pop();
                continue;
            }
            self.state[i] = State::Open;
            let Some(need) = self.needs[i].get(*next).copied() else {
                self.state[i] = State::Done;
                self.order.push(i);
                path.pop();
                continue;
            };
            *next += 1;
            match self.state[need] {
                State::New => path.push((need, 0)),
                State::Open => {
                    let from = path.iter().position(|(j, _)| *j == need).unwrap_or(0);
                    let cycle: Vec<usize> = path[from..].iter().map(|(j, _)| *j).collect();
                    // Functions may call themselves, and each other.
                    let recurs = |i: &usize| matches!(self.items[*i].kind, ItemKind::Function(..));
                    if !cycle.iter().all(recurs) {
                        self.cycle(&cycle);
                    }
                }
                State::Done => {}
            }
        }
    }

    fn cycle(&mut self, cycle: &[usize]) {
        let names: Vec<&Word> = cycle.iter().filter_map(|i| defined(&self.items[*i])).collect();
        let Some(first) = names.first() else { return };
        let told = format!("`{}` is defined by itself", first.text);
        let mut error = Diagnostic::error("E0407", told);
        for (i, name) in names.iter().enumerate().take(8) {
            let next = names[(i + 1) % names.len()];
            error = error.at(name.at, format!("needs `{}`", next.text));
        }
        self.errors.push(error.help("break the circle: one of these must not use the next"));
    }
}

/// Whether an expression uses one of some names from outside of it; and the steps that it took to tell.
pub fn uses(expr: &Expr, names: &[&str]) -> (bool, usize) {
    let mut used = Uses { names: Vec::new(), hidden: Vec::new(), seen: 0, takes_condition: &|_| false };
    used.expr(expr);
    (used.names.iter().any(|n| names.contains(n)), (used.seen + used.names.len() * names.len()) / CHEAP)
}

/// The names that an item uses.
fn needed<'a>(item: &'a Item, takes_condition: &dyn Fn(&str) -> bool) -> Vec<&'a str> {
    let mut uses = Uses { names: Vec::new(), hidden: Vec::new(), seen: 0, takes_condition };
    match &item.kind {
        ItemKind::Let(_, value) => uses.expr(value),
        ItemKind::Function(_, function) => uses.function(function),
        ItemKind::Material(_, args) => uses.args(args, false),
        ItemKind::Param(param) => {
            uses.expr(&param.default);
            if let Some(allowed) = &param.allowed {
                uses.expr(allowed);
            }
        }
        _ => {}
    }
    uses.names
}

struct Uses<'a, 'f> {
    names: Vec<&'a str>,
    /// Names of blocks, loops and parameters around.
    hidden: Vec<&'a str>,
    /// Names compared and parts looked at.
    seen: usize,
    takes_condition: &'f dyn Fn(&str) -> bool,
}

impl<'a> Uses<'a, '_> {
    fn args(&mut self, args: &'a Args, of_coordinates: bool) {
        for arg in &args.list {
            let mut value = &arg.value;
            while let ExprKind::Paren(inside) = &value.kind {
                value = inside;
            }
            let compares = matches!(&value.kind, ExprKind::Infix(_, rest) if rest[0].0.compares());
            let known = self.names.len();
            self.expr(value);
            if compares && of_coordinates {
                let added = self.names.split_off(known);
                self.names.extend(added.into_iter().filter(|n| !["x", "y", "z"].contains(n)));
            }
        }
    }

    fn expr(&mut self, expr: &'a Expr) {
        self.seen += 1 + self.hidden.len();
        match &expr.kind {
            ExprKind::Name(name) if self.hidden.contains(&name.as_str()) => {}
            ExprKind::Name(name) => self.names.push(name),
            ExprKind::List(items) => items.iter().for_each(|i| self.expr(i)),
            ExprKind::Paren(inside) | ExprKind::Prefix(_, _, inside) => self.expr(inside),
            ExprKind::Infix(first, rest) => {
                self.expr(first);
                rest.iter().for_each(|(_, _, e)| self.expr(e));
            }
            ExprKind::Steps(base, steps) => {
                self.expr(base);
                let called = matches!(&base.kind, ExprKind::Name(word) if (self.takes_condition)(word));
                for (i, step) in steps.iter().enumerate() {
                    match step {
                        Step::Call(args) | Step::Method(_, args) => self.args(args, called && i == 0),
                        Step::Index(index, _) => self.expr(index),
                        Step::Member(_) => {}
                    }
                }
            }
            ExprKind::If(parts) => parts.iter().for_each(|part| self.expr(part)),
            ExprKind::For(bindings, body) | ExprKind::Block(bindings, body) => {
                let outside = self.hidden.len();
                for (name, value) in bindings {
                    self.expr(value);
                    self.hidden.push(&name.text);
                }
                self.expr(body);
                self.hidden.truncate(outside);
            }
            ExprKind::Function(function) => self.function(function),
            ExprKind::Number(..) | ExprKind::Color(_) | ExprKind::Text(_) | ExprKind::Bool(_) => {}
        }
    }

    fn function(&mut self, function: &'a Function) {
        let outside = self.hidden.len();
        for param in &function.params {
            param.default.iter().for_each(|default| self.expr(default));
            self.hidden.push(&param.name.text);
        }
        self.expr(&function.body);
        self.hidden.truncate(outside);
    }
}
