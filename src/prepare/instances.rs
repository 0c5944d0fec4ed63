//! What stands in several places, or twice in one, lowered once.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::groups::{Inherited, Prototype, address};
use super::lower::{Context, Lowered, Lowering, placed};
use crate::csg::{Expr, Leaf, Object};
use crate::deep;
use crate::diag::Diagnostic;
use crate::scene::{BooleanOp, Shape};

/// A shape with all that decides which leaves come of it: the node, what it inherits, the bits of its place.
pub(super) type Repeat = (usize, Inherited, [u64; 12]);

impl Lowering<'_, '_> {
    /// Lowers a shape.
    pub(super) fn lower(&mut self, shape: &Shape, context: Context) -> Result<Lowered, Diagnostic> {
        if context.edits.is_some() || !self.groups.may_repeat(shape) {
            return self.lower_once(shape, context);
        }
        let place = context.world_from_local.to_cols_array().map(f64::to_bits);
        let repeat = (address(shape), context.inherited(), place);
        if let Some(known) = self.repeats.get(&repeat) {
            return Ok(Lowered::Solid(Expr::Shared(known.clone())));
        }
        match self.lower_once(shape, context)? {
            Lowered::Solid(expr) => {
                let shared = Arc::new(expr);
                self.repeats.insert(repeat, shared.clone());
                Ok(Lowered::Solid(Expr::Shared(shared)))
            }
            sheets => Ok(sheets),
        }
    }

    fn lower_once(&mut self, shape: &Shape, context: Context) -> Result<Lowered, Diagnostic> {
        if context.edits.is_none()
            && self.groups.wants(shape)
            && let Some(instance) = self.instance(shape, context)?
        {
            return Ok(instance);
        }
        deep::step(|| self.lower_here(shape, context))
    }

    /// A use of a shape that is an object of its own; `None` where it is none, but sheets.
    fn instance(&mut self, shape: &Shape, context: Context) -> Result<Option<Lowered>, Diagnostic> {
        let Some(Prototype { object, origin }) = self.prototype(shape, context)? else { return Ok(None) };
        let place = placed(context.world_from_local * DAffine3::from_translation(origin), shape.0.at)?;
        Ok(Some(Lowered::Solid(self.push(Leaf::instance(&object, place), shape.0.at))))
    }

    /// The object of a shape, made at its first use.
    fn prototype(&mut self, shape: &Shape, context: Context) -> Result<Option<Prototype>, Diagnostic> {
        let key = (address(shape), context.inherited());
        if let Some(known) = self.groups.made.get(&key) {
            return Ok(known.clone());
        }
        let bounds = self.extent(shape, &DAffine3::IDENTITY)?;
        let is_bounded = bounds.is_finite() && !bounds.is_empty();
        let origin = if is_bounded { bounds.center() } else { DVec3::ZERO };
        let mut own = Lowering::new(self.builder, self.measure_all);
        std::mem::swap(&mut own.groups, &mut self.groups);
        let moved = Context { world_from_local: DAffine3::from_translation(-origin), ..context };
        let lowered = deep::step(|| own.lower_here(shape, moved));
        let Lowering { leaves, groups, repeats, .. } = own;
        drop(repeats);
        self.groups = groups;
        let made = match lowered? {
            Lowered::Solid(expr) => Some(Prototype { object: Object::new(leaves, &expr), origin }),
            Lowered::Sheets(_) => None,
        };
        self.groups.made.insert(key, made.clone());
        Ok(made)
    }
}

impl Context<'_> {
    fn inherited(&self) -> Inherited {
        let Context { material, cut, cutter, turned, wanted, .. } = *self;
        let wanted = wanted.map(|(sign, _)| sign == BooleanOp::Union.sign());
        Inherited { material, cut, cutter, turned, wanted }
    }
}
