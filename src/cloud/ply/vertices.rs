//! The body of a PLY: the rows of `vertex` become points; whatever stands before them is passed over.

use std::io::BufRead;

use super::Cut;
use super::columns::{Columns, Role};
use super::header::{Element, Encoding, Header, Property, shown};
use super::input::{Input, Short};
use crate::cloud::{Cloud, CloudError, CloudFault};

/// More points are refused: their positions alone would need 6 GiB, and indices are 32 bits wide.
const POINT_LIMIT: u64 = 1 << 28;

/// Reads the points of a file whose header has been read.
pub fn read<R: BufRead>(input: &mut Input<R>, header: &Header, cut: Cut) -> Result<Cloud, CloudError> {
    let at = header.elements.iter().position(|e| e.name == "vertex").ok_or_else(|| {
        CloudError::bad("no points: the file has no element `vertex`")
            .help("points are read from `element vertex`")
    })?;
    let vertex = &header.elements[at];
    let mut columns = Columns::new(vertex)?;
    if vertex.count == 0 {
        return Err(CloudError::bad("no points: the count of `vertex` is 0").at_line(vertex.line));
    }
    if POINT_LIMIT < vertex.count {
        let message = format!("{} points are more than the limit of {POINT_LIMIT}", vertex.count);
        return Err(CloudError::bad(message).at_line(vertex.line).help("thin the cloud"));
    }
    let most = fits(input, header, at, cut)?;
    for element in &header.elements[..at] {
        skip(input, header.encoding, element)?;
    }
    columns.reserve(vertex.count.min(most) as usize);
    let stop = match header.encoding {
        Encoding::Ascii => ascii_rows(input, vertex, &mut columns)?,
        encoding => binary_rows(input, vertex, encoding, &mut columns)?,
    };
    let note = stop.map(|stop| stop.allowed(cut)).transpose()?;
    let mut cloud = columns.finish(header.encoding)?;
    match note {
        Some(note) => cloud.notes.push(note),
        None if at + 1 == header.elements.len() => note_rest(input, header.encoding, &mut cloud)?,
        None => {}
    }
    Ok(cloud)
}

/// Compares the counts with the length of the file, before anything is walked through; how many points the file
/// can hold at most.
fn fits<R: BufRead>(input: &Input<R>, header: &Header, vertex: usize, cut: Cut) -> Result<u64, CloudError> {
    // The last row of an ASCII file needs no end of line.
    let mut left = u128::from(input.left()) + u128::from(header.encoding == Encoding::Ascii);
    for element in &header.elements[..vertex] {
        let needed = u128::from(element.count) * u128::from(element.least_row(header.encoding));
        left = left.checked_sub(needed).ok_or_else(|| {
            let (count, name, bytes) = (element.count, shown(&element.name), input.left());
            let message = format!(
                "truncated: expected {count} rows of `{name}`, but only {bytes} bytes follow the header"
            );
            CloudError::bad(message)
                .at_line(element.line)
                .help("the file is cut short, or its count is wrong")
        })?;
    }
    let element = &header.elements[vertex];
    let most = left as u64 / element.least_row(header.encoding);
    let rows_are_equal =
        header.encoding != Encoding::Ascii && element.properties.iter().all(|p| p.list.is_none());
    if most < element.count && rows_are_equal && vertex == 0 && (cut == Cut::Refused || most == 0) {
        return Err(input.truncated(expected(element, most), false));
    }
    Ok(most)
}

fn skip<R: BufRead>(input: &mut Input<R>, encoding: Encoding, element: &Element) -> Result<(), CloudError> {
    if element.properties.is_empty() {
        return Ok(());
    }
    let short = |input: &Input<R>, row: u64, short: Short| match short {
        Short::End => {
            let message = format!(
                "truncated: expected {} rows of `{}`, got {row}",
                element.count,
                shown(&element.name)
            );
            input.truncated(message, false)
        }
        Short::Error(error) => error,
    };
    if encoding == Encoding::Ascii {
        for row in 0..element.count {
            if input.row()?.is_none() {
                return Err(short(input, row, Short::End));
            }
        }
    } else if element.properties.iter().all(|p| p.list.is_none()) {
        // Fits: the product was compared with the length of the file.
        let bytes = element.count * element.least_row(encoding);
        input.skip(bytes).map_err(|e| short(input, 0, e))?;
    } else {
        for row in 0..element.count {
            for property in &element.properties {
                skip_property(input, encoding, property).map_err(|e| short(input, row, e))?;
            }
        }
    }
    Ok(())
}

fn skip_property<R: BufRead>(
    input: &mut Input<R>,
    encoding: Encoding,
    property: &Property,
) -> Result<(), Short> {
    let size = property.scalar.size() as u64;
    let Some(counter) = property.list else {
        return input.skip(size);
    };
    let count = input.scalar(counter, encoding)?;
    if count < 0.0 {
        let message = format!("a list of `{}` has the count {count}", shown(&property.name));
        return Err(Short::Error(CloudError::bad(message).help("wrong byte order?")));
    }
    // A count has at most 32 bits.
    input.skip(count as u64 * size)
}

/// Why rows end before their count, with the whole rows that there are.
struct Stop {
    error: CloudError,
    rows: u64,
}

impl Stop {
    /// A note instead of the error, where that is asked for and some rows are there. A file that changes while it is
    /// read is never whole.
    fn allowed(self, cut: Cut) -> Result<String, CloudError> {
        if cut == Cut::Refused || self.rows == 0 || self.error.kind == CloudFault::Io {
            return Err(self.error);
        }
        Ok(format!("{}: these were kept", self.error.message))
    }
}

fn binary_rows<R: BufRead>(
    input: &mut Input<R>,
    vertex: &Element,
    encoding: Encoding,
    columns: &mut Columns,
) -> Result<Option<Stop>, CloudError> {
    for row in 0..vertex.count {
        match binary_row(input, vertex, encoding, columns) {
            Ok(()) => columns.push(row),
            Err(Short::End) => {
                return Ok(Some(Stop { error: input.truncated(expected(vertex, row), false), rows: row }));
            }
            Err(Short::Error(error)) => return Err(error),
        }
    }
    Ok(None)
}

fn binary_row<R: BufRead>(
    input: &mut Input<R>,
    vertex: &Element,
    encoding: Encoding,
    columns: &mut Columns,
) -> Result<(), Short> {
    for (at, property) in vertex.properties.iter().enumerate() {
        match columns.role(at) {
            Role::Ignored => skip_property(input, encoding, property)?,
            Role::Slot(slot) => columns.set(slot, input.scalar(property.scalar, encoding)?),
        }
    }
    Ok(())
}

fn ascii_rows<R: BufRead>(
    input: &mut Input<R>,
    vertex: &Element,
    columns: &mut Columns,
) -> Result<Option<Stop>, CloudError> {
    for row in 0..vertex.count {
        let parsed = input.row()?.map(|text| ascii_row(text, vertex, columns));
        // Without its line's end the last number may be half of one: such a row is whole only at the end of all.
        let cut = !input.line_ended && (row + 1 < vertex.count || 0 < input.left());
        let Some(parsed) = parsed.filter(|_| !cut) else {
            return Ok(Some(Stop { error: input.truncated(expected(vertex, row), true), rows: row }));
        };
        parsed.map_err(|e| e.at_line(input.line))?;
        columns.push(row);
    }
    Ok(None)
}

fn expected(vertex: &Element, got: u64) -> String {
    format!("truncated: expected {} points, got {got}", vertex.count)
}

fn ascii_row(text: &str, vertex: &Element, columns: &mut Columns) -> Result<(), CloudError> {
    let mut words = text.split_ascii_whitespace();
    let short = || {
        CloudError::bad(format!("this row has fewer values than its {} properties", vertex.properties.len()))
            .help("each point needs a line of its own")
    };
    for (at, property) in vertex.properties.iter().enumerate() {
        let word = words.next().ok_or_else(short)?;
        if let Role::Slot(slot) = columns.role(at) {
            columns.set(slot, number(word, &property.name)?);
        } else if property.list.is_some() {
            let count: u64 = word.parse().map_err(|_| {
                CloudError::bad(format!(
                    "`{}` is no count of the list `{}`",
                    shown(word),
                    shown(&property.name)
                ))
            })?;
            for _ in 0..count {
                words.next().ok_or_else(short)?;
            }
        }
    }
    if words.next().is_some() {
        let message = format!("this row has more values than its {} properties", vertex.properties.len());
        return Err(CloudError::bad(message).help("declare the extra columns in the header"));
    }
    Ok(())
}

/// A number of an ASCII body. What Microsoft's runtime prints for no number counts as one.
pub fn number(word: &str, name: &str) -> Result<f64, CloudError> {
    if let Ok(value) = word.parse() {
        return Ok(value);
    }
    let lower = word.to_ascii_lowercase();
    if lower.contains("nan") || ["#ind", "#inf", "#qnan", "#snan"].iter().any(|mark| lower.contains(mark)) {
        return Ok(f64::NAN);
    }
    let error = CloudError::bad(format!("`{}` is no number for `{}`", shown(word), shown(name)));
    Err(if word.contains(',') { error.help("write a decimal point, not a comma") } else { error })
}

fn note_rest<R: BufRead>(
    input: &mut Input<R>,
    encoding: Encoding,
    cloud: &mut Cloud,
) -> Result<(), CloudError> {
    let at = input.position();
    let rest = match encoding {
        Encoding::Ascii => input.row().is_ok_and(|row| row.is_some()),
        _ => 0 < input.left(),
    };
    if rest {
        cloud.notes.push(format!(
            "data after the last point, from byte {at}, were ignored: is the count too small?"
        ));
    }
    Ok(())
}
