//! The signs, units and attributes that scenes are built of, for `pss explain` and the reference page.

/// A sign, or some that belong together.
pub struct Sign {
    /// As they are looked for.
    pub names: &'static [&'static str],
    /// How it is written.
    pub usage: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Items that use it.
    pub example: &'static str,
}

const fn line(
    names: &'static [&'static str],
    usage: &'static str,
    doc: &'static str,
    example: &'static str,
) -> Sign {
    Sign { names, usage, doc, example }
}

/// All of them.
pub const SIGNS: &[Sign] = &[
    line(
        &["|", "&", "-", "^", "!"],
        "a | b, a & b, a - b, a ^ b, !a",
        "Union, intersection, difference, symmetric difference and complement of solids. Two of the first four stand together only with parentheses.",
        "draw (sphere(r: 1) | box(size: 1)) - sphere(r: 0.5)",
    ),
    line(
        &["+", "*", "/", "%", "**"],
        "a + b, a - b, a * b, a / b, a % b, a ** b",
        "Sums, products, remainders and powers of numbers; of vectors part by part, a number with each part.",
        "let v = 2 * [1, 2, 3] + [0, 0, 1]",
    ),
    line(
        &["==", "!=", "<", "<=", ">", ">="],
        "a == b, a < b",
        "Comparisons. Between solids `==` asks whether nothing is inside one of them alone.",
        "let a = 1 < 2",
    ),
    line(
        &["~="],
        "expect a ~= b within 1%",
        "What an expectation compares nearly: numbers, angles, colours and lists of them, by their largest component. Without `within` 1e-7 % of the right side is allowed.",
        "expect 10 ~= 10.05 within 1%",
    ),
    line(
        &[".."],
        "0..5",
        "A range: its end is left out. There are no steps: multiply in the loop.",
        "let a = for i in 0..5 { 10 * i }",
    ),
    line(
        &["um", "mm", "cm", "m", "km", "in", "ft", "deg", "rad", "turn"],
        "12mm, 45deg",
        "Units touch their number. Lengths without one are in that of `units(...)`; angles have to have one.",
        "draw box(size: 12mm).rotate_z(45deg)",
    ),
    line(
        &["@ghost", "@only", "@skip"],
        "@only draw shape",
        "Attributes of a `draw`: it is seen through, or only this is seen, or this is left out. What is seen through casts no shadow, and neither `probe`, a fitted view nor layers know of it; pictures of normals and depth do not show it.",
        "@only draw sphere(r: 1)\ndraw box(size: 9)",
    ),
    line(
        &["//", "/*"],
        "// to the end of the line, /* to here */",
        "Comments.",
        "// a ball\ndraw sphere(r: 1)",
    ),
];

#[cfg(test)]
mod tests {
    use super::super::units;
    use super::*;
    use crate::source::SourceMap;

    #[test]
    fn every_unit_stands_in_the_table() {
        let known = |name: &str| SIGNS.iter().any(|sign| sign.names.contains(&name));
        for unit in units::names() {
            assert!(known(unit), "{unit}");
        }
    }

    #[test]
    fn examples_are_scenes_without_complaint() {
        for sign in SIGNS.iter().filter(|sign| !sign.example.is_empty()) {
            let mut sources = SourceMap::default();
            let file = sources.add("example.pss", None, sign.example);
            let catalog = crate::prepare::catalog();
            let geometry = crate::measure::Measuring::new(&Default::default());
            let reading = super::super::Reading {
                catalog: &catalog,
                defines: &[],
                files: None,
                geometry: Some(&geometry),
                expects: true,
                memory: super::super::MEMORY,
            };
            let read = super::super::read_with(&mut sources, file, &reading);
            let told = read.map(|read| (read.warnings, read.unmet));
            assert!(
                matches!(&told, Ok((w, u)) if w.is_empty() && u.is_empty()),
                "{}\n{told:?}",
                sign.example
            );
        }
    }
}
