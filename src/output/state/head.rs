//! The head of a state file: of which picture it is.

use serde::{Deserialize, Serialize};

use crate::film::Aov;

/// How a state file begins.
const MAGIC: &[u8; 8] = b"pssstate";

/// Changes where the form does.
const VERSION: u32 = 1;

/// Bytes of a head: magic, version, four hashes, window, layers, checksum.
pub const LENGTH: usize = 8 + 4 + 4 * 32 + 4 * 4 + 4 + 4;

/// What a picture is a function of, as hashes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Identity {
    /// The texts of the scene and what the command line defines in it.
    pub scene: [u8; 32],
    /// The files it reads.
    pub files: [u8; 32],
    /// All that the picture is beside the scene: size, samples and so on.
    pub settings: [u8; 32],
    /// The program.
    pub program: [u8; 32],
}

/// A part of an identity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// The texts of the scene.
    Scene,
    /// The files it reads.
    Files,
    /// Size, samples and so on.
    Settings,
    /// The program.
    Program,
}

impl Part {
    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            Part::Scene => "the scene",
            Part::Files => "a file that the scene reads",
            Part::Settings => "the settings",
            Part::Program => "the program",
        }
    }
}

/// How tiles are kept.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Layout {
    /// The part of the picture that is made, `[x0, y0, x1, y1]`.
    pub window: [u32; 4],
    /// Layers beside the colour.
    pub aovs: Vec<Aov>,
}

impl Identity {
    /// The parts in which two are not the same.
    pub fn differing(&self, o: &Identity) -> Vec<Part> {
        let parts = [
            (Part::Scene, self.scene != o.scene),
            (Part::Files, self.files != o.files),
            (Part::Settings, self.settings != o.settings),
            (Part::Program, self.program != o.program),
        ];
        parts.into_iter().filter(|(_, differs)| *differs).map(|(part, _)| part).collect()
    }
}

impl Layout {
    fn bytes(&self) -> [u8; 20] {
        let layers = self.aovs.iter().fold(0_u32, |set, aov| set | 1 << *aov as u32);
        let [x0, y0, x1, y1] = self.window;
        let words = [x0, y0, x1, y1, layers].map(u32::to_le_bytes);
        std::array::from_fn(|i| words[i / 4][i % 4])
    }
}

/// The bytes of a head.
pub fn write(identity: &Identity, layout: &Layout) -> Vec<u8> {
    let mut head = MAGIC.to_vec();
    head.extend(VERSION.to_le_bytes());
    for hash in [identity.scene, identity.files, identity.settings, identity.program] {
        head.extend(hash);
    }
    head.extend(layout.bytes());
    head.extend(crc32fast::hash(&head).to_le_bytes());
    head
}

/// What a head says, compared with what it should.
#[derive(PartialEq, Eq, Debug)]
pub enum Reading {
    /// It is of this picture.
    Same,
    /// It is of another.
    Other(Vec<Part>),
    /// It is damaged, or not there.
    Damaged,
}

/// Compares a head with what it should be.
pub fn read(head: &[u8], identity: &Identity, layout: &Layout) -> Reading {
    let [hashes, rest] = [12, 12 + 4 * 32];
    if head.len() != LENGTH || !head.starts_with(MAGIC) || !is_sound(head) {
        return Reading::Damaged;
    }
    if head[8..hashes] != VERSION.to_le_bytes() {
        return Reading::Other(vec![Part::Program]);
    }
    let hash = |i: usize| std::array::from_fn(|k| head[hashes + 32 * i + k]);
    let found = Identity { scene: hash(0), files: hash(1), settings: hash(2), program: hash(3) };
    let differing = found.differing(identity);
    if !differing.is_empty() {
        return Reading::Other(differing);
    }
    if head[rest..rest + 20] == layout.bytes() { Reading::Same } else { Reading::Other(vec![Part::Settings]) }
}

/// Whether bytes end with their checksum.
pub fn is_sound(bytes: &[u8]) -> bool {
    let Some((body, sum)) = bytes.split_last_chunk::<4>() else { return false };
    crc32fast::hash(body).to_le_bytes() == *sum
}
