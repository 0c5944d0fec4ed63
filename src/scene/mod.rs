//! The description of a picture: what was written, resolved and typed. It knows names and places in the text,
//! but no geometry and no files.

mod decl;
pub mod formula;
mod value;

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize, Serializer};

pub use decl::{BuildError, Catalog, Decl, Group, Kind, Param};
pub use formula::Formula;
pub use value::{Arg, Call, Value};

use crate::deep;
use crate::source::Span;

/// A whole scene.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Scene {
    /// What is drawn, in the order written.
    pub draws: Vec<Draw>,
    /// What pictures show as something to see through, and nothing else knows of.
    #[serde(default)]
    pub ghosts: Vec<Draw>,
    /// Cameras with their names; the first is the default. Calls of [`Group::Camera`].
    pub cameras: Vec<Named>,
    /// Lights. Calls of [`Group::Light`].
    pub lights: Vec<Named>,
    /// Materials that shapes refer to by [`MaterialId`]. Calls of [`Group::Material`].
    pub materials: Vec<Call>,
    /// The `render` item; `None` where the scene has none.
    pub render: Option<Call>,
    /// What the `print` items say, in the order written.
    pub prints: Vec<String>,
}

/// The most shapes that a scene may be to be written out.
pub const MAX_WRITTEN_OUT: u64 = 1_000_000;

impl Scene {
    /// How many shapes it is when written out, as serialising does: those that are used twice count twice.
    pub fn written_out(&self) -> u64 {
        let mut known = HashMap::new();
        self.draws
            .iter()
            .chain(&self.ghosts)
            .fold(0, |sum, draw| draw.shape.written_out(&mut known).saturating_add(sum))
    }
}

impl Scene {
    /// A scene of those of some shapes that are no part of what this one draws.
    pub fn of_idle(&self, shapes: &[Draw]) -> Scene {
        let mut known = HashMap::new();
        for draw in self.draws.iter().chain(&self.ghosts) {
            draw.shape.written_out(&mut known);
        }
        let idle = shapes.iter().filter(|draw| !known.contains_key(&Arc::as_ptr(&draw.shape.0)));
        Scene { draws: idle.cloned().collect(), materials: self.materials.clone(), ..Scene::default() }
    }
}

/// An item that may carry a name of its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Named {
    /// The label, such as `sun` in `light sun(...)`.
    pub name: Option<String>,
    /// What it is.
    pub call: Call,
}

/// One `draw`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Draw {
    /// What.
    pub shape: Shape,
    /// The place of the expression drawn.
    pub at: Span,
}

/// Index into [`Scene::materials`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MaterialId(pub u32);

/// A shape as a value: cheap to copy, shared where it was named once and used twice.
#[derive(Clone, Debug, Deserialize)]
pub struct Shape(pub Arc<ShapeNode>);

/// A chain of operators may be deeper than the stack.
impl Serialize for Shape {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        deep::step(|| self.0.serialize(to))
    }
}

/// A node of the shape's tree and the place of the expression that made it.
#[derive(Debug, Serialize, Deserialize)]
pub struct ShapeNode {
    /// What it is.
    pub kind: ShapeKind,
    /// Where it was written.
    pub at: Span,
}

impl Shape {
    /// A shape of its own.
    pub fn new(kind: ShapeKind, at: Span) -> Shape {
        Shape(Arc::new(ShapeNode { kind, at }))
    }

    fn written_out(&self, known: &mut HashMap<*const ShapeNode, u64>) -> u64 {
        if let Some(count) = known.get(&Arc::as_ptr(&self.0)) {
            return *count;
        }
        let mut add = |sum: u64, part: &Shape| sum.saturating_add(deep::step(|| part.written_out(known)));
        let mut count = self.0.kind.children().fold(1, &mut add);
        if let ShapeKind::Leaf { call, .. } = &self.0.kind {
            let given = call.args.values().filter_map(|arg| match &arg.value {
                Value::Shape(shape) => Some(shape),
                _ => None,
            });
            count = given.fold(count, &mut add);
        }
        known.insert(Arc::as_ptr(&self.0), count);
        count
    }
}

impl ShapeKind {
    /// The shapes that this node is made of; those among a primitive's arguments are not.
    pub fn children(&self) -> impl Iterator<Item = &Shape> {
        let (operands, one, by): (&[Operand], _, _) = match self {
            ShapeKind::Leaf { .. } => (&[], None, None),
            ShapeKind::Boolean { operands, .. } => (operands, None, None),
            ShapeKind::Transform { child, .. }
            | ShapeKind::Fit { child, .. }
            | ShapeKind::With { child, .. }
            | ShapeKind::Cut { child, .. }
            | ShapeKind::Close { child, .. }
            | ShapeKind::Thicken { child, .. }
            | ShapeKind::Offset { child, .. } => (&[], Some(child), None),
            ShapeKind::Clip { child, by } => (&[], Some(child), Some(&by.shape)),
        };
        operands.iter().map(|o| &o.shape).chain(one).chain(by)
    }

    /// Moves the shapes below this node into `out`.
    fn take_children(&mut self, out: &mut Vec<Shape>) {
        let nothing = ShapeKind::Boolean { op: BooleanOp::Union, operands: Vec::new() };
        match std::mem::replace(self, nothing) {
            ShapeKind::Leaf { call, .. } => {
                out.extend(call.args.into_iter().filter_map(|(_, a)| match a.value {
                    Value::Shape(shape) => Some(shape),
                    _ => None,
                }))
            }
            ShapeKind::Boolean { operands, .. } => out.extend(operands.into_iter().map(|o| o.shape)),
            ShapeKind::Transform { child, .. }
            | ShapeKind::Fit { child, .. }
            | ShapeKind::With { child, .. }
            | ShapeKind::Cut { child, .. }
            | ShapeKind::Close { child, .. }
            | ShapeKind::Thicken { child, .. }
            | ShapeKind::Offset { child, .. } => out.push(child),
            ShapeKind::Clip { child, by } => out.extend([child, by.shape]),
        }
    }
}

/// Without recursion: a scene may nest operators deeper than the stack.
impl Drop for ShapeNode {
    fn drop(&mut self) {
        let mut open = Vec::new();
        self.kind.take_children(&mut open);
        while let Some(shape) = open.pop() {
            if let Some(mut node) = Arc::into_inner(shape.0) {
                node.kind.take_children(&mut open);
            }
        }
    }
}

/// Kinds of node.
#[derive(Debug, Serialize, Deserialize)]
pub enum ShapeKind {
    /// A primitive: a call of [`Group::Primitive`].
    Leaf {
        /// The call, its arguments checked against the declaration.
        call: Call,
        /// The name of the `let` it was written in, else the word of the call.
        name: String,
    },
    /// Operands combined; a complement has one, a difference its base first.
    Boolean {
        /// The operator.
        op: BooleanOp,
        /// What is combined, in the order written, lists flattened.
        operands: Vec<Operand>,
    },
    /// An affine image.
    Transform {
        /// The map.
        world_from_local: DAffine3,
        /// What is mapped.
        child: Shape,
    },
    /// Scaled uniformly and moved so that the middle of the bottom of its bounds lies at a point.
    Fit {
        /// The point, scene units.
        at: DVec3,
        /// What the bounds shall measure.
        to: FitTo,
        /// What is fitted.
        child: Shape,
    },
    /// A material for every leaf below that has none, except cutters.
    With {
        /// The material.
        material: MaterialId,
        /// What wears it.
        child: Shape,
    },
    /// A material for every cutter below that has none: what `-`, `difference` and `!` take away.
    Cut {
        /// The material.
        material: MaterialId,
        /// What is cut.
        child: Shape,
    },
    /// The holes of a scan capped.
    Close {
        /// The widest hole to cap, scene units of the frame it is written in; `None`: any.
        max_hole: Option<f64>,
        /// The scan.
        child: Shape,
    },
    /// An open surface given a thickness, half of it to each side.
    Thicken {
        /// The thickness, scene units of the frame it is written in; above zero.
        by: f64,
        /// The surface.
        child: Shape,
    },
    /// The boundary of a solid moved along its normals.
    Offset {
        /// How far, scene units of the frame it is written in: outward above zero, inward below.
        by: f64,
        /// The solid.
        child: Shape,
    },
    /// The surface of a shape that lies inside a solid, without caps.
    Clip {
        /// The solid.
        by: Operand,
        /// The shape.
        child: Shape,
    },
}

/// A shape as an operand, with the place where it is used.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Operand {
    /// The shape.
    pub shape: Shape,
    /// The place in the expression that combines it.
    pub at: Span,
}

/// The set operators.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Serialize, Deserialize)]
pub enum BooleanOp {
    /// Points in any.
    Union,
    /// Points in all.
    Intersection,
    /// Points in the first and in no other.
    Difference,
    /// Points in an odd number.
    Xor,
    /// Points not in it.
    Complement,
}

impl BooleanOp {
    /// The infix or prefix sign of the language.
    pub fn sign(self) -> &'static str {
        match self {
            BooleanOp::Union => "|",
            BooleanOp::Intersection => "&",
            BooleanOp::Difference => "-",
            BooleanOp::Xor => "^",
            BooleanOp::Complement => "!",
        }
    }
}

/// What `.fit` makes of the bounds.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub enum FitTo {
    /// This extent along z.
    Height(f64),
    /// The largest extent along any axis.
    Size(f64),
}
