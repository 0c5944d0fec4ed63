//! Units of lengths and angles. A length is read as a number of scene units; which unit that is, `units(...)`
//! says.

use super::ast::{AngleUnit, Unit};

/// Lengths by their names, in micrometres: products and quotients of these are exact.
pub const LENGTHS: [(&str, f64); 7] =
    [("um", 1.0), ("mm", 1e3), ("cm", 1e4), ("m", 1e6), ("km", 1e9), ("in", 25_400.0), ("ft", 304_800.0)];

const ANGLES: [(&str, AngleUnit); 3] =
    [("deg", AngleUnit::Degree), ("rad", AngleUnit::Radian), ("turn", AngleUnit::Turn)];

/// The unit with a name.
pub fn find(name: &str) -> Option<Unit> {
    let length = LENGTHS.iter().find(|(n, _)| *n == name).map(|(_, um)| Unit::Length(*um));
    length.or_else(|| ANGLES.iter().find(|(n, _)| *n == name).map(|(_, a)| Unit::Angle(*a)))
}

/// What units are called where they are not abbreviated.
const SPOKEN: [(&str, &[&str]); 10] = [
    ("um", &["micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres"]),
    ("mm", &["millimeter", "millimeters", "millimetre", "millimetres"]),
    ("cm", &["centimeter", "centimeters", "centimetre", "centimetres"]),
    ("m", &["meter", "meters", "metre", "metres"]),
    ("km", &["kilometer", "kilometers", "kilometre", "kilometres"]),
    ("in", &["inch", "inches"]),
    ("ft", &["foot", "feet"]),
    ("deg", &["degree", "degrees"]),
    ("rad", &["radian", "radians"]),
    ("turn", &["turns", "rev", "revolution", "revolutions"]),
];

/// The unit that is called so in other places.
pub fn spoken(name: &str) -> Option<&'static str> {
    SPOKEN.iter().find(|(_, long)| long.contains(&name)).map(|(unit, _)| *unit)
}

/// The names of all units.
pub fn names() -> impl Iterator<Item = &'static str> {
    LENGTHS.iter().map(|(n, _)| *n).chain(ANGLES.iter().map(|(n, _)| *n))
}

/// A length of `value` times `unit` micrometres as a number of scene units of `scene` micrometres each.
pub fn length(value: f64, unit: f64, scene: f64) -> f64 {
    if unit == scene { value } else { value * unit / scene }
}

/// An angle in degrees: whole, half and quarter turns are exact in them, as they are in no other unit.
pub fn degrees(value: f64, unit: AngleUnit) -> f64 {
    match unit {
        AngleUnit::Degree => value,
        AngleUnit::Radian => value.to_degrees(),
        AngleUnit::Turn => value * 360.0,
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of a quarter turn.
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    let turned = degrees % 360.0;
    let quarters = (turned / 90.0).round();
    let (s, c) = (turned - 90.0 * quarters).to_radians().sin_cos();
    match (quarters as i64).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos(90.0), (1.0, 0.0));
        assert_eq!(sin_cos(180.0), (0.0, -1.0));
        assert_eq!(sin_cos(-90.0), (-1.0, 0.0));
        assert_eq!(sin_cos(810.0), (1.0, 0.0));
        assert_eq!(sin_cos(degrees(0.25, AngleUnit::Turn)), (1.0, 0.0));
    }

    #[test]
    fn lengths_convert_exactly_where_they_can() {
        assert_eq!(length(1.0, 1e4, 1e3), 10.0);
        assert_eq!(length(3.0, 1e3, 1e6), 0.003);
        assert_eq!(length(5.0, 25_400.0, 1e3), 127.0);
    }
}
