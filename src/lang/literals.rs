//! Numbers, colours and strings as they are written.

use super::ast::ExprKind;
use super::value::MAX_NUMBER;
use super::{keywords, scan, units};
use crate::diag::{Diagnostic, nearest};
use crate::num::srgb;
use crate::source::Span;

/// A number with the unit that touches it.
pub fn number(text: &str, at: Span) -> Result<ExprKind, Box<Diagnostic>> {
    let (digits, name) = text.split_at(scan::digits_len(text));
    let value: f64 = digits.parse().unwrap_or(f64::INFINITY);
    if !value.is_finite() {
        return Err(Diagnostic::error("E0504", format!("`{digits}` is not finite"))
            .at(at, "too large for a number")
            .help(format!("numbers reach from -{MAX_NUMBER:e} to {MAX_NUMBER:e}"))
            .into());
    }
    if value > MAX_NUMBER {
        return Err(super::value::too_large(at).into());
    }
    if name.is_empty() {
        return Ok(ExprKind::Number(value, None));
    }
    if let Some(unit) = units::find(name) {
        return Ok(ExprKind::Number(value, Some(unit)));
    }
    let listed = units::names().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(" ");
    let spoken = units::spoken(name);
    let help = match spoken.or_else(|| nearest(name, units::names())) {
        _ if name == "pi" || name == "tau" || keywords::is_keyword(name) => spaced(digits, name),
        Some(known) if spoken.is_some() => format!("write `{digits}{known}`"),
        Some(known) => format!("did you mean `{digits}{known}`?"),
        None if name.starts_with('_') => "digits stand together: `1000`".to_owned(),
        None => format!("the units are {listed}; for a product write `{digits} * {name}`"),
    };
    // `1 / 2pi` is not `1 / 2 * pi`: of a product there is no edit.
    let edit = spoken.map(|unit| format!("{digits}{unit}"));
    Err(Diagnostic::error("E0105", format!("`{name}` is not a unit"))
        .fix_with(at, edit.as_deref())
        .at(Span { start: at.start + digits.len() as u32, ..at }, "not a unit")
        .help(help)
        .into())
}

/// The warning that a number, which reads as zero, was written as something else.
pub fn lost(text: &str, at: Span) -> Option<Diagnostic> {
    let digits = text[..scan::digits_len(text)].split(['e', 'E']).next().unwrap_or_default();
    let told = || {
        Diagnostic::warning("W0202", format!("`{text}` is too small for a number: it is 0"))
            .at(at, "lost")
            .help("choose smaller units, such as `units(um)`")
    };
    digits.contains(|c: char| c.is_ascii_digit() && c != '0').then(told)
}

fn spaced(digits: &str, name: &str) -> String {
    match name {
        "pi" | "tau" => format!("write `{digits} * {name}`"),
        _ => format!("put a space before the keyword: `{digits} {name}`"),
    }
}

/// A colour, decoded from sRGB to linear.
pub fn color(text: &str, at: Span) -> Result<[f32; 3], Box<Diagnostic>> {
    let digits: Option<Vec<u32>> = text[1..].chars().map(|c| c.to_digit(16)).collect();
    let channels = match digits.as_deref() {
        Some([r, g, b]) => [r * 17, g * 17, b * 17],
        Some([r1, r0, g1, g0, b1, b0]) => [r1 * 16 + r0, g1 * 16 + g0, b1 * 16 + b0],
        _ => {
            return Err(Diagnostic::error("E0105", format!("`{text}` is not a colour"))
                .at(at, "expected 3 or 6 hexadecimal digits")
                .help(match digits {
                    Some(_) => "write `#rgb` or `#rrggbb`, such as `#b8683c`",
                    None => "write `#rgb` or `#rrggbb`, such as `#b8683c`; to see through a shape, `@ghost draw shape`",
                })
                .into());
        }
    };
    Ok(channels.map(|c| srgb::decode(f64::from(c) / 255.0) as f32))
}

/// A string, its quotes removed and its escapes resolved.
pub fn text(quoted: &str, at: Span) -> Result<String, Box<Diagnostic>> {
    let inside = quoted.get(1..quoted.len().saturating_sub(1)).unwrap_or("");
    let mut out = String::with_capacity(inside.len());
    let mut chars = inside.char_indices();
    while let Some((_, c)) = chars.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match chars.next() {
            Some((_, '"')) => out.push('"'),
            Some((_, '\\')) => out.push('\\'),
            Some((_, 'n')) => out.push('\n'),
            Some((_, 't')) => out.push('\t'),
            Some((i, other)) => {
                let start = at.start + i as u32;
                let place = Span { start, end: start + 1 + other.len_utf8() as u32, ..at };
                return Err(Diagnostic::error("E0104", format!("`\\{}` is no escape", other.escape_debug()))
                    .at(place, "unknown escape")
                    .help("the escapes are `\\\"` `\\\\` `\\n` `\\t`; a backslash is written `\\\\`")
                    .into());
            }
            None => {}
        }
    }
    Ok(out)
}
