//! Names before values: every name, every call of something declared and every type word of a file is looked up where it
//! stands, also in functions that nobody calls and branches that are not taken. What the values are is left to `eval`; an item
//! about which that has told something is not told about again.

use super::args::{Callee, formals};
use super::ast::{Args, Expr, ExprKind, Function, Item, ItemKind, Step};
use super::builtins;
use super::defines;
use super::eval::Machine;
use super::scan::{TokenKind, tokens};
use super::split::ITEM_WORDS;
use super::unknown::callable;
use super::value::{Eval, Stop, Val};
use crate::diag::Diagnostic;
use crate::scene::{Group, Kind};
use crate::source::Span;

/// The first of each item that cannot be resolved, of those items in which no told error lies.
pub fn unresolved(machine: &mut Machine, items: &[Item], told: &[Diagnostic]) -> Vec<Diagnostic> {
    let mut places: Vec<Span> = told.iter().flat_map(|e| &e.labels).map(|l| l.span).collect();
    places.sort_by_key(|at| (at.file, at.start));
    let mut errors = Vec::new();
    for item in items {
        let from = places.partition_point(|at| (at.file, at.start) < (item.at.file, item.at.start));
        let is_told = places.get(from).is_some_and(|at| at.file == item.at.file && at.start <= item.at.end);
        if is_told {
            continue;
        }
        let outside = machine.locals.clone();
        if let Err(Stop::Told(error)) = (Resolver { machine }).item(item) {
            errors.push(*error);
        }
        machine.locals = outside;
    }
    errors
}

struct Resolver<'m, 'a> {
    machine: &'m mut Machine<'a>,
}

impl Resolver<'_, '_> {
    fn item(&mut self, item: &Item) -> Eval<()> {
        match &item.kind {
            ItemKind::Let(_, expr) | ItemKind::Draw(_, expr) | ItemKind::Print(expr) => self.expr(expr),
            ItemKind::Function(_, function) => self.function(function),
            ItemKind::Param(param) => {
                self.expr(&param.default)?;
                param.allowed.iter().try_for_each(|allowed| self.expr(allowed))
            }
            ItemKind::Material(_, args)
            | ItemKind::Camera(_, args)
            | ItemKind::Light(_, args)
            | ItemKind::Render(args) => self.args(args),
            ItemKind::Expect(expect) => {
                self.expr(&expect.left)?;
                expect.right.iter().try_for_each(|(_, expr)| self.expr(expr))?;
                expect.within.iter().try_for_each(|(expr, _)| self.expr(expr))
            }
            ItemKind::Import(_) | ItemKind::Units(_) => Ok(()),
        }
    }

    fn expr(&mut self, expr: &Expr) -> Eval<()> {
        match &expr.kind {
            ExprKind::Name(name) => self.name(name, expr.at),
            ExprKind::List(items) => items.iter().try_for_each(|item| self.expr(item)),
            ExprKind::Paren(inside) | ExprKind::Prefix(_, _, inside) => self.expr(inside),
            ExprKind::Infix(first, rest) => {
                self.expr(first)?;
                rest.iter().try_for_each(|(_, _, operand)| self.expr(operand))
            }
            ExprKind::Steps(base, steps) => self.steps(base, steps),
            ExprKind::If(parts) => parts.iter().try_for_each(|part| self.expr(part)),
            ExprKind::For(bindings, body) | ExprKind::Block(bindings, body) => {
                let outside = self.machine.locals.clone();
                for (name, value) in bindings {
                    self.expr(value)?;
                    self.bind(&name.text);
                }
                self.expr(body)?;
                self.machine.locals = outside;
                Ok(())
            }
            ExprKind::Function(function) => self.function(function),
            ExprKind::Number(..) | ExprKind::Color(_) | ExprKind::Text(_) | ExprKind::Bool(_) => Ok(()),
        }
    }

    /// What a name within an item is worth is not known here.
    fn bind(&mut self, name: &str) {
        self.machine.locals = self.machine.locals.with(name, Val::Bool(false));
    }

    fn function(&mut self, function: &Function) -> Eval<()> {
        let outside = self.machine.locals.clone();
        for param in &function.params {
            if let Some(kind) = &param.kind {
                defines::type_named(kind)?;
            }
            param.default.iter().try_for_each(|default| self.expr(default))?;
            self.bind(&param.name.text);
        }
        self.expr(&function.body)?;
        self.machine.locals = outside;
        Ok(())
    }

    fn name(&self, name: &str, at: Span) -> Eval<()> {
        match self.machine.name(name, at) {
            // What a name is worth may be what failed before.
            Ok(_) | Err(Stop::Quiet) => Ok(()),
            Err(told) => Err(told),
        }
    }

    fn steps(&mut self, base: &Expr, steps: &[Step]) -> Eval<()> {
        let mut rest = steps.iter();
        match (&base.kind, steps.first()) {
            (ExprKind::Name(word), Some(Step::Call(args)))
                if self.machine.defined(word, base.at).is_none() =>
            {
                rest.next();
                self.call(word, base.at, args)?;
            }
            _ => self.expr(base)?,
        }
        rest.try_for_each(|step| match step {
            Step::Call(args) => self.args(args),
            Step::Method(word, args) => self.args(args).map_err(|stop| Machine::worn(&word.text, stop)),
            Step::Index(index, _) => self.expr(index),
            Step::Member(_) => Ok(()),
        })
    }

    /// A call of something that the scene itself does not define.
    fn call(&mut self, word: &str, word_at: Span, args: &Args) -> Eval<()> {
        let (catalog, at) = (self.machine.catalog, word_at.to(args.at));
        let decl = catalog.find(Group::Primitive, word).or_else(|| catalog.find(Group::Material, word));
        let mut of_coordinates = false;
        if let Some(decl) = decl {
            Callee { word: decl.word, at, formals: &formals(decl) }.bind(args, "")?;
            of_coordinates = decl.params.iter().any(|p| matches!(p.kind, Kind::HalfSpace | Kind::Condition));
        } else if let Some(builtin) = builtins::functions().find(|b| b.name == word) {
            Callee { word: builtin.name, at, formals: builtin.formals }.bind(args, "")?;
        } else if !callable(catalog).any(|known| known == word) {
            return self.machine.refuse_call(word, word_at);
        }
        let outside = self.machine.locals.clone();
        if of_coordinates {
            ["x", "y", "z"].iter().for_each(|name| self.bind(name));
        }
        self.args(args)?;
        self.machine.locals = outside;
        Ok(())
    }

    fn args(&mut self, args: &Args) -> Eval<()> {
        args.list.iter().try_for_each(|arg| self.expr(&arg.value))
    }
}

/// The names that a broken item would have defined: they are known, and what they are worth is not. `None` where they are those
/// of another file.
pub fn names_in(item: &str) -> Option<Vec<String>> {
    let all = tokens(item);
    let words: Vec<&str> = all.iter().map(|token| token.text(item)).collect();
    if words.contains(&"import") && !words.contains(&"as") {
        return None;
    }
    let defines = |word: &str| {
        matches!(word, "let" | "fn" | "param" | "material" | "as")
            || matches!(
                word,
                "var" | "const" | "function" | "module" | "def" | "func" | "#declare" | "#local"
            )
    };
    // `x = 3`, and `for (i = ...)`.
    let stray = words.first().is_some_and(|word| !ITEM_WORDS.contains(word));
    let pairs = all.windows(2);
    let named = pairs.filter_map(|w| {
        let [first, second] = [&w[0], &w[1]];
        let after = defines(first.text(item)) && second.kind == TokenKind::Word;
        let before = stray && first.kind == TokenKind::Word && second.text(item) == "=";
        if after { Some(second) } else { before.then_some(first) }
    });
    Some(named.map(|token| token.text(item).to_owned()).collect())
}
