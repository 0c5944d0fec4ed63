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

/// A part of a bench by its name.
pub type Part = (&'static str, fn(&mut Vec<Row>));

/// Runs the parts whose names hold one of the words of the command line, all where there are none, and prints their rows.
pub fn run(parts: &[Part]) {
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let mut rows = Vec::new();
    for (name, run) in parts {
        if asked.is_empty() || asked.iter().any(|a| name.contains(a.as_str())) {
            eprintln!("{name}");
            run(&mut rows);
        }
    }
    print(&rows);
}

/// Prints rows as Markdown.
fn print(rows: &[Row]) {
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
