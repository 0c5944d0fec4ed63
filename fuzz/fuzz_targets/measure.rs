//! What a scene asks of its shapes, answered by tracing them as `pss check` does: no question makes it fall over.
//!
//! A volume takes up to half a million rays, and a scene may ask for a million volumes: only a few questions about small shapes
//! are answered here, so that a text takes milliseconds.
#![no_main]

mod common;

use std::cell::Cell;

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use pss::diag::Diagnostic;
use pss::lang::{Answer, Asked, Extent, Geometry, Measured, RayHit};
use pss::measure::Measuring;
use pss::prepare::Options;
use pss::scene::{Scene, Draw, Shape, ShapeKind};

/// Questions that one text may ask, of shapes of so many nodes.
const QUESTIONS: u32 = 8;
const INTEGRALS: u32 = 1;
const NODES: u64 = 12;

struct Few {
    measuring: Measuring,
    asked: Cell<u32>,
    integrals: Cell<u32>,
}

impl Few {
    fn ask<T>(&self, asked: &Asked, question: impl Fn(&Measuring) -> Answer<T>) -> Answer<T> {
        self.asked.set(self.asked.get() + 1);
        let draws = vec![Draw { shape: asked.shape.clone(), at: asked.at }];
        let small = Scene { draws, ..Scene::default() }.written_out() <= NODES;
        if QUESTIONS < self.asked.get() || !small || !is_cheap(asked.shape) {
            return Err(vec![Diagnostic::error("E0708", "not measured here").at(asked.at, "").help("")]);
        }
        question(&self.measuring)
    }

    fn integral<T>(&self, asked: &Asked, question: impl Fn(&Measuring) -> Answer<T>) -> Answer<T> {
        self.integrals.set(self.integrals.get() + 1);
        let spent = INTEGRALS < self.integrals.get();
        self.asked.set(if spent { QUESTIONS } else { self.asked.get() });
        self.ask(asked, question)
    }
}

/// Samples of solids and formulas take their time, and files are not there.
fn is_cheap(shape: &Shape) -> bool {
    match &shape.0.kind {
        ShapeKind::Leaf { call, .. } => !["points", "mesh", "heightfield", "implicit"].contains(&&*call.word),
        kind => kind.children().all(is_cheap),
    }
}

impl Geometry for Few {
    fn bounds(&self, asked: &Asked) -> Answer<Extent> {
        self.ask(asked, |m| m.bounds(asked))
    }

    fn is_solid(&self, asked: &Asked) -> Answer<bool> {
        self.ask(asked, |m| m.is_solid(asked))
    }

    fn is_empty(&self, asked: &Asked) -> Answer<bool> {
        self.integral(asked, |m| m.is_empty(asked))
    }

    fn inside(&self, asked: &Asked, point: DVec3) -> Answer<bool> {
        self.ask(asked, |m| m.inside(asked, point))
    }

    fn volume(&self, asked: &Asked) -> Answer<Measured> {
        self.integral(asked, |m| m.volume(asked))
    }

    fn area(&self, asked: &Asked) -> Answer<Measured> {
        self.integral(asked, |m| m.area(asked))
    }

    fn centroid(&self, asked: &Asked) -> Answer<[Measured; 3]> {
        self.integral(asked, |m| m.centroid(asked))
    }

    fn raycast(&self, asked: &Asked, from: DVec3, dir: DVec3) -> Answer<Vec<RayHit>> {
        self.ask(asked, |m| m.raycast(asked, from, dir))
    }
}

fuzz_target!(|data: &[u8]| {
    let Some((mut sources, file)) = common::source(data) else { return };
    let measuring = Measuring::new(&Options { scene_dir: "/nowhere".into(), ..Options::default() });
    let few = Few { measuring, asked: Cell::new(0), integrals: Cell::new(0) };
    common::read(&mut sources, file, &few);
});
