//! A small catalogue and a way to read a scene from a string, for the tests of the language.
#![allow(dead_code)]

use std::path::{Path, PathBuf};

use pss::diag::Diagnostic;
use pss::lang::{Files, Reading};
use pss::scene::{Catalog, Decl, Group, Kind, Param, Scene};
use pss::source::{SourceMap, Span};

const fn decl(word: &'static str, group: Group, params: &'static [Param]) -> Decl {
    Decl { word, group, doc: "", params, example: "" }
}

const DECLS: &[Decl] = &[
    decl(
        "sphere",
        Group::Primitive,
        &[Param::required("r", Kind::SizeOrVector, "radius"), Param::named("at", Kind::Vector(3), "centre")],
    ),
    decl(
        "box",
        Group::Primitive,
        &[
            Param::placed("a", Kind::Vector(3), "corner"),
            Param::placed("b", Kind::Vector(3), "corner"),
            Param::named("size", Kind::SizeOrVector, "edges"),
            Param::named("at", Kind::Vector(3), "centre"),
        ],
    ),
    decl(
        "cylinder",
        Group::Primitive,
        &[
            Param::required("r", Kind::Size, "radius"),
            Param::named("h", Kind::Size, "height"),
            Param::named("from", Kind::Vector(3), "end"),
            Param::named("to", Kind::Vector(3), "end"),
        ],
    ),
    decl(
        "half_space",
        Group::Primitive,
        &[
            Param::placed("inside", Kind::HalfSpace, "condition"),
            Param::named("normal", Kind::Vector(3), "out"),
            Param::named("at", Kind::Vector(3), "point"),
        ],
    ),
    decl(
        "implicit",
        Group::Primitive,
        &[
            Param { required: true, ..Param::placed("where", Kind::Condition, "condition") },
            Param::required("inside", Kind::Solid, "bounds"),
        ],
    ),
    decl("plane", Group::Primitive, &[Param::required("z", Kind::Length, "height")]),
    decl(
        "points",
        Group::Primitive,
        &[
            Param { required: true, ..Param::placed("source", Kind::PathOrSolid, "file or solid") },
            Param::named("degree", Kind::Int(0, 4), "degree"),
            Param::named("kernel", Kind::Choice(&["gaussian", "compact"]), "weight"),
            Param::named("smoothing", Kind::Positive, "factor"),
        ],
    ),
    decl(
        "camera",
        Group::Camera,
        &[
            Param::named("eye", Kind::Vector(3), "eye"),
            Param::named("look_at", Kind::Vector(3), "target"),
            Param::named("fov", Kind::Angle, "vertical angle"),
        ],
    ),
    decl(
        "light",
        Group::Light,
        &[
            Param::named("direction", Kind::Vector(3), "travels"),
            Param::named("color", Kind::Color, "colour"),
            Param::named("intensity", Kind::Number, "factor"),
            Param::named("softness", Kind::Angle, "angle"),
            Param::named("falloff", Kind::Bool, "with distance"),
        ],
    ),
    decl(
        "render",
        Group::Render,
        &[
            Param::named("size", Kind::Vector(2), "pixels"),
            Param::named("samples", Kind::Int(1, 1_000_000), "a pixel"),
            Param::named("integrator", Kind::Choice(&["direct", "path", "ao"]), "light"),
            Param::named("aov", Kind::Choices(&["depth", "normal"]), "layers"),
        ],
    ),
    decl(
        "matte",
        Group::Material,
        &[
            Param::placed("color", Kind::Color, "colour"),
            Param::named("roughness", Kind::Number, "roughness"),
        ],
    ),
    decl("metal", Group::Material, &[Param::placed("color", Kind::Color, "colour")]),
];

/// Enough to write scenes.
pub fn catalog() -> Catalog {
    Catalog { decls: DECLS.to_vec() }
}

/// A scene with its warnings, or errors.
pub type Outcome = Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>>;

/// Every file that is imported is empty.
struct Empty;

impl Files for Empty {
    fn resolve(&self, written: &str, folder: &Path, _: Span) -> Result<PathBuf, Diagnostic> {
        Ok(folder.join(written))
    }

    fn read(&self, _: &Path, _: Span) -> Result<String, Diagnostic> {
        Ok(String::new())
    }
}

/// Reads a scene that is called `scene.pss` in the folder `/scenes`.
pub fn read_with(text: &str, defines: &[(&str, &str)]) -> (Outcome, SourceMap) {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", Some("/scenes/scene.pss".into()), text);
    let defines: Vec<(String, String)> =
        defines.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    let catalog = catalog();
    let reading = Reading {
        catalog: &catalog,
        defines: &defines,
        files: Some(&Empty),
        geometry: None,
        expects: false,
        memory: pss::lang::MEMORY,
    };
    let outcome = pss::lang::read_with(&mut sources, file, &reading);
    (outcome.map(|read| (read.scene, read.warnings)), sources)
}

/// What a scene's errors and warnings look like in a terminal.
pub fn complaints(text: &str, defines: &[(&str, &str)]) -> String {
    let (outcome, sources) = read_with(text, defines);
    let all = match outcome {
        Ok((_, warnings)) => warnings,
        Err(errors) => errors,
    };
    pss::report::text(&all, &sources, false)
}

/// A scene that must be right.
pub fn scene(text: &str) -> Scene {
    let (outcome, sources) = read_with(text, &[]);
    match outcome {
        Ok((scene, _)) => scene,
        Err(errors) => panic!("{}", pss::report::text(&errors, &sources, false)),
    }
}

/// A test that a scene is answered with exactly this text.
#[allow(unused_macros)]
macro_rules! says {
    ($claim:ident: $scene:expr, $text:expr) => {
        says! { $claim: $scene, -D &[], $text }
    };
    ($claim:ident: $scene:expr, -D $defines:expr, $text:expr) => {
        #[test]
        fn $claim() {
            assert_eq!($crate::lang_support::complaints($scene, $defines).trim_end(), $text.trim());
        }
    };
}
