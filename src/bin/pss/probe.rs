//! `pss probe`: where rays go in and out of what a scene draws.

use std::fmt::Write;
use std::path::Path;

use glam::DVec3;
use pss::csg::Scratch;
use pss::csg::{Boundary, Span, Spans};
use pss::diag::{Diagnostic, Fault};
use pss::geom::{Interval, Ray};
use pss::prepare::Options;
use pss::shot::{Hit, Shot, World};
use pss::source::{self, SourceMap};
use rayon::prelude::*;
use serde::Serialize;

use crate::args::{self, ProbeArgs};
use crate::console::{self, Console, Failure};
use crate::load;

/// So many rays are answered before their lines are written: enough for all threads, little to hold.
const BATCH: usize = 4096;

/// Runs the command.
pub fn run(args: &ProbeArgs, console: &Console) -> Result<(), Failure> {
    let rays = args.rays.as_deref().map(read_rays).transpose()?;
    let options = Options { measure_all: true, ..args.scene.options() };
    let loaded = load::load(&args.scene.scene, &args.scene.read, options, false, console)?;
    let rays = match (rays, args.ray, args.pixel) {
        (Some(rays), ..) => rays,
        (None, Some(ray), _) => vec![ray],
        (None, None, pixel) => vec![pixel_ray(&loaded.shot, pixel.unwrap_or_default())?],
    };
    let print = if args.json { json } else { table };
    for (batch, rays) in rays.chunks(BATCH).enumerate() {
        let answer = |scratch: &mut Scratch, (i, ray): (usize, &Ray)| {
            print(&Answer::of(&loaded.shot.world, batch * BATCH + i, ray, scratch))
        };
        let lines: Vec<String> = rays.par_iter().enumerate().map_init(Scratch::default, answer).collect();
        if !console::print(lines.concat().as_bytes())? {
            break;
        }
    }
    Ok(())
}

/// The ray through a pixel's centre.
fn pixel_ray(shot: &Shot, [x, y]: [u32; 2]) -> Result<Ray, Failure> {
    let [w, h] = shot.settings.size;
    if w <= x || h <= y {
        let message = format!("there is no pixel {x},{y} in a picture of {w} x {h}");
        return Err(Failure::from(Diagnostic::error("E0001", message).fault(Fault::Usage)));
    }
    Ok(shot.camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, [w, h]))
}

/// The longest file of rays, bytes: places in it are counted in 32 bits.
const MAX_RAYS: u64 = 3 << 30;

/// Reads rays, one a line; empty lines are skipped.
fn read_rays(path: &Path) -> Result<Vec<Ray>, Failure> {
    let bytes = load::read_file(path, MAX_RAYS).map_err(|e| {
        let message = format!("cannot read `{}`: {}", path.display(), load::reason(&e));
        Failure::from(Diagnostic::error("E0601", message).fault(Fault::Missing))
    })?;
    if MAX_RAYS < bytes.len() as u64 {
        let message = format!("`{}` is longer than {} GiB", path.display(), MAX_RAYS >> 30);
        return Err(Failure::from(Diagnostic::error("E0701", message)));
    }
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let mut sources = SourceMap::default();
    let file = sources.add(path.display().to_string(), Some(path.to_owned()), text);
    let mut rays = Vec::new();
    let mut start = 0;
    for line in sources.file(file).text.split_inclusive('\n') {
        let trimmed = line.trim();
        if !trimmed.is_empty() {
            match args::ray(trimmed) {
                Ok(ray) => rays.push(ray),
                Err(message) => {
                    let span = source::Span { file, start, end: start + line.trim_end().len() as u32 };
                    let error = Diagnostic::error("E0604", message).at(span, "");
                    return Err(Failure::new(vec![error], sources));
                }
            }
        }
        start += line.len() as u32;
    }
    Ok(rays)
}

/// What a ray meets. The names are a contract.
#[derive(Serialize)]
struct Answer<'a> {
    ray: usize,
    spans: Vec<SpanAnswer<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sheets: Vec<End<'a>>,
}

#[derive(Serialize)]
struct SpanAnswer<'a> {
    enter: Option<End<'a>>,
    exit: Option<End<'a>>,
}

/// A crossing.
#[derive(Serialize)]
struct End<'a> {
    t: f64,
    err: f64,
    point: [f64; 3],
    normal: [f64; 3],
    leaf: &'a str,
    flipped: bool,
    cap: bool,
}

impl<'a> Answer<'a> {
    fn of(world: &'a World, index: usize, ray: &Ray, scratch: &mut Scratch) -> Answer<'a> {
        let mut spans = Spans::new();
        world.spans(ray, Interval::AHEAD, scratch, &mut spans);
        let mut sheets = Vec::new();
        world.sheets(ray, Interval::AHEAD, scratch, &mut sheets);
        let end = |boundary: Option<Boundary>, entering: bool| {
            boundary.map(|boundary| End::of(world, ray, &Hit { boundary, entering, sheet: false }))
        };
        let spans = spans
            .iter()
            .map(|Span { enter, exit }| SpanAnswer { enter: end(*enter, true), exit: end(*exit, false) })
            .collect();
        let sheets = sheets.iter().map(|hit| End::of(world, ray, hit)).collect();
        Answer { ray: index, spans, sheets }
    }
}

impl<'a> End<'a> {
    fn of(world: &'a World, ray: &Ray, hit: &Hit) -> End<'a> {
        let surface = world.surface(ray, hit);
        End {
            t: hit.boundary.t,
            err: world.error(ray, hit, &surface),
            point: surface.point.to_array(),
            normal: surface.normal.to_array(),
            leaf: world.leaf_name(hit),
            flipped: hit.boundary.flipped,
            cap: hit.boundary.crossing.cap,
        }
    }
}

fn json(answer: &Answer) -> String {
    // A struct of numbers and names always has a JSON form.
    serde_json::to_string(answer).unwrap_or_else(|e| format!("\"{e}\"")) + "\n"
}

fn table(answer: &Answer) -> String {
    let mut text = String::new();
    let nothing = answer.spans.is_empty() && answer.sheets.is_empty();
    let _ = writeln!(text, "ray {}{}", answer.ray, if nothing { ": meets nothing" } else { "" });
    for span in &answer.spans {
        row(&mut text, "enter", span.enter.as_ref());
        row(&mut text, "exit", span.exit.as_ref());
    }
    answer.sheets.iter().for_each(|end| row(&mut text, "sheet", Some(end)));
    text
}

fn row(text: &mut String, what: &str, end: Option<&End>) {
    // Writing to a string cannot fail.
    let _ = match end {
        None => writeln!(text, "  {what:<5} -"),
        Some(end) => {
            let flags = [(end.flipped, " flipped"), (end.cap, " cap")];
            let flags: String = flags.iter().filter(|(on, _)| *on).map(|(_, word)| *word).collect();
            let (point, normal) = (DVec3::from(end.point), DVec3::from(end.normal));
            let (t, err, leaf) = (end.t, end.err, end.leaf);
            writeln!(
                text,
                "  {what:<5} t {t:<20} err {err:<8.1e} at {point:.6} normal {normal:.6} {leaf}{flags}"
            )
        }
    };
}
