//! Parameters: their types, what they allow, and values given by `-D name=value`.

use super::args::quoted;
use super::ast::{Expr, ExprKind, Param, PrefixOp, Word};
use super::budget::Budget;
use super::eval::Machine;
use super::value::{Eval, Located, Stop, Val};
use super::{arithmetic, parse, span, split};
use crate::diag::{Diagnostic, Fault, listed, nearest};
use crate::source::{FileId, SourceMap};

/// A `-D` whose text is in the source map.
pub struct Define {
    name: String,
    value: String,
    file: FileId,
}

/// Adds the texts to the source map, each as `name=value`.
pub fn add(sources: &mut SourceMap, defines: &[(String, String)]) -> Vec<Define> {
    let one = |(name, value): &(String, String)| {
        let file = sources.add("command line", None, format!("{name}={value}"));
        Define { name: name.clone(), value: value.clone(), file }
    };
    defines.iter().map(one).collect()
}

/// Errors for names that no parameter has.
pub fn unknown(defines: &[Define], known: &[&str]) -> Vec<Diagnostic> {
    let stranger = |d: &&Define| !known.contains(&d.name.as_str());
    let list = listed(known.iter().copied(), |n| format!("`{n}`")).replace("` `", "`, `");
    let error = |d: &Define| {
        let help = match nearest(&d.name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`? The parameters are {list}"),
            None if known.is_empty() => "the scene has no parameters".to_owned(),
            None => format!("the parameters are {list}"),
        };
        Diagnostic::error("E0409", format!("the scene has no parameter `{}`", d.name.escape_debug()))
            .at(span(d.file, 0..d.name.len()), "unknown parameter")
            .help(help)
            .fault(Fault::Usage)
    };
    defines.iter().filter(stranger).map(error).collect()
}

/// The types that a parameter can have.
pub const TYPES: [&str; 8] = ["number", "int", "length", "angle", "color", "vector", "string", "bool"];

/// The value of a parameter.
pub fn value(machine: &mut Machine, param: &Param, defines: &[Define]) -> Eval<Val> {
    let default = machine.located(&param.default)?;
    let kind = match &param.kind {
        Some(word) => type_named(word)?,
        None => type_of(&default)?,
    };
    let name = param.name.text.as_str();
    let written = machine.written(default.at).to_owned();
    typed(&default, name, kind, &written)?;
    let allowed = param.allowed.as_ref().map(|a| machine.located(a)).transpose()?;
    if let Some((allowed, [lo, hi])) = allowed.as_ref().and_then(|a| Some((a, backwards(&a.value)?))) {
        let error = Diagnostic::error("E0503", format!("`{name}` allows nothing: its range runs backwards"));
        let help = format!("write the lower end first: `{hi}..{lo}`");
        return Err(error.at(allowed.at, "backwards").help(help).into());
    }
    if let Some(allowed) = &allowed {
        within(&default, name, allowed, &machine.budget)?;
    }
    let Some(define) = defines.iter().rev().find(|d| d.name == name) else {
        return Ok(default.value);
    };
    let given = given(machine, define, kind).and_then(|given| {
        typed(&given, name, kind, &define.value)?;
        if let Some(allowed) = &allowed {
            within(&given, name, allowed, &machine.budget)?;
        }
        Ok(given.value)
    });
    given.map_err(|stop| match stop {
        Stop::Told(error) => Stop::Told(Box::new(error.fault(Fault::Usage))),
        Stop::Quiet => Stop::Quiet,
    })
}

/// The ends of a range that runs backwards.
fn backwards(allowed: &Val) -> Option<[f64; 2]> {
    match allowed {
        Val::Range(lo, hi, _) if hi < lo => Some([*lo, *hi]),
        _ => None,
    }
}

/// The type of a name.
pub fn type_named(word: &Word) -> Eval<&'static str> {
    match TYPES.iter().find(|t| **t == word.text) {
        Some(known) => Ok(known),
        None => Err(unknown_type(&word.text).at(word.at, "unknown type").into()),
    }
}

/// Refuses a value that is not of a type, as it was written; `written` is how the value was.
pub fn typed_as(given: &Located, name: &str, kind: &Word, written: &str) -> Eval<()> {
    typed(given, name, type_named(kind)?, written)
}

fn unknown_type(word: &str) -> Diagnostic {
    let error = Diagnostic::error("E0401", format!("`{word}` is not a type"));
    match nearest(word, TYPES) {
        Some(known) => error.help(format!("did you mean `{known}`?")),
        None => error.help(format!("the types are {}", TYPES.map(|t| format!("`{t}`")).join(" "))),
    }
}

fn type_of(default: &Located) -> Eval<&'static str> {
    match &default.value {
        Val::Number(_) | Val::Measured(_) => Ok("number"),
        Val::Angle(_) => Ok("angle"),
        Val::Color(_) => Ok("color"),
        Val::Text(..) => Ok("string"),
        Val::Bool(_) => Ok("bool"),
        value if value.numbers().is_some() => Ok("vector"),
        value => Err(Diagnostic::error("E0501", format!("a parameter cannot be {}", value.kind()))
            .at(default.at, value.kind())
            .help("use `let` for what is not set from outside")
            .into()),
    }
}

/// What `-D` gives: a string as it stands, anything else as a literal.
fn given(machine: &mut Machine, define: &Define, kind: &str) -> Eval<Located> {
    let start = define.name.len() + 1;
    let range = start..start + define.value.len();
    let at = span(define.file, range.clone());
    if kind == "string" {
        return Ok(Located { value: Val::Text(define.value.as_str().into(), None), at });
    }
    let refuse = || {
        Diagnostic::error("E0509", format!("`{}` cannot be read as a value", define.value.escape_debug()))
            .at(at, format!("expected {}", article(kind)))
            .help(format!("write {}, such as `-D {}={}`", article(kind), define.name, example(kind)))
    };
    let text = &machine.sources.file(define.file).text;
    if define.value.contains('\0') || !split::is_shallow(&define.value) {
        return Err(refuse().into());
    }
    let expr = parse::expression(text, define.file, range).map_err(|_| refuse())?;
    if !literal(&expr) {
        return Err(refuse().into());
    }
    machine.located(&expr)
}

fn literal(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number(..) | ExprKind::Color(_) | ExprKind::Text(_) | ExprKind::Bool(_) => true,
        ExprKind::List(items) => items.iter().all(literal),
        ExprKind::Prefix(PrefixOp::Negate, _, inside) => matches!(inside.kind, ExprKind::Number(..)),
        _ => false,
    }
}

fn article(kind: &str) -> &'static str {
    match kind {
        "int" => "a whole number",
        "length" => "a length",
        "angle" => "an angle",
        "color" => "a colour",
        "vector" => "a vector",
        "bool" => "a truth value",
        _ => "a number",
    }
}

fn example(kind: &str) -> &'static str {
    match kind {
        "angle" => "30deg",
        "color" => "#b8683c",
        "vector" => "[1,2,3]",
        "bool" => "true",
        "int" => "3",
        _ => "2.5",
    }
}

/// Refuses a value that is not of the parameter's type.
fn typed(given: &Located, name: &str, kind: &str, written: &str) -> Eval<()> {
    let fits = match (kind, &given.value) {
        ("number", _) => return given.number(name).map(drop),
        ("length", _) => return given.as_number(name, "a length").map(drop),
        ("angle", _) => return given.angle(name, written).map(drop),
        ("int", Val::Number(x)) => x.fract() == 0.0 && given.number(name).is_ok(),
        ("color", Val::Color(_)) | ("string", Val::Text(..)) | ("bool", Val::Bool(_)) => true,
        ("vector", value) => value.numbers().is_some(),
        _ => false,
    };
    if fits {
        return Ok(());
    }
    let example = if kind == "string" { "\"text\"" } else { example(kind) };
    let wanted = if kind == "string" { "a string" } else { article(kind) };
    Err(given.unlike(name, wanted).help(format!("write {wanted}, such as `{example}`")).into())
}

/// Refuses a value that the parameter does not allow.
fn within(given: &Located, name: &str, allowed: &Located, budget: &Budget) -> Eval<()> {
    let outside = |what: String, help: String| {
        let error = Diagnostic::error("E0503", format!("`{name}` is outside of what it allows"));
        Err(error.at(given.at, what).at(allowed.at, "allowed").help(help).into())
    };
    match (&given.value, &allowed.value) {
        (Val::Number(x), Val::Range(lo, hi, false)) | (Val::Angle(x), Val::Range(lo, hi, true)) => {
            if (*lo..=*hi).contains(x) {
                return Ok(());
            }
            let unit = if matches!(given.value, Val::Angle(_)) { "deg" } else { "" };
            outside(format!("{x}{unit}"), format!("write a value from {lo}{unit} to {hi}{unit}"))
        }
        (value, Val::List(list)) => {
            budget.spend(list.items.len(), allowed.at)?;
            for choice in &list.items {
                if arithmetic::equal(value, &choice.value, budget, allowed.at)? == Some(true) {
                    return Ok(());
                }
            }
            let words: Option<Vec<&str>> = list
                .items
                .iter()
                .map(|i| if let Val::Text(t, _) = &i.value { Some(&**t) } else { None })
                .collect();
            let help = match (value, words) {
                (Val::Text(text, _), Some(words)) if budget.may_look(words.len()) => {
                    match nearest(text, words.iter().copied()) {
                        Some(near) => format!("did you mean \"{near}\"?"),
                        None => format!("write one of {}", quoted(&words)),
                    }
                }
                _ => "write one of the listed values".to_owned(),
            };
            outside("not in the list".to_owned(), help)
        }
        _ => Err(Diagnostic::error("E0501", format!("what `{name}` allows does not fit its value"))
            .at(allowed.at, allowed.value.kind())
            .at(given.at, given.value.kind())
            .help("write a range, such as `1..8`, or a list of values")
            .into()),
    }
}
