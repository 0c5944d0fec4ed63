//! The corners and polygons of a PLY: rows of `vertex` and `face`, every other element passed over.

use std::io::BufRead;

use glam::DVec3;

use super::header::{self, Element, Encoding, Property, shown};
use super::input::{Input, Short};
use super::vertices::number;
use crate::cloud::CloudError;

/// Corners and polygons as they stand in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faces {
    /// Positions; some may not be finite.
    pub points: Vec<DVec3>,
    /// Indices of corners, the polygons one after the other; each is less than the number of points.
    pub corners: Vec<u32>,
    /// How many corners each polygon has.
    pub sizes: Vec<u32>,
}

/// Reads a PLY file of `length` bytes from a stream. Counts are compared with the length before room is made.
pub fn read(stream: impl BufRead, length: u64) -> Result<Faces, CloudError> {
    let mut input = Input::new(stream, length);
    let header = header::read(&mut input)?;
    let mut faces = Faces::default();
    for element in &header.elements {
        let least = u128::from(element.least_row(header.encoding));
        // The last row of an ASCII file needs no end of line.
        let left = u128::from(input.left()) + u128::from(header.encoding == Encoding::Ascii);
        if left < u128::from(element.count) * least {
            return Err(truncated(&input, element, 0));
        }
        match element.name.as_str() {
            "vertex" => vertices(&mut input, header.encoding, element, &mut faces)?,
            "face" => polygons(&mut input, header.encoding, element, &mut faces)?,
            _ if element.properties.is_empty() => {}
            _ => rows(&mut input, header.encoding, element, |_, _| Ok(()))?,
        }
    }
    let count = faces.points.len();
    if let Some(bad) = faces.corners.iter().find(|i| count <= **i as usize) {
        let message = format!("a face names vertex {bad}, but there are {count}");
        return Err(CloudError::bad(message).help("export the mesh again"));
    }
    Ok(faces)
}

fn truncated<R: BufRead>(input: &Input<R>, element: &Element, row: u64) -> CloudError {
    let (count, name) = (element.count, shown(&element.name));
    input.truncated(format!("truncated: expected {count} rows of `{name}`, got {row}"), false)
}

fn vertices<R: BufRead>(
    input: &mut Input<R>,
    encoding: Encoding,
    element: &Element,
    faces: &mut Faces,
) -> Result<(), CloudError> {
    let column = |name: &str| {
        let found = element.properties.iter().position(|p| p.name == name && p.list.is_none());
        found.ok_or_else(|| CloudError::bad(format!("`vertex` has no number `{name}`")).at_line(element.line))
    };
    let axes = [column("x")?, column("y")?, column("z")?];
    let mut p = DVec3::ZERO;
    let last = element.properties.len() - 1;
    rows(input, encoding, element, |at, values| {
        for axis in (0..3).filter(|i| axes[*i] == at) {
            p[axis] = values[0];
        }
        if at == last {
            // Adding zero turns -0 into 0, so that equal positions have equal bits.
            faces.points.push(p + DVec3::ZERO);
        }
        Ok(())
    })
}

fn polygons<R: BufRead>(
    input: &mut Input<R>,
    encoding: Encoding,
    element: &Element,
    faces: &mut Faces,
) -> Result<(), CloudError> {
    let named = |p: &Property| matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
    let Some(list) = element.properties.iter().position(|p| named(p) && p.list.is_some()) else {
        let error = CloudError::bad("`face` has no list `vertex_indices`").at_line(element.line);
        return Err(error.help("a mesh needs the corners of its faces"));
    };
    rows(input, encoding, element, |at, values| {
        if at != list {
            return Ok(());
        }
        for x in values {
            let whole = x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(x);
            if !whole {
                return Err(CloudError::bad(format!("`{x}` is no number of a vertex")));
            }
            faces.corners.push(*x as u32);
        }
        faces.sizes.push(values.len() as u32);
        Ok(())
    })
}

/// Reads all rows of an element and shows the values of each property with its place: one value, or a list.
fn rows<R: BufRead>(
    input: &mut Input<R>,
    encoding: Encoding,
    element: &Element,
    mut show: impl FnMut(usize, &[f64]) -> Result<(), CloudError>,
) -> Result<(), CloudError> {
    let mut values = Vec::new();
    for row in 0..element.count {
        if encoding == Encoding::Ascii {
            let Some(text) = input.row()?.map(str::to_owned) else {
                return Err(truncated(input, element, row));
            };
            let line = input.line;
            let mut words = text.split_ascii_whitespace();
            for (at, property) in element.properties.iter().enumerate() {
                words_of(&mut words, property, &mut values).map_err(|e| e.at_line(line))?;
                show(at, &values).map_err(|e| e.at_line(line))?;
            }
            if words.next().is_some() {
                return Err(CloudError::bad("this row has more values than its properties").at_line(line));
            }
            continue;
        }
        for (at, property) in element.properties.iter().enumerate() {
            match bytes_of(input, encoding, property, &mut values) {
                Ok(()) => show(at, &values)?,
                Err(Short::End) => return Err(truncated(input, element, row)),
                Err(Short::Error(error)) => return Err(error),
            }
        }
    }
    Ok(())
}

fn words_of<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    property: &Property,
    values: &mut Vec<f64>,
) -> Result<(), CloudError> {
    values.clear();
    let mut next =
        || words.next().ok_or_else(|| CloudError::bad("this row has fewer values than its properties"));
    let mut count = 1;
    if property.list.is_some() {
        let word = next()?;
        count = word.parse::<u64>().map_err(|_| {
            CloudError::bad(format!("`{}` is no count of the list `{}`", shown(word), shown(&property.name)))
        })?;
    }
    for _ in 0..count {
        values.push(number(next()?, &property.name)?);
    }
    Ok(())
}

fn bytes_of<R: BufRead>(
    input: &mut Input<R>,
    encoding: Encoding,
    property: &Property,
    values: &mut Vec<f64>,
) -> Result<(), Short> {
    values.clear();
    let mut count = 1;
    if let Some(counter) = property.list {
        let n = input.scalar(counter, encoding)?;
        if n < 0.0 {
            let message = format!("a list of `{}` has the count {n}", shown(&property.name));
            return Err(Short::Error(CloudError::bad(message).help("wrong byte order?")));
        }
        // A count has at most 32 bits; values are read one by one, so a wrong one ends with the file.
        count = n as u64;
        if input.left() < count * property.scalar.size() as u64 {
            return Err(Short::End);
        }
    }
    for _ in 0..count {
        values.push(input.scalar(property.scalar, encoding)?);
    }
    Ok(())
}
