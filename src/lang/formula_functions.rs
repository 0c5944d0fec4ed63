//! The functions that a formula of x, y and z may use: those of `maths` but for colours.

use super::args::Formal;
use super::ast::InfixOp;
use super::formula::{Placed, Reader, Term};
use super::value::Eval;
use crate::diag::Diagnostic;
use crate::scene::formula::{One, Two};
use crate::source::Span;

/// A function of a formula.
#[derive(Clone, Copy)]
pub struct Function {
    /// The word.
    pub name: &'static str,
    /// What it takes.
    pub formals: &'static [Formal<'static>],
    /// Adds its steps; all its arguments are given.
    pub call: fn(&mut Reader, &[Placed], Span) -> Eval<Term>,
}

const X: &[Formal] = &[Formal::place("x")];
const V: &[Formal] = &[Formal::place("v")];
const AB: &[Formal] = &[Formal::place("a"), Formal::place("b")];
const ANGLE: &[Formal] = &[Formal::place("angle")];
const YX: &[Formal] = &[Formal::place("y"), Formal::place("x")];
const CLAMP: &[Formal] = &[Formal::place("x"), Formal::place("lo"), Formal::place("hi")];
const MIX: &[Formal] = &[Formal::place("a"), Formal::place("b"), Formal::place("t")];

const fn line(
    name: &'static str,
    formals: &'static [Formal<'static>],
    call: fn(&mut Reader, &[Placed], Span) -> Eval<Term>,
) -> Function {
    Function { name, formals, call }
}

/// The functions.
pub const FUNCTIONS: &[Function] = &[
    line("sqrt", X, |r, a, at| plain(r, One::Sqrt, "sqrt", a, at)),
    line("abs", X, |r, a, at| r.each(a[0].term.clone(), |r, x| r.one(One::Abs, x, at))),
    line("floor", X, |r, a, at| plain(r, One::Floor, "floor", a, at)),
    line("ceil", X, |r, a, at| plain(r, One::Ceil, "ceil", a, at)),
    line("round", X, |r, a, at| plain(r, One::Round, "round", a, at)),
    line("exp", X, |r, a, at| plain(r, One::Exp, "exp", a, at)),
    line("ln", X, |r, a, at| plain(r, One::Ln, "ln", a, at)),
    line("sin", ANGLE, |r, a, at| of_angle(r, One::Sin, "sin", a, at)),
    line("cos", ANGLE, |r, a, at| of_angle(r, One::Cos, "cos", a, at)),
    line("tan", ANGLE, |r, a, at| of_angle(r, One::Tan, "tan", a, at)),
    line("asin", X, |r, a, at| to_angle(r, One::Asin, "asin", a, at)),
    line("acos", X, |r, a, at| to_angle(r, One::Acos, "acos", a, at)),
    line("atan2", YX, |r, a, at| {
        let (y, x) = (r.number(&a[0], "atan2")?, r.number(&a[1], "atan2")?);
        r.two(Two::Atan2, y, x, at).map(Term::Angle)
    }),
    line("min", AB, |r, a, at| pairwise(r, Two::Min, "min", &a[0], &a[1], at)),
    line("max", AB, |r, a, at| pairwise(r, Two::Max, "max", &a[0], &a[1], at)),
    line("clamp", CLAMP, |r, a, at| {
        let above = pairwise(r, Two::Max, "clamp", &a[0], &a[1], at)?;
        pairwise(r, Two::Min, "clamp", &Placed { term: above, at: a[0].at }, &a[2], at)
    }),
    line("mix", MIX, mix),
    line("length", V, |r, a, at| {
        let square = dot(r, &a[0], &a[0], "length", at)?;
        r.one(One::Sqrt, square, at).map(Term::Number)
    }),
    line("normalize", V, |r, a, at| {
        let square = dot(r, &a[0], &a[0], "normalize", at)?;
        let length = r.one(One::Sqrt, square, at)?;
        r.each(a[0].term.clone(), |r, x| r.two(Two::Divide, x, length, at))
    }),
    line("dot", AB, |r, a, at| dot(r, &a[0], &a[1], "dot", at).map(Term::Number)),
    line("cross", AB, cross),
];

fn plain(r: &mut Reader, op: One, name: &str, given: &[Placed], at: Span) -> Eval<Term> {
    if let Term::Vector(_) = given[0].term {
        return r.each(given[0].term.clone(), |r, x| r.one(op, x, at));
    }
    let x = r.number(&given[0], name)?;
    r.one(op, x, at).map(Term::Number)
}

fn of_angle(r: &mut Reader, op: One, name: &str, given: &[Placed], at: Span) -> Eval<Term> {
    let x = r.angle(&given[0], name)?;
    r.one(op, x, at).map(Term::Number)
}

fn to_angle(r: &mut Reader, op: One, name: &str, given: &[Placed], at: Span) -> Eval<Term> {
    let x = r.number(&given[0], name)?;
    r.one(op, x, at).map(Term::Angle)
}

fn pairwise(r: &mut Reader, op: Two, name: &str, a: &Placed, b: &Placed, at: Span) -> Eval<Term> {
    if let (Term::Angle(a), Term::Angle(b)) = (&a.term, &b.term) {
        return r.two(op, *a, *b, at).map(Term::Angle);
    }
    match (&a.term, &b.term) {
        (Term::Vector(u), Term::Vector(v)) if u.len() == v.len() => {
            u.iter().zip(v).map(|(a, b)| r.two(op, *a, *b, at)).collect::<Eval<_>>().map(Term::Vector)
        }
        (Term::Vector(u), Term::Number(b)) => {
            u.iter().map(|a| r.two(op, *a, *b, at)).collect::<Eval<_>>().map(Term::Vector)
        }
        (Term::Number(a), Term::Vector(v)) => {
            v.iter().map(|b| r.two(op, *a, *b, at)).collect::<Eval<_>>().map(Term::Vector)
        }
        _ => {
            let (a, b) = (r.number(a, name)?, r.number(b, name)?);
            r.two(op, a, b, at).map(Term::Number)
        }
    }
}

/// a (1 - t) + b t, of vectors part by part.
fn mix(r: &mut Reader, given: &[Placed], at: Span) -> Eval<Term> {
    let [a, b, t] = given else { return Err(super::formula::stranger(at).into()) };
    let t = r.number(t, "mix")?;
    let one = r.literal(1.0, at)?;
    let rest = r.two(Two::Subtract, one, t, at)?;
    if let (Term::Vector(_), _) | (_, Term::Vector(_)) = (&a.term, &b.term) {
        let number = |step| Placed { term: Term::Number(step), at };
        let low = Placed { term: r.infix(InfixOp::Multiply, at, a, &number(rest))?, at };
        let high = Placed { term: r.infix(InfixOp::Multiply, at, b, &number(t))?, at };
        return r.infix(InfixOp::Add, at, &low, &high);
    }
    let (a, b) = (r.number(a, "mix")?, r.number(b, "mix")?);
    let (low, high) = (r.two(Two::Multiply, a, rest, at)?, r.two(Two::Multiply, b, t, at)?);
    r.two(Two::Add, low, high, at).map(Term::Number)
}

fn cross(r: &mut Reader, given: &[Placed], at: Span) -> Eval<Term> {
    let (u, v) = vectors(&given[0], &given[1], "cross", Some(3))?;
    let mut minor = |i: usize, j: usize| {
        let (there, back) = (r.two(Two::Multiply, u[i], v[j], at)?, r.two(Two::Multiply, u[j], v[i], at)?);
        r.two(Two::Subtract, there, back, at)
    };
    Ok(Term::Vector(vec![minor(1, 2)?, minor(2, 0)?, minor(0, 1)?]))
}

/// Two vectors of one size, of the size that is wanted if one is.
fn vectors<'p>(
    a: &'p Placed,
    b: &'p Placed,
    name: &str,
    size: Option<usize>,
) -> Eval<(&'p [u32], &'p [u32])> {
    let wanted = size.map_or("of one size".to_owned(), |n| format!("of {n} numbers"));
    let wrong = |p: &Placed| {
        let found = match &p.term {
            Term::Vector(v) => format!("one of {}", v.len()),
            other => other.kind().to_owned(),
        };
        let error = Diagnostic::error("E0501", format!("`{name}` wants vectors {wanted}, found {found}"));
        error.at(p.at, p.term.kind()).help("write a vector, such as `[x, y, z]`")
    };
    let Term::Vector(u) = &a.term else { return Err(wrong(a).into()) };
    let Term::Vector(v) = &b.term else { return Err(wrong(b).into()) };
    match u.len() == v.len() && size.is_none_or(|n| n == u.len()) {
        true => Ok((u, v)),
        false => Err(wrong(b).into()),
    }
}

fn dot(r: &mut Reader, a: &Placed, b: &Placed, name: &str, at: Span) -> Eval<u32> {
    let (u, v) = vectors(a, b, name, None)?;
    let mut sum = r.two(Two::Multiply, u[0], v[0], at)?;
    for (a, b) in u.iter().zip(v).skip(1) {
        let product = r.two(Two::Multiply, *a, *b, at)?;
        sum = r.two(Two::Add, sum, product, at)?;
    }
    Ok(sum)
}
