//! A scene made ready to trace: what is drawn is built, placed and bounded; what nothing draws is never touched.
//! [`build`] makes solids of calls, [`assets`] those of files, [`edits`] and [`offset`] what methods make of them,
//! [`fitness`] doubts them, [`samples`] takes samples of solids, [`files`] says what may be read, [`lower`] turns shapes into
//! leaves and one set expression, [`groups`] and [`instances`] see to it that what stands in several places is built
//! once. Text and pixels are left to others.

mod assets;
mod bounding;
mod build;
mod clear;
mod edits;
mod equal;
mod extent;
mod files;
mod fitness;
mod flat;
mod groups;
mod instances;
mod limits;
mod lower;
mod offset;
mod outline;
mod samples;
pub mod survey;

use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

use crate::cloud::ply::Cut;
use crate::csg::{Expr, Object};
use crate::diag::{Diagnostic, Fault};
use crate::geom::Aabb;
use crate::scene::{BuildError, Call, Catalog, Draw, Scene};
use crate::shot::settings::{self, Integrator, Overrides};
use crate::shot::{Camera, Material, Owners, Settings, Shot, World, camera, light, material};
use crate::solid::point_set::Solidity;
use crate::solid::{Counts, table};
use crate::source::Span;

use build::Builder;
pub use files::{Imports, Inputs};
use groups::Groups;
use lower::Lowering;
pub use outline::{Cutting, Meeting, Outline, Part, Piece};

/// What the command line has to say about a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Replaces the size, pixels.
    pub size: Option<[u32; 2]>,
    /// Replaces the samples a pixel.
    pub samples: Option<u32>,
    /// Replaces the seed.
    pub seed: Option<u64>,
    /// The part to make: half-open, pixels from the top left.
    pub crop: Option<[u32; 4]>,
    /// The camera, by name; the first where none is named.
    pub camera: Option<String>,
    /// The folder of the scene: files below it may be read.
    pub scene_dir: PathBuf,
    /// Other folders below which files may be read.
    pub allow_read: Vec<PathBuf>,
    /// What becomes of scans that are cut short.
    pub cut: Cut,
    /// Where the names of files asked for are left.
    pub inputs: Inputs,
    /// Whether what is to be seen through is built; only pictures show it.
    pub ghosts: bool,
    /// Measure the solidity of every scan drawn, even where a picture does not depend on it.
    pub measure_all: bool,
    /// Whether what stands in several places is built anew in each, and not shared, as long as that is not too much: each
    /// use is a leaf of its own then, with a place in the [`Outline`].
    pub write_out: bool,
}

/// A shot, and what was met on the way to it.
#[derive(Debug)]
pub struct Prepared {
    /// What is rendered.
    pub shot: Shot,
    /// What the user should know.
    pub warnings: Vec<Diagnostic>,
    /// Time spent on reading them.
    pub loading: Duration,
    /// The work of measuring and sampling.
    pub counts: Counts,
    /// What was found about each scan.
    pub scans: Vec<ScanReport>,
    /// Where the solids of the shot were written.
    pub outline: Outline,
}

/// What was found about a scan.
#[derive(Clone, Debug)]
pub struct ScanReport {
    /// Its name in the scene.
    pub name: String,
    /// Samples kept.
    pub samples: usize,
    /// Samples whose normals were estimated.
    pub estimated: usize,
    /// What was dropped or mended, one sentence each.
    pub notes: Vec<String>,
    /// Whether it bounds a solid, if the scene had to know.
    pub solidity: Option<Solidity>,
}

/// Everything that a scene can call.
pub fn catalog() -> Catalog {
    let mut decls: Vec<_> = table::decls().collect();
    decls.extend(material::decls());
    decls.extend([camera::DECL, light::DECL, settings::DECL]);
    Catalog { decls }
}

/// Builds, places and bounds what a scene draws.
///
/// Errors are about the scene, its files and the options; the first decides the exit code.
pub fn prepare(scene: &Scene, options: &Options) -> Result<Prepared, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let settings = keep(&mut errors, settings_of(scene, options));
    let materials =
        every(&mut errors, &scene.materials, |call| material::build(call).map_err(|e| complaint(call, e)));
    let chosen = camera_of(&mut errors, scene, options.camera.as_deref());
    let known = materials.as_deref().unwrap_or_default();
    let lines = settings.as_ref().map_or(0, Settings::lines);
    let mut builder = Builder::new(options, known, lines);
    let lights = every(&mut errors, scene.lights.iter().map(|named| &named.call), |call| {
        let map = builder.environment(call)?;
        light::build(call, map).map_err(|e| complaint(call, e))
    });
    let bare = known.len() as u32;
    // A picture of insides, or of what shows them, depends on what has one.
    let shows_insides = settings.as_ref().is_some_and(|s| s.aov.iter().any(|aov| aov.is_of_insides()))
        || known.iter().any(Material::is_clear);
    let measure = options.measure_all || shows_insides;
    let mut built = |draws: &[Draw]| {
        let built = world(draws, &mut builder, [measure, options.write_out], bare);
        built.map_err(|more| errors.extend(more)).ok()
    };
    let world = built(&scene.draws);
    let shown = if options.ghosts { &scene.ghosts[..] } else { &[] };
    let ghosts = if shown.is_empty() { Some(None) } else { built(shown).map(|(ghosts, _)| Some(ghosts)) };
    let (
        Some(settings),
        Some(materials),
        Some(lights),
        Some(chosen),
        Some((world, mut outline)),
        Some(ghosts),
    ) = (settings, materials.clone(), lights, chosen, world, ghosts)
    else {
        return Err(errors);
    };
    let lit = matches!(settings.integrator, Integrator::Direct | Integrator::Path);
    let world = if lit { clear::with_clear(world, &mut outline, &materials) } else { world };
    let scans = builder.reports();
    let Builder { warnings, loading, counts, .. } = builder;
    let camera = chosen.unwrap_or_else(|| Camera::fit(world.bounds()));
    let shot = Shot { world, ghosts, camera, lights, materials, settings };
    Ok(Prepared { shot, warnings, loading, counts, scans, outline })
}

fn keep<T>(errors: &mut Vec<Diagnostic>, result: Result<T, Diagnostic>) -> Option<T> {
    result.map_err(|e| errors.push(e)).ok()
}

/// What all calls build; where some do not, each is told.
fn every<'c, T>(
    errors: &mut Vec<Diagnostic>,
    calls: impl IntoIterator<Item = &'c Call>,
    mut build: impl FnMut(&'c Call) -> Result<T, Diagnostic>,
) -> Option<Vec<T>> {
    let all: Vec<Option<T>> = calls.into_iter().map(|call| keep(errors, build(call))).collect();
    all.into_iter().collect()
}

/// A builder's complaint as a diagnostic at its argument.
fn complaint(call: &Call, e: BuildError) -> Diagnostic {
    Diagnostic::error("E0407", e.message).at(call.place(e.param), "").help(e.help)
}

fn settings_of(scene: &Scene, o: &Options) -> Result<Settings, Diagnostic> {
    let call = scene.render.as_ref();
    let built = call.map(|call| settings::build(call).map_err(|e| complaint(call, e)));
    let mut settings = built.transpose()?.unwrap_or_default();
    let overrides = Overrides { size: o.size, samples: o.samples, seed: o.seed, crop: o.crop };
    settings.apply(&overrides).map_err(|e| {
        let fault = if e.param == "crop" { Fault::Usage } else { Fault::Input };
        Diagnostic::error("E0407", e.message).help(e.help).fault(fault)
    })?;
    Ok(settings)
}

/// The camera asked for, or the first (`None` where the scene has none); mistakes in the others are told too.
fn camera_of(errors: &mut Vec<Diagnostic>, scene: &Scene, name: Option<&str>) -> Option<Option<Camera>> {
    let calls = scene.cameras.iter().map(|named| &named.call);
    let all = every(errors, calls, |call| camera::build(call).map_err(|e| complaint(call, e)));
    let Some(name) = name else { return all.map(|all| all.into_iter().next()) };
    let found = scene.cameras.iter().position(|c| c.name.as_deref() == Some(name));
    let found = keep(errors, found.ok_or_else(|| unknown_camera(scene, name)))?;
    all.map(|all| all.into_iter().nth(found))
}

fn unknown_camera(scene: &Scene, name: &str) -> Diagnostic {
    let known: Vec<&str> = scene.cameras.iter().filter_map(|c| c.name.as_deref()).collect();
    let error = Diagnostic::error("E0403", format!("the scene has no camera `{name}`")).fault(Fault::Usage);
    match crate::diag::nearest(name, known.iter().copied()) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None if known.is_empty() => error.help("none of its cameras has a name"),
        None => error.help(format!("its cameras are {}", known.join(", "))),
    }
}

/// All of these, and where they were written. `bare` is the material of faces that have none; `measure` and `write_out` are
/// those of [`Options`].
fn world(
    draws: &[Draw],
    builder: &mut Builder,
    [measure, write_out]: [bool; 2],
    bare: u32,
) -> Result<(World, Outline), Vec<Diagnostic>> {
    let materials = builder.materials;
    let mut lowering = Lowering::new(builder, measure);
    lowering.groups = Groups::of(draws.iter().map(|draw| &draw.shape), write_out);
    let mut errors = Vec::new();
    let mut solids = Vec::new();
    let mut places = Vec::new();
    let (mut bounds, mut extent) = (Aabb::EMPTY, Aabb::EMPTY);
    let mut owners = Owners::default();
    for (number, draw) in (1..).zip(draws) {
        let first = lowering.leaves.len() as u32;
        match lowering.draw(&draw.shape, draw.at) {
            Ok(drawn) => {
                owners.sheets.resize(lowering.sheets.len(), number);
                if let Some(expr) = drawn.solid {
                    owners.solids.push((first, number));
                    solids.push(expr);
                    places.push((draw.at, first..lowering.leaves.len() as u32, drawn.bounds));
                }
                extent = extent.union(drawn.bounds);
                if drawn.bounds.is_finite() {
                    bounds = bounds.union(drawn.bounds);
                }
            }
            Err(e) => errors.push(e),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let Lowering { leaves, sheets, mut outline, repeats, .. } = lowering;
    outline.extent = extent;
    // What turned out to stand once is not shared.
    drop(repeats);
    let mut whole = Expr::Or(solids);
    let world = World::new(Object::new(leaves, &whole), sheets, bounds, bare).with_owners(owners);
    if let Expr::Or(solids) = &mut whole {
        let part = |(expr, (at, leaves, bounds)): (Expr, (Span, Range<u32>, Aabb))| {
            let own = &world.solids().leaves()[leaves.start as usize..leaves.end as usize];
            Part { at, expr, clear: clear::filling(own, materials), leaves, bounds }
        };
        outline.parts = solids.drain(..).zip(places).map(part).collect();
    }
    Ok((world, outline))
}
