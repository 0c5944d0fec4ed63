//! Scenes from text.

use pss::csg::{Scratch, Spans};
use pss::geom::{Interval, Ray};
use pss::prepare::{self, Options};
use pss::shot::Shot;
use pss::source::SourceMap;

/// A scene's text, prepared.
pub fn shot(text: &str) -> Shot {
    let mut sources = SourceMap::default();
    let file = sources.add("test.pss", None, text.to_owned());
    let read = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]);
    let (scene, _) = read.unwrap_or_else(|e| panic!("{text}\n{e:?}"));
    let prepared = prepare::prepare(&scene, &Options { measure_all: true, ..Options::default() });
    prepared.unwrap_or_else(|e| panic!("{text}\n{e:?}")).shot
}

/// All spans of a ray's line.
pub fn spans(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Spans {
    let mut out = Spans::new();
    shot.world.spans(ray, Interval::ALL, scratch, &mut out);
    out
}
