//! Text of one item to its tree. The only file that knows the parser generator: the grammar is
//! `grammar/pss.pest`, precedence is here, wording of errors is left to `syntax`.

use std::sync::{Arc, LazyLock};

use pest::Parser;
use pest::error::{ErrorVariant, InputLocation};
use pest::iterators::{Pair, Pairs};
use pest::pratt_parser::{Assoc, Op, PrattParser};

use super::ast::{
    Arg, Args, Expect, Expr, ExprKind, Formal, Function, Import, InfixOp, Item, ItemKind, Param, PrefixOp,
    Step, Word,
};
use super::syntax::Refused;
use super::{chains, literals, order, span};
use crate::diag::Diagnostic;
use crate::source::{FileId, Span};

#[derive(pest_derive::Parser)]
#[grammar = "../grammar/pss.pest"]
struct Grammar;

type Parsed<T> = Result<T, Box<Diagnostic>>;

/// Parses the item that stands in `range` of a file.
pub fn item(text: &str, file: FileId, range: std::ops::Range<usize>) -> Parsed<Item> {
    let build = Build { file, base: range.start };
    let pairs = build.run(Rule::item, &text[range])?;
    build.item(pairs)
}

/// Parses the one expression that stands in `range` of a file.
pub fn expression(text: &str, file: FileId, range: std::ops::Range<usize>) -> Parsed<Expr> {
    let build = Build { file, base: range.start };
    let mut pairs = build.run(Rule::alone, &text[range])?;
    build.next_expr(&mut pairs)
}

static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    let left = |rule| Op::infix(rule, Assoc::Left);
    PrattParser::new()
        .op(left(Rule::or_kw))
        .op(left(Rule::and_kw))
        .op(Op::prefix(Rule::not_kw))
        .op(left(Rule::equal)
            | left(Rule::unequal)
            | left(Rule::at_most)
            | left(Rule::at_least)
            | left(Rule::below)
            | left(Rule::above))
        .op(left(Rule::union) | left(Rule::intersect) | left(Rule::exclude))
        .op(left(Rule::range))
        .op(left(Rule::plus) | left(Rule::subtract))
        .op(left(Rule::times) | left(Rule::divide) | left(Rule::remainder))
        .op(Op::prefix(Rule::minus) | Op::prefix(Rule::complement))
        .op(Op::infix(Rule::power, Assoc::Right))
});

/// Where the parsed text lies in its file.
#[derive(Clone, Copy)]
struct Build {
    file: FileId,
    base: usize,
}

impl Build {
    /// Runs the grammar and gives what is inside the outer rule.
    fn run<'t>(&self, rule: Rule, text: &'t str) -> Parsed<Pairs<'t, Rule>> {
        let error = match Grammar::parse(rule, text) {
            Ok(mut pairs) => return Ok(pairs.next().map_or(pairs, Pair::into_inner)),
            Err(error) => error,
        };
        if let ErrorVariant::CustomError { .. } = error.variant {
            let all = span(self.file, self.base..self.base + text.len());
            return Err(Diagnostic::error("E0701", "the item is too large to be read")
                .at(all, "this item")
                .help("name its parts with `let`")
                .into());
        }
        let stop = match error.location {
            InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
        };
        Err(Refused { text, file: self.file, base: self.base, stop }.explain().into())
    }

    fn place(&self, pair: &Pair<Rule>) -> Span {
        let at = pair.as_span();
        span(self.file, self.base + at.start()..self.base + at.end())
    }

    fn word(&self, pair: &Pair<Rule>) -> Word {
        Word { text: pair.as_str().to_owned(), at: self.place(pair) }
    }

    /// What a rule ends too early for cannot happen: the grammar ensures it.
    fn lost(&self) -> Box<Diagnostic> {
        let at = span(self.file, self.base..self.base);
        Diagnostic::error("E0101", "the item is incomplete").at(at, "").help("complete it").into()
    }

    fn next_expr(&self, pairs: &mut Pairs<Rule>) -> Parsed<Expr> {
        let pair = pairs.find(|p| matches!(p.as_rule(), Rule::expr | Rule::number | Rule::vector));
        self.expr(pair.ok_or_else(|| self.lost())?)
    }

    fn item(&self, mut pairs: Pairs<Rule>) -> Parsed<Item> {
        let pair = pairs.next().ok_or_else(|| self.lost())?;
        let at = self.place(&pair);
        let rule = pair.as_rule();
        let mut inner = pair.into_inner();
        let kind = match rule {
            Rule::let_item => ItemKind::Let(self.next_name(&mut inner)?, self.next_expr(&mut inner)?),
            Rule::param_item => ItemKind::Param(Box::new(self.param(inner)?)),
            Rule::material_item => {
                ItemKind::Material(self.next_name(&mut inner)?, self.next_args(&mut inner)?)
            }
            Rule::camera_item => ItemKind::Camera(self.label(&mut inner), self.next_args(&mut inner)?),
            Rule::light_item => ItemKind::Light(self.label(&mut inner), self.next_args(&mut inner)?),
            Rule::render_item => ItemKind::Render(self.next_args(&mut inner)?),
            Rule::units_item => {
                let word = inner.find(|p| p.as_rule() == Rule::word).ok_or_else(|| self.lost())?;
                ItemKind::Units(self.word(&word))
            }
            Rule::draw_item => self.draw(inner)?,
            Rule::fn_item => {
                let name = self.next_name(&mut inner)?;
                ItemKind::Function(name, self.function(inner)?)
            }
            Rule::import_item => ItemKind::Import(self.import(inner)?),
            Rule::print_item => ItemKind::Print(self.next_expr(&mut inner)?),
            _ => ItemKind::Expect(Box::new(self.expect(inner)?)),
        };
        Ok(Item { kind, at })
    }

    fn next_name(&self, pairs: &mut Pairs<Rule>) -> Parsed<Word> {
        let pair = pairs.find(|p| p.as_rule() == Rule::name).ok_or_else(|| self.lost())?;
        Ok(self.word(&pair))
    }

    fn label(&self, pairs: &mut Pairs<Rule>) -> Option<Word> {
        let name = pairs.clone().find(|p| p.as_rule() == Rule::name);
        name.map(|p| self.word(&p))
    }

    fn next_args(&self, pairs: &mut Pairs<Rule>) -> Parsed<Args> {
        let pair = pairs.find(|p| p.as_rule() == Rule::args).ok_or_else(|| self.lost())?;
        self.args(pair)
    }

    fn param(&self, mut pairs: Pairs<Rule>) -> Parsed<Param> {
        let name = self.next_name(&mut pairs)?;
        let kind = pairs.clone().find(|p| p.as_rule() == Rule::type_word).map(|p| self.word(&p));
        let default = self.next_expr(&mut pairs)?;
        let allowed = pairs.find(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p)).transpose()?;
        Ok(Param { name, kind, default, allowed })
    }

    /// What follows the name of a function, or its keyword.
    fn function(&self, mut pairs: Pairs<Rule>) -> Parsed<Arc<Function>> {
        let formals = pairs.find(|p| p.as_rule() == Rule::formals).ok_or_else(|| self.lost())?;
        let formal = |pair: Pair<Rule>| {
            let mut parts = pair.into_inner();
            let name = self.next_name(&mut parts)?;
            let kind = parts.clone().find(|p| p.as_rule() == Rule::type_word).map(|p| self.word(&p));
            let default = parts.find(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p)).transpose()?;
            Ok(Formal { name, kind, default })
        };
        let params = formals.into_inner().map(formal).collect::<Parsed<Vec<Formal>>>()?;
        once(params.iter().map(|p| &p.name))?;
        Ok(Arc::new(Function { params, body: self.next_expr(&mut pairs)? }))
    }

    fn import(&self, mut pairs: Pairs<Rule>) -> Parsed<Import> {
        let string = pairs.find(|p| p.as_rule() == Rule::string).ok_or_else(|| self.lost())?;
        let at = self.place(&string);
        Ok(Import { path: literals::text(string.as_str(), at)?, at, space: self.label(&mut pairs) })
    }

    fn expect(&self, mut pairs: Pairs<Rule>) -> Parsed<Expect> {
        let left = self.next_expr(&mut pairs)?;
        let rest: Vec<Pair<Rule>> = pairs.collect();
        let after = |rule: fn(&Rule) -> bool| {
            let sign = rest.iter().position(|p| rule(&p.as_rule()))?;
            Some((rest[sign].as_rule(), self.expr(rest.get(sign + 1)?.clone())))
        };
        let right = after(|r| matches!(r, Rule::is_kw | Rule::nearly));
        let right = right.map(|(sign, expr)| Ok::<_, Box<Diagnostic>>((sign == Rule::nearly, expr?)));
        let percent = rest.iter().any(|p| p.as_rule() == Rule::percent);
        let within =
            after(|r| *r == Rule::within_kw).map(|(_, expr)| Ok::<_, Box<Diagnostic>>((expr?, percent)));
        Ok(Expect { left, right: right.transpose()?, within: within.transpose()? })
    }

    /// `name in expr` or `name = expr`, all that there are.
    fn bindings<'t>(&self, pairs: impl Iterator<Item = Pair<'t, Rule>>) -> Parsed<Vec<(Word, Expr)>> {
        let mut bound = Vec::new();
        let mut name = None;
        for pair in pairs {
            match pair.as_rule() {
                Rule::name => name = Some(self.word(&pair)),
                Rule::expr => bound.extend(name.take().zip(Some(self.expr(pair)?))),
                _ => {}
            }
        }
        once(bound.iter().map(|(name, _)| name))?;
        Ok(bound)
    }

    fn draw(&self, mut pairs: Pairs<Rule>) -> Parsed<ItemKind> {
        let words = pairs.clone().filter(|p| p.as_rule() == Rule::attribute);
        let words = words.filter_map(|p| p.into_inner().next()).map(|p| self.word(&p)).collect();
        Ok(ItemKind::Draw(words, self.next_expr(&mut pairs)?))
    }

    fn expr(&self, pair: Pair<Rule>) -> Parsed<Expr> {
        match pair.as_rule() {
            Rule::number | Rule::vector => return self.atom(pair),
            Rule::negative => return self.negative(pair),
            _ => {}
        }
        let at = self.place(&pair);
        let inner = pair.into_inner().next().ok_or_else(|| self.lost())?;
        let kind = match inner.as_rule() {
            Rule::negative => return self.negative(inner),
            Rule::if_expr => return self.condition(inner),
            Rule::for_expr => {
                let parts = inner.into_inner();
                let bound = self.bindings(parts.clone())?;
                let body = parts.filter(|p| p.as_rule() == Rule::block).last().ok_or_else(|| self.lost())?;
                ExprKind::For(bound, Box::new(self.atom(body)?))
            }
            Rule::fn_expr => ExprKind::Function(self.function(inner.into_inner())?),
            _ => return self.operation(inner),
        };
        Ok(Expr { kind, at })
    }

    fn condition(&self, pair: Pair<Rule>) -> Parsed<Expr> {
        let at = self.place(&pair);
        let mut parts = pair.into_inner();
        let asked = self.next_expr(&mut parts)?;
        let then = parts.find(|p| p.as_rule() == Rule::block).ok_or_else(|| self.lost())?;
        let last = parts.find(|p| matches!(p.as_rule(), Rule::block | Rule::if_expr));
        let last = last.ok_or_else(|| self.lost())?;
        let otherwise = if last.as_rule() == Rule::block { self.atom(last)? } else { self.condition(last)? };
        Ok(Expr { kind: ExprKind::If(Box::new([asked, self.atom(then)?, otherwise])), at })
    }

    /// The negative of a number, alone.
    fn negative(&self, pair: Pair<Rule>) -> Parsed<Expr> {
        let mut parts = pair.into_inner();
        let sign = self.place(&parts.next().ok_or_else(|| self.lost())?);
        let operand = self.atom(parts.next().ok_or_else(|| self.lost())?)?;
        let at = sign.to(operand.at);
        Ok(Expr { kind: ExprKind::Prefix(PrefixOp::Negate, sign, Box::new(operand)), at })
    }

    fn operation(&self, pair: Pair<Rule>) -> Parsed<Expr> {
        let mut alone = pair.clone().into_inner();
        if let (Some(term), None) = (alone.next(), alone.next()) {
            return self.term(term);
        }
        let signs = pair.clone().into_inner().filter_map(|p| Some((infix(p.as_rule())?, self.place(&p))));
        let source = chains::Source { text: pair.as_str(), at: self.place(&pair) };
        chains::refuse_mixed(&signs.collect::<Vec<_>>(), &source)?;
        PRECEDENCE
            .map_primary(|p| self.term(p))
            .map_prefix(|sign, operand| {
                let operand = operand?;
                let op = match sign.as_rule() {
                    Rule::minus => PrefixOp::Negate,
                    Rule::complement => PrefixOp::Complement,
                    _ => PrefixOp::Not,
                };
                let at = self.place(&sign);
                Ok(Expr { at: at.to(operand.at), kind: ExprKind::Prefix(op, at, Box::new(operand)) })
            })
            .map_infix(|a, sign, b| match infix(sign.as_rule()) {
                Some(op) => chains::join(a?, op, self.place(&sign), b?),
                None => Err(self.lost()),
            })
            .parse(pair.into_inner())
    }

    fn term(&self, pair: Pair<Rule>) -> Parsed<Expr> {
        let whole = self.place(&pair);
        let mut inner = pair.into_inner().peekable();
        let base = self.atom(inner.next().ok_or_else(|| self.lost())?)?;
        let mut steps = Vec::new();
        while let Some(pair) = inner.next() {
            let at = self.place(&pair);
            steps.push(match pair.as_rule() {
                Rule::args => Step::Call(self.args(pair)?),
                Rule::index => Step::Index(self.next_expr(&mut pair.into_inner())?, at),
                _ => match inner.next_if(|p| p.as_rule() == Rule::args) {
                    Some(args) => Step::Method(self.word(&pair), self.args(args)?),
                    None => Step::Member(self.word(&pair)),
                },
            });
        }
        if steps.is_empty() {
            return Ok(base);
        }
        Ok(Expr { kind: ExprKind::Steps(Box::new(base), steps), at: whole })
    }

    fn atom(&self, pair: Pair<Rule>) -> Parsed<Expr> {
        let at = self.place(&pair);
        let text = pair.as_str();
        let kind = match pair.as_rule() {
            Rule::number => literals::number(text, at)?,
            Rule::color => ExprKind::Color(literals::color(text, at)?),
            Rule::string => ExprKind::Text(literals::text(text, at)?),
            Rule::true_kw => ExprKind::Bool(true),
            Rule::false_kw => ExprKind::Bool(false),
            Rule::name => ExprKind::Name(text.to_owned()),
            Rule::list | Rule::vector => {
                ExprKind::List(pair.into_inner().map(|p| self.expr(p)).collect::<Parsed<_>>()?)
            }
            Rule::paren => ExprKind::Paren(Box::new(self.next_expr(&mut pair.into_inner())?)),
            _ => self.block(pair)?,
        };
        Ok(Expr { kind, at })
    }

    fn block(&self, pair: Pair<Rule>) -> Parsed<ExprKind> {
        let parts = pair.into_inner();
        let (bindings, rest): (Vec<_>, Vec<_>) = parts.partition(|p| p.as_rule() == Rule::binding);
        let bound = self.bindings(bindings.into_iter().flat_map(Pair::into_inner))?;
        let body = rest.into_iter().find(|p| p.as_rule() == Rule::expr).ok_or_else(|| self.lost())?;
        Ok(ExprKind::Block(bound, Box::new(self.expr(body)?)))
    }

    fn args(&self, pair: Pair<Rule>) -> Parsed<Args> {
        let at = self.place(&pair);
        let list = pair.into_inner().map(|arg| {
            let mut parts = arg.into_inner();
            let label = parts.clone().find(|p| p.as_rule() == Rule::label);
            let name = label.and_then(|p| p.into_inner().next()).map(|p| self.word(&p));
            Ok(Arg { name, value: self.next_expr(&mut parts)? })
        });
        Ok(Args { list: list.collect::<Parsed<_>>()?, at })
    }
}

/// Refuses a name that is given twice in one scope.
fn once<'a>(names: impl Iterator<Item = &'a Word>) -> Parsed<()> {
    match order::redefinitions(names).into_iter().next() {
        Some(error) => Err(error.into()),
        None => Ok(()),
    }
}

fn infix(rule: Rule) -> Option<InfixOp> {
    Some(match rule {
        Rule::or_kw => InfixOp::Or,
        Rule::and_kw => InfixOp::And,
        Rule::equal => InfixOp::Equal,
        Rule::unequal => InfixOp::Unequal,
        Rule::at_most => InfixOp::AtMost,
        Rule::at_least => InfixOp::AtLeast,
        Rule::below => InfixOp::Below,
        Rule::above => InfixOp::Above,
        Rule::union => InfixOp::Union,
        Rule::intersect => InfixOp::Intersect,
        Rule::exclude => InfixOp::Exclude,
        Rule::range => InfixOp::Range,
        Rule::plus => InfixOp::Add,
        Rule::subtract => InfixOp::Subtract,
        Rule::times => InfixOp::Multiply,
        Rule::divide => InfixOp::Divide,
        Rule::remainder => InfixOp::Remainder,
        Rule::power => InfixOp::Power,
        _ => return None,
    })
}
