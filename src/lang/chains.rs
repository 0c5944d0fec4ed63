//! Operators without parentheses between them: how they join into flat chains, and which may not stand
//! together. What they do to values is left to `arithmetic`.

use super::ast::{Expr, ExprKind, InfixOp, PrefixOp};
use crate::diag::Diagnostic;
use crate::source::Span;

/// The text of an operation and its place in the file.
pub struct Source<'a> {
    /// From the first operand to the last.
    pub text: &'a str,
    /// The place.
    pub at: Span,
}

impl Source<'_> {
    fn between(&self, start: u32, end: u32) -> &str {
        self.text[(start - self.at.start) as usize..(end - self.at.start) as usize].trim()
    }

    /// The place of what stands between two places, without blanks around it.
    fn trimmed(&self, start: u32, end: u32) -> Span {
        let whole = &self.text[(start - self.at.start) as usize..(end - self.at.start) as usize];
        let start = start + (whole.len() - whole.trim_start().len()) as u32;
        Span { start, end: start + whole.trim().len() as u32, ..self.at }
    }
}

/// Joins two operands; operators of one level become one chain.
pub fn join(left: Expr, op: InfixOp, sign: Span, right: Expr) -> Result<Expr, Box<Diagnostic>> {
    if let ExprKind::Prefix(PrefixOp::Not, not, _) = &right.kind
        && op.level() >= 2
    {
        return Err(Diagnostic::error("E0101", format!("`not` cannot stand after `{}`", op.sign()))
            .at(*not, "binds less tightly than the operator before it")
            .help("put parentheses around it: `(not a)`")
            .into());
    }
    let at = left.at.to(right.at);
    let chains = op != InfixOp::Power
        && matches!(&left.kind, ExprKind::Infix(_, rest) if rest[0].0.level() == op.level());
    match left.kind {
        ExprKind::Infix(_, rest) if chains && (op.compares() || op == InfixOp::Range) => {
            let error = if op == InfixOp::Range {
                Diagnostic::error("E0107", "ranges do not chain").help("a range has two ends: `1..8`")
            } else {
                Diagnostic::error("E0107", "comparisons do not chain")
                    .help("compare twice: `a < b and b < c`; a half-space has one side: `z < 60`")
            };
            Err(error.at(sign, "a second one").at(rest[0].1, "the first").into())
        }
        ExprKind::Infix(first, mut rest) if chains => {
            rest.push((op, sign, right));
            Ok(Expr { kind: ExprKind::Infix(first, rest), at })
        }
        kind => {
            let left = Expr { kind, at: left.at };
            Ok(Expr { kind: ExprKind::Infix(Box::new(left), vec![(op, sign, right)]), at })
        }
    }
}

/// Refuses a chain that holds two kinds of `| & - ^` without parentheses, whatever the operands are.
pub fn refuse_mixed(signs: &[(InfixOp, Span)], source: &Source) -> Result<(), Box<Diagnostic>> {
    let mut start = source.at.start;
    for chain in signs.split_inclusive(|(op, _)| op.level() < 3) {
        let (last, inside) = match chain.split_last() {
            Some((last, rest)) if last.0.level() < 3 => (Some(last.1), rest),
            _ => (None, chain),
        };
        let end = last.map_or(source.at.end, |s| s.start);
        let sets: Vec<(InfixOp, Span)> =
            inside.iter().copied().filter(|(op, _)| op.combines_solids()).collect();
        let other = sets.iter().find(|(op, _)| Some(*op) != sets.first().map(|f| f.0));
        if let (Some(first), Some(other)) = (sets.first(), other)
            && sets.iter().any(|(op, _)| op.level() == 3)
        {
            let told =
                format!("`{}` and `{}` stand together without parentheses", first.0.sign(), other.0.sign());
            let error = Diagnostic::error("E0201", told)
                .at(other.1, "which comes first?")
                .at(first.1, "the first operator")
                .fix_with(
                    source.trimmed(start, end),
                    sure(&sets).then(|| from_the_left(&sets, start, end, source)).as_deref(),
                );
            return Err(error.help(rewriting(&sets, start, end, source)).into());
        }
        start = last.map_or(end, |s| s.end);
    }
    Ok(())
}

/// Whether a chain reads from left to right for whoever knows programming languages too, where `-` binds before `&`, that
/// before `^`, and that before `|`.
fn sure(sets: &[(InfixOp, Span)]) -> bool {
    let looseness = |op: InfixOp| match op {
        InfixOp::Subtract => 0,
        InfixOp::Intersect => 1,
        InfixOp::Exclude => 2,
        _ => 3,
    };
    sets.is_sorted_by_key(|(op, _)| looseness(*op))
}

/// Both readings of a short chain, the one from left to right of a longer one.
fn rewriting(sets: &[(InfixOp, Span)], start: u32, end: u32, source: &Source) -> String {
    const WIDEST: usize = 90;
    let text = source.between(start, end);
    if text.contains('\n') || text.len() > WIDEST {
        return "put parentheses around what belongs together".to_owned();
    }
    let left = from_the_left(sets, start, end, source);
    if let [first, second] = sets {
        let [a, b, c] = [0, 1, 2].map(|i| operand(i, sets, start, end, source));
        return format!("write `{left}` or `{a} {} ({b} {} {c})`", first.0.sign(), second.0.sign());
    }
    format!("write `{left}`, or put the parentheses where they are meant")
}

/// An operand of a chain of set operators, as it was written.
fn operand<'a>(i: usize, sets: &[(InfixOp, Span)], start: u32, end: u32, source: &'a Source) -> &'a str {
    let from = if i == 0 { start } else { sets[i - 1].1.end };
    source.between(from, sets.get(i).map_or(end, |s| s.1.start))
}

/// The chain with parentheses as it reads from left to right.
fn from_the_left(sets: &[(InfixOp, Span)], start: u32, end: u32, source: &Source) -> String {
    let mut left = operand(0, sets, start, end, source).to_owned();
    for (i, (op, _)) in sets.iter().enumerate() {
        if i > 0 && *op != sets[i - 1].0 {
            left = format!("({left})");
        }
        left = format!("{left} {} {}", op.sign(), operand(i + 1, sets, start, end, source));
    }
    left
}
