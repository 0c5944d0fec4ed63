//! Golden layers: which leaf each pixel shows, how far away and how its face lies, in a small picture of the scene.

use std::io;
use std::path::Path;

use crate::csg::Scratch;
use crate::film::{Aov, Film};
use crate::geom::{Interval, tolerance};
use crate::output::{exr_size, read_exr};
use crate::render::{Progress, RenderError, View, render_scenery};
use crate::shot::{Settings, Shot};

/// The longer side of a golden picture, pixels, where the scene's own is not shorter.
pub const SIDE: u32 = 72;

/// The most rays a pixel.
const SAMPLES: u32 = 4;

/// What goldens hold.
const LAYERS: [Aov; 3] = [Aov::Depth, Aov::Normal, Aov::Leaf];

/// How goldens are rendered: as the scene says, but small and with the layers that goldens hold.
pub fn settings(of: &Settings) -> Settings {
    let longer = of.size[0].max(of.size[1]);
    let side = |n: u32| match longer <= SIDE {
        true => n,
        false => (f64::from(n) * f64::from(SIDE) / f64::from(longer)).round().max(1.0) as u32,
    };
    let (size, samples) = (of.size.map(side), of.samples.min(SAMPLES));
    Settings { size, samples, crop: None, aov: LAYERS.to_vec(), ..of.clone() }
}

/// The small picture of a scene with the layers of goldens.
pub fn film(shot: &Shot) -> Result<Film, RenderError> {
    let settings = settings(&shot.settings);
    let Shot { world, ghosts, camera, lights, materials, .. } = shot;
    let view = View { camera, lights, materials, ghosts: ghosts.as_ref(), settings: &settings };
    Ok(render_scenery(world, &view, &Progress::default())?.film)
}

/// The layers alone: colour belongs to the picture.
pub fn alone(film: &Film) -> Film {
    Film { rgba: vec![[0.0; 4]; film.rgba.len()], ..film.clone() }
}

/// Reads a golden; fails where the file is no such.
pub fn read(path: &Path) -> io::Result<Film> {
    let film = read_exr(path)?;
    match LAYERS.iter().all(|aov| film.layer(*aov).is_some()) {
        true => Ok(film),
        false => {
            Err(io::Error::new(io::ErrorKind::InvalidData, "it has not the layers depth, N and leaf.id"))
        }
    }
}

/// Whether a file is a golden: small, without a colour, and with its layers. What people render has a colour.
pub fn is_golden(path: &Path) -> bool {
    let size = std::fs::File::open(path).and_then(exr_size);
    size.is_ok_and(|size| size.iter().all(|side| *side <= SIDE))
        && read(path).is_ok_and(|film| film.rgba.iter().all(|pixel| *pixel == [0.0; 4]))
}

/// What a pixel shows.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Seen {
    /// One more than the leaf's index; 0 where nothing is.
    id: f32,
    /// World length.
    depth: f32,
    normal: [f32; 3],
}

impl Seen {
    fn at(film: &Film, pixel: usize) -> Seen {
        let values = |aov| film.layer(aov).map_or(&[][..], |layer| &layer.data);
        let value = |aov, i| values(aov).get(i).copied().unwrap_or(f32::NAN);
        Seen {
            id: value(Aov::Leaf, pixel),
            depth: value(Aov::Depth, pixel),
            normal: [0, 1, 2].map(|i| value(Aov::Normal, 3 * pixel + i)),
        }
    }

    /// Whether depth and normal agree, where `bar` says by how much the depth may be off.
    fn agrees(&self, now: &Seen, bar: impl FnOnce() -> f64) -> bool {
        let lies =
            self.normal.iter().zip(&now.normal).all(|(a, b)| (a - b).abs() <= tolerance::GOLDEN_NORMAL);
        if self.depth == now.depth {
            return lies;
        }
        let [a, b] = [self.depth, now.depth].map(f64::from);
        // Each is rounded to its own `f32`.
        let share = tolerance::GOLDEN_SHARE + f64::from(f32::EPSILON);
        lies && ((a - b).abs() <= share * a.max(b) || (a - b).abs() <= share * a.max(b) + 2.0 * bar())
    }

    fn told(&self) -> String {
        let Seen { id, depth, normal: [x, y, z] } = self;
        match *id == 0.0 {
            true => "nothing".to_owned(),
            false => format!("leaf {}, depth {depth}, normal {x} {y} {z}", id - 1.0),
        }
    }
}

/// Which pixels stand at an edge: within one pixel another leaf is seen.
pub fn edges(film: &Film) -> Vec<bool> {
    let [w, h] = film.size.map(|n| n as usize);
    let ids = film.layer(Aov::Leaf).map_or(&[][..], |layer| &layer.data);
    let edge = |i: usize| {
        let ([x, y], id) = ([i % w, i / w], ids.get(i));
        let mut near = (y.saturating_sub(1)..(y + 2).min(h))
            .flat_map(|y| (x.saturating_sub(1)..(x + 2).min(w)).map(move |x| y * w + x));
        near.any(|j| ids.get(j) != id)
    };
    (0..w * h).map(edge).collect()
}

/// So many pixels at edges may be others.
pub fn strays(pixels: usize) -> usize {
    (tolerance::GOLDEN_STRAYS * pixels as f64) as usize
}

/// Pixels that may differ at edges, and those that may not, brought together: what is wrong.
pub fn wrong(strays_found: Vec<usize>, mut wrong: Vec<usize>, pixels: usize) -> Vec<usize> {
    if strays(pixels) < strays_found.len() {
        wrong.extend(strays_found);
        wrong.sort_unstable();
    }
    wrong
}

/// The pixels that differ between two films of one size, ascending. `bar` says by how much the depth of a pixel may be off, world
/// length; it is asked where depths differ by more than rounding.
pub fn differing(was: &Film, now: &Film, bar: impl Fn(usize) -> f64) -> Vec<usize> {
    let (mut apart, mut off) = (Vec::new(), Vec::new());
    let edges = edges(was);
    for (pixel, edge) in edges.iter().enumerate() {
        let (a, b) = (Seen::at(was, pixel), Seen::at(now, pixel));
        if a.id != b.id {
            if *edge { apart.push(pixel) } else { off.push(pixel) }
        } else if !a.agrees(&b, || bar(pixel)) {
            off.push(pixel);
        }
    }
    wrong(apart, off, edges.len())
}

/// What a pixel was and is, in words.
pub fn told(film: &Film, pixel: usize) -> String {
    Seen::at(film, pixel).told()
}

/// By how much the depth of a pixel may be off, world length, where it shows what is known within a bound only; else 0.
pub fn bar(shot: &Shot, size: [u32; 2], pixel: usize) -> f64 {
    let [x, y] = [pixel as u32 % size[0], pixel as u32 / size[0]].map(|n| f64::from(n) + 0.5);
    let ray = shot.camera.ray(x, y, size);
    let hit = shot.world.first(&ray, Interval::AHEAD, &mut Scratch::default());
    hit.map_or(0.0, |hit| hit.boundary.crossing.err * ray.dir.length())
}

/// Normals as colours, for people: 8-bit, three bytes a pixel.
pub fn shown(film: &Film) -> Vec<u8> {
    let color = |pixel| {
        let Seen { id, normal, .. } = Seen::at(film, pixel);
        normal.map(|x| if id == 0.0 { 0 } else { (127.5 * (x + 1.0)).clamp(0.0, 255.0) as u8 })
    };
    (0..film.rgba.len()).flat_map(color).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hundred by forty pixels, the left half of leaf 0 and the right of leaf 1: at most two may stray.
    fn halves() -> Film {
        let mut film = Film::new([100, 40], &LAYERS).unwrap();
        for pixel in 0..4000 {
            set(&mut film, pixel, if pixel % 100 < 50 { 1.0 } else { 2.0 }, 3.0, 1.0);
        }
        film
    }

    fn set(film: &mut Film, pixel: usize, id: f32, depth: f32, z: f32) {
        for layer in &mut film.layers {
            match layer.aov {
                Aov::Depth => layer.data[pixel] = depth,
                Aov::Leaf => layer.data[pixel] = id,
                _ => layer.data[3 * pixel + 2] = z,
            }
        }
    }

    fn with(changes: &[(usize, f32, f32, f32)], bar: f64) -> Vec<usize> {
        let (was, mut now) = (halves(), halves());
        changes.iter().for_each(|&(pixel, id, depth, z)| set(&mut now, pixel, id, depth, z));
        differing(&was, &now, |_| bar)
    }

    #[test]
    fn a_few_pixels_at_an_edge_may_show_the_other_side() {
        let strays = [(50, 1.0, 4.0, -1.0), (149, 2.0, 3.0, 1.0)];
        assert!(with(&strays, 0.0).is_empty());
        assert_eq!(
            with(&[&strays[..], &[(250, 1.0, 3.0, 1.0)]].concat(), 0.0),
            [50, 149, 250],
            "three are many"
        );
        assert_eq!(with(&[(52, 1.0, 3.0, 1.0)], 0.0), [52], "no edge is near");
    }

    #[test]
    fn depth_and_normal_are_held_to_rounding_or_to_what_a_scan_knows() {
        let next = 3f32.next_up();
        assert!(with(&[(7, 1.0, next, 1.0 - 5e-7)], 0.0).is_empty());
        assert_eq!(with(&[(7, 1.0, 3.000_001, 1.0)], 0.0), [7]);
        assert!(with(&[(7, 1.0, 3.000_001, 1.0)], 1e-6).is_empty());
        assert_eq!(with(&[(7, 1.0, 3.0, 0.999)], 1.0), [7]);
        assert_eq!(with(&[(7, 1.0, f32::NAN, 1.0)], 0.0), [7], "what is no number agrees with nothing");
    }
}
