//! Which clear bodies a ray is in, and what it meets next where there are any.
//!
//! The union of all that is drawn has no faces within it, but light is bent where glass and liquid touch. So the solids stand
//! here once more, by what fills them: one object of all that is opaque, one for each clear material. Each says along the
//! whole ray where it is inside, so that a ray needs no memory: whether it starts in glass is told by the first face it meets,
//! and an error at one face is forgotten at the next. Faces of several objects that coincide, as the clean-up of CSG has it,
//! are one face: between a liquid and the glass that holds it there is then no film of air, and where a gap is left, there
//! is one.

use super::world::{Hit, World};
use crate::csg::{Boundary, Object, Scratch, Spans};
use crate::geom::{Interval, Ray, tolerance};

/// What fills space.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Filling {
    /// Nothing, or air.
    Empty,
    /// A clear material, by its index.
    Clear(u32),
    /// Something that light does not enter.
    Opaque,
}

/// The solids of a world by what fills them.
#[derive(Debug, Default)]
pub struct Clear {
    /// Objects over the leaves of the world's union. Where several are at a place, the first fills it.
    shares: Vec<(Option<u32>, Object)>,
}

/// What a ray meets.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Meeting {
    /// The face; nothing where space ends first.
    pub hit: Option<Hit>,
    /// What fills the space before it.
    pub before: Filling,
    /// What fills the space beyond it.
    pub beyond: Filling,
    /// Where the last of the faces is that are one with it.
    pub end: f64,
}

impl Meeting {
    /// A face of something opaque in the open, or nothing.
    pub fn opaque(hit: Option<Hit>) -> Meeting {
        let beyond = if hit.is_some_and(|hit| !hit.sheet) { Filling::Opaque } else { Filling::Empty };
        let end = hit.map_or(f64::INFINITY, |hit| hit.boundary.t);
        Meeting { hit, before: Filling::Empty, beyond, end }
    }
}

/// The first face of one share.
struct First {
    filling: Filling,
    /// The face and whether the ray goes in there.
    face: Option<(Boundary, bool)>,
    /// Whether the ray begins inside.
    inside: bool,
}

impl Clear {
    /// Objects over the leaves of the world's union, by their clear material (`None`: opaque), the first to win first.
    pub fn new(shares: Vec<(Option<u32>, Object)>) -> Clear {
        Clear { shares }
    }

    /// What a ray meets first past `after`, faces between like and like left out, and what fills the space before and beyond.
    pub(super) fn meet(&self, world: &World, ray: &Ray, mut after: f64, scratch: &mut Scratch) -> Meeting {
        loop {
            let range = Interval::new(after, f64::INFINITY);
            let firsts: Vec<First> = self
                .shares
                .iter()
                .map(|(clear, object)| first(*clear, object, ray, range, scratch))
                .collect();
            let faces = || firsts.iter().filter_map(|f| f.face);
            let nearest = faces().min_by(|(a, _), (b, _)| a.t.total_cmp(&b.t)).map(|(face, _)| face);
            let before = filling(&firsts, |f| f.inside);
            if let Some(hit) = first_sheet(world, ray, after, nearest.as_ref(), scratch) {
                return Meeting { hit: Some(hit), before, beyond: before, end: hit.boundary.t };
            }
            let Some(nearest) = nearest else {
                return Meeting { hit: None, before, beyond: before, end: f64::INFINITY };
            };
            let joined =
                |f: &First| f.face.is_some_and(|(face, _)| is_one(world, ray, &nearest, &face, false));
            let beyond = filling(&firsts, |f| f.inside != joined(f));
            let owner = |filling| {
                let found = firsts.iter().find(|f| f.filling == filling && joined(f))?;
                found.face.map(|(boundary, entering)| Hit { boundary, entering, sheet: false })
            };
            let last = firsts.iter().filter(|f| joined(f)).filter_map(|f| f.face).map(|(face, _)| face.t);
            let end = last.fold(nearest.t, f64::max);
            // Who looks from within something opaque sees where it ends, and nothing else. Any other face is that of what begins
            // there, else of what ends there.
            let hit = match before {
                Filling::Opaque => owner(before),
                _ if before == beyond => None,
                _ => owner(beyond).or_else(|| owner(before)),
            };
            if hit.is_some() {
                return Meeting { hit, before, beyond, end };
            }
            after = end.next_up();
        }
    }
}

/// What fills a place where only shares that a test holds of are.
fn filling(firsts: &[First], is_there: impl Fn(&First) -> bool) -> Filling {
    firsts.iter().find(|f| is_there(f)).map_or(Filling::Empty, |f| f.filling)
}

fn first(clear: Option<u32>, object: &Object, ray: &Ray, range: Interval, scratch: &mut Scratch) -> First {
    let filling = clear.map_or(Filling::Opaque, Filling::Clear);
    let face = object.first(ray, range, scratch);
    let inside = match face {
        Some((_, entering)) => !entering,
        None if object.bounds().is_finite() => false,
        // Nothing ends something without bounds that the ray is in.
        None => {
            let mut spans = Spans::new();
            object.spans(ray, range, scratch, &mut spans);
            !spans.is_empty()
        }
    };
    First { filling, face, inside }
}

/// The first sheet before a face or on it: glass may stand on a floor.
fn first_sheet(
    world: &World,
    ray: &Ray,
    after: f64,
    face: Option<&Boundary>,
    scratch: &mut Scratch,
) -> Option<Hit> {
    let Some(face) = face else {
        return world.first_sheet(ray, Interval::new(after, f64::INFINITY), scratch);
    };
    let length = ray.dir.length();
    let scale = ray.at(face.t).length().max(ray.origin.length()).max(world.solids().part(face.leaf).scale);
    let on_it = tolerance::rounded(scale, face.normal.dot(ray.dir) / length) / length;
    let hit = world.first_sheet(ray, Interval::new(after, face.t + on_it), scratch)?;
    (hit.boundary.t <= face.t || is_one(world, ray, face, &hit.boundary, true)).then_some(hit)
}

/// Whether two faces, of which the second may be that of a sheet, cannot be told apart, as in the clean-up of an object.
fn is_one(world: &World, ray: &Ray, a: &Boundary, b: &Boundary, is_sheet: bool) -> bool {
    let slope = ray.dir.dot(a.normal).abs().max(ray.dir.dot(b.normal).abs());
    let [of_a, of_b] = [world.solids().part(a.leaf), world.part_of(b, is_sheet)];
    let scale = ray.at(a.t).length().max(ray.origin.length()).max(of_a.scale).max(of_b.scale);
    let error = a.crossing.shift * of_a.stretch + b.crossing.shift * of_b.stretch;
    (b.t - a.t) * slope <= tolerance::cleanup(scale) + error
}
