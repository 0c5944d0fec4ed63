//! The point of a surface nearest to a point of space: where its normal passes through that point.

use glam::DVec3;

use super::PointSet;
use super::field::FieldScratch;
use super::line::part;
use super::probe::Room;
use crate::mls::{Sample, Stray};
use crate::solid::Crossing;

/// Where a surface is nearest to a point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Foot {
    /// The point of the surface.
    pub at: DVec3,
    /// Outward, of unit length: the surface's normal there, and the gradient of `distance`.
    pub normal: DVec3,
    /// Signed distance, world length; positive outside.
    pub distance: f64,
    /// How far the samples about the foot lean to one side, in widths: near zero inside a sampled surface,
    /// [`PointSet::edge`] where they end.
    pub drift: f64,
    /// The width there.
    pub width: f64,
}

/// The foot is found when its point is off the normal by less than this many widths: the distance is then wrong by its
/// square, 1e-12 of a width.
const ALONG: f64 = 1e-6;
/// And off the surface by less than this many.
const ACROSS: f64 = 1e-12;
/// A step along the surface, widths: F is known to be one branch over so much.
const STRIDE: f64 = 0.5;
/// Steps at most: a handful on a smooth surface; more at creases, where what is reached after so many serves.
const STEPS: usize = 24;
/// A point this many widths off the normal after all steps has no foot here.
const LOOSE: f64 = 0.1;

impl PointSet {
    /// The foot of a point that is sought from a sample (in the order of the hierarchy), a function of both alone.
    ///
    /// Newton's method on F, and in the tangent plane on the distance, whose Hessian there is 1 + k s for curvature k
    /// (measured by how the normal turned with the last step) and height s.
    pub fn foot(&self, of: DVec3, sample: usize, scratch: &mut FieldScratch) -> Result<Foot, Stray> {
        self.foot_from(of, sample, scratch.room())
    }

    pub(super) fn foot_from(&self, of: DVec3, sample: usize, room: &mut Room) -> Result<Foot, Stray> {
        let mut x = self.samples.points[sample];
        let mut before: Option<(DVec3, DVec3)> = None;
        let mut bend = 0.0;
        for step in 1..=STEPS {
            let nearest = self.samples.nearest(x).ok_or(Stray::Sparse)?;
            let width = self.samples.widths[nearest];
            let Sample { value, gradient, drift, .. } = self.field_near(x, nearest, room)?;
            let fall = value / gradient.length_squared();
            let on = x - fall * gradient;
            let normal = gradient.normalize();
            let off = of - on;
            let distance = off.dot(normal);
            let along = off - distance * normal;
            let settled = fall.abs() <= ACROSS * width && along.length() <= ALONG * width;
            if settled || (step == STEPS && along.length() <= LOOSE * width) {
                return Ok(Foot { at: on, normal, distance, drift, width });
            }
            if let Some((x0, n0)) = before {
                let moved = on - x0;
                if (ALONG * width).powi(2) < moved.length_squared() {
                    bend = (normal - n0).dot(moved) / moved.length_squared();
                }
            }
            before = Some((on, normal));
            // Far outside a centre of curvature the Hessian changes sign: the step must still go downhill.
            let damp = 1.0 / (1.0 + bend * distance).max(0.25);
            x = on + (damp * along).clamp_length_max(STRIDE * width);
        }
        Err(Stray::Unsettled)
    }

    /// Whether a crossing lies on the cap of a hole.
    pub fn is_on_cap(crossing: &Crossing) -> bool {
        crossing.part == part::CAP
    }

    /// The drift past which the samples have ended, widths.
    pub fn edge(&self) -> f64 {
        self.kernel.edge()
    }
}
