//! Pixels in memory: linear colour and, where asked for, layers of facts beside it. How they are filled and
//! how they become files is left to [`crate::render`] and [`crate::output`].

/// A layer of facts, never averaged: about what the ray through each pixel's centre sees, or about the pixel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Aov {
    /// Distance from the eye, world length; infinite where nothing is.
    Depth,
    /// Unit normal out of the solid, of a sheet toward the eye; zero where nothing is.
    Normal,
    /// Point in the world; zero where nothing is.
    Position,
    /// Share of light the surface sends on, linear; zero where nothing is.
    Albedo,
    /// The number of the solid drawn that the face belongs to, from 1 in the order written, sheets after solids; zero where
    /// nothing is.
    Owner,
    /// One more than the index of the leaf that owns the face; zero where nothing is.
    Leaf,
    /// How many spans of solids the ray goes through.
    Layers,
    /// How long they are together, world length.
    Thickness,
    /// How long the first of them is, world length; zero where there is none.
    Wall,
    /// Groups of several crossings at one place, along the whole ray.
    Ties,
    /// Gaps whose ends disagreed and were mended by a cap, along the whole ray.
    Parity,
    /// Solves of plane and polynomial that all rays of the pixel asked for, those left out that build what other rays use as well.
    Projections,
    /// Those, and questions to leaves.
    Cost,
    /// The squared standard error of the pixel's brightness (Rec. 709 luminance), as its quarters differ: an upper bound, on the
    /// mean some two or three times the truth, as a whole sequence of samples is spread better than its quarters.
    Variance,
    /// How many samples the pixel has.
    Samples,
}

/// What there is to know of a layer: its word, and the names of its channels in a file.
type About = (Aov, &'static str, &'static [&'static str]);

/// All layers, in the order they are kept.
const ABOUT: [About; Aov::COUNT] = [
    (Aov::Depth, "depth", &["depth.Z"]),
    (Aov::Normal, "normal", &["N.X", "N.Y", "N.Z"]),
    (Aov::Position, "position", &["P.X", "P.Y", "P.Z"]),
    (Aov::Albedo, "albedo", &["albedo.R", "albedo.G", "albedo.B"]),
    (Aov::Owner, "owner", &["owner.id"]),
    (Aov::Leaf, "leaf", &["leaf.id"]),
    (Aov::Layers, "layers", &["layers"]),
    (Aov::Thickness, "thickness", &["thickness"]),
    (Aov::Wall, "wall", &["wall"]),
    (Aov::Ties, "ties", &["ties"]),
    (Aov::Parity, "parity_repairs", &["parity_repairs"]),
    (Aov::Projections, "projections", &["projections"]),
    (Aov::Cost, "cost", &["cost"]),
    (Aov::Variance, "variance", &["variance"]),
    (Aov::Samples, "samples", &["samples"]),
];

impl Aov {
    const COUNT: usize = 15;

    /// All layers, in the order they are kept.
    pub const ALL: [Aov; Aov::COUNT] = {
        let mut all = [Aov::Depth; Aov::COUNT];
        let mut i = 0;
        while i < Aov::COUNT {
            // Their order is that of the variants.
            assert!(ABOUT[i].0 as usize == i);
            all[i] = ABOUT[i].0;
            i += 1;
        }
        all
    };

    /// The word in `aov: [...]`.
    pub const fn word(self) -> &'static str {
        ABOUT[self as usize].1
    }

    /// The names of its channels in a file.
    pub const fn channels(self) -> &'static [&'static str] {
        ABOUT[self as usize].2
    }

    /// Whether it is known once all rays of a pixel are traced, and not from the one through its centre.
    pub const fn is_summed(self) -> bool {
        matches!(self, Aov::Projections | Aov::Cost | Aov::Variance | Aov::Samples)
    }

    /// Whether it tells of the insides that a ray goes through, so that it has to be known what has one.
    pub const fn is_of_insides(self) -> bool {
        matches!(self, Aov::Layers | Aov::Thickness | Aov::Wall | Aov::Ties | Aov::Parity)
    }

    /// Whether it counts or numbers something: two of its values are the same or not.
    pub const fn is_whole(self) -> bool {
        !matches!(
            self,
            Aov::Depth
                | Aov::Normal
                | Aov::Position
                | Aov::Albedo
                | Aov::Thickness
                | Aov::Wall
                | Aov::Variance
        )
    }

    /// The value of every channel where nothing is.
    pub const fn nothing(self) -> f32 {
        match self {
            Aov::Depth => f32::INFINITY,
            _ => 0.0,
        }
    }
}

/// One layer of a film.
#[derive(Clone, PartialEq, Debug)]
pub struct Layer {
    /// What it holds.
    pub aov: Aov,
    /// Rows from the top, pixels from the left, the channels of a pixel side by side.
    pub data: Vec<f32>,
}

/// A picture.
#[derive(Clone, PartialEq, Debug)]
pub struct Film {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Linear red, green, blue, and the share of the pixel that shows something drawn or the sky, which the
    /// colour is already multiplied with; rows from the top.
    pub rgba: Vec<[f32; 4]>,
    /// The layers asked for.
    pub layers: Vec<Layer>,
}

/// There is not enough memory for a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("no memory for {} x {} pixels: {} MiB are wanted", size[0], size[1], bytes.div_ceil(1 << 20))]
pub struct NoRoom {
    /// The size asked for.
    pub size: [u32; 2],
    /// What it takes.
    pub bytes: u64,
}

impl Film {
    /// A black, empty picture; fails where there is not enough memory.
    pub fn new(size: [u32; 2], aovs: &[Aov]) -> Result<Film, NoRoom> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let layers = aovs
            .iter()
            .map(|&aov| {
                let data = filled(pixels * aov.channels().len() as u64, aov.nothing())?;
                Some(Layer { aov, data })
            })
            .collect::<Option<Vec<Layer>>>();
        let rgba = filled(pixels, [0.0; 4]);
        rgba.zip(layers)
            .map(|(rgba, layers)| Film { size, rgba, layers })
            .ok_or(NoRoom { size, bytes: pixels * pixel_bytes(aovs) })
    }

    /// The colour of a pixel.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 4] {
        self.rgba[y as usize * self.size[0] as usize + x as usize]
    }

    /// The layer of a kind, if it was asked for.
    pub fn layer(&self, aov: Aov) -> Option<&Layer> {
        self.layers.iter().find(|l| l.aov == aov)
    }

    /// Copies a smaller picture with the same layers to a place of this one.
    pub fn paste(&mut self, part: &Film, at: [u32; 2]) {
        let width = self.size[0] as usize;
        let part_width = part.size[0] as usize;
        for row in 0..part.size[1] as usize {
            let to = (at[1] as usize + row) * width + at[0] as usize;
            let from = row * part_width;
            self.rgba[to..to + part_width].copy_from_slice(&part.rgba[from..from + part_width]);
            for (layer, other) in self.layers.iter_mut().zip(&part.layers) {
                let n = layer.aov.channels().len();
                layer.data[to * n..(to + part_width) * n]
                    .copy_from_slice(&other.data[from * n..(from + part_width) * n]);
            }
        }
    }
}

/// What a pixel takes in memory, bytes.
pub fn pixel_bytes(aovs: &[Aov]) -> u64 {
    let floats = 4 + aovs.iter().map(|aov| aov.channels().len()).sum::<usize>();
    (floats * size_of::<f32>()) as u64
}

/// So many copies of a value, or `None` where memory does not suffice.
fn filled<T: Copy>(count: u64, value: T) -> Option<Vec<T>> {
    let count = usize::try_from(count).ok()?;
    let mut list = Vec::new();
    list.try_reserve_exact(count).ok()?;
    list.resize(count, value);
    Some(list)
}
