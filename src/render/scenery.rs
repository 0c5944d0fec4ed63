//! What an integrator asks of the world, as a trait, so that tests can render closed forms without it; and
//! the counting of rays.

use glam::DVec3;

use crate::csg::Scratch;
use crate::geom::{Aabb, Interval, Ray};
use crate::shot::{Hit, Surface, World};

/// Something that answers rays.
pub trait Scenery: Sync {
    /// A box around everything bounded in it.
    fn bounds(&self) -> Aabb;

    /// The first surface with `t` in `range`.
    fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<Hit>;

    /// Whether anything lies in `range`.
    fn blocked(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool;

    /// The surface of a hit.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;

    /// The linear colour that what was hit has itself.
    fn color(&self, _hit: &Hit, _point: DVec3, _scratch: &mut Scratch) -> Option<[f32; 3]> {
        None
    }
}

impl Scenery for World {
    fn bounds(&self) -> Aabb {
        World::bounds(self)
    }

    fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<Hit> {
        World::first(self, ray, range, scratch)
    }

    fn blocked(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool {
        World::blocked(self, ray, range, scratch)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        World::surface(self, ray, hit)
    }

    fn color(&self, hit: &Hit, point: DVec3, scratch: &mut Scratch) -> Option<[f32; 3]> {
        World::color(self, hit, point, scratch)
    }
}

/// How many rays were traced.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub struct Rays {
    /// From the eye.
    pub camera: u64,
    /// To a light or the sky.
    pub shadow: u64,
    /// From surface to surface.
    pub bounce: u64,
}

impl Rays {
    /// Adds another tile's rays.
    pub fn add(&mut self, o: &Rays) {
        self.camera += o.camera;
        self.shadow += o.shadow;
        self.bounce += o.bounce;
    }
}

/// Traces rays of one tile and counts them.
pub struct Tracer<'a, S> {
    scenery: &'a S,
    /// Room and counts of the world.
    pub scratch: Scratch,
    /// Rays so far.
    pub rays: Rays,
}

/// A surface that the eye sees.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// What was met.
    pub hit: Hit,
    /// The surface there.
    pub surface: Surface,
    /// The unit normal on the eye's side: of sheets, and of solids seen from inside, turned to the eye.
    pub normal: DVec3,
}

impl<'a, S: Scenery> Tracer<'a, S> {
    /// Starts a tile.
    pub fn new(scenery: &'a S) -> Tracer<'a, S> {
        Tracer { scenery, scratch: Scratch::default(), rays: Rays::default() }
    }

    /// What the eye sees along a ray.
    pub fn see(&mut self, ray: &Ray) -> Option<Seen> {
        self.rays.camera += 1;
        let hit = self.scenery.first(ray, Interval::AHEAD, &mut self.scratch)?;
        let surface = self.scenery.surface(ray, &hit);
        let away = if hit.sheet { 0.0 < surface.normal.dot(ray.dir) } else { !hit.entering };
        Some(Seen { hit, surface, normal: if away { -surface.normal } else { surface.normal } })
    }

    /// The colour that what the eye sees has itself.
    pub fn color(&mut self, seen: &Seen) -> Option<[f32; 3]> {
        self.scenery.color(&seen.hit, seen.surface.point, &mut self.scratch)
    }

    /// Whether something lies between a surface and what sends it light.
    pub fn shadowed(&mut self, ray: &Ray, range: Interval) -> bool {
        self.rays.shadow += 1;
        self.scenery.blocked(ray, range, &mut self.scratch)
    }
}
