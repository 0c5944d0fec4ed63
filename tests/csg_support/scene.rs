//! Scenes from text.
#![allow(dead_code)]

use pss::csg::{Scratch, Spans};
use pss::geom::{Interval, Ray};
use pss::diag::Diagnostic;
use pss::prepare::{self, Options, Prepared};
use pss::shot::Shot;
use pss::source::SourceMap;

fn read(text: &str) -> Result<Prepared, Vec<Diagnostic>> {
    let mut sources = SourceMap::default();
    let file = sources.add("test.pss", None, text.to_owned());
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[])?;
    prepare::prepare(&scene, &Options { measure_all: true, scene_dir: env!("CARGO_MANIFEST_DIR").into(), allow_read: vec!["../shared/scans".into()], ..Options::default() })
}

/// A scene's text, prepared, with what was found on the way.
pub fn prepared(text: &str) -> Prepared {
    read(text).unwrap_or_else(|e| panic!("{text}\n{e:?}"))
}

/// A scene's text, prepared.
pub fn shot(text: &str) -> Shot {
    prepared(text).shot
}

/// What is wrong with a scene's text.
pub fn errors(text: &str) -> Vec<Diagnostic> {
    read(text).err().unwrap_or_default()
}

/// All spans of a ray's line.
pub fn spans(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Spans {
    let mut out = Spans::new();
    shot.world.spans(ray, Interval::ALL, scratch, &mut out);
    out
}
