//! Whether a scene expects a number of a shape: what a formula knows of it, and no blessing changes.

use std::collections::{HashMap, HashSet};

use pss::lang::ast::{Expr, ExprKind, Item, ItemKind, Step};
use pss::source::{FileId, SourceMap};

/// Functions that measure shapes. That one is solid, empty or around a point is no number.
const MEASURES: [&str; 5] = ["volume", "area", "centroid", "bounds", "raycast"];

/// Whether some `expect` of the scene's own text asks for a measure: by its word, or by names whose definitions do, of its own file
/// or of one that it imports. A scene that calls something of its own `volume` has that meant.
pub fn are_expected(sources: &SourceMap) -> bool {
    // The scene's own text is the first.
    let files: Vec<Vec<Item>> = (0..sources.files().count())
        .map(|i| pss::lang::items(sources, FileId(i as u32)).unwrap_or_default())
        .collect();
    let mut meant = Meant { defined: HashMap::new(), seen: HashSet::new() };
    files.iter().flatten().for_each(|item| meant.define(item));
    let expects = files.first().into_iter().flatten().filter_map(|item| match &item.kind {
        ItemKind::Expect(expect) => Some(expect),
        _ => None,
    });
    expects.into_iter().any(|expect| {
        meant.measures(&expect.left) || expect.right.as_ref().is_some_and(|(_, right)| meant.measures(right))
    })
}

/// What names stand for.
struct Meant<'a> {
    defined: HashMap<&'a str, Vec<&'a Expr>>,
    /// Names that were looked into: functions may call themselves.
    seen: HashSet<&'a str>,
}

impl<'a> Meant<'a> {
    fn define(&mut self, item: &'a Item) {
        let (name, value) = match &item.kind {
            ItemKind::Let(name, value) => (name, value),
            ItemKind::Function(name, function) => (name, &function.body),
            ItemKind::Param(param) => (&param.name, &param.default),
            _ => return,
        };
        self.defined.entry(&name.text).or_default().push(value);
    }

    /// Whether an expression asks for a measure. Deep chains of definitions take a list and no stack.
    fn measures(&mut self, expr: &'a Expr) -> bool {
        let mut open = vec![expr];
        while let Some(expr) = open.pop() {
            let mut names = Vec::new();
            parts(expr, &mut open, &mut names);
            for name in names {
                match self.defined.get(name) {
                    None if MEASURES.contains(&name) => return true,
                    Some(values) if self.seen.insert(name) => open.extend(values),
                    _ => {}
                }
            }
        }
        false
    }
}

/// The expressions in one, and the names that it says itself: also those behind a point, which may be of a module.
fn parts<'a>(expr: &'a Expr, inside: &mut Vec<&'a Expr>, names: &mut Vec<&'a str>) {
    match &expr.kind {
        ExprKind::Number(..) | ExprKind::Color(_) | ExprKind::Text(_) | ExprKind::Bool(_) => {}
        ExprKind::Name(name) => names.push(name),
        ExprKind::List(list) => inside.extend(list),
        ExprKind::Paren(inner) | ExprKind::Prefix(_, _, inner) => inside.push(inner),
        ExprKind::Steps(first, steps) => {
            inside.push(first);
            steps.iter().for_each(|step| of_step(step, inside, names));
        }
        ExprKind::Infix(first, others) => {
            inside.push(first);
            inside.extend(others.iter().map(|(_, _, operand)| operand));
        }
        ExprKind::If(parts) => inside.extend(parts.iter()),
        ExprKind::For(bound, body) | ExprKind::Block(bound, body) => {
            inside.extend(bound.iter().map(|(_, value)| value));
            inside.push(body);
        }
        ExprKind::Function(function) => inside.push(&function.body),
    }
}

fn of_step<'a>(step: &'a Step, inside: &mut Vec<&'a Expr>, names: &mut Vec<&'a str>) {
    match step {
        Step::Call(args) => inside.extend(args.list.iter().map(|arg| &arg.value)),
        Step::Method(word, args) => {
            names.push(&word.text);
            inside.extend(args.list.iter().map(|arg| &arg.value));
        }
        Step::Member(word) => names.push(&word.text),
        Step::Index(index, _) => inside.push(index),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_a_measure_of_a_shape_however_it_is_named() {
        let expected = |text: &str| {
            let mut sources = SourceMap::default();
            sources.add("a.pss", None, text);
            are_expected(&sources)
        };
        for text in [
            "expect volume(a) ~= 3",
            "expect 3 ~= (1 + 2 * area(a))",
            "let hits = raycast(a, from: p, dir: d)\nexpect count(hits) is 2",
            "fn w(s) = { let b = bounds(s) b.max.x }\nexpect [1, if w(a) < 2 { 1 } else { 2 }][0] is 1",
            "fn f(n) = if n < 1 { area(a) } else { f(n - 1) }\nexpect f(3) > 0",
        ] {
            assert!(expected(text), "{text}");
        }
        for text in [
            "expect 1 is 1",
            "expect solid(a)",
            "let v = volume(a)\nprint v",
            "fn volume(s) = 3\nexpect volume(a) is 3",
            "fn f(n) = f(n - 1)\nexpect f(3) > 0",
        ] {
            assert!(!expected(text), "{text}");
        }
    }
}
