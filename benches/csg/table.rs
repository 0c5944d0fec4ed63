//! Figures as a table.

/// A figure.
#[derive(Debug)]
pub struct Row {
    what: String,
    value: f64,
    unit: &'static str,
    asked: &'static str,
}

impl Row {
    /// A measured value, its unit, and what is asked of it.
    pub fn new(what: impl Into<String>, value: f64, unit: &'static str, asked: &'static str) -> Row {
        Row { what: what.into(), value, unit, asked }
    }
}

/// Prints rows as Markdown.
pub fn print(rows: &[Row]) {
    println!("| what | measured | unit | asked |");
    println!("|---|---|---|---|");
    for Row { what, value, unit, asked } in rows {
        println!("| {what} | {} | {unit} | {asked} |", three_digits(*value));
    }
}

fn three_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.digits$}")
}
