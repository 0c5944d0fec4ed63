//! Shapes measured as scenes measure them.

use pss::lang::{Asked, Reading};
use pss::measure::Measuring;
use pss::prepare::{self, Options};
use pss::source::{SourceMap, Span};

/// What is answered of a shape at each level of accuracy asked, by one who keeps what was measured.
pub fn answers<T>(shape: &str, levels: &[usize], ask: impl Fn(&Measuring, &Asked) -> T) -> Vec<T> {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, format!("draw {shape}"));
    let catalog = prepare::catalog();
    let memory = pss::lang::MEMORY;
    let reading =
        Reading { catalog: &catalog, defines: &[], files: None, geometry: None, expects: false, memory };
    let scene = pss::lang::read_with(&mut sources, file, &reading).unwrap().scene;
    let measuring = Measuring::new(&Options::default());
    let asked = |level| Asked { shape: &scene.draws[0].shape, materials: &[], at: Span::default(), level };
    levels.iter().map(|level| ask(&measuring, &asked(*level))).collect()
}
