//! Golden dumps and pictures of scenes, beside the scenes in `tests/goldens`.

use std::fmt::Write;
use std::path::PathBuf;

use glam::DVec3;
use pss::csg::{Boundary, Scratch};
use pss::geom::{Interval, Ray};
use pss::render::{Progress, render};
use pss::shot::Shot;

use super::draws::Draws;
use super::scene::spans;

/// The file of a golden.
pub fn path(name: &str, suffix: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/goldens");
    folder.join(format!("{name}.{suffix}"))
}

/// Whether goldens are to be written, not compared.
pub fn blessing() -> bool {
    std::env::var_os("PSS_BLESS").is_some()
}

/// Fixed rays through the ball of radius two about the origin.
pub fn rays(count: usize) -> impl Iterator<Item = Ray> {
    let mut draws = Draws::new(42);
    (0..count).map(move |i| {
        let from = 4.0 * draws.direction();
        let to = 0.9 * draws.direction() * draws.unit();
        if i % 4 == 0 {
            let axis = draws.pick(&DVec3::AXES);
            return Ray::new(to - 3.0 * axis, axis);
        }
        Ray::new(from, to - from)
    })
}

/// Nine significant digits: what other machines round alike.
fn end(shot: &Shot, b: Option<Boundary>) -> String {
    b.map_or("-".to_owned(), |b| {
        let marks = [(b.flipped, "~"), (b.crossing.cap, "^")];
        let marks: String = marks.iter().filter(|m| m.0).map(|m| m.1).collect();
        format!("{:.8e}{}{marks}", b.t, shot.world.name(&b))
    })
}

/// All spans on the fixed rays, one line a ray that meets something.
pub fn dump(shot: &Shot, count: usize) -> String {
    let (mut scratch, mut text) = (Scratch::default(), String::new());
    for (i, ray) in rays(count).enumerate() {
        let spans = spans(shot, &ray, &mut scratch);
        if spans.is_empty() {
            continue;
        }
        write!(text, "{i}").unwrap();
        for s in spans {
            write!(text, " {}..{}", end(shot, s.enter), end(shot, s.exit)).unwrap();
        }
        text.push('\n');
    }
    text
}

/// The picture as RGB bytes.
pub fn picture(shot: &Shot) -> Vec<u8> {
    let film = render(shot, &Progress::default()).unwrap().film;
    let mut png = Vec::new();
    pss::output::write_png(&film, shot.settings.exposure, shot.settings.tone, &mut png).unwrap();
    image::load_from_memory(&png).unwrap().to_rgb8().into_raw()
}

/// The volume in the box [-1.5, 1.5]^3, by rays along z on a jittered grid.
pub fn volume(shot: &Shot, size: u32) -> f64 {
    let (mut scratch, mut draws, mut sum) = (Scratch::default(), Draws::new(1), 0.0);
    let cell = 3.0 / f64::from(size);
    for i in 0..size * size {
        let [x, y] = [i % size, i / size].map(|k| (f64::from(k) + draws.unit()) * cell - 1.5);
        let ray = Ray::new(DVec3::new(x, y, -1.5), DVec3::Z);
        let range = Interval::new(0.0, 3.0);
        for s in spans(shot, &ray, &mut scratch) {
            sum += s.interval().intersect(range).length().max(0.0);
        }
    }
    sum * cell * cell
}
