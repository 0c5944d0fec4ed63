//! The way that light takes to the eye, followed backwards: from surface to surface, through glass, to the lights.
//!
//! One loop serves two integrators. For all light every surface sends the path on; for direct light it ends where a surface
//! spreads light evenly, and goes on only in mirrors and through glass. At every surface all lights are aimed at, and what the
//! path's own next direction finds counts as well ([`super::lighting`]).

use glam::{DVec3, Vec3};

use super::frame::Frame;
use super::integrator::Painter;
use super::lighting::{Aimed, Came, TOWARD_PAIR, balance, start, turn_pair};
use super::sampler::Sample;
use super::scenery::{Scenery, Seen, Tracer};
use crate::geom::{Interval, Ray};
use crate::shot::material::finish::{Share, Toward};
use crate::shot::material::glass::Glass;
use crate::shot::material::{Finish, even_share};
use crate::shot::settings::Integrator;
use crate::shot::{Filling, Material, Meeting};

/// The pair of a turn that chooses among ways, and whether the path goes on.
const CHOICE_PAIR: u32 = 255;

/// So many turns a path makes before chance may end it: the first few carry most of the picture.
const SURE_TURNS: u32 = 3;

/// Faces that light passes unbent, one after the other, before a path is given up: each is a body of its own.
const MAX_PASSED: u32 = 4096;

/// A path on its way.
struct Path {
    /// The ray it follows now, of unit length but for the first.
    ray: Ray,
    /// From where on, in multiples of the ray's direction.
    after: f64,
    /// What light is multiplied with on the way back to the eye, but for the growth of radiance in dense media.
    left: Vec3,
    /// That growth.
    growth: f32,
    /// How often it has turned.
    turns: u32,
    /// How its direction was chosen.
    came: Came,
    /// Whether the eye sees what it meets, be it through glass or in mirrors.
    from_eye: bool,
    /// Whether it has met anything but bodies that do not bend it.
    touched: bool,
    /// Light found.
    light: Vec3,
    /// What light that has turned counts for at most.
    most: f32,
}

impl Path {
    fn add(&mut self, light: Vec3) {
        let light = light * self.left * self.growth;
        let brightest = light.max_element();
        let counts = if 0 < self.turns && self.most < brightest { self.most / brightest } else { 1.0 };
        self.light += light * counts;
    }

    /// Goes on in a new direction.
    fn turn(&mut self, origin: DVec3, dir: DVec3, came: Came) {
        self.ray = Ray::new(origin, dir);
        (self.after, self.came) = (0.0, came);
        self.turns += 1;
    }
}

impl<S: Scenery> Painter<'_, S> {
    /// The colour and coverage that a ray from the eye brings back, of which it is known what it sees.
    pub(super) fn light(
        &self,
        tracer: &mut Tracer<S>,
        ray: &Ray,
        seen: Option<&Seen>,
        sample: Sample,
    ) -> [f32; 4] {
        let mut path = Path {
            ray: *ray,
            after: 0.0,
            left: Vec3::ONE,
            growth: 1.0,
            turns: 0,
            came: Came::Eye,
            from_eye: true,
            touched: false,
            light: Vec3::ZERO,
            most: self.view.settings.clamp.map_or(f32::INFINITY, |most| most as f32),
        };
        let mut goes_on = self.first_step(tracer, &mut path, seen, sample);
        let mut passed = 0;
        while goes_on && passed < MAX_PASSED {
            passed = if 0.0 < path.after { passed + 1 } else { 0 };
            tracer.rays.bounce += u64::from(path.after == 0.0);
            let met = tracer.meet(&path.ray, path.after);
            goes_on = self.step(tracer, &mut path, &met, sample);
        }
        let covered = path.touched || self.lights.has_open();
        let [r, g, b] = path.light.to_array();
        [r, g, b, f32::from(u8::from(covered))]
    }

    /// The first step. Where what the eye sees first of the union of all is opaque, that is all there is to know.
    fn first_step(
        &self,
        tracer: &mut Tracer<S>,
        path: &mut Path,
        seen: Option<&Seen>,
        sample: Sample,
    ) -> bool {
        let is_plain = |seen: &Seen| {
            seen.hit.entering && !seen.hit.sheet && !self.material(seen.surface.material).is_clear()
        };
        if tracer.is_clear() && !seen.is_some_and(is_plain) {
            let met = tracer.meet(&path.ray, 0.0);
            return self.step(tracer, path, &met, sample);
        }
        let Some(seen) = seen else {
            path.add(self.lights.open(path.ray.dir.normalize_or_zero(), path.came));
            return false;
        };
        self.opaque(tracer, path, seen, sample)
    }

    /// Takes in the light of what was met, and chooses where to go on; false where the path ends.
    fn step(&self, tracer: &mut Tracer<S>, path: &mut Path, met: &Meeting, sample: Sample) -> bool {
        let length = path.ray.dir.length();
        let until = met.hit.map(|hit| hit.boundary.t);
        if let Filling::Clear(index) = met.before {
            let way = (until.unwrap_or(f64::INFINITY) - path.after) * length;
            path.left *= self.glass(index).map_or(Vec3::ONE, |glass| glass.left(way));
        }
        path.add(self.lights.found(&path.ray, path.after, until, path.came));
        let Some(hit) = met.hit else { return false };
        let seen = tracer.seen(&path.ray, hit);
        let Some((glass, ratio)) = self.bend(met, &seen) else {
            return self.opaque(tracer, path, &seen, sample);
        };
        if ratio == 1.0 {
            path.after = met.end.next_up();
            return true;
        }
        path.touched = true;
        self.through(path, &seen, glass, ratio, sample) && self.survives(path, sample)
    }

    /// Takes in the light of an opaque surface and goes on where anything is left.
    fn opaque(&self, tracer: &mut Tracer<S>, path: &mut Path, seen: &Seen, sample: Sample) -> bool {
        path.touched = true;
        self.surface(tracer, path, seen, sample) && self.survives(path, sample)
    }

    /// Ends a path that has turned by chance where little is left of its light, and makes up for that where it goes on.
    fn survives(&self, path: &mut Path, sample: Sample) -> bool {
        if self.view.settings.bounces < path.turns {
            return false;
        }
        if path.turns <= SURE_TURNS {
            return path.left != Vec3::ZERO;
        }
        let chance = path.left.max_element().min(1.0);
        path.left /= chance;
        choices(sample, path.turns - 1)[1] < f64::from(chance)
    }

    /// The glass of a face between clear bodies, and the index before it over that beyond; `None` of an opaque face.
    fn bend(&self, met: &Meeting, seen: &Seen) -> Option<(&Glass, f64)> {
        if seen.hit.sheet || met.before == Filling::Opaque || met.beyond == Filling::Opaque {
            return None;
        }
        let of = |filling| match filling {
            Filling::Clear(index) => self.glass(index),
            _ => None,
        };
        let (before, beyond) = (of(met.before), of(met.beyond));
        let ior = |glass: Option<&Glass>| glass.map_or(1.0, |glass| glass.ior);
        let painted = (seen.surface.material as usize) < self.view.materials.len();
        let own = self.material(seen.surface.material).finish.glass();
        if painted && own.is_none() {
            return None;
        }
        let face = own.or(beyond).or(before)?;
        Some((face, ior(before) / ior(beyond)))
    }

    /// Goes on at a face between clear bodies.
    fn through(&self, path: &mut Path, seen: &Seen, glass: &Glass, ratio: f64, sample: Sample) -> bool {
        let frame = Frame::new(seen.normal);
        let eye = frame.to(-path.ray.dir.normalize_or_zero());
        let place = sample.pair(turn_pair(path.turns, TOWARD_PAIR));
        if eye.z <= 0.0 {
            return false;
        }
        let Some(turn) = glass.turn(ratio, eye, place, choices(sample, path.turns)[0]) else { return false };
        path.left *= turn.weight as f32;
        let side = if turn.through { -seen.surface.offset } else { seen.surface.offset };
        let came = match path.came {
            // Through glass the eye sees what it would see without: no lights themselves.
            Came::Eye if turn.through => Came::Eye,
            _ => Came::Sharp,
        };
        if turn.through {
            // Radiance over the square of the index stays the same.
            path.growth *= (ratio * ratio) as f32;
        }
        path.turn(seen.surface.point + side * seen.normal, frame.from(turn.dir), came);
        true
    }

    /// Takes in the light of an opaque surface and chooses where to go on.
    fn surface(&self, tracer: &mut Tracer<S>, path: &mut Path, seen: &Seen, sample: Sample) -> bool {
        let finish = self.material(seen.surface.material).finish.as_ref();
        let color = Vec3::from_array(self.albedo(tracer, seen));
        path.add(finish.glow(color));
        if 0.0 <= seen.normal.dot(path.ray.dir) {
            return false;
        }
        let all = self.view.settings.integrator == Integrator::Path;
        let sends = Sends::new(finish, color, seen, &path.ray);
        let own = |share: &Share| [share.density, if all { share.density } else { share.pointed }];
        let ray = path.ray;
        self.lights.aim(&ray, seen, sample, path.turns, path.from_eye, |aimed| {
            let share = sends.share(aimed.dir);
            let counts = aimed.density.map_or(1.0, |d| balance(d, own(&share)[usize::from(!aimed.open)]));
            let light = share.value * aimed.light * counts;
            if light != Vec3::ZERO
                && let Some(left) = self.reaches(tracer, aimed)
            {
                path.add(light * left);
            }
        });
        let is_even = matches!(sends, Sends::Evenly { .. });
        if is_even && !all && !self.lights.is_open_bright() {
            return false;
        }
        let (frame, eye) = sends.frame_and_eye();
        let place = sample.pair(turn_pair(path.turns, TOWARD_PAIR));
        let lobe = if is_even { 0.0 } else { choices(sample, path.turns)[0] };
        let Some(toward) = finish.toward(color, eye, place, lobe) else { return false };
        self.follow(tracer, path, seen, &frame, &toward, |dir| own(&sends.share(dir)))
    }

    /// Goes on in a direction that a surface chose.
    fn follow(
        &self,
        tracer: &mut Tracer<S>,
        path: &mut Path,
        seen: &Seen,
        frame: &Frame,
        toward: &Toward,
        own: impl Fn(DVec3) -> [f64; 2],
    ) -> bool {
        path.left *= toward.weight;
        let dir = frame.from(toward.dir);
        let came = if toward.sharp { Came::Sharp } else { Came::Spread(own(dir)) };
        if toward.even && self.view.settings.integrator == Integrator::Direct {
            let ray = Ray::new(start(seen), dir);
            let open =
                Aimed { dir, ray, range: Interval::AHEAD, light: Vec3::ONE, density: None, open: true };
            if self.lights.is_open_bright()
                && let Some(left) = self.reaches(tracer, &open)
            {
                path.add(self.lights.open(dir, came) * left);
            }
            return false;
        }
        let side = if toward.dir.z < 0.0 { -seen.surface.offset } else { seen.surface.offset };
        path.from_eye &= !toward.even;
        path.turn(seen.surface.point + side * seen.normal, dir, came);
        true
    }

    /// What is left of light that was aimed at; `None` where something is in the way.
    #[inline]
    fn reaches(&self, tracer: &mut Tracer<S>, aimed: &Aimed) -> Option<Vec3> {
        if aimed.range.is_empty() {
            return Some(Vec3::ONE);
        }
        if !tracer.is_clear() {
            return (!tracer.shadowed(&aimed.ray, aimed.range)).then_some(Vec3::ONE);
        }
        // Light passes what does not bend it; what bends it leads elsewhere.
        tracer.rays.shadow += 1;
        let (mut left, mut after) = (Vec3::ONE, aimed.range.lo);
        for _ in 0..MAX_PASSED {
            let met = tracer.meet(&aimed.ray, after);
            let reached = met.hit.is_none_or(|hit| aimed.range.hi < hit.boundary.t);
            let until = if reached { aimed.range.hi } else { met.end };
            if let Filling::Clear(index) = met.before {
                let way = (until - after) * aimed.ray.dir.length();
                left *= self.glass(index).map_or(Vec3::ONE, |glass| glass.left(way));
            }
            let Some(hit) = met.hit.filter(|_| !reached) else { return Some(left) };
            let seen = tracer.seen(&aimed.ray, hit);
            if self.bend(&met, &seen).is_none_or(|(_, ratio)| ratio != 1.0) {
                return None;
            }
            after = met.end.next_up();
        }
        None
    }

    fn glass(&self, index: u32) -> Option<&Glass> {
        self.material(index).finish.glass()
    }

    pub(super) fn material(&self, index: u32) -> &Material {
        Material::of(self.view.materials, index)
    }
}

/// How a surface sends light on to the eye, asked in directions of the world.
enum Sends<'a> {
    /// Evenly: neither the eye nor a frame is needed.
    Evenly { color: Vec3, normal: DVec3 },
    /// By where the eye is.
    Toward { finish: &'a dyn Finish, color: Vec3, frame: Frame, eye: DVec3 },
}

impl<'a> Sends<'a> {
    fn new(finish: &'a dyn Finish, color: Vec3, seen: &Seen, ray: &Ray) -> Sends<'a> {
        if finish.is_even() {
            return Sends::Evenly { color, normal: seen.normal };
        }
        let frame = Frame::new(seen.normal);
        Sends::Toward { finish, color, frame, eye: frame.to(-ray.dir.normalize_or_zero()) }
    }

    /// The frame of the surface, and where the eye is in it, which is not asked for what is sent evenly.
    fn frame_and_eye(&self) -> (Frame, DVec3) {
        match self {
            Sends::Evenly { normal, .. } => (Frame::new(*normal), DVec3::Z),
            Sends::Toward { frame, eye, .. } => (*frame, *eye),
        }
    }

    fn share(&self, dir: DVec3) -> Share {
        match self {
            Sends::Evenly { color, normal } => even_share(*color, normal.dot(dir)),
            Sends::Toward { finish, color, frame, eye } => finish.share(*color, *eye, frame.to(dir)),
        }
    }
}

/// Numbers to choose by at a turn: among ways, and whether the path goes on. They take as long as a short ray, so they are made
/// where something is chosen.
fn choices(sample: Sample, turn: u32) -> [f64; 2] {
    sample.pair(turn_pair(turn, CHOICE_PAIR))
}
