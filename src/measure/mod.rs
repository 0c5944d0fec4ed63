//! What a scene asks of its shapes while it is evaluated: bounds, insides, volumes, areas. A shape is prepared as a scene that
//! draws it alone; integrals are taken over lines ([`integrals`]), ends of what is cut by them too ([`extent`]), emptiness by
//! the test lines of a check.
//!
//! Answers depend on the shape, the files it names, the accuracy asked and the options alone, and are kept: a shape that is
//! asked about twice, by its name or as the same text, is prepared once.

mod adaptive;
mod alike;
mod cells;
mod exact;
mod extent;
mod integrals;

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

use glam::DVec3;

use crate::check::Evidence;
use crate::csg::{Scratch, Spans};
use crate::diag::Diagnostic;
use crate::geom::{Aabb, Interval, Ray};
use crate::lang::{Answer, Asked, Extent, Geometry, Measured, RayHit};
use crate::prepare::{self, Options, Prepared};
use crate::scene::{BooleanOp, Draw, Scene, Shape, ShapeKind, ShapeNode, Value};
use crate::shot::{Hit, World};
use crate::solid::table::{self, Build};
use integrals::Lines;

/// Measures shapes of one scene.
#[derive(Debug)]
pub struct Measuring {
    options: Options,
    /// By the node; the shape is kept, so that no other takes its place.
    known: RefCell<HashMap<*const ShapeNode, (Shape, Rc<Known>)>>,
    /// By what the shape says.
    alike: RefCell<HashMap<String, Rc<Known>>>,
}

/// A shape, prepared, and what was asked of it.
#[derive(Debug)]
struct Known {
    prepared: Prepared,
    fills: Fills,
    volume: RefCell<Option<Lines>>,
    area: RefCell<Option<Lines>>,
    empty: RefCell<Option<bool>>,
    reached: RefCell<Option<Extent>>,
}

impl Measuring {
    /// Measures with the options of a command: what may be read, and what becomes of scans that are cut short.
    pub fn new(options: &Options) -> Measuring {
        let options =
            Options { measure_all: true, write_out: true, crop: None, camera: None, ..options.clone() };
        Measuring { options, known: RefCell::default(), alike: RefCell::default() }
    }

    fn known(&self, asked: &Asked) -> Answer<Rc<Known>> {
        let key = Arc::as_ptr(&asked.shape.0);
        if let Some((_, known)) = self.known.borrow().get(&key) {
            return Ok(known.clone());
        }
        let scene = Scene {
            draws: vec![Draw { shape: asked.shape.clone(), at: asked.at }],
            materials: asked.materials.to_vec(),
            ..Scene::default()
        };
        let likeness = alike::likeness(&scene);
        let alike = likeness.as_ref().and_then(|text| self.alike.borrow().get(text).cloned());
        let known = match alike {
            Some(known) => known,
            None => Rc::new(Known::new(prepare::prepare(&scene, &self.options)?, Fills::of(asked.shape))),
        };
        self.alike.borrow_mut().extend(likeness.map(|text| (text, known.clone())));
        self.known.borrow_mut().insert(key, (asked.shape.clone(), known.clone()));
        Ok(known)
    }

    /// A solid; a sheet has no inside.
    fn solid(&self, asked: &Asked) -> Answer<Rc<Known>> {
        let known = self.known(asked)?;
        match known.world().open().first() {
            None => Ok(known),
            Some(sheet) => {
                let error = Diagnostic::error("E0301", "the shape has no inside")
                    .at(asked.at, sheet.solid.sheet_words());
                Err(vec![error.help(sheet.solid.sheet_remedy())])
            }
        }
    }

    /// A shape with an end, and the box around it.
    fn bounded(&self, asked: &Asked, known: &Known, what: &str) -> Answer<Aabb> {
        let bounds = known.extent();
        if bounds.is_empty() || bounds.is_finite() {
            return Ok(bounds);
        }
        let error =
            Diagnostic::error("E0305", format!("the shape has no finite {what}")).at(asked.at, "unbounded");
        Err(vec![error.help("cut it with something bounded: `shape & box(size: 100)`")])
    }

    /// The volume, the middle, and the bar of the middle's coordinates; zero for nothing.
    fn integrals(&self, asked: &Asked) -> Answer<(Measured, DVec3, f64)> {
        let known = self.solid(asked)?;
        let bounds = known.domain(&self.bounded(asked, &known, "volume")?);
        if bounds.is_empty() || bounds.size().min_element() == 0.0 {
            return Ok((Measured::default(), DVec3::ZERO, 0.0));
        }
        let (world, mut kept) = (known.world(), known.volume.borrow_mut());
        let lines = kept.get_or_insert_with(|| Lines::of_volume(world, &bounds));
        Ok(lines.volume(world, asked.level))
    }
}

/// How a shape fills the box of what it is made of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Fills {
    /// It reaches all sides, by what its parts know of themselves.
    Wholly,
    /// The sides are proved to be around it, and as near as that goes: a formula in a box.
    Nearly,
    /// It may end anywhere in it: something was taken away.
    Partly,
}

impl Fills {
    fn of(shape: &Shape) -> Fills {
        let mut shape = shape;
        while let ShapeKind::Transform { child, .. }
        | ShapeKind::With { child, .. }
        | ShapeKind::Fit { child, .. } = &shape.0.kind
        {
            shape = child;
        }
        if let Some(bounding) = bounding(shape) {
            let is_box = matches!(&bounding.0.kind, ShapeKind::Leaf { call, .. } if call.word == "box");
            return if is_box { Fills::Nearly } else { Fills::Partly };
        }
        if is_cut(shape) { Fills::Partly } else { Fills::Wholly }
    }
}

/// The solid that bounds a formula.
fn bounding(shape: &Shape) -> Option<&Shape> {
    let ShapeKind::Leaf { call, .. } = &shape.0.kind else { return None };
    let Build::Bounded { by, .. } = table::find(&call.word)?.build else { return None };
    match call.get(by)? {
        Value::Shape(shape) => Some(shape),
        _ => None,
    }
}

/// Whether anything is taken away in a shape, so that it may not reach the box of what it is made of.
fn is_cut(shape: &Shape) -> bool {
    let (mut open, mut seen) = (vec![shape], HashSet::new());
    while let Some(shape) = open.pop() {
        if !seen.insert(Arc::as_ptr(&shape.0)) {
            continue;
        }
        match &shape.0.kind {
            ShapeKind::Boolean { op, .. } if *op != BooleanOp::Union => return true,
            ShapeKind::Clip { .. } => return true,
            ShapeKind::Leaf { .. } if bounding(shape).is_some() => return true,
            kind => open.extend(kind.children()),
        }
    }
    false
}

impl Known {
    fn new(prepared: Prepared, fills: Fills) -> Known {
        let (volume, area) = (RefCell::default(), RefCell::default());
        Known { prepared, fills, volume, area, empty: RefCell::default(), reached: RefCell::default() }
    }

    fn world(&self) -> &World {
        &self.prepared.shot.world
    }

    /// A box around all of it, unbounded where it is.
    fn extent(&self) -> Aabb {
        self.prepared.outline.extent
    }

    /// A box that no crossing is out of: that of a scan's surface, not of its samples.
    fn domain(&self, extent: &Aabb) -> Aabb {
        let sheets = self.world().open().iter().map(|sheet| sheet.bounds);
        sheets.fold(integrals::domain(self.world().solids(), extent), Aabb::union)
    }

    /// The box that it reaches.
    fn reached(&self) -> Extent {
        let around = self.extent();
        let is_flat = around.size().min_element() == 0.0;
        if self.fills == Fills::Wholly || around.is_empty() || !around.is_finite() || is_flat {
            return Extent { bounds: around, err: 0.0 };
        }
        let is_tight = self.fills == Fills::Nearly;
        *self.reached.borrow_mut().get_or_insert_with(|| {
            match extent::reached(self.world(), &around, is_tight) {
                Some((bounds, err)) => Extent { bounds, err },
                None if self.is_nothing() => Extent { bounds: Aabb::EMPTY, err: 0.0 },
                None => Extent { bounds: around, err: around.size().max_element() },
            }
        })
    }

    /// Whether no line meets it.
    fn is_nothing(&self) -> bool {
        let Prepared { shot, outline, .. } = &self.prepared;
        let solids = || Evidence::gather(shot.world.solids(), outline, &[], 0.0).is_nothing();
        *self.empty.borrow_mut().get_or_insert_with(|| self.sheets_are_missed() && solids())
    }

    /// Whether what is left of sheets that were clipped is met by no line along the axes; others are something.
    fn sheets_are_missed(&self) -> bool {
        let (sheets, around) = (self.world().open(), self.extent());
        if sheets.is_empty() || around.is_empty() {
            return true;
        }
        let bounded = around.is_finite() && self.fills == Fills::Partly;
        bounded && extent::reached(self.world(), &around, false).is_none()
    }
}

impl Geometry for Measuring {
    fn bounds(&self, asked: &Asked) -> Answer<Extent> {
        Ok(self.known(asked)?.reached())
    }

    fn is_solid(&self, asked: &Asked) -> Answer<bool> {
        Ok(self.known(asked)?.world().open().is_empty())
    }

    fn is_empty(&self, asked: &Asked) -> Answer<bool> {
        Ok(self.known(asked)?.is_nothing())
    }

    fn inside(&self, asked: &Asked, point: DVec3) -> Answer<bool> {
        let known = self.solid(asked)?;
        let mut spans = Spans::new();
        // A direction that is no one's axis.
        let ray = Ray::new(point, DVec3::new(0.36, 0.48, 0.8));
        known.world().spans(&ray, Interval::AHEAD, &mut Scratch::default(), &mut spans);
        Ok(spans.first().is_some_and(|span| span.enter.is_none()))
    }

    fn volume(&self, asked: &Asked) -> Answer<Measured> {
        if let Some(exact) = self.known(asked)?.exact() {
            return Ok(exact.volume);
        }
        self.integrals(asked).map(|(volume, _, _)| volume)
    }

    fn area(&self, asked: &Asked) -> Answer<Measured> {
        let known = self.known(asked)?;
        if let Some(area) = known.exact().and_then(|exact| exact.area) {
            return Ok(area);
        }
        let bounds = known.domain(&self.bounded(asked, &known, "area")?);
        if bounds.is_empty() {
            return Ok(Measured::default());
        }
        let (world, mut kept) = (known.world(), known.area.borrow_mut());
        let lines = kept.get_or_insert_with(|| Lines::of_area(world, &bounds));
        Ok(lines.area(world, asked.level))
    }

    fn centroid(&self, asked: &Asked) -> Answer<[Measured; 3]> {
        let (volume, middle, bar) = self.integrals(asked)?;
        if volume.value == 0.0 {
            let error =
                Diagnostic::error("E0305", "the shape is nothing, and has no middle").at(asked.at, "");
            return Err(vec![error.help("ask `empty(shape)` first")]);
        }
        // What a middle may be off is held against the shape, wherever that stands.
        let size = self.known(asked)?.extent().diagonal();
        Ok(middle.to_array().map(|value| Measured { value, err: bar, size, is_open: volume.is_open }))
    }

    fn raycast(&self, asked: &Asked, from: DVec3, dir: DVec3) -> Answer<Vec<RayHit>> {
        let known = self.known(asked)?;
        let (world, ray) = (known.world(), Ray::new(from, dir));
        let (mut scratch, mut spans, mut hits) = (Scratch::default(), Spans::new(), Vec::new());
        world.spans(&ray, Interval::AHEAD, &mut scratch, &mut spans);
        for span in &spans {
            let ends = [(span.enter, true), (span.exit, false)];
            let ends = ends.into_iter().filter_map(|(end, entering)| Some((end?, entering)));
            hits.extend(ends.map(|(boundary, entering)| Hit { boundary, entering, sheet: false }));
        }
        world.sheets(&ray, Interval::AHEAD, &mut scratch, &mut hits);
        hits.sort_by(|a, b| a.boundary.t.total_cmp(&b.boundary.t));
        let told = |hit: &Hit| {
            let surface = world.surface(&ray, hit);
            RayHit { t: hit.boundary.t, point: surface.point, normal: surface.normal, entering: hit.entering }
        };
        Ok(hits.iter().map(told).collect())
    }
}
