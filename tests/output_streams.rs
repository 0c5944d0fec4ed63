//! Pictures made slab by slab: tiles that go wrong, files written in pieces, and pictures larger than memory.

mod cli_common;

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

use cli_common::Folder;
use glam::DVec3;
use pss::csg::Scratch;
use pss::film::{Aov, Film};
use pss::geom::{Aabb, Interval, Ray};
use pss::num::hash::unit;
use pss::output::state::{Claim, Identity, Layout, State};
use pss::output::{Encode, Growing, Old, Picture, PngRows, write_exr, write_png};
use pss::render::{
    Done, Moment, Onlooker, Progress, RenderError, Scenery, Slab, Tile, View, Work, render_scenery,
    render_scenery_for,
};
use pss::shot::settings::Tone;
use pss::shot::{Camera, Hit, Settings, Surface};

/// Nothing, and perhaps a mine in some direction.
struct Mined(Option<DVec3>);

/// One in the way of the ray through a pixel.
fn mined() -> Mined {
    let camera = Camera::fit(Mined(None).bounds());
    Mined(Some(camera.ray(150.0, 100.0, settings().size).dir.normalize()))
}

impl Scenery for Mined {
    fn bounds(&self) -> Aabb {
        Aabb::of_points([DVec3::ZERO, DVec3::ONE])
    }

    fn first(&self, ray: &Ray, _: Interval, scratch: &mut Scratch) -> Option<Hit> {
        scratch.solid.counts.leaf_queries += 1;
        // The rays of its own pixel lie within half of this.
        let far = |mine: DVec3| 0.01 < mine.distance(ray.dir.normalize());
        assert!(self.0.is_none_or(far), "the mine went off");
        None
    }

    fn blocked(&self, _: &Ray, _: Interval, _: &mut Scratch) -> bool {
        false
    }

    fn surface(&self, _: &Ray, _: &Hit) -> Surface {
        unreachable!("nothing is hit")
    }
}

/// Keeps all that is painted, and puts rows together.
struct Keeper {
    state: State,
    film: Film,
    rows: u32,
}

fn place(tile: &Tile) -> [u32; 4] {
    [tile.x, tile.y, tile.size[0], tile.size[1]]
}

impl Onlooker for Keeper {
    fn rows(&mut self, rows: &Film) -> ControlFlow<()> {
        self.film.paste(rows, [0, self.rows]);
        self.rows += rows.size[1];
        ControlFlow::Continue(())
    }

    fn recall(&mut self, tile: &Tile) -> Option<(Film, Work)> {
        let (film, note) = self.state.tile(place(tile))?;
        Some((film, serde_json::from_str(&note).unwrap()))
    }

    fn painted(&mut self, slab: &mut Slab, moment: Moment) {
        if moment != Moment::Tile {
            let (film, at) = (&slab.film, slab.at);
            let tiles = slab.fresh.drain(..).map(|(tile, work)| {
                let first = [tile.x - at[0], tile.y - at[1]];
                (place(&tile), serde_json::to_string(&work).unwrap(), first)
            });
            self.state.add(film, tiles);
        }
    }
}

const IDENTITY: Identity = Identity { scene: [1; 32], files: [2; 32], settings: [3; 32], program: [4; 32] };

fn settings() -> Settings {
    Settings { size: [200, 150], samples: 2, aov: vec![Aov::Depth, Aov::Normal], ..Settings::default() }
}

fn painted(scenery: &Mined, state: State) -> (Done, Keeper) {
    let settings = settings();
    let camera = Camera::fit(scenery.bounds());
    let view = View { camera: &camera, lights: &[], materials: &[], ghosts: None, settings: &settings };
    let film = Film::new(settings.size, &settings.aov).unwrap();
    let mut keeper = Keeper { state, film, rows: 0 };
    let done = render_scenery_for(scenery, &view, &Progress::default(), &mut keeper).unwrap();
    assert_eq!(keeper.rows, settings.size[1]);
    (done, keeper)
}

#[test]
fn o10_a_panic_in_a_tile_costs_that_tile_alone() {
    let folder = Folder::new();
    let layout = Layout { window: [0, 0, 200, 150], aovs: settings().aov };
    let mut claim = Claim::new(&folder.path().join("a.png")).unwrap();
    let (done, keeper) = painted(&mined(), claim.begin(&IDENTITY, layout.clone()).unwrap());
    assert!(
        matches!(&done.failed, Some(RenderError::Panicked { message, .. }) if message == "the mine went off")
    );
    assert_eq!(done.tiles, 7 * 5);
    assert!((1..done.tiles).contains(&done.missing), "{} missing", done.missing);
    assert_eq!(keeper.state.len(), done.tiles - done.missing);
    drop((keeper, claim));
    // Where the mine is gone, only the missing tiles are painted.
    let mut claim = Claim::new(&folder.path().join("a.png")).unwrap();
    let (state, found) = claim.resume(&IDENTITY, layout).unwrap().unwrap();
    assert_eq!((found.tiles, found.dropped), (done.tiles - done.missing, 0));
    let (resumed, keeper) = painted(&Mined(None), state);
    assert_eq!((resumed.missing, resumed.recalled, resumed.failed), (0, found.tiles, None));
    let settings = settings();
    let camera = Camera::fit(Mined(None).bounds());
    let view = View { camera: &camera, lights: &[], materials: &[], ghosts: None, settings: &settings };
    let whole = render_scenery(&Mined(None), &view, &Progress::default()).unwrap();
    assert_eq!(keeper.film, whole.film);
    assert_eq!(resumed.work, Work { rays: whole.rays, counts: whole.counts });
    claim.remove();
    assert!(folder.files().is_empty());
}

/// Hashed colours and layers.
fn film(size: [u32; 2], aovs: &[Aov]) -> Film {
    let mut film = Film::new(size, aovs).unwrap();
    film.rgba.iter_mut().enumerate().for_each(|(i, p)| *p = [0, 1, 2, 3].map(|c| unit(c, i as u64) as f32));
    for (seed, layer) in film.layers.iter_mut().enumerate() {
        layer.data.iter_mut().enumerate().for_each(|(i, x)| *x = unit(9 + seed as u64, i as u64) as f32);
    }
    film
}

/// Some rows of a film.
fn rows(film: &Film, from: u32, to: u32) -> Film {
    let width = film.size[0] as usize;
    let [from, to] = [from, to].map(|y| y as usize * width);
    let mut part = film.clone();
    part.size[1] = ((to - from) / width) as u32;
    part.rgba = film.rgba[from..to].to_vec();
    for (part, layer) in part.layers.iter_mut().zip(&film.layers) {
        let n = layer.aov.channels().len();
        part.data = layer.data[from * n..to * n].to_vec();
    }
    part
}

#[test]
fn the_pieces_in_which_rows_come_change_no_byte() {
    let folder = Folder::new();
    let film = film([70, 101], &[Aov::Depth, Aov::Albedo]);
    let aov = vec![Aov::Depth, Aov::Albedo];
    let picture = Picture::new(&Settings { size: film.size, aov, ..Settings::default() });
    let (mut exr, mut png) = (io::Cursor::new(Vec::new()), Vec::new());
    write_exr(&film, &mut exr).unwrap();
    write_png(&film, 0.0, Tone::Agx, &mut png).unwrap();
    for step in [1, 7, 16, 32, 33, 101] {
        for (name, whole) in [("a.exr", exr.get_ref()), ("a.png", &png)] {
            let path = folder.path().join(name);
            let mut file = Growing::begin(&path, &picture).unwrap();
            for y in (0..101).step_by(step) {
                file.rows(&rows(&film, y, (y + step as u32).min(101))).unwrap();
            }
            file.finish(Old::Replaced).unwrap();
            assert!(folder.read(name) == *whole, "{name} in pieces of {step} rows");
        }
    }
    for name in ["b.exr", "b.png"] {
        let mut file = Growing::begin(&folder.path().join(name), &picture).unwrap();
        file.rows(&rows(&film, 0, 100)).unwrap();
        assert!(file.finish(Old::Replaced).is_err(), "a row is missing in {name}");
    }
    assert_eq!(folder.files(), ["a.exr", "a.png"]);
}

/// Takes so many bytes.
#[derive(Clone)]
struct Small(Arc<Mutex<usize>>);

impl Write for Small {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut left = self.0.lock().unwrap();
        let n = bytes.len().min(*left);
        *left -= n;
        if n == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(n) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn o3_a_png_that_finds_no_room_for_any_byte_says_so() {
    let film = film([40, 60], &[]);
    let picture = Picture::new(&Settings { size: film.size, ..Settings::default() });
    let mut png = Vec::new();
    write_png(&film, 0.0, Tone::Agx, &mut png).unwrap();
    let write = |room: usize| -> io::Result<()> {
        let mut rows = PngRows::begin(Small(Arc::new(Mutex::new(room))), &picture)?;
        rows.rows(&film)?;
        Box::new(rows).finish()
    };
    for room in [0, 1, 7, 8, 20, 33, 40, png.len() / 2, png.len() - 12, png.len() - 1] {
        let failed = write(room).expect_err("no room");
        assert_eq!(failed.kind(), io::ErrorKind::StorageFull, "{room} bytes");
    }
    write(png.len()).unwrap();
}

/// A picture of a billion pixels takes no more memory than one of its slabs; of it this makes a strip of the whole width.
#[cfg(target_os = "linux")]
#[test]
fn a_large_picture_takes_little_memory() {
    let folder = Folder::new();
    folder.write("a.pss", "draw sphere(r: 1)\nrender(integrator: \"flat\", samples: 1)\n");
    let peak = |size: &str, crop: &str| {
        let args =
            ["render", "a.pss", "-o", "a.exr", "-o", "a.png", "--size", size, "--crop", crop, "--quiet"];
        let ran = folder.run(&[&args[..], &["--stats-json", "s.json"]].concat());
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let stats: serde_json::Value = serde_json::from_slice(&folder.read("s.json")).unwrap();
        stats["peak_bytes"].as_u64().unwrap()
    };
    let height = if std::env::var_os("PSS_LONG").is_some() { 32768 } else { 512 };
    let [small, large] = [peak("64x64", "0,0,64,64"), peak("32768x32768", &format!("0,0,32768,{height}"))];
    println!("peak: {} MiB, small {} MiB", large >> 20, small >> 20);
    assert!(large < small + (256 << 20), "{} MiB over {} MiB", large >> 20, small >> 20);
}
