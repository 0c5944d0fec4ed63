//! The header of a PLY: which elements there are, how many, and what each row of them holds.

use std::io::BufRead;

use super::input::Input;
use crate::cloud::CloudError;
use crate::cloud::magic::looks_like;

/// No header is longer; programs that write comments into it stay far below.
const HEADER_LIMIT: u64 = 1 << 16;

/// How the body is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Encoding {
    /// Words and lines.
    Ascii,
    /// Binary, lowest byte first.
    Little,
    /// Binary, highest byte first.
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Scalar> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// Whether it is a `float` or a `double`.
    pub fn is_float(self) -> bool {
        matches!(self, Scalar::F32 | Scalar::F64)
    }

    /// The number in `bytes`, lowest first, [`Scalar::size`] of them; exact for every type.
    pub fn decode(self, bytes: &[u8]) -> f64 {
        let word = bytes.iter().rev().fold(0u64, |word, &byte| word << 8 | u64::from(byte));
        match self {
            Scalar::I8 => f64::from(word as u8 as i8),
            Scalar::U8 => f64::from(word as u8),
            Scalar::I16 => f64::from(word as u16 as i16),
            Scalar::U16 => f64::from(word as u16),
            Scalar::I32 => f64::from(word as u32 as i32),
            Scalar::U32 => f64::from(word as u32),
            Scalar::F32 => f64::from(f32::from_bits(word as u32)),
            Scalar::F64 => f64::from_bits(word),
        }
    }
}

/// One column of an element.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Property {
    /// Its name.
    pub name: String,
    /// The type of its numbers.
    pub scalar: Scalar,
    /// The type of the count that precedes them, for a list.
    pub list: Option<Scalar>,
    /// The line of the header that declares it.
    pub line: usize,
}

/// One table of the file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Element {
    /// Its name; the points are `vertex`.
    pub name: String,
    /// Rows.
    pub count: u64,
    /// Columns, in their order.
    pub properties: Vec<Property>,
    /// The line of the header that declares it.
    pub line: usize,
}

impl Element {
    /// The fewest bytes a row can have in an encoding.
    pub fn least_row(&self, encoding: Encoding) -> u64 {
        let binary = |p: &Property| p.list.unwrap_or(p.scalar).size() as u64;
        match encoding {
            Encoding::Ascii => 2 * self.properties.len() as u64,
            _ => self.properties.iter().map(binary).sum(),
        }
    }
}

/// What the header says.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Header {
    /// How the body is written.
    pub encoding: Encoding,
    /// The tables, in their order.
    pub elements: Vec<Element>,
}

/// Reads the header and leaves the input at the first byte of the body.
pub fn read<R: BufRead>(input: &mut Input<R>) -> Result<Header, CloudError> {
    let ends = magic_line(input)?;
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let text = line(input, ends)?;
        let number = input.line;
        let at = |error: CloudError| error.at_line(number);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words.as_slice() {
            [] | ["comment" | "obj_info", ..] => {}
            ["end_header"] => break,
            ["format", name, _version] if encoding.is_none() => encoding = Some(format(name).map_err(at)?),
            ["format", ..] => {
                return Err(at(CloudError::bad("there must be one `format` line with a name and a version")));
            }
            ["element", name, count] => {
                let element = element(name, count, number).map_err(at)?;
                if elements.iter().any(|known| known.name == element.name) {
                    return Err(at(CloudError::bad(format!("element `{}` is declared twice", shown(name)))));
                }
                elements.push(element);
            }
            ["element", ..] => return Err(at(CloudError::bad("an element needs a name and one count"))),
            ["property", rest @ ..] => add_property(elements.last_mut(), rest, number).map_err(at)?,
            [word, ..] => {
                let message = format!("`{}` is no keyword of a PLY header", shown(word));
                return Err(at(CloudError::bad(message).help("the header ends with the line `end_header`")));
            }
        }
    }
    let encoding = encoding.ok_or_else(|| {
        CloudError::bad("the header has no `format` line").help("add `format ascii 1.0` or the binary one")
    })?;
    Ok(Header { encoding, elements })
}

/// How lines of the header end: with CR alone in files of old Macs, else with LF, a CR before it ignored.
/// The first line decides, so that a binary body may begin with any byte.
fn magic_line<R: BufRead>(input: &mut Input<R>) -> Result<u8, CloudError> {
    let head = input.peek()?;
    if head.is_empty() {
        return Err(CloudError::bad("no points: the file is empty"));
    }
    let is_ply = head.starts_with(b"ply") && head.get(3).is_none_or(u8::is_ascii_whitespace);
    if !is_ply {
        let found = looks_like(head);
        let error = match found {
            Some((name, help)) => CloudError::bad(format!("not a PLY file: it looks like {name}")).help(help),
            None => CloudError::bad("not a PLY file").help("its first line is not `ply`"),
        };
        return Err(error);
    }
    input.line = 1;
    while let Some(byte) = input.byte()? {
        match byte {
            b'\n' => return Ok(b'\n'),
            b'\r' if input.eat(b'\n')? => return Ok(b'\n'),
            b'\r' => return Ok(b'\r'),
            b'p' | b'l' | b'y' | b' ' | b'\t' => {}
            _ => return Err(CloudError::bad("not a PLY file").help("its first line is not `ply`")),
        }
    }
    Err(unfinished())
}

fn line<R: BufRead>(input: &mut Input<R>, end: u8) -> Result<String, CloudError> {
    input.line += 1;
    let mut text = Vec::new();
    loop {
        match input.byte()? {
            Some(byte) if byte == end => break,
            // The last line of a file that has a header and nothing else.
            None if text.trim_ascii() == b"end_header" => break,
            None => return Err(unfinished()),
            Some(byte) => text.push(byte),
        }
        if HEADER_LIMIT < input.position() {
            return Err(CloudError::bad(format!("the header is longer than {HEADER_LIMIT} bytes"))
                .help("its last line, `end_header`, may be missing"));
        }
    }
    Ok(String::from_utf8_lossy(&text).into_owned())
}

fn unfinished() -> CloudError {
    CloudError::bad("no points: the header has no `end_header` line")
        .help("the file is cut short: copy or export it again")
}

fn format(name: &str) -> Result<Encoding, CloudError> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::Little),
        "binary_big_endian" => Ok(Encoding::Big),
        _ => Err(CloudError::bad(format!("unknown format `{}`", shown(name)))
            .help("there are `ascii`, `binary_little_endian` and `binary_big_endian`")),
    }
}

fn element(name: &str, count: &str, line: usize) -> Result<Element, CloudError> {
    let digits = !count.is_empty() && count.bytes().all(|b| b.is_ascii_digit());
    let message =
        |why: &str| CloudError::bad(format!("the count `{}` of `{}` {why}", shown(count), shown(name)));
    if !digits {
        return Err(message("is no whole number").help("write it in decimal digits"));
    }
    let count = count.parse().map_err(|_| message("is too large"))?;
    Ok(Element { name: name.to_string(), count, properties: Vec::new(), line })
}

fn add_property(element: Option<&mut Element>, words: &[&str], line: usize) -> Result<(), CloudError> {
    let element = element.ok_or_else(|| CloudError::bad("a property stands before the first element"))?;
    let scalar = |name: &str| {
        Scalar::named(name).ok_or_else(|| {
            CloudError::bad(format!("unknown type `{}`", shown(name)))
                .help("there are char, uchar, short, ushort, int, uint, float and double")
        })
    };
    let (name, property_type, list) = match words {
        ["list", count, of, name] => (name, scalar(of)?, Some(scalar(count)?)),
        [of, name] if *of != "list" => (name, scalar(of)?, None),
        _ => return Err(CloudError::bad("a property needs a type and a name")),
    };
    if list.is_some_and(Scalar::is_float) {
        return Err(CloudError::bad("the count of a list must have a whole type"));
    }
    if element.properties.iter().any(|known| known.name == *name) {
        return Err(CloudError::bad(format!("property `{}` is declared twice", shown(name))));
    }
    element.properties.push(Property { name: name.to_string(), scalar: property_type, list, line });
    Ok(())
}

/// A word of the file, short enough and safe to print.
pub fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    let mut text: String = word.chars().take(LONGEST).map(|c| if c.is_control() { '?' } else { c }).collect();
    if LONGEST < word.chars().count() {
        text.push_str("...");
    }
    text
}
