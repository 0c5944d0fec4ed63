//! Files that are written row by row, while the picture is made: there is no other way, so that a file is the same however
//! its picture came to be.

use std::io;

use crate::film::{Aov, Film};
use crate::shot::Settings;
use crate::shot::settings::{Integrator, Tone};

/// What a picture is before its pixels are known.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Layers beside the colour, as films have them.
    pub aovs: Vec<Aov>,
    /// Stops, for pictures that are shown.
    pub exposure: f64,
    /// The curve, for pictures that are shown.
    pub tone: Tone,
    /// What EXR files say about it, by name: ASCII names of less than 32 letters, no two alike.
    pub about: Vec<(&'static str, String)>,
}

impl Picture {
    /// The picture that settings ask for; nothing is said about it but which program made it.
    pub fn new(settings: &Settings) -> Picture {
        Picture {
            size: settings.window_size(),
            aovs: settings.aov.clone(),
            exposure: settings.exposure,
            tone: settings.tone,
            about: vec![software()],
        }
    }
}

/// Which program made a picture.
fn software() -> (&'static str, String) {
    ("software", format!("pss {}", env!("CARGO_PKG_VERSION")))
}

/// Writes a picture as its rows come.
pub trait Encode: Send {
    /// Writes the next rows, all columns of them.
    fn rows(&mut self, rows: &Film) -> io::Result<()>;

    /// Ends the file and flushes it; fails where rows are missing.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Writes a whole film.
pub fn write_film<E: Encode>(film: &Film, begin: impl FnOnce(&Picture) -> io::Result<E>) -> io::Result<()> {
    let aovs = film.layers.iter().map(|layer| layer.aov).collect();
    let picture = Picture { size: film.size, aovs, ..Picture::new(&Settings::default()) };
    let mut encoder = begin(&picture)?;
    encoder.rows(film)?;
    Box::new(encoder).finish()
}

/// What EXR files say about a picture: nothing of time, threads, names of files, or how often it was resumed.
pub fn about(scene: &str, settings: &str) -> Vec<(&'static str, String)> {
    vec![("pss.scene", scene.to_owned()), ("pss.settings", settings.to_owned()), software()]
}

/// Settings on a line, for people.
pub fn settings_line(s: &Settings) -> String {
    let [w, h] = s.size;
    let mut line = format!("size {w}x{h}");
    if let Some([x0, y0, x1, y1]) = s.crop {
        line += &format!(", crop {x0},{y0},{x1},{y1}");
    }
    let layers: Vec<&str> = s.aov.iter().map(|aov| aov.word()).collect();
    let integrator = format!("{:?}", s.integrator).to_lowercase();
    line += &format!(", samples {}", s.samples);
    if let Some(error) = s.error {
        line += &format!(", error {error}");
    }
    let filter = format!("{:?}", s.filter).to_lowercase();
    line += &format!(", filter {filter}, integrator {integrator}");
    if matches!(s.integrator, Integrator::Direct | Integrator::Path) {
        line += &format!(", bounces {}", s.bounces);
    }
    if let Some(clamp) = s.clamp {
        line += &format!(", clamp {clamp}");
    }
    let tone = format!("{:?}", s.tone).to_lowercase();
    line += &format!(", exposure {}, tone {tone}, seed {}", s.exposure, s.seed);
    if layers.is_empty() { line } else { line + ", aov " + &layers.join(" ") }
}
