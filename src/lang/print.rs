//! Values as text, as they would be written in a scene where that is possible.

use std::fmt::Write;

use super::args::signature;
use super::value::Val;

/// Elements of a list that are written out.
const SHOWN: usize = 1000;
/// Bytes after which a text ends: few lists of lists of lists would fill any memory.
const LONGEST: usize = 1 << 20;

/// What `print` says: strings as they stand.
pub fn text(value: &Val) -> String {
    let mut out = String::new();
    match value {
        Val::Text(text, _) => out.push_str(text),
        value => write(value, &mut out),
    }
    if is_full(&out) && !matches!(value, Val::Text(..)) {
        out.push_str(" ...");
    }
    out
}

fn is_full(out: &str) -> bool {
    LONGEST < out.len()
}

fn write(value: &Val, out: &mut String) {
    // Writing to a string does not fail.
    let _ = match value {
        // The two zeros are one number.
        Val::Number(x) => write!(out, "{}", x + 0.0),
        Val::Measured(estimate) => write!(out, "{}", estimate.digits()),
        Val::Angle(x) => write!(out, "{}deg", x + 0.0),
        Val::Color([r, g, b]) => write!(out, "rgb({r}, {g}, {b})"),
        Val::Text(text, _) => write!(out, "{text:?}"),
        Val::Bool(b) => write!(out, "{b}"),
        Val::List(list) => {
            between("[", list.items.iter().take(SHOWN), out, |item, out| write(&item.value, out));
            match list.items.len().saturating_sub(SHOWN) {
                0 => write!(out, "]"),
                more => write!(out, ", ... {more} more]"),
            }
        }
        Val::Range(lo, hi, false) => write!(out, "{lo}..{hi}"),
        Val::Range(lo, hi, true) => write!(out, "{lo}deg..{hi}deg"),
        Val::Function(closure) => {
            out.push_str(closure.word());
            between("(", closure.function.params.iter(), out, |param, out| out.push_str(&param.name.text));
            write!(out, ")")
        }
        Val::Builtin(builtin) => write!(out, "{}", signature(builtin.name, builtin.formals)),
        Val::Record(record) => {
            between("{", record.fields.iter(), out, |(name, value), out| {
                out.push_str(name);
                out.push_str(": ");
                write(value, out);
            });
            write!(out, "}}")
        }
        Val::Shape(_) | Val::Material(_) => write!(out, "{}", value.kind()),
    };
}

/// Parts with commas between them, as long as there is room.
fn between<T>(open: &str, parts: impl Iterator<Item = T>, out: &mut String, write: impl Fn(T, &mut String)) {
    out.push_str(open);
    for (i, part) in parts.enumerate() {
        if is_full(out) {
            return;
        }
        out.push_str(if i == 0 { "" } else { ", " });
        write(part, out);
    }
}
