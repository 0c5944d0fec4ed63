//! A picture made slab by slab from its top, so that the memory it takes does not grow with its height. Somebody looks on,
//! takes the rows as they are done, and may keep tiles and give them back in a later run; what becomes of rows and tiles is
//! left to them.

use std::any::Any;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::integrator::Painter;
use super::scenery::{Rays, Scenery};
use super::tiles::{self, SIDE, Tile};
use super::{Progress, RenderError, View};
use crate::film::{Film, pixel_bytes};
use crate::shot::Settings;
use crate::solid::Counts;

/// What a slab takes, bytes, if a row of tiles does not take more. A slab ends when its last tile does, and threads wait for
/// that: two thousand tiles of colours make it a short wait. A picture of 1920 x 1080 is one slab.
const SLAB_BYTES: u64 = 32 << 20;

/// What was done.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct Work {
    /// Rays traced.
    pub rays: Rays,
    /// Work of the world.
    pub counts: Counts,
}

/// Part of a picture: all its columns, and the rows of some rows of tiles.
#[derive(Debug)]
pub struct Slab {
    /// Its pixels; those of tiles not painted yet are empty.
    pub film: Film,
    /// Its first pixel in the whole picture.
    pub at: [u32; 2],
    /// Tiles painted in this run; whoever looks on may take them out when they are kept.
    pub fresh: Vec<(Tile, Work)>,
}

/// When somebody looks on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Moment {
    /// A tile was painted.
    Tile,
    /// All tiles of the slab were painted, and its film is about to go away.
    Slab,
    /// The same of a slab in which tiles are missing, or that comes after one.
    Broken,
}

/// Takes what is made.
pub trait Onlooker: Send {
    /// Takes the next rows of the picture, from its top; tiles that are missing are empty. Once it breaks, no more come.
    fn rows(&mut self, rows: &Film) -> ControlFlow<()>;

    /// A tile that was kept in an earlier run.
    fn recall(&mut self, _tile: &Tile) -> Option<(Film, Work)> {
        None
    }

    /// Asked after every tile, one at a time.
    fn painted(&mut self, _slab: &mut Slab, _moment: Moment) {}
}

/// What was done, and what not.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Done {
    /// The work, that of tiles from earlier runs among it.
    pub work: Work,
    /// How many tiles there are.
    pub tiles: u64,
    /// Of those, how many came from earlier runs.
    pub recalled: u64,
    /// How many are missing: the render was stopped, or went wrong in them.
    pub missing: u64,
    /// What went wrong in the first tile in which something did, by its place.
    pub failed: Option<RenderError>,
}

/// How a picture is cut into slabs, and in which order tiles are painted: of no consequence for any pixel.
pub(super) struct Cut {
    pub slab_bytes: u64,
    pub order: fn(&mut Vec<Tile>),
}

impl Default for Cut {
    fn default() -> Cut {
        Cut { slab_bytes: SLAB_BYTES, order: |_| {} }
    }
}

/// Renders for somebody who looks on.
pub(super) fn render<S: Scenery>(
    scenery: &S,
    view: &View,
    progress: &Progress,
    onlooker: &mut dyn Onlooker,
    cut: &Cut,
) -> Result<Done, RenderError> {
    let painter = Painter::new(scenery, view);
    let mut done = Done::default();
    let [x0, mut y, x1, y1] = view.settings.window();
    let rows = slab_rows(view.settings, cut.slab_bytes);
    while y < y1 {
        let end = (y / SIDE * SIDE).saturating_add(rows).min(y1);
        let mut tiles = tiles::cover([x0, y, x1, end]);
        (cut.order)(&mut tiles);
        let film = Film::new([x1 - x0, end - y], &view.settings.aov)?;
        let mut slab = Slab { film, at: [x0, y], fresh: Vec::new() };
        done.slab(&painter, progress, onlooker, &tiles, &mut slab);
        if let Some(RenderError::NoRoom(_)) = done.failed {
            progress.stop();
        }
        if onlooker.rows(&slab.film).is_break() {
            done.missing += tiles::count([x0, end, x1, y1]);
            done.tiles += tiles::count([x0, end, x1, y1]);
            break;
        }
        y = end;
    }
    Ok(done)
}

/// How many rows a slab has: those of at least one row of tiles.
fn slab_rows(settings: &Settings, bytes: u64) -> u32 {
    let row = u64::from(settings.window_size()[0]) * pixel_bytes(&settings.aov);
    let rows = (bytes / row).min(u64::from(u32::MAX)) as u32;
    (rows / SIDE * SIDE).max(SIDE)
}

impl Done {
    /// Paints the tiles of a slab that no earlier run has.
    fn slab<S: Scenery>(
        &mut self,
        painter: &Painter<S>,
        progress: &Progress,
        onlooker: &mut dyn Onlooker,
        tiles: &[Tile],
        slab: &mut Slab,
    ) {
        let mut open = Vec::new();
        for tile in tiles {
            match onlooker.recall(tile) {
                Some((film, work)) => {
                    slab.film.paste(&film, slab.place(tile));
                    self.work.add(&work);
                    self.recalled += 1;
                    progress.add(tile.pixels());
                }
                None => open.push(*tile),
            }
        }
        let shared = Mutex::new((&mut *slab, &mut *onlooker));
        let paint = |tile: &Tile| -> Result<Option<Work>, RenderError> {
            if progress.is_stopped() {
                return Ok(None);
            }
            let (film, work) = paint_caught(painter, tile, progress)?;
            if progress.gives_up() {
                return Ok(None);
            }
            progress.add(tile.pixels());
            // What a panic of the onlooker leaves is still a film with whole tiles in it.
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let (slab, onlooker) = &mut *shared;
            slab.film.paste(&film, slab.place(tile));
            slab.fresh.push((*tile, work));
            onlooker.painted(slab, Moment::Tile);
            Ok(Some(work))
        };
        let results: Vec<_> = open.par_iter().map(paint).collect();
        for result in results {
            match result {
                Ok(Some(work)) => self.work.add(&work),
                Ok(None) => self.missing += 1,
                Err(e) => {
                    self.missing += 1;
                    self.failed.get_or_insert(e);
                }
            }
        }
        self.tiles += tiles.len() as u64;
        onlooker.painted(slab, if self.missing == 0 { Moment::Slab } else { Moment::Broken });
    }
}

impl Slab {
    /// The first pixel of a tile in the film.
    pub fn place(&self, tile: &Tile) -> [u32; 2] {
        [tile.x - self.at[0], tile.y - self.at[1]]
    }
}

impl Work {
    /// Adds another tile's work.
    pub fn add(&mut self, o: &Work) {
        self.rays.add(&o.rays);
        self.counts.add(&o.counts);
    }
}

/// Paints a tile; a panic becomes an error that says where.
fn paint_caught<S: Scenery>(
    painter: &Painter<S>,
    tile: &Tile,
    progress: &Progress,
) -> Result<(Film, Work), RenderError> {
    let painted = catch_unwind(AssertUnwindSafe(|| painter.tile(tile, progress)));
    let panicked = |panic: Box<dyn Any + Send>| {
        Err(RenderError::Panicked { at: [tile.x, tile.y], message: panic_message(&*panic) })
    };
    painted.unwrap_or_else(panicked).map(|(film, rays, counts)| (film, Work { rays, counts }))
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic".to_owned())
}
