//! The functions that a formula of x, y and z may use: those of `maths` but for colours.

use super::args::Formal;
use super::ast::InfixOp;
use super::formula::{Placed, Reader, Term};
use super::parts::Parts;
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
    line("abs", X, |r, a, at| each(r, &a[0].term, a[0].term.of_angles, |r, x| r.one(One::Abs, x, at))),
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
        let Term { steps, .. } = pairwise(r, Two::Atan2, "atan2", &a[0], &a[1], at)?;
        Ok(Term { steps, of_angles: true })
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
        r.one(One::Sqrt, square, at).map(Term::number)
    }),
    line("normalize", V, |r, a, at| {
        let square = dot(r, &a[0], &a[0], "normalize", at)?;
        let length = r.one(One::Sqrt, square, at)?;
        each(r, &a[0].term, false, |r, x| r.two(Two::Divide, x, length, at))
    }),
    line("dot", AB, |r, a, at| dot(r, &a[0], &a[1], "dot", at).map(Term::number)),
    line("cross", AB, cross),
];

fn plain(r: &mut Reader, op: One, name: &str, given: &[Placed], at: Span) -> Eval<Term> {
    plain_numbers(r, &given[0], name)?;
    each(r, &given[0].term, false, |r, x| r.one(op, x, at))
}

fn of_angle(r: &mut Reader, op: One, name: &str, given: &[Placed], at: Span) -> Eval<Term> {
    if !given[0].term.of_angles {
        r.angle(&given[0], name)?;
    }
    each(r, &given[0].term, false, |r, x| r.one(op, x, at))
}

fn to_angle(r: &mut Reader, op: One, name: &str, given: &[Placed], at: Span) -> Eval<Term> {
    plain_numbers(r, &given[0], name)?;
    each(r, &given[0].term, true, |r, x| r.one(op, x, at))
}

/// Refuses angles.
fn plain_numbers(r: &Reader, given: &Placed, name: &str) -> Eval<()> {
    if given.term.of_angles { r.number(given, name).map(drop) } else { Ok(()) }
}

/// A function of one number, of each where it is given a vector.
fn each(
    r: &mut Reader,
    term: &Term,
    of_angles: bool,
    mut f: impl FnMut(&mut Reader, u32) -> Eval<u32>,
) -> Eval<Term> {
    Ok(Term { steps: term.steps.clone().try_map(|x| f(r, x))?, of_angles })
}

fn pairwise(r: &mut Reader, op: Two, name: &str, a: &Placed, b: &Placed, at: Span) -> Eval<Term> {
    let of_angles = a.term.of_angles;
    let pairs = a.term.steps.clone().zip(b.term.steps.clone()).filter(|_| of_angles == b.term.of_angles);
    let Some(pairs) = pairs.filter(|_| op != Two::Atan2 || !of_angles) else {
        // Of two that do not fit the first that is no number is told.
        r.number(a, name)?;
        r.number(b, name)?;
        return Err(super::formula::stranger(at).into());
    };
    let steps = pairs.try_map(|(a, b)| r.two(op, a, b, at))?;
    Ok(Term { steps, of_angles })
}

/// a (1 - t) + b t, of vectors part by part.
fn mix(r: &mut Reader, given: &[Placed], at: Span) -> Eval<Term> {
    let [a, b, t] = given else { return Err(super::formula::stranger(at).into()) };
    let t = r.number(t, "mix")?;
    let one = r.literal(1.0, at)?;
    let rest = r.two(Two::Subtract, one, t, at)?;
    if a.term.of_angles != b.term.of_angles {
        r.number(a, "mix")?;
        r.number(b, "mix")?;
    }
    let number = |step| Placed { term: Term::number(step), at };
    let low = Placed { term: r.infix(InfixOp::Multiply, at, a, &number(rest))?, at };
    let high = Placed { term: r.infix(InfixOp::Multiply, at, b, &number(t))?, at };
    r.infix(InfixOp::Add, at, &low, &high)
}

fn cross(r: &mut Reader, given: &[Placed], at: Span) -> Eval<Term> {
    let (u, v) = vectors(&given[0], &given[1], "cross", Some(3))?;
    let mut minor = |i: usize, j: usize| {
        let (there, back) = (r.two(Two::Multiply, u[i], v[j], at)?, r.two(Two::Multiply, u[j], v[i], at)?);
        r.two(Two::Subtract, there, back, at)
    };
    let steps = Parts::Many(vec![minor(1, 2)?, minor(2, 0)?, minor(0, 1)?]);
    Ok(Term { steps, of_angles: false })
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
            Term { steps: Parts::Many(v), of_angles: false } => format!("one of {}", v.len()),
            other => other.kind().to_owned(),
        };
        let error = Diagnostic::error("E0501", format!("`{name}` wants vectors {wanted}, found {found}"));
        error.at(p.at, p.term.kind()).help("write a vector, such as `[x, y, z]`")
    };
    let Term { steps: Parts::Many(u), of_angles: false } = &a.term else { return Err(wrong(a).into()) };
    let Term { steps: Parts::Many(v), of_angles: false } = &b.term else { return Err(wrong(b).into()) };
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
