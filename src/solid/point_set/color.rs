//! The colour of a surface: that of its samples, by the weights that make the surface there.

use std::sync::Arc;

use glam::DVec3;

use super::{Kernel, PointSet};
use crate::mls::{AnyWay, Facing, SameWay, Weight};
use crate::solid::Scratch;

impl PointSet {
    /// The same surface with colours, one a sample in the order of the lists that [`PointSet::new`] was given. Linear.
    pub fn with_colors(&self, colors: &[[f32; 3]]) -> PointSet {
        let sorted: Vec<[f32; 3]> = self.samples.original.iter().map(|i| colors[*i as usize]).collect();
        PointSet { colors: Some(Arc::new(sorted)), ..self.with_body(self.body) }
    }

    /// The colour at a point of the surface: the mean of the samples' by their weights about q, the origin of the
    /// reference plane there, those left out that face another way. On a cap, and wherever F is undefined, there is no
    /// such plane: the colour is the nearest sample's (in its own widths). `None` where samples have no colours.
    pub(in crate::solid) fn color_at(&self, at: DVec3, scratch: &mut Scratch) -> Option<[f32; 3]> {
        let colors = self.colors.as_ref()?;
        let before = scratch.field.projections();
        let field = self.field(at, &mut scratch.field);
        scratch.counts.projections += scratch.field.projections() - before;
        let mean = field.ok().and_then(|f| match self.kernel {
            Kernel::Compact(w) => self.mean_color(w, colors, f.foot, f.plane_normal),
            Kernel::Gaussian(w) => self.mean_color(w, colors, f.foot, f.plane_normal),
        });
        mean.or_else(|| self.samples.nearest_of_all(at).map(|i| colors[i]))
    }

    fn mean_color(
        &self,
        weight: impl Weight,
        colors: &[[f32; 3]],
        q: DVec3,
        outward: DVec3,
    ) -> Option<[f32; 3]> {
        let (mut total, mut sum) = (0.0, DVec3::ZERO);
        self.samples.visit(q, 0.0, weight.support().sqrt(), |i| {
            let h = self.samples.widths[i];
            let facing = self.samples.normal(i).dot(outward);
            let factor = if self.mixed { AnyWay::at(facing) } else { SameWay::at(facing) };
            let w = weight.at((self.samples.points[i] - q).length_squared() / (h * h)) * factor;
            total += w;
            sum += w * DVec3::from_array(colors[i].map(f64::from));
        });
        (0.0 < total).then(|| (sum / total).to_array().map(|c| c as f32))
    }
}
