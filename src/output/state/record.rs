//! Tiles in a state file: length of what follows, place, length of the note, note, colours, layers, checksum; all numbers
//! little endian, the checksum over all before it.

use std::io::{self, Read};

use super::head::{Layout, is_sound};
use crate::film::{Film, pixel_bytes};

/// A tile's first pixel in the whole picture, its width and its height.
pub type Place = [u32; 4];

/// The largest side of a tile, and the longest note, that are believed: they bound what is read before its checksum is.
const MAX_SIDE: u32 = 256;
const MAX_NOTE: u32 = 1 << 16;

/// Bytes before the note.
const FRONT: usize = 4 + 4 * 4 + 4;

/// Adds the record of a tile whose pixels begin at `at` in a film.
pub fn write(out: &mut Vec<u8>, place: Place, note: &str, film: &Film, at: [u32; 2]) {
    let begin = out.len();
    out.extend([0; 4]);
    out.extend(place.iter().flat_map(|n| n.to_le_bytes()));
    out.extend((note.len() as u32).to_le_bytes());
    out.extend(note.as_bytes());
    let [_, _, w, h] = place.map(|n| n as usize);
    let row = |y: usize| {
        let first = (at[1] as usize + y) * film.size[0] as usize + at[0] as usize;
        first..first + w
    };
    for y in 0..h {
        film.rgba[row(y)].iter().for_each(|pixel| pixel.iter().for_each(|c| out.extend(c.to_le_bytes())));
    }
    for layer in &film.layers {
        let n = layer.aov.channels().len();
        for y in 0..h {
            let row = row(y);
            layer.data[row.start * n..row.end * n].iter().for_each(|x| out.extend(x.to_le_bytes()));
        }
    }
    let length = (out.len() + 4 - begin - 4) as u32;
    out[begin..begin + 4].copy_from_slice(&length.to_le_bytes());
    out.extend(crc32fast::hash(&out[begin..]).to_le_bytes());
}

/// Reads the bytes of the next record, of at most `left`, and tells how many they are; `None` where there is no room for
/// what it says it has.
pub fn read(from: &mut impl Read, left: u64, bytes: &mut Vec<u8>) -> io::Result<Option<u64>> {
    let mut length = [0; 4];
    if left < 4 {
        return Ok(None);
    }
    from.read_exact(&mut length)?;
    let rest = u32::from_le_bytes(length);
    // Layers take less than this.
    let most = FRONT as u32 + MAX_NOTE + MAX_SIDE * MAX_SIDE * 256;
    if left - 4 < u64::from(rest) || most < rest {
        return Ok(None);
    }
    bytes.clear();
    bytes.extend(length);
    bytes.resize(4 + rest as usize, 0);
    from.read_exact(&mut bytes[4..])?;
    Ok(Some(4 + u64::from(rest)))
}

/// The place of a tile; `None` where the record is damaged or is of no tile of the picture.
pub fn place(bytes: &[u8], layout: &Layout) -> Option<Place> {
    let word = |i: usize| Some(u32::from_le_bytes(*bytes.get(4 * i..)?.first_chunk()?));
    if !is_sound(bytes) {
        return None;
    }
    let place @ [x, y, w, h] = [word(1)?, word(2)?, word(3)?, word(4)?];
    let [x0, y0, x1, y1] = layout.window;
    let inside = x0 <= x && y0 <= y && x.checked_add(w)? <= x1 && y.checked_add(h)? <= y1;
    let floats = u64::from(w) * u64::from(h) * pixel_bytes(&layout.aovs);
    let fits = bytes.len() as u64 == FRONT as u64 + u64::from(word(5)?) + floats + 4;
    (inside && fits && w.max(h) <= MAX_SIDE).then_some(place)
}

/// The tile of a record, if it is the one at this place, and its note.
pub fn tile(bytes: &[u8], wanted: Place, layout: &Layout) -> Option<(Film, String)> {
    if place(bytes, layout)? != wanted {
        return None;
    }
    let note = u32::from_le_bytes(*bytes.get(FRONT - 4..)?.first_chunk()?) as usize;
    let (note, floats) = bytes.get(FRONT..bytes.len() - 4)?.split_at_checked(note)?;
    let mut floats = floats.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let mut film = Film::new([wanted[2], wanted[3]], &layout.aovs).ok()?;
    for pixel in &mut film.rgba {
        for c in pixel {
            *c = floats.next()?;
        }
    }
    for x in film.layers.iter_mut().flat_map(|layer| &mut layer.data) {
        *x = floats.next()?;
    }
    Some((film, String::from_utf8(note.to_vec()).ok()?))
}
