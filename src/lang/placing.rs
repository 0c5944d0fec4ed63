//! The affine maps that methods name: turns, mirrors, and rows of numbers.

use glam::{DAffine3, DMat3, DVec3};

use super::check;
use super::units::sin_cos;
use super::value::{Eval, Located, Val};
use crate::diag::Diagnostic;
use crate::geom::Placement;

/// The right-handed rotation around a unit vector (Rodrigues), exact for quarter turns around the axes.
pub fn rotation(axis: DVec3, degrees: f64) -> DMat3 {
    let (s, c) = sin_cos(degrees);
    let skew = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    let along = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    let across = DMat3::IDENTITY + along * -1.0;
    positive_zeros(along + across * c + skew * s)
}

/// The mirror at the plane through the origin across a unit vector, I - 2 n n^T (Householder), exact for the axes.
pub fn reflection(n: DVec3) -> DMat3 {
    let twice = DMat3::from_cols(n * n.x, n * n.y, n * n.z) * 2.0;
    positive_zeros(DMat3::IDENTITY - twice)
}

/// A sum with zero turns -0 into 0.
fn positive_zeros(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis + DVec3::ZERO, m.y_axis + DVec3::ZERO, m.z_axis + DVec3::ZERO)
}

/// A map that leaves a point where it is.
pub fn about(linear: DMat3, point: DVec3) -> DAffine3 {
    DAffine3::from_mat3_translation(linear, point - linear * point)
}

/// The unit vector of an argument that names an axis, by a vector.
pub fn direction(axis: &Located) -> Eval<DVec3> {
    let direction = axis.vec3("axis")?;
    let largest = direction.abs().max_element();
    if largest == 0.0 {
        return Err(Diagnostic::error("E0510", "the axis has no direction")
            .at(axis.at, "zero")
            .help("write a direction, such as `[0, 0, 1]`")
            .into());
    }
    Ok((direction / largest).normalize())
}

/// The same, where one of the words "x" "y" "z" will do too.
pub fn named_direction(axis: &Located) -> Eval<DVec3> {
    if !matches!(axis.value, Val::Text(..)) {
        return direction(axis);
    }
    Ok(match check::choice(axis, "axis", &["x", "y", "z"])?.as_str() {
        "x" => DVec3::X,
        "y" => DVec3::Y,
        _ => DVec3::Z,
    })
}

/// Whether a value is written as rows: a list of lists.
pub fn is_matrix(given: &Located) -> bool {
    matches!(&given.value, Val::List(rows) if rows.items.iter().any(|r| matches!(r.value, Val::List(_))))
}

/// The map of three rows of four numbers; points are columns, so the last of each row is the translation.
pub fn matrix(given: &Located) -> Eval<DAffine3> {
    let shape = "write 3 rows of 4 numbers: `[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]`";
    let Val::List(rows) = &given.value else {
        return Err(given.unlike("rows", "3 rows of 4 numbers").help(shape).into());
    };
    if rows.items.len() != 3 {
        let found = rows.items.len();
        let error = Diagnostic::error("E0501", format!("`rows` wants 3 rows of 4 numbers, found {found}"));
        return Err(error.at(given.at, format!("{found} given")).help(shape).into());
    }
    let mut columns = [DVec3::ZERO; 4];
    for (axis, row) in rows.items.iter().enumerate() {
        for (column, x) in columns.iter_mut().zip(row.vector("rows", 4)?) {
            column[axis] = x;
        }
    }
    let [x, y, z, translation] = columns;
    let map = DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), translation);
    if Placement::new(map).is_none() {
        return Err(Diagnostic::error("E0505", "the matrix has no inverse")
            .at(given.at, "flattens the shape to nothing")
            .help("no row may be zero or a sum of multiples of the others")
            .into());
    }
    Ok(map)
}
