//! A shot to a film: tiles of a fixed size, each a pure function of shot and place, so that the picture does
//! not depend on threads or on the order of tiles. What rays meet is left to the world, files to
//! [`crate::output`], clocks and messages to the program.

mod filter;
mod frame;
mod ghosts;
mod integrator;
mod judged;
mod layers;
mod lighting;
mod path;
mod pixels;
mod sampler;
mod scenery;
mod slabs;
mod tiles;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

pub use scenery::{Rays, Scenery};
pub use slabs::{Done, Moment, Onlooker, Slab, Work};
pub use tiles::Tile;

use crate::film::{Film, NoRoom};
use crate::shot::{Camera, Light, Material, Settings, Shot, World};
use crate::solid::Counts;
use slabs::Cut;

/// How many pixels are done, and whether more shall be; to be read and told by other threads.
#[derive(Default, Debug)]
pub struct Progress {
    done: AtomicU64,
    stopped: AtomicBool,
    given_up: AtomicBool,
}

impl Progress {
    /// Pixels done, of [`Settings::pixels`].
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// From now on no tile is begun; those under way are painted to their end.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Tiles under way are dropped, too.
    pub fn give_up(&self) {
        self.stop();
        self.given_up.store(true, Ordering::Relaxed);
    }

    /// Whether no more tiles are begun.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    fn gives_up(&self) -> bool {
        self.given_up.load(Ordering::Relaxed)
    }

    fn add(&self, pixels: u64) {
        self.done.fetch_add(pixels, Ordering::Relaxed);
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

impl<'a> From<&'a Shot> for View<'a> {
    fn from(shot: &'a Shot) -> View<'a> {
        View {
            camera: &shot.camera,
            lights: &shot.lights,
            materials: &shot.materials,
            ghosts: shot.ghosts.as_ref(),
            settings: &shot.settings,
        }
    }
}

/// Renders a shot on the threads of the current rayon pool, to a film that is kept whole.
pub fn render(shot: &Shot, progress: &Progress) -> Result<Rendered, RenderError> {
    render_scenery(&shot.world, &View::from(shot), progress)
}

/// Renders a shot on the threads of the current rayon pool, for somebody who looks on. Fails where nothing can be made;
/// what else goes wrong is told in [`Done`], and the rest is made.
pub fn render_for(
    shot: &Shot,
    progress: &Progress,
    onlooker: &mut dyn Onlooker,
) -> Result<Done, RenderError> {
    render_scenery_for(&shot.world, &View::from(shot), progress, onlooker)
}

/// The same of anything that answers rays.
pub fn render_scenery_for<S: Scenery>(
    scenery: &S,
    view: &View,
    progress: &Progress,
    onlooker: &mut dyn Onlooker,
) -> Result<Done, RenderError> {
    slabs::render(scenery, view, progress, onlooker, &Cut::default())
}

/// Renders anything that answers rays to a film that is kept whole.
pub fn render_scenery<S: Scenery>(
    scenery: &S,
    view: &View,
    progress: &Progress,
) -> Result<Rendered, RenderError> {
    render_whole(scenery, view, progress, &Cut::default())
}

fn render_whole<S: Scenery>(
    scenery: &S,
    view: &View,
    progress: &Progress,
    cut: &Cut,
) -> Result<Rendered, RenderError> {
    let mut whole = Whole { film: Film::new(view.settings.window_size(), &view.settings.aov)?, rows: 0 };
    let done = slabs::render(scenery, view, progress, &mut whole, cut)?;
    match done.failed {
        Some(e) => Err(e),
        None => Ok(Rendered { film: whole.film, rays: done.work.rays, counts: done.work.counts }),
    }
}

/// Puts rows together.
struct Whole {
    film: Film,
    rows: u32,
}

impl Onlooker for Whole {
    fn rows(&mut self, rows: &Film) -> ControlFlow<()> {
        self.film.paste(rows, [0, self.rows]);
        self.rows += rows.size[1];
        ControlFlow::Continue(())
    }
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
    fn the_order_of_tiles_and_the_cut_into_slabs_change_no_bit() {
        let camera = Camera::fit(Aabb::of_points([DVec3::ZERO, DVec3::ONE]));
        let aov = crate::film::Aov::ALL.to_vec();
        let settings = Settings { size: [70, 50], samples: 3, aov, ..Settings::default() };
        let view = View { camera: &camera, lights: &[], materials: &[], ghosts: None, settings: &settings };
        let by_hash = |tiles: &mut Vec<Tile>| {
            tiles.sort_by_key(|t| crate::num::hash::mix(u64::from(t.x) << 32 | u64::from(t.y)));
        };
        let a = render_scenery(&Screen, &view, &Progress::default()).unwrap();
        let shuffled = Cut { order: by_hash, ..Cut::default() };
        assert_eq!(a, render_whole(&Screen, &view, &Progress::default(), &shuffled).unwrap());
        // A slab for each row of tiles.
        let b =
            render_whole(&Screen, &view, &Progress::default(), &Cut { slab_bytes: 1, ..shuffled }).unwrap();
        assert_eq!(a, b);
    }
}
