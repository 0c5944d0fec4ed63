//! Volumes and areas of single solids that know them in closed form, wherever they stand.
//!
//! An affine map M changes volumes by |det M|, a similarity by s areas by s^2; other maps leave no closed form of an area. The bar
//! is that of roundings: of a few products, and of lengths that are differences of coordinates.

use super::Known;
use crate::geom::tolerance;
use crate::lang::Measured;

/// What is known without lines.
pub(super) struct Exactly {
    pub volume: Measured,
    pub area: Option<Measured>,
}

impl Known {
    /// Of one solid from which nothing is taken; `None` of others, and of those that are nothing.
    pub(super) fn exact(&self) -> Option<Exactly> {
        let (world, outline) = (self.world(), &self.prepared.outline);
        let [leaf] = world.solids().leaves() else { return None };
        let is_alone = world.open().is_empty() && outline.cuts.is_empty() && outline.meetings.is_empty();
        let (place, bounds) = (&leaf.place, leaf.solid.bounds());
        let least = bounds.size().min_element();
        let exact = leaf.solid.exact().filter(|_| is_alone && bounds.is_finite() && 0.0 < least)?;
        let share = tolerance::noise(1.0 + bounds.farthest() / least) * place.condition;
        let measured = |value: f64| Measured { value, err: share * value, size: value, is_open: false };
        // A similarity to roundings.
        let is_similar = place.condition <= 1.0 + tolerance::noise(1.0);
        let by_area = |area: f64| is_similar.then(|| measured(area * place.stretch * place.stretch));
        let grows = place.world_from_local.matrix3.determinant().abs();
        Some(Exactly { volume: measured(exact.volume * grows), area: exact.area.and_then(by_area) })
    }
}
