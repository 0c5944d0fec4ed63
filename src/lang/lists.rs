//! Functions of lists, and pure random numbers.

use super::args::{Bound, Formal};
use super::builtins::Builtin;
use super::estimate::{is_measured, summed};
use super::flow::{elements, range_count, room};
use super::value::{Eval, List, Located, Val};
use crate::num::hash::{Stream, mix};

const LIST: &[Formal] = &[Formal::place("list").is("a list or a range")];
const LISTS: &[Formal] =
    &[Formal::place("a").is("a list or a range"), Formal::place("b").is("a list or a range")];
const SEEDS: &[Formal] = &[
    Formal::place("seed").is("a number"),
    Formal::place("i").optional().is("a number, and so on: the same numbers give the same value"),
    Formal::place("j").optional(),
    Formal::place("k").optional(),
    Formal::place("l").optional(),
    Formal::place("m").optional(),
    Formal::place("n").optional(),
    Formal::place("o").optional(),
    Formal::place("p").optional(),
    Formal::place("q").optional(),
    Formal::place("r").optional(),
    Formal::place("s").optional(),
    Formal::place("t").optional(),
    Formal::place("u").optional(),
    Formal::place("v").optional(),
    Formal::place("w").optional(),
];

/// The functions.
pub const TABLE: &[Builtin] = &[
    Builtin { name: "count", formals: LIST, doc: "How many elements a list or a range has.", call: count },
    Builtin {
        name: "concat",
        formals: LISTS,
        doc: "The elements of one list, then those of another.",
        call: concat,
    },
    Builtin {
        name: "sum",
        formals: LIST,
        doc: "The sum of a list of numbers, of angles or of vectors.",
        call: sum,
    },
    Builtin {
        name: "rand",
        formals: SEEDS,
        doc: "A number from 0 to below 1 that depends on its arguments alone.",
        call: rand,
    },
];

fn count(bound: &Bound) -> Eval<Val> {
    let list = bound.need("list")?;
    Ok(Val::Number(match &list.value {
        Val::Range(lo, hi, _) => range_count(*lo, *hi) as f64,
        Val::List(list) => list.items.len() as f64,
        _ => return Err(list.unlike("list", "a list").help("write a list: `[a, b]`").into()),
    }))
}

fn concat(bound: &Bound) -> Eval<Val> {
    let at = bound.callee.at;
    let a = elements(bound.need("a")?, "a", bound.budget)?;
    let b = elements(bound.need("b")?, "b", bound.budget)?;
    room((a.len() + b.len()).saturating_sub(1), at)?;
    List::value([a, b].concat(), bound.budget, at)
}

fn sum(bound: &Bound) -> Eval<Val> {
    let list = elements(bound.need("list")?, "list", bound.budget)?;
    if let Some(Val::Angle(_)) = list.first().map(|first| &first.value) {
        let angle = |item: &Located| item.angle("list", bound.sources.text(item.at));
        return Ok(Val::Angle(list.iter().map(angle).collect::<Eval<Vec<f64>>>()?.iter().sum()));
    }
    let Some(first) = list.first().and_then(|first| first.value.numbers()) else {
        let numbers = list.iter().map(|item| item.number("list")).collect::<Eval<Vec<f64>>>()?;
        let values: Vec<&Val> = list.iter().map(|item| &item.value).collect();
        let measured = if values.iter().any(|value| is_measured(value)) { summed(&values) } else { None };
        return Ok(measured.unwrap_or_else(|| Val::Number(numbers.iter().sum())));
    };
    let mut total = vec![0.0; first.len()];
    for item in list.iter() {
        let v = item.vector("list", total.len())?;
        total.iter_mut().zip(v).for_each(|(sum, x)| *sum += x);
    }
    Ok(Val::vector(total, bound.callee.at))
}

/// A hash of the arguments' bits, one after another.
fn rand(bound: &Bound) -> Eval<Val> {
    let mut hash = 0;
    for (formal, given) in SEEDS.iter().zip(&bound.values) {
        if let Some(given) = given {
            // The two zeros are one number.
            let x = given.number(formal.name)? + 0.0;
            hash = mix(hash ^ x.to_bits());
        }
    }
    Ok(Val::Number(Stream::new(hash).unit()))
}
