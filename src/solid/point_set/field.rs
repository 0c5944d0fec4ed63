//! F at a point of space, for those who do not come along a line: projecting samples, measuring, tests.

use glam::DVec3;

use super::PointSet;
use super::probe::Room;
use crate::mls::{Sample, Stray};

/// Room for asking about points, one for each thread; it holds no answers from point to point.
#[derive(Debug, Default)]
pub struct FieldScratch(Room);

impl FieldScratch {
    /// Solves of plane and polynomial so far.
    pub fn projections(&self) -> u64 {
        self.0.work.projections
    }

    pub(super) fn room(&mut self) -> &mut Room {
        &mut self.0
    }
}

impl PointSet {
    /// F and its gradient at a point, the very ones that crossings are found with.
    ///
    /// Fails with [`Stray::Sparse`] outside all trust spheres, with [`Stray::Ended`] where the samples have ended, and
    /// with the other reasons where the projection does.
    pub fn field(&self, at: DVec3, scratch: &mut FieldScratch) -> Result<Sample, Stray> {
        let sample = self.samples.nearest(at).ok_or(Stray::Sparse)?;
        let field = self.field_near(at, sample, &mut scratch.0)?;
        if self.has_ended(sample, &field, &scratch.0) { Err(Stray::Ended) } else { Ok(field) }
    }

    /// The width that scales things at a point inside a trust sphere: that of the sample nearest in its own widths.
    pub fn width_at(&self, at: DVec3) -> Option<f64> {
        self.samples.nearest(at).map(|i| self.samples.widths[i])
    }
}
