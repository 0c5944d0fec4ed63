//! Calls of declared things: every argument checked against the kind its declaration names.

use std::path::{Path, PathBuf};

use glam::DVec3;
use litemap::LiteMap;

use super::args::{Callee, formals, quoted, wanted};
use super::ast::{Args, Expr, ExprKind};
use super::eval::Machine;
use super::value::{Eval, Located, Stop, Val};
use super::{formula, half_space};
use crate::diag::{Diagnostic, nearest};
use crate::geom::tolerance;
use crate::scene::{Arg, Call, Decl, Kind, Param, Value};
use crate::source::Span;

/// A call of `decl` with its arguments checked.
pub fn call(machine: &mut Machine, decl: &Decl, args: &Args, at: Span) -> Eval<Call> {
    call_without(machine, decl, args, at, "")
}

/// The same where an argument of this name was read already.
pub fn call_without(machine: &mut Machine, decl: &Decl, args: &Args, at: Span, known: &str) -> Eval<Call> {
    let formals = formals(decl);
    let bound = Callee { word: decl.word, at, formals: &formals }.bind(args, known)?;
    let mut checked = LiteMap::with_capacity(bound.iter().flatten().count());
    for (param, expr) in decl.params.iter().zip(bound) {
        if let Some(expr) = expr {
            let value =
                argument(machine, param, expr).map_err(|stop| sized(stop, decl, param, machine, expr))?;
            checked.insert(param.name.to_owned(), Arg { value, at: expr.at });
        }
    }
    Ok(Call { word: decl.word.to_owned(), args: checked, at })
}

/// The error for a number where a corner is wanted, of what has a size too: `box(10)`.
fn sized(stop: Stop, decl: &Decl, param: &Param, machine: &Machine, expr: &Expr) -> Stop {
    let Stop::Told(mut error) = stop else { return stop };
    let has_size = decl.params.iter().any(|p| p.name == "size" && p.kind == Kind::SizeOrVector);
    if has_size && param.by_place && error.message.ends_with("found a number") {
        error.help =
            Some(format!("write `{}(size: {})`, or two corners", decl.word, machine.written(expr.at)).into());
    }
    Stop::Told(error)
}

fn argument(machine: &mut Machine, param: &Param, expr: &Expr) -> Eval<Value> {
    if param.kind == Kind::HalfSpace {
        let (normal, offset) = half_space::read(machine, expr)?;
        return Ok(Value::HalfSpace { normal, offset });
    }
    if param.kind == Kind::Condition {
        return Ok(Value::Formula(formula::read(machine, expr)?.into()));
    }
    if let Kind::Choice(words) | Kind::LengthOr(words) = param.kind {
        unquoted(machine, expr, param.name, words)?;
    }
    let given = machine.located(expr)?;
    let name = param.name;
    Ok(match param.kind {
        Kind::Number => Value::Number(given.number(name)?),
        Kind::Length => Value::Number(given.as_number(name, "a length")?),
        Kind::Positive => Value::Number(above_zero(&given, name, given.number(name)?)?),
        Kind::Width => Value::Number(above_zero(&given, name, given.as_number(name, &wanted(param.kind))?)?),
        Kind::Int(lo, hi) => Value::Number(whole(&given, name, lo, hi)?),
        Kind::Size => Value::Number(size(machine, &given, name)?),
        Kind::SizeOrVector if matches!(given.value, Val::List(_)) => {
            let items = sizes(machine, &given, name)?;
            Value::Vector(items)
        }
        Kind::SizeOrVector => Value::Number(size(machine, &given, name)?),
        Kind::Angle => Value::Angle(given.angle(name, machine.written(expr.at))?.to_radians()),
        Kind::Color => match given.value {
            Val::Color(c) => Value::Color(c),
            _ => return Err(given.unlike(name, "a colour").help("write a colour, such as `#b8683c`").into()),
        },
        Kind::Vector(n) => Value::Vector(given.vector(name, n)?),
        Kind::Points => Value::Points(points(&given, name)?),
        Kind::Bool => match given.value {
            Val::Bool(b) => Value::Bool(b),
            _ => return Err(given.unlike(name, "`true` or `false`").help("write `true` or `false`").into()),
        },
        Kind::Choice(words) => Value::Text(choice(&given, name, words)?),
        Kind::Choices(words) => Value::Texts(choices(&given, name, words, param.kind)?),
        Kind::LengthOr(words) => match &given.value {
            Val::Text(..) => Value::Text(choice(&given, name, words)?),
            _ => Value::Number(given.as_number(name, &wanted(param.kind))?),
        },
        Kind::Path => path(machine, &given, name, param.kind)?,
        Kind::PathOrSolid => match given.value {
            Val::Shape(shape) => Value::Shape(shape),
            _ => path(machine, &given, name, param.kind)?,
        },
        Kind::Outline => Value::Loops(outline(&given, name)?),
        Kind::NumberOrPair if matches!(given.value, Val::List(_)) => Value::Vector(given.vector(name, 2)?),
        Kind::NumberOrPair => Value::Number(given.number(name)?),
        Kind::Solid => Value::Shape(given.shape(name)?.clone()),
        Kind::HalfSpace | Kind::Condition => return Err(given.unlike(name, &wanted(param.kind)).into()),
    })
}

fn size(machine: &mut Machine, given: &Located, name: &str) -> Eval<f64> {
    let x = given.as_number(name, "a length")?;
    if x < 0.0 {
        return Err(Diagnostic::error("E0506", format!("`{name}` is negative"))
            .at(given.at, format!("{x}"))
            .help("a size is zero or more")
            .into());
    }
    if x == 0.0 {
        let warning = Diagnostic::warning("W0101", format!("`{name}` is zero: the shape is nothing"))
            .at(given.at, "no size")
            .help("give it a size, or leave the shape out");
        machine.warn(warning);
    } else if x < tolerance::SMALLEST {
        return Err(Diagnostic::error("E0506", format!("`{name}` is too small for its powers to be told"))
            .at(given.at, format!("{x:e}"))
            .help("choose smaller units, such as `units(um)`")
            .into());
    }
    Ok(x)
}

fn sizes(machine: &mut Machine, given: &Located, name: &str) -> Eval<Vec<f64>> {
    let Val::List(list) = &given.value else {
        return given.vector(name, 3);
    };
    given.vector(name, 3)?;
    list.items.iter().map(|i| size(machine, i, name)).collect()
}

fn points(given: &Located, name: &str) -> Eval<Vec<DVec3>> {
    match &given.value {
        Val::List(list) => list.items.iter().map(|point| point.vec3(name)).collect(),
        _ => Err(given.unlike(name, "a list of points").help("write `[[0, 0, 0], [1, 0, 0]]`").into()),
    }
}

fn above_zero(given: &Located, name: &str, x: f64) -> Eval<f64> {
    if x > 0.0 {
        return Ok(x);
    }
    Err(Diagnostic::error("E0503", format!("`{name}` must be above zero"))
        .at(given.at, format!("{x}"))
        .help("write a number above zero")
        .into())
}

fn whole(given: &Located, name: &str, lo: i64, hi: i64) -> Eval<f64> {
    let x = given.number(name)?;
    if x.fract() == 0.0 && (lo as f64..=hi as f64).contains(&x) {
        return Ok(x);
    }
    Err(Diagnostic::error("E0503", format!("`{name}` must be a whole number from {lo} to {hi}"))
        .at(given.at, format!("{x}"))
        .help(format!("write a whole number from {lo} to {hi}"))
        .into())
}

/// Refuses a word that stands without its quotes, unless the scene gives it a meaning.
pub fn unquoted(machine: &Machine, expr: &Expr, name: &str, words: &[&str]) -> Eval<()> {
    let ExprKind::Name(word) = &expr.kind else { return Ok(()) };
    if !words.contains(&word.as_str()) || machine.defined(word, expr.at).is_some() {
        return Ok(());
    }
    let error = Diagnostic::error("E0507", format!("the word of `{name}` stands in quotes"));
    let quoted = format!("\"{word}\"");
    Err(error
        .at(expr.at, "without them it is a name")
        .fix(expr.at, &quoted)
        .help(format!("write `{quoted}`"))
        .into())
}

/// One of some words.
pub fn choice(given: &Located, name: &str, words: &[&str]) -> Eval<String> {
    let Val::Text(text, _) = &given.value else {
        let help = format!("write one of {}", quoted(words));
        return Err(given.unlike(name, "a word").help(help).into());
    };
    if words.contains(&&**text) {
        return Ok(text.to_string());
    }
    let told = format!("`{name}` cannot be \"{}\"", text.escape_debug());
    Err(Diagnostic::error("E0507", told)
        .at(given.at, "unknown word")
        .help(match nearest(text, words.iter().copied()) {
            Some(known) => format!("did you mean \"{known}\"?"),
            None => format!("write one of {}", quoted(words)),
        })
        .into())
}

/// One loop of points, or a list of loops.
fn outline(given: &Located, name: &str) -> Eval<Vec<Vec<[f64; 2]>>> {
    let Val::List(list) = &given.value else {
        let help = "write its corners in order: `[[0, 0], [4, 0], [2, 3]]`";
        return Err(given.unlike(name, &wanted(Kind::Outline)).help(help).into());
    };
    let point = |p: &Located| -> Eval<[f64; 2]> {
        let v = p.vector(name, 2)?;
        Ok([v[0], v[1]])
    };
    // A list of loops holds lists of lists.
    let of_lists = |l: &Located| matches!(&l.value, Val::List(l) if l.items.iter().any(|p| matches!(p.value, Val::List(_))));
    if !list.items.first().is_some_and(of_lists) {
        return Ok(vec![list.items.iter().map(point).collect::<Eval<_>>()?]);
    }
    let one = |l: &Located| match &l.value {
        Val::List(points) => points.items.iter().map(point).collect::<Eval<Vec<_>>>(),
        _ => Err(l.unlike(name, "a list of points").help("write a hole as a list of its own").into()),
    };
    list.items.iter().map(one).collect()
}

fn choices(given: &Located, name: &str, words: &[&str], kind: Kind) -> Eval<Vec<String>> {
    match &given.value {
        Val::List(list) => list.items.iter().map(|i| choice(i, name, words)).collect(),
        _ => Err(given.unlike(name, &wanted(kind)).help("write a list, such as `[\"depth\"]`").into()),
    }
}

fn path(machine: &Machine, given: &Located, name: &str, kind: Kind) -> Eval<Value> {
    let Val::Text(text, home) = &given.value else {
        return Err(given.unlike(name, &wanted(kind)).help("write a name, such as `\"scan.ply\"`").into());
    };
    if text.is_empty() {
        return Err(Diagnostic::error("E0503", format!("`{name}` names no file"))
            .at(given.at, "empty")
            .help("write a name, such as `\"scan.ply\"`")
            .into());
    }
    let file = home.and_then(|id| machine.sources.file(id).path.as_deref());
    Ok(Value::Path {
        text: text.to_string(),
        base: file.and_then(Path::parent).map_or_else(PathBuf::new, Path::to_owned),
        from_command_line: home.is_none(),
    })
}
