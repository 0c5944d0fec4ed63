//! Bare numbers where an angle is wanted: what may be written instead, and whether there is one way.

/// Whole numbers up to this one may be radians: it is about a turn.
const DOUBTFUL: f64 = 6.0;

/// The ways out of a bare number.
pub struct Meant {
    /// In words.
    pub help: String,
    /// The one way, where nobody could mean another.
    pub edit: Option<String>,
}

/// What a bare number may mean, as it was written. Formulas of x, y and z count in radians, as they do everywhere.
pub fn meant(written: &str, in_formula: bool) -> Meant {
    let written = written.trim_end();
    let numeral = written.trim_start_matches('-').chars().all(|c| c.is_ascii_digit() || c == '.');
    if let (true, Ok(x)) = (numeral, written.parse::<f64>()) {
        let fixed = format!("{written}deg");
        return match x.fract() == 0.0 && (x == 0.0 || DOUBTFUL < x.abs()) {
            true => one(fixed),
            false => Meant { help: format!("write `{fixed}` or `{written}rad`"), edit: None },
        };
    }
    let plain = written.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let product =
        |unit: &str| if plain { format!("{written} * 1{unit}") } else { format!("({written}) * 1{unit}") };
    let words = || written.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let whole = |word: &str| word.parse::<f64>().is_ok_and(|x| DOUBTFUL < x);
    let of_pi = words().any(|word| matches!(word, "pi" | "tau"));
    // `x * 180 / pi` is in degrees, `x * pi / 180` is not.
    if (of_pi || in_formula)
        && !words().any(whole)
        && !written.contains(['\n', '"'])
        && !written.contains("/*")
    {
        return one(product("rad"));
    }
    Meant {
        help: format!("write `{}`, or `{}` if it is in radians", product("deg"), product("rad")),
        edit: None,
    }
}

fn one(fixed: String) -> Meant {
    Meant { help: format!("write `{fixed}`"), edit: Some(fixed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_is_made_where_the_unit_is_beyond_doubt() {
        let edit = |written: &str| meant(written, false).edit;
        assert_eq!(edit("45").as_deref(), Some("45deg"));
        assert_eq!(edit("-90").as_deref(), Some("-90deg"));
        assert_eq!(edit("pi / 2").as_deref(), Some("(pi / 2) * 1rad"));
        assert_eq!(edit("pi").as_deref(), Some("pi * 1rad"));
        for unsure in ["1.57", "3", "a", "2 * a", "a * 180 / pi", "i * 30"] {
            assert_eq!(edit(unsure), None, "{unsure}");
        }
        assert_eq!(meant("x", true).edit.as_deref(), Some("x * 1rad"));
        assert_eq!(meant("360 * x", true).edit, None);
    }
}
