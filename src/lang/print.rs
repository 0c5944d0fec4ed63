//! Values as text, as they would be written in a scene where that is possible.

use super::value::{Located, Val};

/// Elements of a list that are written out.
const SHOWN: usize = 1000;

/// What `print` says: strings as they stand.
pub fn text(value: &Val) -> String {
    match value {
        Val::Text(text, _) => text.to_string(),
        value => written(value),
    }
}

fn written(value: &Val) -> String {
    match value {
        // The two zeros are one number.
        Val::Number(x) => format!("{}", x + 0.0),
        Val::Angle(x) => format!("{}deg", x + 0.0),
        Val::Color([r, g, b]) => format!("rgb({r}, {g}, {b})"),
        Val::Text(text, _) => format!("{text:?}"),
        Val::Bool(b) => format!("{b}"),
        Val::List(list) => {
            let more = list.items.len().saturating_sub(SHOWN);
            let mut items: Vec<String> = list.items.iter().take(SHOWN).map(element).collect();
            if 0 < more {
                items.push(format!("... {more} more"));
            }
            format!("[{}]", items.join(", "))
        }
        Val::Range(lo, hi, false) => format!("{lo}..{hi}"),
        Val::Range(lo, hi, true) => format!("{lo}deg..{hi}deg"),
        Val::Function(closure) => {
            let params: Vec<&str> = closure.function.params.iter().map(|p| p.name.text.as_str()).collect();
            format!("{}({})", closure.word(), params.join(", "))
        }
        Val::Record(record) => {
            let fields: Vec<String> =
                record.fields.iter().map(|(name, value)| format!("{name}: {}", written(value))).collect();
            format!("{{{}}}", fields.join(", "))
        }
        Val::Shape(_) | Val::Material(_) => value.kind().to_owned(),
    }
}

fn element(item: &Located) -> String {
    written(&item.value)
}
