//! What a scene asks of its shapes while it is evaluated: bounds, insides, volumes, areas. A shape is prepared as a scene that
//! draws it alone; integrals are taken over lines ([`integrals`]), emptiness by the test lines of a check.
//!
//! Answers depend on the shape, the files it names and the options alone, and are kept: a name that is asked about twice is
//! prepared once.

mod integrals;

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use glam::DVec3;

use crate::check::Evidence;
use crate::csg::{Scratch, Spans};
use crate::diag::Diagnostic;
use crate::geom::{Aabb, Interval, Ray};
use crate::lang::{Answer, Asked, Geometry, Measured, RayHit};
use crate::prepare::{self, Options, Prepared};
use crate::scene::{Draw, Scene, ShapeNode};
use crate::shot::{Hit, World};

/// Measures shapes of one scene.
#[derive(Debug)]
pub struct Measuring {
    options: Options,
    /// By the node; the shape is kept, so that no other takes its place.
    known: RefCell<HashMap<*const ShapeNode, (crate::scene::Shape, Rc<Known>)>>,
}

/// A shape, prepared, and what was asked of it.
#[derive(Debug)]
struct Known {
    prepared: Prepared,
    volume: RefCell<Option<(Measured, DVec3, f64)>>,
    area: RefCell<Option<Measured>>,
    empty: RefCell<Option<bool>>,
}

impl Measuring {
    /// Measures with the options of a command: what may be read, and what becomes of scans that are cut short.
    pub fn new(options: &Options) -> Measuring {
        let options =
            Options { measure_all: true, write_out: true, crop: None, camera: None, ..options.clone() };
        Measuring { options, known: RefCell::default() }
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
        let prepared = prepare::prepare(&scene, &self.options)?;
        let known = Rc::new(Known {
            prepared,
            volume: RefCell::default(),
            area: RefCell::default(),
            empty: RefCell::default(),
        });
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

    fn integrals(&self, asked: &Asked) -> Answer<(Measured, DVec3, f64)> {
        let known = self.solid(asked)?;
        let bounds = self.bounded(asked, &known, "volume")?;
        let mut kept = known.volume.borrow_mut();
        Ok(*kept.get_or_insert_with(|| integrals::volume(known.world(), &bounds)))
    }
}

impl Known {
    fn world(&self) -> &World {
        &self.prepared.shot.world
    }

    /// A box around all of it, unbounded where it is.
    fn extent(&self) -> Aabb {
        let parts = self.prepared.outline.parts.iter().map(|part| part.bounds);
        let sheets = self.world().open().iter().map(|sheet| sheet.bounds);
        parts.chain(sheets).fold(Aabb::EMPTY, Aabb::union)
    }

    fn is_empty(&self) -> bool {
        let Prepared { shot, outline, .. } = &self.prepared;
        if !shot.world.open().is_empty() {
            return false;
        }
        *self
            .empty
            .borrow_mut()
            .get_or_insert_with(|| Evidence::gather(shot.world.solids(), outline, &[], 0.0).is_nothing())
    }
}

impl Geometry for Measuring {
    fn bounds(&self, asked: &Asked) -> Answer<Aabb> {
        Ok(self.known(asked)?.extent())
    }

    fn is_solid(&self, asked: &Asked) -> Answer<bool> {
        Ok(self.known(asked)?.world().open().is_empty())
    }

    fn is_empty(&self, asked: &Asked) -> Answer<bool> {
        Ok(self.known(asked)?.is_empty())
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
        self.integrals(asked).map(|(volume, _, _)| volume)
    }

    fn area(&self, asked: &Asked) -> Answer<Measured> {
        let known = self.known(asked)?;
        let bounds = self.bounded(asked, &known, "area")?;
        Ok(*known.area.borrow_mut().get_or_insert_with(|| integrals::area(known.world(), &bounds)))
    }

    fn centroid(&self, asked: &Asked) -> Answer<(DVec3, f64)> {
        let (volume, middle, bar) = self.integrals(asked)?;
        if volume.value == 0.0 {
            let error =
                Diagnostic::error("E0305", "the shape is nothing, and has no middle").at(asked.at, "");
            return Err(vec![error.help("ask `empty(shape)` first")]);
        }
        Ok((middle, bar))
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
