//! Scenes from text.

use std::path::Path;

use pss::csg::{Scratch, Spans};
use pss::diag::Diagnostic;
use pss::geom::{Interval, Ray};
use pss::prepare::{self, Options, Prepared};
use pss::render::{Progress, render};
use pss::shot::Shot;
use pss::source::SourceMap;

fn read(text: &str, folder: &Path) -> Result<Prepared, Vec<Diagnostic>> {
    let mut sources = SourceMap::default();
    let file = sources.add("test.pss", Some(folder.join("test.pss")), text);
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[])?;
    let options =
        Options { measure_all: true, write_out: true, scene_dir: folder.to_owned(), ..Options::default() };
    prepare::prepare(&scene, &options)
}

/// A scene's text, prepared as if it lay in a folder, with what was found on the way.
pub fn prepared_in(text: &str, folder: &Path) -> Prepared {
    read(text, folder).unwrap_or_else(|e| panic!("{text}\n{e:?}"))
}

/// What is wrong with a scene's text in a folder.
pub fn errors_in(text: &str, folder: &Path) -> Vec<Diagnostic> {
    read(text, folder).err().unwrap_or_default()
}

/// A scene's text, prepared, with what was found on the way.
pub fn prepared(text: &str) -> Prepared {
    prepared_in(text, Path::new("."))
}

/// A scene's text, prepared.
pub fn shot(text: &str) -> Shot {
    prepared(text).shot
}

/// What is wrong with a scene's text.
pub fn errors(text: &str) -> Vec<Diagnostic> {
    errors_in(text, Path::new("."))
}

/// Where they begin and end.
pub fn ends(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Vec<[f64; 2]> {
    spans(shot, ray, scratch).iter().map(|s| [s.interval().lo, s.interval().hi]).collect()
}

/// All spans of a ray's line.
pub fn spans(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Spans {
    let mut out = Spans::new();
    shot.world.spans(ray, Interval::ALL, scratch, &mut out);
    out
}

/// The picture as RGB bytes.
pub fn picture(shot: &Shot) -> Vec<u8> {
    let film = render(shot, &Progress::default()).unwrap().film;
    let mut png = Vec::new();
    pss::output::write_png(&film, shot.settings.exposure, shot.settings.tone, &mut png).unwrap();
    image::load_from_memory(&png).unwrap().to_rgb8().into_raw()
}
