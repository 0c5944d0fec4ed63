//! A shot to a film: tiles of a fixed size, each a pure function of shot and place, so that the picture does
//! not depend on threads or on the order of tiles. What rays meet is left to the world, files to
//! [`crate::output`], clocks and messages to the program.

mod filter;
mod ghosts;
mod integrator;
mod layers;
mod lighting;
mod path;
mod pixels;
mod sampler;
mod scenery;
mod tiles;

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rayon::prelude::*;

pub use scenery::{Rays, Scenery};

use crate::film::{Film, NoRoom};
use crate::shot::{Camera, Light, Material, Settings, Shot, World};
use crate::solid::Counts;
use integrator::Painter;
use tiles::Tile;

/// How many pixels are done; to be read by another thread.
#[derive(Default, Debug)]
pub struct Progress {
    done: AtomicU64,
}

impl Progress {
    /// Pixels done, of [`Settings::pixels`].
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }
}

/// How a world is seen: all of a [`Shot`] but the world.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// From where.
    pub camera: &'a Camera,
    /// In which light; none: [`crate::shot::light::DEFAULT`].
    pub lights: &'a [Light],
    /// Materials by the index that a surface carries; beyond the end: the default.
    pub materials: &'a [Material],
    /// What is seen through before all else.
    pub ghosts: Option<&'a World>,
    /// Size, samples and so on.
    pub settings: &'a Settings,
}

/// A picture and what it took.
#[derive(Clone, PartialEq, Debug)]
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// Rays traced.
    pub rays: Rays,
    /// Work of the world.
    pub counts: Counts,
}

/// Why there is no picture.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum RenderError {
    /// Too little memory.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// The program went wrong in a tile.
    #[error("a tile at pixel {}, {} could not be rendered: {message}", at[0], at[1])]
    Panicked {
        /// The tile's first pixel.
        at: [u32; 2],
        /// What the panic said.
        message: String,
    },
}

/// Renders a shot on the threads of the current rayon pool.
pub fn render(shot: &Shot, progress: &Progress) -> Result<Rendered, RenderError> {
    let view = View {
        camera: &shot.camera,
        lights: &shot.lights,
        materials: &shot.materials,
        ghosts: shot.ghosts.as_ref(),
        settings: &shot.settings,
    };
    render_scenery(&shot.world, &view, progress)
}

/// Renders anything that answers rays.
pub fn render_scenery<S: Scenery>(
    scenery: &S,
    view: &View,
    progress: &Progress,
) -> Result<Rendered, RenderError> {
    render_tiles(scenery, view, progress, tiles::cover(view.settings.window()))
}

/// Renders tiles, whose order is of no consequence.
fn render_tiles<S: Scenery>(
    scenery: &S,
    view: &View,
    progress: &Progress,
    tiles: Vec<Tile>,
) -> Result<Rendered, RenderError> {
    let settings = view.settings;
    let film = Mutex::new(Film::new(settings.window_size(), &settings.aov)?);
    let [x0, y0, ..] = settings.window();
    let painter = Painter::new(scenery, view);
    let failed = AtomicBool::new(false);
    let work: Vec<(Rays, Counts)> = tiles
        .par_iter()
        .map(|tile| {
            if failed.load(Ordering::Relaxed) {
                return Ok(Default::default());
            }
            let (part, rays, counts) = paint_caught(&painter, tile).inspect_err(|_| {
                failed.store(true, Ordering::Relaxed);
            })?;
            // Nothing panics while the lock is held, so a poisoned lock still guards a whole film.
            film.lock().unwrap_or_else(|e| e.into_inner()).paste(&part, [tile.x - x0, tile.y - y0]);
            progress.done.fetch_add(tile.pixels(), Ordering::Relaxed);
            Ok((rays, counts))
        })
        .collect::<Result<_, RenderError>>()?;
    let mut rays = Rays::default();
    let mut counts = Counts::default();
    for (r, c) in &work {
        rays.add(r);
        counts.add(c);
    }
    Ok(Rendered { film: film.into_inner().unwrap_or_else(|e| e.into_inner()), rays, counts })
}

/// Paints a tile; a panic becomes an error that says where.
fn paint_caught<S: Scenery>(painter: &Painter<S>, tile: &Tile) -> Result<(Film, Rays, Counts), RenderError> {
    let painted = catch_unwind(AssertUnwindSafe(|| painter.tile(tile)));
    painted.unwrap_or_else(|panic| {
        Err(RenderError::Panicked { at: [tile.x, tile.y], message: panic_message(&*panic) })
    })
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic".to_owned())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::csg::{Boundary, Scratch};
    use crate::geom::{Aabb, Interval, Ray};
    use crate::shot::{Hit, Surface};
    use crate::solid::Crossing;

    /// Meets every ray that goes to the right, facing it; the sky is half covered.
    struct Screen;

    impl Scenery for Screen {
        fn bounds(&self) -> Aabb {
            Aabb::EMPTY
        }

        fn first(&self, ray: &Ray, _: Interval, scratch: &mut Scratch) -> Option<Hit> {
            scratch.solid.counts.leaf_queries += 1;
            let crossing = Crossing::exact(1.0, true, 0);
            let normal = -ray.dir.normalize();
            let boundary = Boundary { t: 1.0, leaf: 0, crossing, normal, flipped: false, filler: None };
            (0.0 < ray.dir.x).then_some(Hit { boundary, entering: true, sheet: false })
        }

        fn blocked(&self, ray: &Ray, _: Interval, _: &mut Scratch) -> bool {
            0.0 < ray.dir.z
        }

        fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
            Surface { point: ray.at(hit.boundary.t), normal: hit.boundary.normal, material: 0, offset: 0.0 }
        }
    }

    #[test]
    fn the_order_of_tiles_changes_no_bit() {
        let camera = Camera::fit(Aabb::of_points([DVec3::ZERO, DVec3::ONE]));
        let aov = crate::film::Aov::ALL.to_vec();
        let settings = Settings { size: [70, 50], samples: 3, aov, ..Settings::default() };
        let view = View { camera: &camera, lights: &[], materials: &[], ghosts: None, settings: &settings };
        let forward = tiles::cover(settings.window());
        let mut shuffled = forward.clone();
        shuffled.sort_by_key(|t| crate::num::hash::mix(u64::from(t.x) << 32 | u64::from(t.y)));
        let a = render_tiles(&Screen, &view, &Progress::default(), forward).unwrap();
        let b = render_tiles(&Screen, &view, &Progress::default(), shuffled).unwrap();
        assert_eq!(a, b);
    }
}
