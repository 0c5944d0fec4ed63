//! The declaration of `points`; the surface itself is [`super::point_set`].

use super::point_set::{Lead, Options};
use super::table::{Build, Primitive};
use crate::geom::tolerance;
use crate::mls::Form;
use crate::scene::{Call, Decl, Group, Kind, Param};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "points",
        group: Group::Primitive,
        doc: "The surface of a scanned cloud, or of samples taken evenly from a solid.",
        params: &[
            Param::placed("source", Kind::PathOrSolid, "a PLY file, or the solid to sample"),
            Param::named("samples", Kind::Int(1, 50_000_000), "how many samples to take of a solid"),
            Param::named("noise", Kind::Length, "standard deviation of the samples' error (default 0)"),
            Param::named("seed", Kind::Int(0, i64::MAX), "seed of sampling and noise (default 0)"),
            Param::named("smoothing", Kind::Positive, "factor on the automatic width (default 1)"),
            Param::named("h", Kind::Width, "one width for all samples instead of the automatic ones"),
            Param::named("degree", Kind::Int(0, 4), "degree of the local polynomial (default 2)"),
            Param::named("kernel", Kind::Choice(&["compact", "gaussian"]), "the weight"),
            Param::named(
                "facing",
                Kind::Choice(&["same", "any"]),
                "which samples weigh: those that face the same way, or all",
            ),
            Param::named(
                "plane",
                Kind::Choice(&["free", "levin"]),
                "the reference plane: of least squares with both normal and offset free, or Levin's",
            ),
            Param::named("normals", Kind::Choice(&["file", "estimate"]), "where normals come from"),
            Param::named("tolerance", Kind::Positive, "relative to the size of the cloud (default 1e-9)"),
        ],
        example: "points(sphere(r: 1), samples: 2000)",
    },
    build: Build::Points,
};

/// The options of the surface that a call asks for; whether patches pay is for the picture to say.
pub fn options(call: &Call) -> Options {
    Options {
        gaussian: call.text("kernel") == Some("gaussian"),
        mixed: call.text("facing") == Some("any"),
        form: if call.text("plane") == Some("levin") { Form::Levin } else { Form::Free },
        degree: call.number("degree").map_or(2, |d| d as usize),
        tolerance: call.number("tolerance").unwrap_or(tolerance::POINTS),
        lead: Lead::Guides,
    }
}
