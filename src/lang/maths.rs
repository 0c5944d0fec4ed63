//! The functions of numbers, angles, vectors and colours. On a vector, a function of one number acts on each.

use super::args::{Bound, Formal};
use super::ast::AngleUnit;
use super::builtins::{Builtin, line};
use super::estimate::{components, gathered, is_measured, lifted};
use super::units;
use super::value::{Eval, Located, Val};
use crate::diag::Diagnostic;

const X: &[Formal] = &[Formal::place("x").is("a number, or a vector: each of its numbers")];
const V: &[Formal] = &[Formal::place("v").is("a vector")];
const AB: &[Formal] = &[Formal::place("a"), Formal::place("b")];
const ANGLE: &[Formal] = &[Formal::place("angle").is("an angle: `30deg`, or a list of 2 to 4")];
const CLAMP: &[Formal] = &[
    Formal::place("x").is("a number"),
    Formal::place("lo").is("the least"),
    Formal::place("hi").is("the most"),
];
const MIX: &[Formal] = &[
    Formal::place("a").is("where t is 0"),
    Formal::place("b").is("where t is 1"),
    Formal::place("t").is("a number"),
];
const YX: &[Formal] = &[Formal::place("y"), Formal::place("x")];
const RGB: &[Formal] = &[
    Formal::place("r").is("a number, linear, from 0 to 1"),
    Formal::place("g").is("the same"),
    Formal::place("b").is("the same"),
];

/// The functions.
pub const TABLE: &[Builtin] = &[
    line("sqrt", X, "The square root.", |b| each(b, f64::sqrt)),
    line("abs", X, "Without its sign.", |b| each_or_angle(b, f64::abs)),
    line("floor", X, "The largest whole number not above.", |b| each(b, f64::floor)),
    line("ceil", X, "The smallest whole number not below.", |b| each(b, f64::ceil)),
    line("round", X, "The nearest whole number; halves away from zero.", |b| each(b, f64::round)),
    line("exp", X, "e to this power.", |b| each(b, f64::exp)),
    line("ln", X, "The natural logarithm.", |b| each(b, f64::ln)),
    line("min", AB, "The smaller of two.", |b| pairwise(b.need("a")?, b.need("b")?, f64::min)),
    line("max", AB, "The larger of two.", |b| pairwise(b.need("a")?, b.need("b")?, f64::max)),
    line("clamp", CLAMP, "The nearest to x between lo and hi.", clamp),
    line("mix", MIX, "From a to b as t goes from 0 to 1.", mix),
    line("sin", ANGLE, "The sine of an angle.", |b| of_angle(b, |d| units::sin_cos(d).0)),
    line("cos", ANGLE, "The cosine of an angle.", |b| of_angle(b, |d| units::sin_cos(d).1)),
    line("tan", ANGLE, "The tangent of an angle.", |b| {
        of_angle(b, |d| {
            let (s, c) = units::sin_cos(d);
            s / c
        })
    }),
    line("asin", X, "The angle with this sine.", |b| to_angle(b, f64::asin)),
    line("acos", X, "The angle with this cosine.", |b| to_angle(b, f64::acos)),
    line("atan2", YX, "The angle from the x axis to [x, y].", atan2),
    line("length", V, "The Euclidean length of a vector.", |b| {
        let plain = norm(&vector(b, "v")?);
        Ok(of_vectors(&[b.need("v")?], norm).unwrap_or(Val::Number(plain)))
    }),
    line("normalize", V, "The vector with length 1.", normalize),
    line("dot", AB, "The scalar product.", dot),
    line("cross", AB, "The vector product.", cross),
    line("rgb", RGB, "A colour by its linear channels.", rgb),
];

fn each(bound: &Bound, f: fn(f64) -> f64) -> Eval<Val> {
    let x = bound.need("x")?;
    if is_measured(&x.value) {
        let parts = components(&x.value).unwrap_or_default();
        return Ok(gathered(parts.iter().filter_map(|part| lifted(&[part], |x| f(x[0]))).collect(), x.at));
    }
    match x.value.numbers() {
        Some(v) => Ok(Val::vector(v.into_iter().map(f), x.at)),
        None => Ok(Val::Number(f(x.number("x")?))),
    }
}

fn each_or_angle(bound: &Bound, f: fn(f64) -> f64) -> Eval<Val> {
    let x = bound.need("x")?;
    match x.value.parts() {
        Some((parts, true)) => Ok(parts.map(f).value(true, x.at)),
        _ => each(bound, f),
    }
}

fn pairwise(a: &Located, b: &Located, f: impl Fn(f64, f64) -> f64) -> Eval<Val> {
    if let (true, Some(u), Some(v)) =
        (is_measured(&a.value) || is_measured(&b.value), components(&a.value), components(&b.value))
        && (u.len() == v.len() || u.len() == 1 || v.len() == 1)
    {
        let pairs = (0..u.len().max(v.len())).map(|i| [&u[i % u.len()], &v[i % v.len()]]);
        return Ok(gathered(pairs.filter_map(|pair| lifted(&pair, |x| f(x[0], x[1]))).collect(), a.at));
    }
    let both = a.value.parts().zip(b.value.parts());
    let same = both.filter(|((_, a), (_, b))| a == b);
    if let Some(value) =
        same.and_then(|((u, of_angles), (v, _))| Some(u.zip(v)?.map(|(u, v)| f(u, v)).value(of_angles, a.at)))
    {
        return Ok(value);
    }
    // Of two that do not fit the first that is no number is told.
    a.number("a")?;
    b.number("b")?;
    Err(b.unlike("b", "a number").help("write a number, such as `10`").into())
}

fn clamp(bound: &Bound) -> Eval<Val> {
    let x = bound.need("x")?;
    let above = Located { value: pairwise(x, bound.need("lo")?, f64::max)?, at: x.at };
    pairwise(&above, bound.need("hi")?, f64::min)
}

fn mix(bound: &Bound) -> Eval<Val> {
    let (a, b, t) = (bound.need("a")?, bound.need("b")?, bound.need("t")?.number("t")?);
    if let (Val::Color(a), Val::Color(b)) = (&a.value, &b.value) {
        let t = t as f32;
        return Ok(Val::Color([0, 1, 2].map(|i| a[i] * (1.0 - t) + b[i] * t)));
    }
    pairwise(a, b, |a, b| a * (1.0 - t) + b * t)
}

fn of_angle(bound: &Bound, f: fn(f64) -> f64) -> Eval<Val> {
    let given = bound.need("angle")?;
    let Val::List(list) = &given.value else { return Ok(Val::Number(f(bound.angle("angle")?))) };
    if !(2..=4).contains(&list.items.len()) {
        return Err(given.unlike("angle", "an angle").help("write an angle, or a list of 2 to 4").into());
    }
    let one = |item: &Located| item.angle("angle", bound.sources.text(item.at)).map(f);
    Ok(Val::vector(list.items.iter().map(one).collect::<Eval<Vec<f64>>>()?, given.at))
}

fn to_angle(bound: &Bound, f: fn(f64) -> f64) -> Eval<Val> {
    let given = bound.need("x")?;
    let degrees = |x: f64| units::degrees(f(x), AngleUnit::Radian);
    match given.value.numbers() {
        Some(v) => Ok(Val::row(v.into_iter().map(degrees), true, given.at)),
        None => Ok(Val::Angle(degrees(given.number("x")?))),
    }
}

fn atan2(bound: &Bound) -> Eval<Val> {
    let (y, x) = (bound.need("y")?, bound.need("x")?);
    let degrees = |y: f64, x: f64| units::degrees(y.atan2(x), AngleUnit::Radian);
    if let (Some((v, false)), Some((u, false))) = (y.value.parts(), x.value.parts())
        && let Some(parts) = v.zip(u)
    {
        return Ok(parts.map(|(y, x)| degrees(y, x)).value(true, y.at));
    }
    Ok(Val::Angle(degrees(y.number("y")?, x.number("x")?)))
}

fn vector(bound: &Bound, name: &str) -> Eval<Vec<f64>> {
    let given = bound.need(name)?;
    match given.value.numbers() {
        Some(v) => Ok(v),
        None => given.vector(name, 3),
    }
}

/// A function of all numbers of some vectors, where one was measured.
fn of_vectors(vectors: &[&Located], f: impl Fn(&[f64]) -> f64) -> Option<Val> {
    let all = vectors.iter().map(|v| components(&v.value)).collect::<Option<Vec<_>>>()?.concat();
    if all.iter().any(is_measured) { lifted(&all.iter().collect::<Vec<_>>(), f) } else { None }
}

fn norm(v: &[f64]) -> f64 {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest == 0.0 { 0.0 } else { largest * v.iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt() }
}

fn normalize(bound: &Bound) -> Eval<Val> {
    let v = vector(bound, "v")?;
    let n = norm(&v);
    Ok(Val::vector(v.into_iter().map(|x| x / n), bound.callee.at))
}

fn dot(bound: &Bound) -> Eval<Val> {
    let a = vector(bound, "a")?;
    let b = bound.need("b")?.vector("b", a.len())?;
    let sum = |both: &[f64]| (0..a.len()).map(|i| both[i] * both[a.len() + i]).sum();
    let measured = of_vectors(&[bound.need("a")?, bound.need("b")?], sum);
    Ok(measured.unwrap_or_else(|| Val::Number(sum(&[&a[..], &b].concat()))))
}

fn cross(bound: &Bound) -> Eval<Val> {
    let (a, b) = (bound.need("a")?.vec3("a")?, bound.need("b")?.vec3("b")?);
    Ok(Val::vector(a.cross(b).to_array(), bound.callee.at))
}

fn rgb(bound: &Bound) -> Eval<Val> {
    let mut channels = [0.0; 3];
    for (channel, name) in channels.iter_mut().zip(["r", "g", "b"]) {
        let given = bound.need(name)?;
        let x = given.number(name)?;
        if x < 0.0 {
            return Err(Diagnostic::error("E0506", format!("`{name}` is negative"))
                .at(given.at, format!("{x}"))
                .help("the channels of a colour are zero or more")
                .into());
        }
        if x > 1.0 {
            let warning = Diagnostic::warning("W0205", format!("`{name}` is above 1: brighter than white"));
            let warning = warning.at(given.at, format!("{x}"));
            let bytes = "the channels reach from 0 to 1, and are linear; bytes are written `#ff8000`";
            bound.warnings.borrow_mut().push(warning.help(bytes));
        }
        *channel = x as f32;
    }
    Ok(Val::Color(channels))
}
