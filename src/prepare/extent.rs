//! Boxes around shapes before they are placed: what `.fit` measures.

use glam::DAffine3;

use super::bounding::bounded_by;
use super::groups::address;
use super::lower::Lowering;
use crate::deep;
use crate::diag::Diagnostic;
use crate::geom::Aabb;
use crate::scene::{BooleanOp, Operand, Shape, ShapeKind};

impl Lowering<'_, '_> {
    /// A box around the image of a shape: tight for leaves and unions but those of a million solids in many places; for the
    /// other operators that of what they are cut from, less what half-spaces along the axes take away. Sides are unbounded where
    /// the shape is.
    pub(super) fn extent(&mut self, shape: &Shape, to_from: &DAffine3) -> Result<Aabb, Diagnostic> {
        if !self.groups.is_vast(shape) {
            return deep::step(|| self.extent_here(shape, to_from));
        }
        let known = self.groups.extents.get(&address(shape)).copied();
        let own = known.map_or_else(|| deep::step(|| self.extent_here(shape, &DAffine3::IDENTITY)), Ok)?;
        self.groups.extents.insert(address(shape), own);
        Ok(own.transformed_sides(to_from))
    }

    fn extent_here(&mut self, shape: &Shape, to_from: &DAffine3) -> Result<Aabb, Diagnostic> {
        match &shape.0.kind {
            ShapeKind::Leaf { call, .. } => {
                let solid = self.any_solid(shape)?;
                match bounded_by(call) {
                    Some((_, bounding)) => {
                        Ok(self.extent(bounding, to_from)?.intersection(solid.extent_under(to_from)))
                    }
                    None if solid.bounds().is_finite() => Ok(solid.extent_under(to_from)),
                    None => Ok(solid.limits()[0].transformed_sides(to_from)),
                }
            }
            ShapeKind::Transform { world_from_local, child } => {
                self.extent(child, &(*to_from * *world_from_local))
            }
            ShapeKind::Fit { child, .. } => {
                let fitted = self.fit(shape)?;
                self.extent(child, &(*to_from * fitted))
            }
            ShapeKind::With { child, .. } | ShapeKind::Cut { child, .. } | ShapeKind::Close { child, .. } => {
                self.extent(child, to_from)
            }
            ShapeKind::Thicken { by, child } => Ok(grown(self.extent(child, to_from)?, 0.5 * by, to_from)),
            ShapeKind::Offset { by, child } => Ok(grown(self.extent(child, to_from)?, *by, to_from)),
            ShapeKind::Clip { by, child } => {
                Ok(self.extent(child, to_from)?.intersection(self.extent(&by.shape, to_from)?))
            }
            ShapeKind::Boolean { op, operands } => self.extent_of(*op, operands, to_from),
        }
    }

    fn extent_of(
        &mut self,
        op: BooleanOp,
        operands: &[Operand],
        to_from: &DAffine3,
    ) -> Result<Aabb, Diagnostic> {
        let mut all = if op == BooleanOp::Intersection { Aabb::ALL } else { Aabb::EMPTY };
        for (i, operand) in operands.iter().enumerate() {
            let shape = &operand.shape;
            all = match op {
                BooleanOp::Intersection => all.intersection(self.extent(shape, to_from)?),
                BooleanOp::Difference if 0 < i => all.intersection(self.extent_outside(shape, to_from)?),
                BooleanOp::Complement => self.extent_outside(shape, to_from)?,
                _ => all.union(self.extent(shape, to_from)?),
            };
        }
        Ok(all)
    }

    /// A box around all that is outside of the image of a shape.
    fn extent_outside(&mut self, shape: &Shape, to_from: &DAffine3) -> Result<Aabb, Diagnostic> {
        if self.groups.is_vast(shape) {
            return Ok(Aabb::ALL);
        }
        deep::step(|| match &shape.0.kind {
            ShapeKind::Leaf { call, .. } if bounded_by(call).is_none() => {
                Ok(self.any_solid(shape)?.limits()[1].transformed_sides(to_from))
            }
            ShapeKind::Transform { world_from_local, child } => {
                self.extent_outside(child, &(*to_from * *world_from_local))
            }
            ShapeKind::With { child, .. } | ShapeKind::Cut { child, .. } => {
                self.extent_outside(child, to_from)
            }
            ShapeKind::Boolean { op: BooleanOp::Complement, operands } => {
                operands.iter().try_fold(Aabb::EMPTY, |all, o| Ok(all.union(self.extent(&o.shape, to_from)?)))
            }
            ShapeKind::Boolean { op: BooleanOp::Union, operands } => {
                let outside =
                    |all: Aabb, o: &Operand| Ok(all.intersection(self.extent_outside(&o.shape, to_from)?));
                operands.iter().try_fold(Aabb::ALL, outside)
            }
            ShapeKind::Boolean { op: BooleanOp::Intersection, operands } => {
                let outside = |all: Aabb, o: &Operand| Ok(all.union(self.extent_outside(&o.shape, to_from)?));
                operands.iter().try_fold(Aabb::EMPTY, outside)
            }
            _ => Ok(Aabb::ALL),
        })
    }
}

/// A box grown by the image of a ball, which reaches the length of the map's row along each axis.
fn grown(bounds: Aabb, by: f64, to_from: &DAffine3) -> Aabb {
    let rows = to_from.matrix3.transpose();
    let reach = by * glam::DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
    Aabb { min: bounds.min - reach, max: bounds.max + reach }
}
