//! STL, binary and text, by `stl_io`. Its normals are not read: corners say more.

use std::io::Cursor;

use glam::DVec3;

use super::Soup;
use crate::cloud::CloudError;

/// Bytes before the first triangle of a binary file, the count among them.
const HEADER: usize = 84;
/// Bytes of a triangle.
const TRIANGLE: u64 = 50;

/// The count that a binary file would have here.
fn count(bytes: &[u8]) -> Option<u64> {
    let word: [u8; 4] = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(u64::from(u32::from_le_bytes(word)))
}

/// Whether the length of the file is that of a binary STL. Its header may say anything, also `solid`.
pub fn is_binary(bytes: &[u8]) -> bool {
    let rest = bytes.len().saturating_sub(HEADER) as u64;
    let text = bytes.iter().take(512).all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace());
    match count(bytes) {
        Some(n) if n * TRIANGLE == rest => true,
        // Cut short or with a tail: binary where bytes that no text has say so.
        Some(_) => !text && (bytes.starts_with(b"solid") || bytes[..HEADER - 4].contains(&0)),
        None => false,
    }
}

/// Whether it begins as a text STL does.
pub fn is_text(bytes: &[u8]) -> bool {
    bytes.trim_ascii_start().starts_with(b"solid")
}

/// Reads a whole file.
pub fn read(bytes: &[u8]) -> Result<Soup, CloudError> {
    let mut soup = Soup::default();
    if is_binary(bytes) {
        let (n, rest) = (count(bytes).unwrap_or(0), bytes.len().saturating_sub(HEADER) as u64);
        if rest < n * TRIANGLE {
            let message = format!("truncated: expected {n} triangles, got {}", rest / TRIANGLE);
            return Err(CloudError::bad(message).help("the file is cut short: copy or export it again"));
        }
        let rows = bytes[HEADER..].chunks_exact(TRIANGLE as usize).take(n as usize);
        for row in rows {
            let number = |i: usize| {
                let word = [row[4 * i], row[4 * i + 1], row[4 * i + 2], row[4 * i + 3]];
                f64::from(f32::from_le_bytes(word))
            };
            add(&mut soup, [3, 6, 9].map(|i| DVec3::new(number(i), number(i + 1), number(i + 2))));
        }
        return Ok(soup);
    }
    let bad = |e: std::io::Error| {
        let error = CloudError::bad(format!("not a text STL: {e}"));
        error.help("each `facet` needs an `outer loop` of three lines `vertex x y z`")
    };
    if !bytes
        .trim_ascii_end()
        .rsplit(|b| *b == b'\n')
        .next()
        .is_some_and(|l| l.trim_ascii_start().starts_with(b"endsolid"))
    {
        let error = CloudError::bad("truncated: the file has no line `endsolid` at its end");
        return Err(error.help("the file is cut short: copy or export it again"));
    }
    // The reader wants the word at the very start.
    for triangle in stl_io::create_stl_reader(&mut Cursor::new(bytes.trim_ascii_start())).map_err(bad)? {
        let corners = triangle.map_err(bad)?.vertices;
        add(&mut soup, corners.map(|v| DVec3::new(v[0].into(), v[1].into(), v[2].into())));
    }
    Ok(soup)
}

fn add(soup: &mut Soup, corners: [DVec3; 3]) {
    let first = soup.points.len() as u32;
    // Adding zero turns -0 into 0, so that equal positions have equal bits.
    soup.points.extend(corners.map(|p| p + DVec3::ZERO));
    soup.triangles.push([first, first + 1, first + 2]);
}
