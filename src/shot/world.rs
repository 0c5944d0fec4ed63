//! What rays meet: the union of all solids drawn, and the sheets beside it.

use glam::DVec3;

use crate::csg::{Boundary, Spans};
use crate::geom::{Aabb, Interval, Ray};
use crate::solid::Scratch;

/// Everything drawn.
#[derive(Debug, Default)]
pub struct World {}

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

impl World {
    /// A box around everything bounded that is drawn; empty where nothing is.
    pub fn bounds(&self) -> Aabb {
        todo!()
    }

    /// The first surface with `t` in `range`.
    pub fn first(&self, _ray: &Ray, _range: Interval, _scratch: &mut Scratch) -> Option<Hit> {
        todo!()
    }

    /// Whether anything lies in `range`.
    pub fn blocked(&self, _ray: &Ray, _range: Interval, _scratch: &mut Scratch) -> bool {
        todo!()
    }

    /// All spans of the union of the solids, clipped to `range`.
    pub fn spans(&self, _ray: &Ray, _range: Interval, _scratch: &mut Scratch, _out: &mut Spans) {
        todo!()
    }

    /// All crossings of sheets in `range`, ascending.
    pub fn sheets(&self, _ray: &Ray, _range: Interval, _scratch: &mut Scratch, _out: &mut Vec<Hit>) {
        todo!()
    }

    /// The surface of a hit.
    pub fn surface(&self, _ray: &Ray, _hit: &Hit, _scratch: &mut Scratch) -> Surface {
        todo!()
    }

    /// The name of a boundary's leaf, as the scene calls it.
    pub fn leaf_name(&self, _hit: &Hit) -> &str {
        todo!()
    }
}
