//! What rays meet: the union of all solids drawn, and the sheets beside it.

use glam::DVec3;

use super::clear::{Clear, Meeting};
use crate::csg::{self, Boundary, Bundle, Leaf, Object, Part, Spans};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::solid::Crossing;

/// Everything drawn.
#[derive(Debug, Default)]
pub struct World {
    solids: Object,
    sheets: Vec<Leaf>,
    bounds: Aabb,
    /// The material of a face that has none.
    bare: u32,
    /// The solids by what fills them, where some are clear.
    clear: Option<Clear>,
    owners: Owners,
}

/// Which faces belong to what is drawn.
#[derive(Debug, Default)]
pub struct Owners {
    /// For each solid drawn the first of its leaves and its number, in the order written.
    pub solids: Vec<(u32, u32)>,
    /// For each sheet the number of what it belongs to.
    pub sheets: Vec<u32>,
}

/// The first thing a ray meets.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Hit {
    /// Where and on which leaf.
    pub boundary: Boundary,
    /// Whether the ray goes into a solid here (false: it comes out, having begun inside).
    pub entering: bool,
    /// Whether the leaf is a sheet.
    pub sheet: bool,
}

/// A crossing of a sheet; its normal is not asked for yet.
struct OnSheet<'a> {
    leaf: &'a Leaf,
    index: usize,
    local: &'a Ray,
    crossing: &'a Crossing,
}

impl OnSheet<'_> {
    fn hit(&self, scratch: &mut csg::Scratch) -> Hit {
        let normal = self.leaf.normal(self.local, self.crossing, &mut scratch.solid);
        let (t, leaf, crossing) = (self.crossing.t, self.index as u32, *self.crossing);
        let boundary = Boundary { t, leaf, crossing, normal, flipped: false, filler: None };
        Hit { boundary, entering: crossing.entering, sheet: true }
    }
}

/// The surface at a crossing, world frame.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Surface {
    /// The point.
    pub point: DVec3,
    /// The outward unit normal of the object (of a sheet: of its own orientation).
    pub normal: DVec3,
    /// Index into [`super::Shot::materials`].
    pub material: u32,
    /// How far a ray that leaves has to start from `point` along the normal so that it does not meet this
    /// surface again, world length.
    pub offset: f64,
}

/// Whether a ray can be traced; one that cannot is counted.
#[inline]
fn counted(ray: &Ray, scratch: &mut csg::Scratch) -> bool {
    let valid = ray.is_valid();
    scratch.solid.counts.invalid_rays += u64::from(!valid);
    valid
}

impl World {
    /// The union of `solids` and the sheets beside it. `bounds` is a box around what is bounded, `bare` the material
    /// of faces that have none.
    pub fn new(solids: Object, sheets: Vec<Leaf>, bounds: Aabb, bare: u32) -> World {
        World { solids, sheets, bounds, bare, clear: None, owners: Owners::default() }
    }

    /// The same where it is known what was drawn, so that faces can be told apart by it ([`World::owner`]).
    pub fn with_owners(self, owners: Owners) -> World {
        World { owners, ..self }
    }

    /// The number of what is drawn that a face belongs to, from 1 in the order written.
    pub fn owner(&self, hit: &Hit) -> u32 {
        if hit.sheet {
            return self.owners.sheets.get(hit.boundary.leaf as usize).copied().unwrap_or(0);
        }
        let leaf = self.solids.holder(hit.boundary.leaf);
        let past = self.owners.solids.partition_point(|(first, _)| *first <= leaf);
        past.checked_sub(1).map_or(0, |last| self.owners.solids[last].1)
    }

    /// The number of the leaf that a face belongs to, from 1: those of solids in the order written, then those of sheets.
    pub fn leaf(&self, hit: &Hit) -> u64 {
        let before = if hit.sheet { u64::from(self.solids.leaf_count()) } else { 0 };
        before + u64::from(hit.boundary.leaf) + 1
    }

    /// The same where light goes through some of the solids.
    pub fn with_clear(self, clear: Clear) -> World {
        World { clear: Some(clear), ..self }
    }

    /// Whether light goes through any of the solids.
    pub fn is_clear(&self) -> bool {
        self.clear.is_some()
    }

    /// What a ray meets first past `after`, faces between like and like left out, and what fills the space on both sides of
    /// it. Where nothing is clear solids are opaque.
    pub fn meet(&self, ray: &Ray, after: f64, scratch: &mut csg::Scratch) -> Meeting {
        match &self.clear {
            Some(clear) if counted(ray, scratch) => clear.meet(self, ray, after, scratch),
            Some(_) => Meeting::opaque(None),
            None => Meeting::opaque(self.first(ray, Interval::new(after, f64::INFINITY), scratch)),
        }
    }

    /// The union of the solids.
    pub fn solids(&self) -> &Object {
        &self.solids
    }

    /// The sheets.
    pub fn open(&self) -> &[Leaf] {
        &self.sheets
    }

    /// A box around everything bounded that is drawn; empty where nothing is.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The first surface with `t` in `range`; a ray that is none ([`Ray::is_valid`]) meets nothing and is counted, here
    /// and in what else asks for surfaces.
    pub fn first(&self, ray: &Ray, range: Interval, scratch: &mut csg::Scratch) -> Option<Hit> {
        self.first_of(&Bundle::default(), ray, range, scratch)
    }

    /// The same for a ray of a bundle of [`World::solids`] and a range from 0 or later on, sooner.
    #[inline]
    pub fn first_of(
        &self,
        bundle: &Bundle,
        ray: &Ray,
        range: Interval,
        scratch: &mut csg::Scratch,
    ) -> Option<Hit> {
        if !counted(ray, scratch) {
            return None;
        }
        let solid = self.solids.first_of(bundle, ray, range, scratch);
        let solid = solid.map(|(boundary, entering)| Hit { boundary, entering, sheet: false });
        self.sheet_before(solid, ray, range, scratch)
    }

    /// The first crossing of a sheet in the range.
    pub(super) fn first_sheet(&self, ray: &Ray, range: Interval, scratch: &mut csg::Scratch) -> Option<Hit> {
        self.sheet_before(None, ray, range, scratch)
    }

    /// The first crossing of a sheet in the range up to a hit, else that.
    #[inline(always)]
    fn sheet_before(
        &self,
        mut best: Option<Hit>,
        ray: &Ray,
        range: Interval,
        scratch: &mut csg::Scratch,
    ) -> Option<Hit> {
        for index in 0..self.sheets.len() {
            let end = best.as_ref().map_or(range.hi, |hit| hit.boundary.t.min(range.hi));
            self.sheet(index, ray, Interval::new(range.lo, end), scratch, |found, scratch| {
                best = Some(found.hit(scratch));
                false
            });
        }
        best
    }

    /// Whether anything lies in `range`.
    #[inline]
    pub fn blocked(&self, ray: &Ray, range: Interval, scratch: &mut csg::Scratch) -> bool {
        counted(ray, scratch)
            && (self.solids.any(ray, range, scratch)
                || (0..self.sheets.len()).any(|index| {
                    let mut any = false;
                    self.sheet(index, ray, range, scratch, |_, _| {
                        any = true;
                        false
                    });
                    any
                }))
    }

    /// All spans of the union of the solids, clipped to `range`.
    pub fn spans(&self, ray: &Ray, range: Interval, scratch: &mut csg::Scratch, out: &mut Spans) {
        if counted(ray, scratch) {
            self.solids.spans(ray, range, scratch, out);
        }
    }

    /// All crossings of sheets in `range`, ascending.
    pub fn sheets(&self, ray: &Ray, range: Interval, scratch: &mut csg::Scratch, out: &mut Vec<Hit>) {
        if !counted(ray, scratch) {
            return;
        }
        for index in 0..self.sheets.len() {
            self.sheet(index, ray, range, scratch, |found, scratch| {
                out.push(found.hit(scratch));
                true
            });
        }
        out.sort_by(|a, b| a.boundary.t.total_cmp(&b.boundary.t));
    }

    /// Shows a sheet's crossings in the range to `go_on`, ascending, until it returns false.
    #[inline]
    fn sheet(
        &self,
        index: usize,
        ray: &Ray,
        range: Interval,
        scratch: &mut csg::Scratch,
        mut go_on: impl FnMut(OnSheet, &mut csg::Scratch) -> bool,
    ) {
        let leaf = &self.sheets[index];
        let range = leaf.met(ray).intersect(range);
        let local = leaf.place.ray_to_local(ray);
        let mut found = std::mem::take(&mut scratch.found);
        let mut lo = range.lo;
        'rest: while lo <= range.hi {
            found.clear();
            let rest = Interval::new(lo, range.hi);
            let answer = leaf.crossings(&local, rest, &mut scratch.solid, &mut found);
            for crossing in found.iter().filter(|c| lo < c.t && c.t <= range.hi) {
                if !go_on(OnSheet { leaf, index, local: &local, crossing }, scratch) {
                    break 'rest;
                }
            }
            if answer.range.hi <= lo {
                break;
            }
            lo = answer.range.hi;
        }
        scratch.found = found;
    }

    #[inline]
    fn part(&self, hit: &Hit) -> Part<'_> {
        self.part_of(&hit.boundary, hit.sheet)
    }

    /// The leaf of a boundary.
    #[inline]
    pub(super) fn part_of(&self, boundary: &Boundary, is_sheet: bool) -> Part<'_> {
        let index = boundary.leaf;
        if is_sheet { Part::of(&self.sheets[index as usize]) } else { self.solids.part(index) }
    }

    /// The surface of a hit.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let Part { leaf, stretch, scale, .. } = self.part(hit);
        let boundary = &hit.boundary;
        let point = ray.at(boundary.t);
        let filler = boundary.filler.and_then(|f| self.solids.part(f).leaf.material);
        let scale = point.length().max(ray.origin.length()).max(scale);
        let bound = boundary.crossing.shift.max(leaf.solid.shift_bound()) * stretch;
        // A crossing that is known to lie within `err` lies within this along the normal.
        let error = bound.max(boundary.crossing.err * ray.dir.dot(boundary.normal).abs());
        Surface {
            point,
            normal: boundary.normal,
            material: leaf.material.or(filler).unwrap_or(self.bare),
            // Twice: the ray that leaves has an error of its own at the same face.
            offset: 2.0 * (error + tolerance::cleanup(scale)),
        }
    }

    /// The linear colour that the leaf of a hit itself has there.
    pub fn color(&self, hit: &Hit, point: DVec3, scratch: &mut csg::Scratch) -> Option<[f32; 3]> {
        let Part { leaf, local_from_world, .. } = self.part(hit);
        leaf.solid.color(local_from_world.transform_point3(point), &mut scratch.solid)
    }

    /// Half the width, in `t`, of what a crossing at a surface may be off by: what its solid knows, and roundings
    /// ([`tolerance::rounded`]).
    pub fn error(&self, ray: &Ray, hit: &Hit, surface: &Surface) -> f64 {
        let scale = ray.origin.length().max(surface.point.length()).max(self.part(hit).leaf.scale());
        let length = ray.dir.length();
        hit.boundary.crossing.err + tolerance::rounded(scale, surface.normal.dot(ray.dir) / length) / length
    }

    /// The name of a boundary's leaf, as the scene calls it.
    pub fn leaf_name(&self, hit: &Hit) -> &str {
        &self.part(hit).leaf.name
    }

    /// The name of the leaf of a span's boundary.
    pub fn name(&self, boundary: &Boundary) -> &str {
        &self.solids.part(boundary.leaf).leaf.name
    }
}
