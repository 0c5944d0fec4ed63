//! Wavefront OBJ: `v` and `f` lines; all others (normals, textures, groups, materials) say nothing about the shape.
//!
//! An own reader, as the crates for OBJ read other lines too and fail on them, keep `f32`, and name no line in errors.

use glam::DVec3;

use super::Soup;
use crate::cloud::CloudError;

/// Reads a whole file.
pub fn read(bytes: &[u8]) -> Result<Soup, CloudError> {
    let mut soup = Soup::default();
    let mut corners = Vec::new();
    let mut lines = bytes.split(|b| *b == b'\n').enumerate();
    while let Some((number, line)) = lines.next() {
        let text = String::from_utf8_lossy(line);
        let mut text = text.trim_end_matches('\r').to_owned();
        // A backslash joins the next line.
        while text.ends_with('\\') {
            text.pop();
            let Some((_, next)) = lines.next() else { break };
            text.push_str(String::from_utf8_lossy(next).trim_end_matches('\r'));
        }
        let mut words = text.split_ascii_whitespace();
        let read = match words.next() {
            Some("v") => vertex(&mut words).map(|p| soup.points.push(p)),
            Some("f") => face(words, soup.points.len(), &mut corners).map(|()| soup.polygon(&corners)),
            Some(word) if soup.points.is_empty() && !known(word) => {
                Err(CloudError::bad("not a mesh file: it is no PLY or STL, and this line is none of an OBJ")
                    .help("give a mesh as PLY, OBJ or STL"))
            }
            _ => Ok(()),
        };
        read.map_err(|e| e.at_line(number + 1))?;
        if u32::MAX as usize <= soup.points.len() {
            return Err(CloudError::bad("the mesh has too many vertices: indices have 32 bits"));
        }
    }
    Ok(soup)
}

/// Whether a line of an OBJ may begin so before the first vertex.
fn known(word: &str) -> bool {
    word.starts_with('#')
        || ["vt", "vn", "vp", "o", "g", "s", "mtllib", "usemtl", "mg", "l", "p"].contains(&word)
}

fn vertex<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<DVec3, CloudError> {
    let mut next = || {
        let word = words.next().ok_or_else(|| CloudError::bad("a vertex needs three numbers"))?;
        word.parse::<f64>().map_err(|_| CloudError::bad(format!("`{}` is no number", shown(word))))
    };
    // Adding zero turns -0 into 0, so that equal positions have equal bits.
    Ok(DVec3::new(next()?, next()?, next()?) + DVec3::ZERO)
}

/// The corners of a face: counted from 1, or from the last vertex backwards, a slash before what is not read.
fn face<'a>(
    words: impl Iterator<Item = &'a str>,
    count: usize,
    corners: &mut Vec<u32>,
) -> Result<(), CloudError> {
    corners.clear();
    for word in words.take_while(|w| !w.starts_with('#')) {
        let index = word.split('/').next().unwrap_or_default();
        let bad = |why: &str| CloudError::bad(format!("`{}` {why}", shown(word)));
        let index: i64 = index.parse().map_err(|_| bad("is no number of a vertex"))?;
        let place = if index < 0 { count as i64 + index } else { index - 1 };
        if !(0..count as i64).contains(&place) {
            return Err(bad(&format!("names no vertex: there are {count} up to here")));
        }
        corners.push(place as u32);
    }
    if corners.len() < 3 {
        return Err(CloudError::bad("a face needs three corners"));
    }
    Ok(())
}

/// A word, short enough and safe to print.
fn shown(word: &str) -> String {
    word.chars().take(40).map(|c| if c.is_control() { '?' } else { c }).collect()
}
