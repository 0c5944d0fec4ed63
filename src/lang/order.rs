//! The names of a file: each defined once, none by itself, in an order in which every one is known before it
//! is used. What they are worth is left to `items`.

use std::collections::HashMap;

use super::ast::{Args, Expr, ExprKind, Item, ItemKind, Step, Word};
use crate::diag::Diagnostic;

/// The name that an item defines in the file.
pub fn defined(item: &Item) -> Option<&Word> {
    match &item.kind {
        ItemKind::Let(name, _) | ItemKind::Material(name, _) => Some(name),
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
pub fn sorted(items: &[Item]) -> (Vec<usize>, Vec<Diagnostic>) {
    let index: HashMap<&str, usize> = items
        .iter()
        .enumerate()
        .rev()
        .filter_map(|(i, item)| Some((defined(item)?.text.as_str(), i)))
        .collect();
    let needs: Vec<Vec<usize>> = items
        .iter()
        .map(|item| needed(item).into_iter().filter_map(|n| index.get(n).copied()).collect())
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
                    self.cycle(&cycle);
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

/// The names that an item uses.
fn needed(item: &Item) -> Vec<&str> {
    let mut names = Vec::new();
    match &item.kind {
        ItemKind::Let(_, value) => in_expr(value, &mut names),
        ItemKind::Material(_, args) => in_args(args, &mut names),
        ItemKind::Param(param) => {
            in_expr(&param.default, &mut names);
            if let Some(allowed) = &param.allowed {
                in_expr(allowed, &mut names);
            }
        }
        _ => {}
    }
    names
}

fn in_args<'a>(args: &'a Args, names: &mut Vec<&'a str>) {
    for arg in &args.list {
        let mut value = &arg.value;
        while let ExprKind::Paren(inside) = &value.kind {
            value = inside;
        }
        let compares = matches!(&value.kind, ExprKind::Infix(_, rest) if rest[0].0.compares());
        let known = names.len();
        in_expr(value, names);
        if compares {
            // A condition on the coordinates: there x, y and z are not names of the file.
            let mut i = 0;
            names.retain(|n| {
                i += 1;
                i <= known || !["x", "y", "z"].contains(n)
            });
        }
    }
}

fn in_expr<'a>(expr: &'a Expr, names: &mut Vec<&'a str>) {
    match &expr.kind {
        ExprKind::Name(name) => names.push(name),
        ExprKind::List(items) => items.iter().for_each(|i| in_expr(i, names)),
        ExprKind::Paren(inside) | ExprKind::Prefix(_, _, inside) => in_expr(inside, names),
        ExprKind::Infix(first, rest) => {
            in_expr(first, names);
            rest.iter().for_each(|(_, _, e)| in_expr(e, names));
        }
        ExprKind::Steps(base, steps) => {
            in_expr(base, names);
            for step in steps {
                match step {
                    Step::Call(args) | Step::Method(_, args) => in_args(args, names),
                    Step::Index(index, _) => in_expr(index, names),
                    Step::Member(_) => {}
                }
            }
        }
        _ => {}
    }
}
