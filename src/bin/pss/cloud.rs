//! `pss cloud`: what the program sees in a cloud, and clouds to PLY.

use std::fmt::Write as _;
use std::path::Path;

use pss::cloud::{Cloud, CloudError, CloudFault, SampleOptions, Samples, ply};
use pss::diag::{Diagnostic, Fault};
use pss::output::write_whole;
use pss::prepare::survey::{Spread, Survey, survey};
use pss::source::SourceMap;

use crate::args::{CloudCommand, ConvertArgs, InfoArgs, cut};
use crate::console::{self, Console, Failure};

/// Does what is asked.
pub fn run(command: &CloudCommand, console: &Console) -> Result<(), Failure> {
    match command {
        CloudCommand::Info(args) => info(args),
        CloudCommand::Convert(args) => convert(args, console),
    }
}

fn info(args: &InfoArgs) -> Result<(), Failure> {
    for path in &args.files {
        let found = read(path, args.common.lenient)
            .and_then(|cloud| survey(cloud).map_err(|e| complaint(path, &e)))?;
        let text = if args.json { json(path, &found) } else { table(path, &found) };
        console::print(text.as_bytes())?;
    }
    Ok(())
}

fn convert(args: &ConvertArgs, console: &Console) -> Result<(), Failure> {
    let ConvertArgs { file, out, .. } = args;
    let refuse = |code, message: String, fault| Failure::from(Diagnostic::error(code, message).fault(fault));
    if !out.extension().is_some_and(|e| e.eq_ignore_ascii_case("ply")) {
        return Err(refuse("E0001", format!("`{}` does not end in .ply", out.display()), Fault::Usage));
    }
    let same = |a: &Path, b: &Path| a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
    if same(file, out) {
        return Err(refuse("E0607", format!("`{}` is the input", out.display()), Fault::Output));
    }
    let mut cloud = read(file, args.common.lenient)?;
    if args.normals || args.clean {
        cloud = worked(cloud, args).map_err(|e| complaint(file, &e))?;
    }
    let warning = |note| Diagnostic::warning("W0102", format!("`{}`: {note}", file.display()));
    let warnings: Vec<Diagnostic> = cloud.notes.iter().map(warning).collect();
    console.show(&warnings, &SourceMap::default());
    let encoding = if args.ascii { ply::Encoding::Text } else { ply::Encoding::Binary };
    Ok(write_whole(out, |sink| ply::write(&cloud, encoding, sink))?)
}

/// The samples that a surface is made of, with normals where asked for or given.
fn worked(cloud: Cloud, args: &ConvertArgs) -> Result<Cloud, CloudError> {
    let keeps_normals = args.normals || cloud.normals.is_some();
    let options = SampleOptions { keep_strays: !args.clean, ..SampleOptions::default() };
    let Samples { points, normals, colors, notes, .. } = Samples::new(cloud, &options)?;
    Ok(Cloud { points, normals: keeps_normals.then_some(normals), colors, notes, dropped: 0 })
}

fn read(path: &Path, lenient: bool) -> Result<Cloud, Failure> {
    ply::read_path_as(path, cut(lenient)).map_err(|e| complaint(path, &e))
}

fn complaint(path: &Path, e: &CloudError) -> Failure {
    let (code, fault) = match e.kind {
        CloudFault::Missing => ("E0601", Fault::Missing),
        CloudFault::Bad => ("E0605", Fault::Input),
        CloudFault::Io => ("E0606", Fault::Io),
    };
    let usual = "a cloud is a PLY file with x, y and z of at least three points that do not lie on a line";
    let error = Diagnostic::error(code, format!("`{}`: {e}", path.display())).fault(fault);
    Failure::from(error.help(e.help.clone().unwrap_or_else(|| usual.to_owned())))
}

/// One line of JSON.
fn json(path: &Path, survey: &Survey) -> String {
    let mut value = serde_json::to_value(survey).unwrap_or_default();
    if let serde_json::Value::Object(fields) = &mut value {
        fields.insert("file".to_owned(), path.display().to_string().into());
    }
    format!("{value}\n")
}

/// Lines for people; lengths as in the file.
fn table(path: &Path, s: &Survey) -> String {
    let range = |r: &Spread| format!("{:.4e} .. {:.4e} (median {:.4e})", r.least, r.most, r.median);
    // Six digits of the size, but no row of zeros before them.
    let length = |x: f64| match s.diagonal {
        0.1..1e6 => format!("{x:.6}"),
        _ => format!("{x:.6e}"),
    };
    let place = |p: glam::DVec3| format!("[{}]", p.to_array().map(length).join(", "));
    let [x, y, z] = (s.max - s.min).to_array().map(length);
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let odd = 100.0 * f64::from(s.inside.odd) / f64::from(s.inside.chords.max(1));
    let mut rows = vec![
        ("points", format!("{} in the file, {} samples", s.points, s.samples)),
        ("extent", format!("{x} x {y} x {z}, diagonal {}", length(s.diagonal))),
        ("from, to", format!("{} .. {}", place(s.min), place(s.max))),
        ("spacing", format!("{}, nearest +-{}", range(&s.spacing), percent(s.unevenness))),
        ("noise", format!("{:.4e}, {:.3} of a width", s.noise, s.noise / s.width.median)),
        ("width", range(&s.width)),
        (
            "smallest wall",
            format!("{:.4e}; {} of samples lie on thinner ones", s.smallest_wall, percent(s.thin)),
        ),
        ("normals", format!("{}, {} of near pairs opposed", s.normals, percent(s.opposed))),
        ("colours", if s.colors { "yes" } else { "no" }.to_owned()),
        (
            "holes",
            match s.holes.count {
                0 => "none".to_owned(),
                n => format!(
                    "{n}, {} open, the widest {:.4e}: `.close(max_hole: ...)` must allow it",
                    s.holes.open, s.holes.widest
                ),
            },
        ),
        (
            "inside",
            format!(
                "a {}: {} of {} test lines cross it an odd number of times ({odd:.2} %)",
                s.inside.body, s.inside.odd, s.inside.chords
            ),
        ),
    ];
    rows.extend(s.notes.iter().map(|n| ("note", n.clone())));
    rows.extend(s.warnings.iter().map(|n| ("warning", n.clone())));
    let mut out = format!("{}\n", path.display());
    for (name, value) in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {name:<14} {value}");
    }
    out
}
