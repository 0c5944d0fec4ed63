//! What a picture is a function of, beside the scene itself.

use crate::film::Aov;
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The `render` item.
pub const DECL: Decl = Decl {
    word: "render",
    group: Group::Render,
    doc: "How the picture is made.",
    params: &[
        Param::named("size", Kind::Vector(2), "width and height, pixels; default [800, 600]"),
        Param::named("samples", Kind::Int(1, MAX_SAMPLES as i64), "rays a pixel; default 16"),
        Param::named(
            "error",
            Kind::Positive,
            "samples are taken where they help most until the root mean square error of each tile of 32 x 32 pixels is at most this, of a display's 0 to 1; `samples` is the most a pixel gets",
        ),
        Param::named(
            "filter",
            Kind::Choice(&["box", "tent", "gauss", "mitchell"]),
            "how samples are spread around their pixel; default box",
        ),
        Param::named(
            "integrator",
            Kind::Choice(&["direct", "path", "ao", "normals", "depth", "flat"]),
            "what a ray brings back",
        ),
        Param::named("aov", Kind::Choices(&AOV_WORDS), "layers beside the colour; default none"),
        Param::named("exposure", Kind::Number, "stops; default 0"),
        Param::named(
            "tone",
            Kind::Choice(&["agx", "reinhard", "none"]),
            "the curve from light to pixels; default agx, for pictures of facts none",
        ),
        Param::named(
            "bounces",
            Kind::Int(1, MAX_BOUNCES as i64),
            "how often light may turn on its way, for \"path\" and in glass and mirrors; default 16",
        ),
        Param::named(
            "clamp",
            Kind::Positive,
            "light that has turned counts for at most this, radiance: rare bright paths speckle less, and light is lost; default none",
        ),
        Param::named("seed", Kind::Int(0, i64::MAX), "chooses the noise; default 0"),
    ],
    example: "render(size: [640, 480], samples: 64)",
};

/// The longest sequence of samples whose points are well spread.
pub const MAX_SAMPLES: u32 = 1 << 16;

/// The most pixels a picture has: its colours take 16 GiB, and both file formats can hold it.
pub const MAX_PIXELS: u64 = 1 << 30;

/// Where light turns more often hardly any of it is left; each turn has numbers of its own to choose by.
pub const MAX_BOUNCES: u32 = 1 << 10;

/// Beyond this many stops `f32` colours overflow or vanish.
const MAX_EXPOSURE: f64 = 100.0;

const AOV_WORDS: [&str; Aov::ALL.len()] = {
    let mut words = [""; Aov::ALL.len()];
    let mut i = 0;
    while i < words.len() {
        words[i] = Aov::ALL[i].word();
        i += 1;
    }
    words
};

/// What a ray brings back.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Integrator {
    /// Light that comes straight from the lights.
    Direct,
    /// All light, from surface to surface.
    Path,
    /// The share of the sky above each point that nothing covers.
    Ao,
    /// Normals as colours, -1 to 1 as 0 to 1.
    Normals,
    /// Distance as brightness: white where what is drawn begins, black where it ends.
    Depth,
    /// The surface's own colour.
    Flat,
}

/// The curve from linear light to the display.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Tone {
    /// AgX: keeps hues of bright colours by letting them go to white.
    Agx,
    /// Reinhard et al. 2002: `L / (1 + L)`.
    Reinhard,
    /// Clamped and encoded as sRGB.
    None,
}

/// How far around a pixel's middle its samples lie, and how they weigh.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Filter {
    /// Evenly over the pixel.
    Box,
    /// Falling straight to nothing one pixel away.
    Tent,
    /// A bell of half a pixel's standard deviation, cut at one and a half.
    Gauss,
    /// Mitchell and Netravali 1988 with B = C = 1/3, up to two pixels away: the sharpest, with a dark rim around bright lines.
    Mitchell,
}

impl Filter {
    fn of(word: &str) -> Filter {
        match word {
            "tent" => Filter::Tent,
            "gauss" => Filter::Gauss,
            "mitchell" => Filter::Mitchell,
            _ => Filter::Box,
        }
    }
}

/// Settings.
#[derive(Clone, PartialEq, Debug)]
pub struct Settings {
    /// Width and height of the whole picture, pixels; at least one pixel, at most [`MAX_PIXELS`].
    pub size: [u32; 2],
    /// The part to make, `[x0, y0, x1, y1]`, half-open, pixels from the top left, inside the picture.
    pub crop: Option<[u32; 4]>,
    /// Rays a pixel, from 1 to [`MAX_SAMPLES`].
    pub samples: u32,
    /// What a ray brings back.
    pub integrator: Integrator,
    /// Layers beside the colour, each once, in the order of [`Aov::ALL`].
    pub aov: Vec<Aov>,
    /// Stops, for pictures that are shown.
    pub exposure: f64,
    /// The curve, for pictures that are shown.
    pub tone: Tone,
    /// Where given, samples are taken where they help most until the root mean square error of each tile is at most this, of
    /// what a display shows from 0 to 1; `samples` is the most that a pixel gets.
    pub error: Option<f64>,
    /// How samples are spread around their pixel.
    pub filter: Filter,
    /// How often light may turn on its way, for integrators that follow it; from 1 to [`MAX_BOUNCES`].
    pub bounces: u32,
    /// The most that one path's light after its first turn counts for at a time, radiance.
    pub clamp: Option<f64>,
    /// Chooses the noise.
    pub seed: u64,
}

/// What the command line says instead of the scene.
#[derive(Clone, Copy, Default, Debug)]
pub struct Overrides {
    /// Width and height, pixels.
    pub size: Option<[u32; 2]>,
    /// Rays a pixel.
    pub samples: Option<u32>,
    /// Chooses the noise.
    pub seed: Option<u64>,
    /// The part to make, `[x0, y0, x1, y1]`.
    pub crop: Option<[u32; 4]>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            size: [800, 600],
            crop: None,
            samples: 16,
            integrator: Integrator::Direct,
            aov: Vec::new(),
            exposure: 0.0,
            tone: Tone::Agx,
            error: None,
            filter: Filter::Box,
            bounces: 16,
            clamp: None,
            seed: 0,
        }
    }
}

/// Builds the settings of a `render` item.
pub fn build(call: &Call) -> Result<Settings, BuildError> {
    let mut settings = Settings::default();
    if let Some(size) = call.vec2("size") {
        settings.size = whole_size(size)?;
    }
    settings.set_samples(whole(call, "samples", 1, u64::from(MAX_SAMPLES))?)?;
    settings.integrator = integrator(call.text("integrator").unwrap_or("direct"))?;
    settings.aov = aovs(call)?;
    settings.exposure = call.number("exposure").unwrap_or(0.0);
    if !(-MAX_EXPOSURE..=MAX_EXPOSURE).contains(&settings.exposure) {
        return Err(error("exposure", "`exposure` is beyond 100 stops", "stops: each doubles the light"));
    }
    settings.tone = match call.text("tone") {
        Some("agx") => Tone::Agx,
        Some("reinhard") => Tone::Reinhard,
        Some(_) => Tone::None,
        // Facts shall be read off the picture as they are.
        None if matches!(settings.integrator, Integrator::Direct | Integrator::Path) => Tone::Agx,
        None => Tone::None,
    };
    settings.error = call.number("error");
    if settings.error.is_some_and(|e| !(e.is_finite() && 0.0 < e)) {
        return Err(error(
            "error",
            "`error` must be above zero",
            "0.01 is some three of the 256 steps of a display",
        ));
    }
    settings.filter = Filter::of(call.text("filter").unwrap_or("box"));
    let bounces = whole(call, "bounces", 1, u64::from(MAX_BOUNCES))?;
    settings.bounces = bounces.map_or(settings.bounces, |n| n as u32);
    settings.clamp = call.number("clamp");
    settings.seed = whole(call, "seed", 0, i64::MAX as u64)?.unwrap_or(0);
    Ok(settings)
}

impl Settings {
    /// How many rays the whole picture sends from the eye, whatever part of it is made.
    pub fn lines(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1]) * u64::from(self.samples)
    }

    /// Replaces what the command line gives.
    pub fn apply(&mut self, overrides: &Overrides) -> Result<(), BuildError> {
        if let Some(size) = overrides.size {
            self.size = checked_size(size.map(u64::from))?;
        }
        self.set_samples(overrides.samples.map(u64::from))?;
        self.seed = overrides.seed.unwrap_or(self.seed);
        if let Some([x0, y0, x1, y1]) = overrides.crop {
            let [w, h] = self.size;
            if !(x0 < x1 && x1 <= w && y0 < y1 && y1 <= h) {
                let message =
                    format!("the part {x0},{y0},{x1},{y1} does not lie in the picture of {w} x {h}");
                return Err(error("crop", message, "x0 < x1 <= width and y0 < y1 <= height"));
            }
            self.crop = Some([x0, y0, x1, y1]);
        }
        Ok(())
    }

    /// The part to make, `[x0, y0, x1, y1]`.
    pub fn window(&self) -> [u32; 4] {
        self.crop.unwrap_or([0, 0, self.size[0], self.size[1]])
    }

    /// Width and height of the part to make, pixels.
    pub fn window_size(&self) -> [u32; 2] {
        let [x0, y0, x1, y1] = self.window();
        [x1 - x0, y1 - y0]
    }

    /// How many pixels are made.
    pub fn pixels(&self) -> u64 {
        let [w, h] = self.window_size();
        u64::from(w) * u64::from(h)
    }

    fn set_samples(&mut self, samples: Option<u64>) -> Result<(), BuildError> {
        let Some(samples) = samples else { return Ok(()) };
        self.samples =
            u32::try_from(samples).ok().filter(|n| (1..=MAX_SAMPLES).contains(n)).ok_or_else(|| {
                error("samples", format!("{samples} samples"), format!("from 1 to {MAX_SAMPLES}"))
            })?;
        Ok(())
    }
}

fn error(param: &'static str, message: impl Into<String>, help: impl Into<String>) -> BuildError {
    BuildError { param, message: message.into(), help: help.into() }
}

/// A whole number of a call, if it was written.
fn whole(call: &Call, name: &'static str, lo: u64, hi: u64) -> Result<Option<u64>, BuildError> {
    let Some(x) = call.number(name) else { return Ok(None) };
    if x.fract() == 0.0 && (lo as f64..=hi as f64).contains(&x) {
        return Ok(Some(x as u64));
    }
    Err(error(name, format!("`{name}` is {x}"), format!("a whole number from {lo} to {hi}")))
}

fn whole_size(size: [f64; 2]) -> Result<[u32; 2], BuildError> {
    if size.iter().any(|s| s.fract() != 0.0 || *s < 1.0) {
        let message = format!("a picture of {} x {} pixels", size[0], size[1]);
        return Err(error("size", message, "two whole numbers above zero"));
    }
    // Beyond `u64` the conversion saturates, far above the limit.
    checked_size(size.map(|s| s as u64))
}

fn checked_size(size: [u64; 2]) -> Result<[u32; 2], BuildError> {
    let [w, h] = size;
    let pixels = w.checked_mul(h).filter(|n| (1..=MAX_PIXELS).contains(n));
    match (pixels, u32::try_from(w), u32::try_from(h)) {
        (Some(_), Ok(w), Ok(h)) => Ok([w, h]),
        _ => {
            let message = format!("a picture of {w} x {h} pixels");
            Err(error("size", message, format!("at least one pixel, at most {MAX_PIXELS}")))
        }
    }
}

fn integrator(word: &str) -> Result<Integrator, BuildError> {
    match word {
        "direct" => Ok(Integrator::Direct),
        "path" => Ok(Integrator::Path),
        "ao" => Ok(Integrator::Ao),
        "normals" => Ok(Integrator::Normals),
        "depth" => Ok(Integrator::Depth),
        "flat" => Ok(Integrator::Flat),
        _ => {
            let help = "one of: direct, path, ao, normals, depth, flat";
            Err(error("integrator", format!("there is no integrator \"{word}\""), help))
        }
    }
}

fn aovs(call: &Call) -> Result<Vec<Aov>, BuildError> {
    let Some(Value::Texts(words)) = call.get("aov") else { return Ok(Vec::new()) };
    if let Some(word) = words.iter().find(|w| !AOV_WORDS.contains(&w.as_str())) {
        let help = format!("one of: {}", AOV_WORDS.join(", "));
        return Err(error("aov", format!("there is no layer \"{word}\""), help));
    }
    Ok(Aov::ALL.into_iter().filter(|aov| words.iter().any(|w| w == aov.word())).collect())
}
