//! Shapes to leaves and one set expression over them: transforms pushed down, materials handed out, operands checked
//! to have an inside.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::bounding::bounded_by;
use super::build::{Builder, Built, exact};
use super::edits::{Change, Edit, Edits, Stage, edits};
use super::groups::Groups;
use super::instances::Repeat;
use super::limits;
use super::outline::Outline;
use super::samples::{Sampling, sample};
use crate::cloud::Cloud;
use crate::csg::{Clipped, Clippee, Expr, Leaf, Object};
use crate::diag::Diagnostic;
use crate::geom::{Aabb, Placement, tolerance};
use crate::scene::{BooleanOp, Call, FitTo, MaterialId, Operand, Shape, ShapeKind, Value};
use crate::solid::table::{self, Build};
use crate::solid::{Body, SHEET, Solid};
use crate::source::Span;

/// What a `draw` has become.
pub(super) struct Drawn {
    /// The expression of its solids, if it is one.
    pub solid: Option<Expr>,
    /// A box around it.
    pub bounds: Aabb,
}

/// Leaves gathered from shapes.
pub(super) struct Lowering<'b, 'o> {
    pub builder: &'b mut Builder<'o>,
    pub measure_all: bool,
    /// Leaves that expressions refer to.
    pub leaves: Vec<Leaf>,
    /// Sheets drawn.
    pub sheets: Vec<Leaf>,
    /// Where the leaves, and what cuts them, were written.
    pub outline: Outline,
    /// Shapes that become one leaf each; none where every leaf is wanted as it was written.
    pub groups: Groups,
    /// Expressions of shapes that may stand twice in one place.
    pub repeats: HashMap<Repeat, Arc<Expr>>,
}

/// What a node inherits from above.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub world_from_local: DAffine3,
    pub material: Option<MaterialId>,
    /// What cutters wear that have no material.
    pub cut: Option<MaterialId>,
    pub cutter: bool,
    /// Whether an odd number of complements stands above: what grows the whole shrinks this.
    pub turned: bool,
    /// Whether an operator above asks for an inside, with its sign and the place of the operand.
    pub wanted: Option<(&'static str, Span)>,
    /// What the methods above change about the leaves, the innermost first.
    pub edits: Option<&'a Edits<'a>>,
}

const TOP: Context = Context {
    world_from_local: DAffine3::IDENTITY,
    material: None,
    cut: None,
    cutter: false,
    turned: false,
    wanted: None,
    edits: None,
};

/// A lowered shape.
pub(super) enum Lowered {
    Solid(Expr),
    Sheets(Vec<Open>),
}

/// A sheet, and the place of what made it: its call, or what it is clipped by.
pub(super) struct Open {
    pub leaf: Leaf,
    pub at: Span,
}

impl<'b, 'o> Lowering<'b, 'o> {
    /// Nothing gathered yet.
    pub fn new(builder: &'b mut Builder<'o>, measure_all: bool) -> Lowering<'b, 'o> {
        Lowering {
            builder,
            measure_all,
            leaves: Vec::new(),
            sheets: Vec::new(),
            outline: Outline::default(),
            groups: Groups::default(),
            repeats: HashMap::new(),
        }
    }

    /// Lowers what is drawn at a place of the text.
    pub fn draw(&mut self, shape: &Shape, at: Span) -> Result<Drawn, Diagnostic> {
        limits::check_count(shape, &self.groups)?;
        let bounds = self.extent(shape, &DAffine3::IDENTITY)?;
        let solid = match self.lower(shape, TOP)? {
            Lowered::Solid(expr) => Some(expr),
            Lowered::Sheets(sheets) => {
                self.outline.sheets.extend(sheets.iter().map(|sheet| [at, sheet.at]));
                self.sheets.extend(sheets.into_iter().map(|sheet| sheet.leaf));
                None
            }
        };
        Ok(Drawn { solid, bounds })
    }

    pub(super) fn push(&mut self, leaf: Leaf, at: Span) -> Expr {
        self.leaves.push(leaf);
        self.outline.calls.push(at);
        Expr::Leaf(self.leaves.len() as u32 - 1)
    }

    pub(super) fn lower_here(&mut self, shape: &Shape, context: Context) -> Result<Lowered, Diagnostic> {
        match &shape.0.kind {
            ShapeKind::Leaf { call, name } => self.leaf(shape, call, name, context),
            ShapeKind::Transform { world_from_local, child } => {
                let world_from_local = context.world_from_local * *world_from_local;
                self.lower(child, Context { world_from_local, ..context })
            }
            ShapeKind::Fit { child, .. } => {
                let fitted = self.fit(shape)?;
                let world_from_local = context.world_from_local * fitted;
                self.lower(child, Context { world_from_local, ..context })
            }
            ShapeKind::With { material, child } => {
                // The innermost `.with` is nearest to the leaf; an outer one leaves it alone.
                self.lower(child, Context { material: Some(*material), ..context })
            }
            ShapeKind::Cut { material, child } => {
                self.lower(child, Context { cut: Some(*material), ..context })
            }
            ShapeKind::Close { max_hole, child } => {
                self.edited(shape, Change::Close(max_hole.unwrap_or(f64::INFINITY)), child, context)
            }
            ShapeKind::Thicken { by, child } => self.edited(shape, Change::Thicken(*by), child, context),
            ShapeKind::Offset { by, child } => self.edited(shape, Change::Move(*by), child, context),
            ShapeKind::Clip { by, child } => self.clip(child, by, context),
            ShapeKind::Boolean { op, operands } => self.boolean(shape, *op, operands, context),
        }
    }

    fn boolean(
        &mut self,
        shape: &Shape,
        op: BooleanOp,
        operands: &[Operand],
        context: Context,
    ) -> Result<Lowered, Diagnostic> {
        for edit in edits(context.edits) {
            edit.check_through(op, context.turned, shape.0.at)?;
        }
        let mut parts = Vec::with_capacity(operands.len());
        let mut cut = self.outline.begin_cut(op);
        let begin = self.leaves.len() as u32;
        let mut middle = begin;
        for (i, operand) in operands.iter().enumerate() {
            let taken = op == BooleanOp::Complement || (op == BooleanOp::Difference && 0 < i);
            let context = Context {
                cutter: context.cutter || taken,
                turned: context.turned != taken,
                // A cutter keeps its own material, has that of `.cut`, or shows the base's: `.with` above stops here.
                material: if taken { context.cut } else { context.material },
                wanted: Some((op.sign(), operand.at)),
                ..context
            };
            let first = self.leaves.len() as u32;
            parts.push((self.lower(&operand.shape, context)?, operand.at));
            if let Some(cut) = &mut cut {
                self.outline.add_to_cut(*cut, taken, operand.at, first..self.leaves.len() as u32);
            }
            if i == 0 {
                middle = self.leaves.len() as u32;
            }
        }
        if op == BooleanOp::Union && parts.iter().any(|p| matches!(p.0, Lowered::Sheets(_))) {
            return joined_sheets(parts);
        }
        let mut exprs = Vec::with_capacity(parts.len());
        for (part, at) in parts {
            match part {
                Lowered::Solid(expr) => exprs.push(expr),
                Lowered::Sheets(sheets) => return Err(no_inside(op.sign(), at, &sheets)),
            }
        }
        if 1 < operands.len() {
            self.outline.add_meeting(op, shape.0.at, [begin, middle, self.leaves.len() as u32]);
        }
        Ok(Lowered::Solid(combined(op, exprs)))
    }

    fn leaf(
        &mut self,
        shape: &Shape,
        call: &Call,
        name: &str,
        context: Context,
    ) -> Result<Lowered, Diagnostic> {
        let solid = self.solid(shape, name, context)?;
        let place = placed(context.world_from_local, call.at)?;
        let mut leaf = Leaf::new(solid.clone(), place);
        leaf.name = name.into();
        leaf.material = context.material.map(|m| m.0);
        leaf.cutter = context.cutter;
        leaf.rank = u64::from(call.at.file.0) << 32 | u64::from(call.at.start);
        if solid.body() == Body::Sheet {
            return Ok(Lowered::Sheets(vec![Open { leaf, at: call.at }]));
        }
        let own = self.push(leaf, call.at);
        let Some((by, bounding)) = bounded_by(call) else { return Ok(Lowered::Solid(own)) };
        let at = call.place(by);
        match self.lower(bounding, Context { wanted: Some((by, at)), edits: None, ..context })? {
            Lowered::Solid(expr) => Ok(Lowered::Solid(Expr::And(vec![own, expr]))),
            Lowered::Sheets(sheets) => Err(no_inside(by, at, &sheets)),
        }
    }

    /// A node that changes the leaves below it.
    fn edited(
        &mut self,
        shape: &Shape,
        change: Change,
        child: &Shape,
        context: Context,
    ) -> Result<Lowered, Diagnostic> {
        let edit = Edit { change, frame: context.world_from_local, turned: context.turned, at: shape.0.at };
        let edits = Edits { edit, outer: context.edits };
        self.lower(child, Context { edits: Some(&edits), ..context })
    }

    /// The surface of a shape inside a solid: a sheet for each leaf that has a part in it.
    fn clip(&mut self, child: &Shape, by: &Operand, context: Context) -> Result<Lowered, Diagnostic> {
        if let Some(Edits { edit, .. }) = context.edits {
            let error = Diagnostic::error("E0304", "a clipped surface is an open one that ends sharply");
            return Err(error
                .at(edit.at, "")
                .at(by.at, "clipped by this")
                .help("close, thicken or move the shape first, and clip it last"));
        }
        let own = Context { wanted: None, edits: None, turned: false, cutter: false, ..context };
        let asked = Context { wanted: Some((".clip", by.at)), material: None, ..own };
        let within = self.extent(&by.shape, &context.world_from_local)?;
        let within = within.inflated(tolerance::cleanup(within.farthest()));
        let mut cutter = Lowering::new(self.builder, self.measure_all);
        let expr = match cutter.lower(&by.shape, asked)? {
            Lowered::Solid(expr) => expr,
            Lowered::Sheets(sheets) => return Err(no_inside(".clip", by.at, &sheets)),
        };
        let outline = cutter.outline.of_one(by.at, &expr, within);
        let (by, by_at) = (Arc::new(Object::new(cutter.leaves, &expr)), by.at);
        self.outline.add_inner(&by, outline);
        let mut clipped = Lowering::new(self.builder, self.measure_all);
        let sheets = match clipped.lower(child, own)? {
            Lowered::Sheets(sheets) => {
                sheets.into_iter().map(|s| (s.leaf.clone(), Clippee::Sheet(s.leaf.into()))).collect()
            }
            Lowered::Solid(expr) => {
                let outline = clipped.outline.of_one(child.0.at, &expr, Aabb::ALL);
                let object = Arc::new(Object::new(clipped.leaves, &expr));
                self.outline.add_inner(&object, outline);
                let face =
                    |(i, leaf): (usize, &Leaf)| (leaf.clone(), Clippee::Faces(object.clone(), i as u32));
                object.leaves().iter().enumerate().map(face).collect::<Vec<_>>()
            }
        };
        let sheet = |(leaf, of): (Leaf, Clippee)| {
            let clipped = Leaf::new(Arc::new(Clipped { of, by: by.clone(), within }), Placement::IDENTITY);
            let leaf = Leaf { solid: clipped.solid, place: clipped.place, bounds: clipped.bounds, ..leaf };
            Open { leaf, at: by_at }
        };
        Ok(Lowered::Sheets(sheets.into_iter().map(sheet).collect()))
    }

    /// The solid of a leaf, edited and measured as what stands above it asks.
    fn solid(&mut self, shape: &Shape, name: &str, context: Context) -> Result<Arc<dyn Solid>, Diagnostic> {
        let mut stage = match self.built(shape)? {
            Built::Exact(solid) => Stage::Exact(solid),
            Built::Scan(id) if self.builder.lacks_color(id, context.material) => {
                return Err(colorless(shape));
            }
            Built::Scan(id) => Stage::Scan(id),
        };
        for edit in edits(context.edits) {
            // Lengths of the frame that the method is written in, taken to the leaf's own.
            let map = edit.frame.inverse() * context.world_from_local;
            stage = self.builder.edit(stage, &edit.in_frame(&map, context.turned)?, name)?;
        }
        let id = match stage {
            Stage::Exact(solid) => return Ok(solid),
            Stage::Closed(id, ref close) => return Ok(self.builder.close(id, close)?),
            Stage::Scan(id) => id,
        };
        if context.wanted.is_none() && !self.measure_all {
            return Ok(self.builder.unmeasured(id));
        }
        let (solidity, surface) = self.builder.measured(id);
        if surface.body() == Body::Sheet && self.builder.bounds_a_solid(id) {
            return Ok(self.builder.mended(id, &solidity));
        }
        match context.wanted {
            Some((sign, at)) if sign != BooleanOp::Union.sign() && surface.body() == Body::Sheet => {
                Err(without_inside(sign, at, &solidity.complaint(), surface.sheet_remedy()))
            }
            _ => Ok(surface),
        }
    }

    /// The solid of a leaf, whatever its body.
    pub(super) fn any_solid(&mut self, shape: &Shape) -> Result<Arc<dyn Solid>, Diagnostic> {
        Ok(match self.built(shape)? {
            Built::Exact(solid) => solid,
            Built::Scan(id) => self.builder.unmeasured(id),
        })
    }

    fn built(&mut self, shape: &Shape) -> Result<Built, Diagnostic> {
        if let Some(known) = self.builder.known(&shape.0) {
            return Ok(known);
        }
        let ShapeKind::Leaf { call, name } = &shape.0.kind else {
            return Err(Diagnostic::error("E0900", "this shape is no primitive").at(shape.0.at, ""));
        };
        let primitive = table::find(&call.word);
        let built = match primitive.map(|p| p.build) {
            Some(Build::Exact(build)) => self.builder.exact(call, build)?,
            Some(Build::Mesh) => self.builder.mesh(call)?,
            Some(Build::Heights) => self.builder.heights(call)?,
            Some(Build::Bounded { by, build }) => {
                let bounds = self.bounding_box(call, by)?;
                exact(call, |call| build(call, &bounds))?
            }
            Some(Build::Points) => {
                let cloud = match call.get("source") {
                    Some(Value::Shape(solid)) => self.sampled(call, solid)?,
                    _ => self.builder.read_cloud(call)?,
                };
                Built::Scan(self.builder.scan(call, name, cloud)?)
            }
            None => return Err(Diagnostic::error("E0900", "nobody builds this primitive").at(call.at, "")),
        };
        Ok(self.builder.keep(&shape.0, built))
    }

    /// Samples of a solid.
    fn sampled(&mut self, call: &Call, solid: &Shape) -> Result<Cloud, Diagnostic> {
        let at = call.place("source");
        let Some(count) = call.number("samples") else {
            let error =
                Diagnostic::error("E0404", "samples of a solid need a number: `samples:`").at(call.at, "");
            return Err(error.help("write `points(sphere(r: 1), samples: 2000)`"));
        };
        if call.number("noise").is_some_and(|n| n < 0.0) {
            let error = Diagnostic::error("E0506", "`noise` is a standard deviation and cannot be negative");
            return Err(error.at(call.place("noise"), "").help("write zero or more, such as `noise: 0.1`"));
        }
        let mut own = Lowering::new(self.builder, true);
        own.groups = Groups::of(std::iter::once(solid), true);
        limits::check_count(solid, &own.groups)?;
        let bounds = own.extent(solid, &DAffine3::IDENTITY)?;
        let Lowered::Solid(expr) = own.lower(solid, TOP)? else {
            return Err(Diagnostic::error("E0301", "only a solid can be sampled").at(at, "a Sheet"));
        };
        let object = Object::new(own.leaves, &expr);
        let colors = self.builder.reads_colors().then_some(self.builder.materials);
        let sampling = Sampling {
            count: count as usize,
            noise: call.number("noise").unwrap_or(0.0),
            seed: call.number("seed").unwrap_or(0.0) as u64,
        };
        sample(&object, &bounds, &sampling, colors).map_err(|e| {
            let error = Diagnostic::error("E0306", e.to_string()).at(at, "");
            error.help("sample a bounded solid that has an inside, such as `sphere(r: 1)`")
        })
    }

    /// The map of a `.fit` node.
    pub(super) fn fit(&mut self, shape: &Shape) -> Result<DAffine3, Diagnostic> {
        let ShapeKind::Fit { at, to, child } = &shape.0.kind else { return Ok(DAffine3::IDENTITY) };
        let bounds = self.extent(child, &DAffine3::IDENTITY)?;
        let (want, have) = match to {
            FitTo::Height(h) => (*h, bounds.size().z),
            FitTo::Size(s) => (*s, bounds.size().max_element()),
        };
        let scale = want / have;
        if bounds.is_empty() || !bounds.is_finite() || !scale.is_finite() || scale <= 0.0 {
            let error = Diagnostic::error(
                "E0305",
                "a shape without finite bounds, or without extent, cannot be fitted",
            );
            return Err(error.at(shape.0.at, "").help("fit what is bounded, and place the rest by `.move`"));
        }
        let bottom = DVec3::new(bounds.center().x, bounds.center().y, bounds.min.z);
        Ok(DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(scale)), translation: *at - scale * bottom })
    }
}

pub(super) fn placed(world_from_local: DAffine3, at: Span) -> Result<Placement, Diagnostic> {
    Placement::new(world_from_local).ok_or_else(|| {
        Diagnostic::error("E0505", "a transform leaves nothing of this shape, or too little to invert")
            .at(at, "")
            .help("no factor of a `.scale` may be zero or a million million times smaller than another")
    })
}

fn combined(op: BooleanOp, mut exprs: Vec<Expr>) -> Expr {
    match op {
        BooleanOp::Union => Expr::Or(exprs),
        BooleanOp::Intersection => Expr::And(exprs),
        BooleanOp::Xor => Expr::Xor(exprs),
        BooleanOp::Complement => Expr::Not(Box::new(Expr::Or(exprs))),
        BooleanOp::Difference if exprs.is_empty() => Expr::Or(exprs),
        BooleanOp::Difference => {
            let cutters = exprs.split_off(1);
            exprs.push(Expr::Not(Box::new(Expr::Or(cutters))));
            Expr::And(exprs)
        }
    }
}

/// A union of sheets; with a solid among them an error.
fn joined_sheets(parts: Vec<(Lowered, Span)>) -> Result<Lowered, Diagnostic> {
    let mut sheets = Vec::new();
    let sheet_at = parts.iter().find(|p| matches!(p.0, Lowered::Sheets(_))).map(|p| p.1);
    for (part, at) in parts {
        match part {
            Lowered::Sheets(more) => sheets.extend(more),
            Lowered::Solid(_) => {
                let error =
                    Diagnostic::error("E0302", "`|` joins two solids or two sheets").at(at, "a Solid");
                let error = sheet_at.into_iter().fold(error, |e, at| e.at(at, "a Sheet"));
                return Err(
                    error.help("`draw` them one by one, or close the sheet: `scan.close(max_hole: 8mm)`")
                );
            }
        }
    }
    Ok(Lowered::Sheets(sheets))
}

/// The error that a sheet stands where an inside is wanted.
fn no_inside(sign: &str, at: Span, sheets: &[Open]) -> Diagnostic {
    let first = sheets.first().map(|sheet| &sheet.leaf.solid);
    let (why, remedy) = first.map_or((SHEET.into(), ""), |solid| (solid.sheet_words(), solid.sheet_remedy()));
    without_inside(sign, at, &why, remedy)
}

fn without_inside(sign: &str, at: Span, why: &str, remedy: &str) -> Diagnostic {
    Diagnostic::error("E0301", format!("an operand of `{sign}` has no inside")).at(at, why).help(remedy)
}

fn colorless(shape: &Shape) -> Diagnostic {
    Diagnostic::error("E0310", "its material takes its colour from the scan, which has none")
        .at(shape.0.at, "")
        .help("take a scan with `red green blue`, or a material of one colour: `matte(#b8683c)`")
}
