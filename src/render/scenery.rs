//! What an integrator asks of the world, as a trait, so that tests can render closed forms without it; and
//! the counting of rays.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::csg::{Bundle, Scratch, Spans};
use crate::geom::{Aabb, Beam, Interval, Ray};
use crate::shot::{Hit, Meeting, Surface, World};

/// Something that answers rays.
pub trait Scenery: Sync {
    /// A box around everything bounded in it.
    fn bounds(&self) -> Aabb;

    /// The first surface with `t` in `range`.
    fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<Hit>;

    /// What rays of a beam may meet.
    fn bundle(&self, _beam: &Beam) -> Bundle {
        Bundle::default()
    }

    /// The same for a beam within that of a bundle.
    fn part_of_bundle(&self, _bundle: &Bundle, _beam: &Beam) -> Bundle {
        Bundle::default()
    }

    /// The first surface that a ray of a bundle meets from its start on.
    fn first_of(&self, _bundle: &Bundle, ray: &Ray, scratch: &mut Scratch) -> Option<Hit> {
        self.first(ray, Interval::AHEAD, scratch)
    }

    /// Whether anything lies in `range`.
    fn blocked(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool;

    /// Whether light goes through any solid.
    fn is_clear(&self) -> bool {
        false
    }

    /// What a ray meets first past `after`, faces between like and like left out.
    fn meet(&self, ray: &Ray, after: f64, scratch: &mut Scratch) -> Meeting {
        Meeting::opaque(self.first(ray, Interval::new(after, f64::INFINITY), scratch))
    }

    /// The surface of a hit.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;

    /// The spans of solids from the ray's start on.
    fn spans(&self, _ray: &Ray, _scratch: &mut Scratch) -> Spans {
        Spans::new()
    }

    /// The number of what is drawn that a face belongs to, from 1.
    fn owner(&self, _hit: &Hit) -> u32 {
        1
    }

    /// The number of the leaf that a face belongs to, from 1.
    fn leaf(&self, hit: &Hit) -> u64 {
        u64::from(hit.boundary.leaf) + 1
    }

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

    fn bundle(&self, beam: &Beam) -> Bundle {
        self.solids().bundle(beam)
    }

    fn part_of_bundle(&self, bundle: &Bundle, beam: &Beam) -> Bundle {
        self.solids().part_of_bundle(bundle, beam)
    }

    fn first_of(&self, bundle: &Bundle, ray: &Ray, scratch: &mut Scratch) -> Option<Hit> {
        World::first_of(self, bundle, ray, Interval::AHEAD, scratch)
    }

    fn blocked(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> bool {
        World::blocked(self, ray, range, scratch)
    }

    fn is_clear(&self) -> bool {
        World::is_clear(self)
    }

    fn meet(&self, ray: &Ray, after: f64, scratch: &mut Scratch) -> Meeting {
        World::meet(self, ray, after, scratch)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        World::surface(self, ray, hit)
    }

    fn spans(&self, ray: &Ray, scratch: &mut Scratch) -> Spans {
        let mut spans = Spans::new();
        World::spans(self, ray, Interval::AHEAD, scratch, &mut spans);
        spans
    }

    fn owner(&self, hit: &Hit) -> u32 {
        World::owner(self, hit)
    }

    fn leaf(&self, hit: &Hit) -> u64 {
        World::leaf(self, hit)
    }

    fn color(&self, hit: &Hit, point: DVec3, scratch: &mut Scratch) -> Option<[f32; 3]> {
        World::color(self, hit, point, scratch)
    }
}

/// How many rays were traced.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(default)]
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
    /// The world.
    pub scenery: &'a S,
    /// Room and counts of the world.
    pub scratch: Scratch,
    /// Rays so far.
    pub rays: Rays,
    /// What rays from the eye may meet now.
    pub bundle: Bundle,
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
        Tracer { scenery, scratch: Scratch::default(), rays: Rays::default(), bundle: Bundle::default() }
    }

    /// What the eye sees along a ray of the bundle.
    #[inline(always)]
    pub fn see(&mut self, ray: &Ray) -> Option<Seen> {
        self.rays.camera += 1;
        let hit = self.scenery.first_of(&self.bundle, ray, &mut self.scratch)?;
        Some(self.seen(ray, hit))
    }

    /// A face as it is seen along a ray.
    #[inline(always)]
    pub fn seen(&self, ray: &Ray, hit: Hit) -> Seen {
        let surface = self.scenery.surface(ray, &hit);
        let away = if hit.sheet { 0.0 < surface.normal.dot(ray.dir) } else { !hit.entering };
        Seen { hit, surface, normal: if away { -surface.normal } else { surface.normal } }
    }

    /// Whether light goes through any solid.
    pub fn is_clear(&self) -> bool {
        self.scenery.is_clear()
    }

    /// What a ray meets first past `after`; faces between like and like are passed.
    pub fn meet(&mut self, ray: &Ray, after: f64) -> Meeting {
        self.scenery.meet(ray, after, &mut self.scratch)
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
