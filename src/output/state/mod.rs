//! What is kept of a render that may be stopped, in a hidden file beside the picture: a head that says of what, then tiles as
//! they are painted. Each has a checksum; the first that is wrong ends the file, so that a run that was killed while it wrote
//! loses no more than that. When to keep is left to the program, what tiles are to [`crate::render`].

mod claim;
mod head;
mod record;

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};

pub use claim::{Claim, ClaimError, state_path};
pub use head::{Identity, Layout, Part};
pub use record::Place;

use crate::film::Film;

/// A state file that is written to.
#[derive(Debug)]
pub struct State {
    file: File,
    layout: Layout,
    /// Where each tile's record begins, by its first pixel.
    tiles: HashMap<[u32; 2], u64>,
    /// Where the next record goes: all before it is whole.
    end: u64,
    /// Why no more is kept.
    broken: Option<io::Error>,
}

/// What was found in a state.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub struct Found {
    /// Tiles that are whole.
    pub tiles: u64,
    /// Tiles that are damaged, or come after one that is.
    pub dropped: u64,
}

impl State {
    /// Empties the file and begins anew.
    fn begin(mut file: File, identity: &Identity, layout: Layout) -> io::Result<State> {
        let head = head::write(identity, &layout);
        file.set_len(0)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&head)?;
        let end = head.len() as u64;
        Ok(State { file, layout, tiles: HashMap::new(), end, broken: None })
    }

    /// Reads what is there, and cuts off what is damaged.
    fn resume(file: File, layout: Layout) -> io::Result<(State, Found)> {
        let mut state = State { file, layout, tiles: HashMap::new(), end: head::LENGTH as u64, broken: None };
        let length = state.file.seek(SeekFrom::End(0))?;
        state.file.seek(SeekFrom::Start(state.end))?;
        let mut reader = BufReader::with_capacity(1 << 20, &state.file);
        let (mut bytes, mut dropped) = (Vec::new(), 0);
        let mut at = state.end;
        while at < length {
            let Some(size) = record::read(&mut reader, length - at, &mut bytes)? else {
                // What is left is too short for a record, or is none.
                dropped += 1;
                break;
            };
            match record::place(&bytes, &state.layout).filter(|_| dropped == 0) {
                Some([x, y, ..]) => {
                    state.tiles.insert([x, y], at);
                    state.end = at + size;
                }
                None => dropped += 1,
            }
            at += size;
        }
        if state.end < length {
            state.file.set_len(state.end)?;
        }
        let tiles = state.tiles.len() as u64;
        Ok((state, Found { tiles, dropped }))
    }

    /// Adds tiles: the place of each in the whole picture, a note, and its first pixel in a film. A failure is remembered,
    /// and nothing more is kept; what was there before stays whole.
    pub fn add(&mut self, film: &Film, tiles: impl Iterator<Item = (Place, String, [u32; 2])>) {
        if self.broken.is_some() {
            return;
        }
        let (mut bytes, mut begun) = (Vec::new(), Vec::new());
        for (place, note, at) in tiles {
            begun.push(([place[0], place[1]], self.end + bytes.len() as u64));
            record::write(&mut bytes, place, &note, film, at);
        }
        let written = self.file.seek(SeekFrom::Start(self.end)).and_then(|_| self.file.write_all(&bytes));
        match written {
            Ok(()) => {
                self.end += bytes.len() as u64;
                self.tiles.extend(begun);
            }
            Err(e) => {
                // If that fails too, the next run finds a record that is cut short.
                let _ = self.file.set_len(self.end);
                self.broken = Some(e);
            }
        }
    }

    /// A tile that is kept, and its note; `None` where it is not, or cannot be read again.
    pub fn tile(&mut self, place: Place) -> Option<(Film, String)> {
        let at = *self.tiles.get(&[place[0], place[1]])?;
        let mut bytes = Vec::new();
        self.file.seek(SeekFrom::Start(at)).ok()?;
        record::read(&mut (&self.file).take(self.end - at), self.end - at, &mut bytes).ok()??;
        record::tile(&bytes, place, &self.layout)
    }

    /// How many tiles are kept.
    pub fn len(&self) -> u64 {
        self.tiles.len() as u64
    }

    /// Whether none is kept.
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Why no more is kept, if so.
    pub fn failure(&self) -> Option<&io::Error> {
        self.broken.as_ref()
    }
}
