//! Any text is a scene or an error. What is read can be dumped; the house style says the same and stays as it is.
#![no_main]

mod common;

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use pss::geom::Aabb;
use pss::lang::{Answer, Asked, Extent, Geometry, Measured, RayHit, formatted, items};
use pss::scene::MAX_WRITTEN_OUT;
use pss::source::{FileId, SourceMap};
use serde_json::Value;

/// A number whose bar narrows a few times.
fn guess(value: u32, err: f64, asked: &Asked) -> Measured {
    let value = f64::from(value);
    Measured { value, err: err / (1 + asked.level) as f64, size: value, is_open: asked.level < 3 }
}

/// Answers at once: what is read afterwards matters here, not what is true.
struct Guess;

impl Geometry for Guess {
    fn bounds(&self, asked: &Asked) -> Answer<Extent> {
        let size = f64::from(asked.at.start % 7);
        let bounds =
            if size == 6.0 { Aabb::EMPTY } else { Aabb { min: DVec3::ZERO, max: DVec3::splat(size) } };
        Ok(Extent { bounds, err: 0.0 })
    }

    fn is_solid(&self, asked: &Asked) -> Answer<bool> {
        Ok(asked.at.start % 2 == 0)
    }

    fn is_empty(&self, asked: &Asked) -> Answer<bool> {
        Ok(asked.at.start % 3 == 0)
    }

    fn inside(&self, asked: &Asked, point: DVec3) -> Answer<bool> {
        Ok(point.x < f64::from(asked.at.start))
    }

    fn volume(&self, asked: &Asked) -> Answer<Measured> {
        Ok(guess(asked.at.start, 0.01, asked))
    }

    fn area(&self, asked: &Asked) -> Answer<Measured> {
        Ok(guess(asked.at.end, 0.0, asked))
    }

    fn centroid(&self, asked: &Asked) -> Answer<[Measured; 3]> {
        Ok([guess(asked.at.start, 0.5, asked); 3])
    }

    fn raycast(&self, asked: &Asked, from: DVec3, dir: DVec3) -> Answer<Vec<RayHit>> {
        let hit = |i| RayHit { t: f64::from(i), point: from + dir, normal: -dir, entering: i % 2 == 0 };
        Ok((0..asked.at.start % 5).map(hit).collect())
    }
}

fuzz_target!(|data: &[u8]| {
    let Some((mut sources, file)) = common::source(data) else { return };
    styled(&sources, file);
    if let Some(read) = common::read(&mut sources, file, &Guess) {
        let written = items(&sources, file).expect("what was read can be parsed");
        if read.scene.written_out() <= MAX_WRITTEN_OUT {
            serde_json::to_writer(std::io::sink(), &(&written, &read.scene)).expect("plain data");
        }
    }
});

/// What is formatted says the same, and stays as it is.
fn styled(sources: &SourceMap, file: FileId) {
    let Ok(once) = formatted(sources, file) else { return };
    let mut again = SourceMap::default();
    let file_again = again.add("scene.pss", None, once.clone());
    let twice = formatted(&again, file_again).expect("what is formatted can be parsed");
    assert_eq!(once, twice, "the house style moves");
    let (before, after) = (said(sources, file), said(&again, file_again));
    assert!(before == after, "formatting changes what is said\n{before}\n{after}");
}

/// The items without their places.
fn said(sources: &SourceMap, file: FileId) -> Value {
    let mut value = serde_json::to_value(items(sources, file).expect("parsed before")).expect("plain data");
    forget_places(&mut value);
    value
}

fn forget_places(value: &mut Value) {
    match value {
        Value::Object(map) if map.contains_key("start") && map.contains_key("end") => *value = Value::Null,
        Value::Object(map) => map.values_mut().for_each(forget_places),
        Value::Array(list) => list.iter_mut().for_each(forget_places),
        _ => {}
    }
}
