//! Goldens: what a scene was found to be, kept in files beside it and compared with what it is now. First where fixed rays go in and
//! out ([`spans`], on [`rays`]), exactly; then which leaf each pixel of a small picture shows, how far away and how it lies
//! ([`layers`]); then that picture, for people ([`picture`]). Scenes, messages and the decision to write are left to the program.

pub mod layers;
pub mod picture;
pub mod rays;
pub mod spans;

use std::io;
use std::path::{Path, PathBuf};

use crate::film::Film;
use crate::geom::Ray;
use crate::output::{self, OutputError, write_exr, write_rgb, write_rgb_noted, write_whole};
use crate::render::RenderError;
use crate::shot::Shot;
use picture::{Pair, Picture};
use rays::Rays;
use spans::Traces;

/// Kinds of golden.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// Where fixed rays go in and out.
    Spans,
    /// Leaf, depth and normal of each pixel.
    Layers,
    /// What a display shows.
    Picture,
}

impl Kind {
    /// All kinds, the most telling first.
    pub const ALL: [Kind; 3] = [Kind::Spans, Kind::Layers, Kind::Picture];

    /// The suffix of its file.
    pub const fn suffix(self) -> &'static str {
        match self {
            Kind::Spans => "spans",
            Kind::Layers => "exr",
            Kind::Picture => "png",
        }
    }

    /// What it counts.
    pub const fn unit(self) -> &'static str {
        match self {
            Kind::Spans => "rays",
            Kind::Layers | Kind::Picture => "pixels",
        }
    }

    /// Its file beside a scene.
    pub fn beside(self, scene: &Path) -> PathBuf {
        scene.with_extension(self.suffix())
    }

    /// Whether a file of its suffix is a golden, and no rendering that people keep beside their scenes.
    pub fn is_at(self, path: &Path) -> bool {
        match self {
            Kind::Spans => path.is_file(),
            Kind::Layers => layers::is_golden(path),
            Kind::Picture => Picture::is_golden(path),
        }
    }
}

/// The goldens that a file belongs to, where it is one: their scene, which may be gone.
pub fn scene_of(path: &Path) -> Option<PathBuf> {
    let suffix = path.extension()?;
    let kind = Kind::ALL.into_iter().find(|kind| suffix == kind.suffix())?;
    kind.is_at(path).then(|| path.with_extension("pss"))
}

/// The picture of differences beside a scene.
pub fn differences_beside(scene: &Path) -> PathBuf {
    scene.with_extension("diff.png")
}

/// Why goldens cannot be compared or written.
#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    /// A file cannot be read, or is no golden.
    #[error("`{}` is no golden that can be read: {why}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The reason.
        why: String,
    },
    /// A picture lies where a golden would go, beside no golden: somebody rendered it.
    #[error("`{}` lies where a golden goes, and is none", path.display())]
    InTheWay {
        /// The file.
        path: PathBuf,
    },
    /// A golden would change, and those that could show how are gone.
    #[error("`{}` would change, and `{}` and `{}` are gone, which could show how", Kind::Spans.beside(scene).display(), Kind::Layers.beside(scene).display(), Kind::Picture.beside(scene).display())]
    Unseen {
        /// The scene.
        scene: PathBuf,
    },
    /// The scene cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// What lies beside a scene.
#[derive(Debug, Default)]
pub struct Goldens {
    /// Where rays go in and out.
    pub spans: Option<Traces>,
    /// The layers.
    pub layers: Option<Film>,
    /// The picture.
    pub picture: Option<Picture>,
}

/// What a golden and the scene do not agree in.
#[derive(Clone, PartialEq, Debug)]
pub struct Differs {
    /// Which golden.
    pub kind: Kind,
    /// How many rays or pixels differ.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// The first of them, such as `ray 17` or `pixel 3,4`.
    pub first: String,
    /// What the golden has there.
    pub was: String,
    /// What is there now.
    pub is: String,
    /// The ray, of spans.
    pub ray: Option<Ray>,
}

/// What became of a comparison.
#[derive(Debug, Default)]
pub struct Compared {
    /// Goldens that differ, in the order of [`Kind::ALL`].
    pub differs: Vec<Differs>,
    /// What was and is to be seen, where goldens with pixels were compared.
    pub pairs: Vec<Pair>,
}

/// What a scene is now, as far as there is something to compare it with.
struct Today {
    spans: Traces,
    film: Option<Film>,
}

impl Goldens {
    /// Reads what lies beside a scene; nothing where no file is surely a golden.
    pub fn read(scene: &Path) -> Result<Goldens, GoldenError> {
        if !Kind::ALL.into_iter().any(|kind| kind.is_at(&kind.beside(scene))) {
            return Ok(Goldens::default());
        }
        let [spans, layers, picture] = Kind::ALL.map(|kind| kind.beside(scene));
        let broken = |path: &Path, why: String| GoldenError::Broken { path: path.to_owned(), why };
        let text = present(std::fs::read_to_string(&spans)).map_err(|e| broken(&spans, e.to_string()))?;
        let traces = text.map(|text| spans::parse(&text)).transpose();
        Ok(Goldens {
            spans: traces.map_err(|(line, why)| broken(&spans, format!("line {line}: {why}")))?,
            layers: present(layers::read(&layers)).map_err(|e| broken(&layers, e.to_string()))?,
            picture: present(Picture::read(&picture)).map_err(|e| broken(&picture, e.to_string()))?,
        })
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.missing().count() == Kind::ALL.len()
    }

    /// The kinds that there are none of.
    pub fn missing(&self) -> impl Iterator<Item = Kind> {
        let has = [self.spans.is_some(), self.layers.is_some(), self.picture.is_some()];
        Kind::ALL.into_iter().zip(has).filter(|(_, has)| !has).map(|(kind, _)| kind)
    }

    /// Compares with what the scene is now. Only fails to render.
    pub fn compare(&self, shot: &Shot) -> Result<Compared, RenderError> {
        let pixels = self.layers.is_some() || self.picture.is_some();
        let film = pixels.then(|| layers::film(shot)).transpose()?;
        Ok(self.compare_with(&Today { spans: spans::trace(&shot.world, self.rays(shot)), film }, shot))
    }

    /// The rays of the golden, or those that a new one would have.
    fn rays(&self, shot: &Shot) -> Rays {
        self.spans.as_ref().map_or_else(|| Rays::of(shot.world.bounds()), |traces| traces.rays)
    }

    fn compare_with(&self, now: &Today, shot: &Shot) -> Compared {
        let mut compared = Compared::default();
        let spans = self.spans.as_ref().and_then(|was| rays_apart(was, &now.spans));
        compared.differs.extend(spans);
        if let (Some(was), Some(film)) = (&self.layers, &now.film) {
            let [old, new] = [was, film].map(|f| Picture { size: f.size, bytes: layers::shown(f) });
            let find = || layers::differing(was, film, |pixel| layers::bar(shot, film.size, pixel));
            compared.pixels(
                Kind::Layers,
                [old, new],
                find,
                [&|i| layers::told(was, i), &|i| layers::told(film, i)],
            );
        }
        if let (Some(was), Some(film)) = (&self.picture, &now.film) {
            let new = Picture::of(film, &shot.settings);
            let find = || picture::differing(was, &new, film);
            let pair = [was.clone(), new.clone()];
            compared.pixels(Kind::Picture, pair, find, [&|i| was.told(i), &|i| new.told(i)]);
        }
        compared
    }
}

/// Nothing where there is no file.
fn present<T>(read: io::Result<T>) -> io::Result<Option<T>> {
    match read {
        Ok(read) => Ok(Some(read)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(e),
    }
}

/// The rays that two traces do not agree in.
fn rays_apart(was: &Traces, now: &Traces) -> Option<Differs> {
    let differing = spans::differing(was, now);
    let first = *differing.first()?;
    let told = |traces: &Traces| match &traces.lines[first as usize] {
        line if line.is_empty() => "nothing".to_owned(),
        line => line.to_string(),
    };
    Some(Differs {
        kind: Kind::Spans,
        count: differing.len(),
        of: was.lines.len(),
        first: format!("ray {first}"),
        was: told(was),
        is: told(now),
        ray: Some(was.rays.get(first)),
    })
}

impl Compared {
    /// Adds two pictures, the golden's first, and what they do not agree in. `told` say what is at a pixel.
    fn pixels(
        &mut self,
        kind: Kind,
        [was, now]: [Picture; 2],
        find: impl FnOnce() -> Vec<usize>,
        told: [&dyn Fn(usize) -> String; 2],
    ) {
        let pixels = |picture: &Picture| picture.bytes.len() / 3;
        let differs =
            |first, count, was, is| Differs { kind, count, of: pixels(&now), first, was, is, ray: None };
        if was.size != now.size {
            let size = |picture: &Picture| format!("{} x {} pixels", picture.size[0], picture.size[1]);
            self.differs.push(differs("the size".to_owned(), pixels(&now), size(&was), size(&now)));
            self.pairs.push(Pair { was, now, differing: Vec::new() });
            return;
        }
        let differing = find();
        if let Some(&first) = differing.first() {
            let width = now.size[0] as usize;
            let place = format!("pixel {},{}", first % width, first / width);
            self.differs.push(differs(place, differing.len(), told[0](first), told[1](first)));
        }
        self.pairs.push(Pair { was, now, differing });
    }

    /// Writes the picture of differences beside a scene, or removes it where there are none. Where no pixels were compared nothing is
    /// written. Whether there is one now.
    pub fn show_beside(&self, scene: &Path) -> Result<bool, OutputError> {
        let path = differences_beside(scene);
        if self.differs.is_empty() || self.pairs.is_empty() {
            // One that is not there need not go; one that cannot be removed harms nobody.
            let _ = std::fs::remove_file(path);
            return Ok(false);
        }
        let Picture { size, bytes } = picture::differences(&self.pairs);
        write_whole(&path, |sink| write_rgb(size, &bytes, sink)).map(|()| true)
    }
}

/// What became of goldens that were written.
#[derive(Debug, Default)]
pub struct Blessed {
    /// Those that were there, and differed.
    pub compared: Compared,
    /// Those that were not there.
    pub added: Vec<Kind>,
}

impl Blessed {
    /// Whether every golden was there and stays.
    pub fn is_nothing(&self) -> bool {
        self.added.is_empty() && self.compared.differs.is_empty()
    }
}

/// Makes goldens of what a scene is now: writes those that are not there or differ, the others stay as they are. Before one that
/// differs is written over, the picture of the differences lies beside the scene. `inputs` are the files that the scene reads, and
/// none of which is written over. A file of spans that there is keeps its number and seed of rays.
pub fn bless(
    scene: &Path,
    goldens: &Goldens,
    shot: &Shot,
    inputs: &[PathBuf],
) -> Result<Blessed, GoldenError> {
    let paths = Kind::ALL.map(|kind| kind.beside(scene));
    let mut missing = goldens.missing();
    if let Some(kind) = missing.find(|kind| paths[*kind as usize].exists()) {
        return Err(GoldenError::InTheWay { path: paths[kind as usize].clone() });
    }
    paths.iter().try_for_each(|path| output::check(path, inputs))?;
    output::check(&differences_beside(scene), inputs)?;
    let rays = goldens.rays(shot);
    let now = Today { spans: spans::trace(&shot.world, rays), film: Some(layers::film(shot)?) };
    let blessed = Blessed { compared: goldens.compare_with(&now, shot), added: goldens.missing().collect() };
    let is_shown = blessed.compared.show_beside(scene)?;
    if !blessed.compared.differs.is_empty() && !is_shown {
        return Err(GoldenError::Unseen { scene: scene.to_owned() });
    }
    let differing = blessed.compared.differs.iter().map(|d| d.kind);
    for kind in blessed.added.iter().copied().chain(differing) {
        let rays = Rays { bounds: Rays::of(shot.world.bounds()).bounds, ..rays };
        write(kind, &paths[kind as usize], &now, rays, shot)?;
    }
    Ok(blessed)
}

/// Writes a golden; spans on the rays given.
fn write(kind: Kind, path: &Path, now: &Today, rays: Rays, shot: &Shot) -> Result<(), OutputError> {
    let Some(film) = &now.film else { return Ok(()) };
    write_whole(path, |sink| match kind {
        Kind::Spans if rays == now.spans.rays => sink.write_all(spans::text(&now.spans).as_bytes()),
        Kind::Spans => sink.write_all(spans::text(&spans::trace(&shot.world, rays)).as_bytes()),
        Kind::Layers => write_exr(&layers::alone(film), sink),
        Kind::Picture => {
            let Picture { size, bytes } = Picture::of(film, &shot.settings);
            write_rgb_noted(size, &bytes, picture::NOTE, sink)
        }
    })
}
