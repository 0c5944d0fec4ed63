//! `pss render`: scene to files.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::time::Instant;

use pss::diag::{Diagnostic, Fault};
use pss::film::Film;
use pss::output::{self, Format};
use pss::prepare::{Inputs, Options};
use pss::render::{Progress, Rendered};
use pss::shot::{Settings, Shot};

use crate::args::{ProgressMode, RenderArgs};
use crate::console::{self, Console, Failure};
use crate::load::{self, Loaded};
use crate::progress;
use crate::stats::{Stages, Stats};
use crate::{deps, watch};

/// Runs the command.
pub fn run(args: &RenderArgs, console: &Console) -> Result<(), Failure> {
    if args.watch { watch::run(args, console) } else { once(args, &Inputs::default(), console) }
}

/// Makes the picture once. The names of the files that the scene asks for are left in `inputs`, also where it fails.
pub fn once(args: &RenderArgs, inputs: &Inputs, console: &Console) -> Result<(), Failure> {
    let start = Instant::now();
    let outputs = outputs(args)?;
    let inputs = inputs.clone();
    let options = Options {
        samples: args.spp,
        seed: args.seed,
        crop: args.crop,
        inputs,
        ghosts: true,
        ..args.scene.options()
    };
    let mut loaded = load::load(&args.scene.scene, &args.scene.read, options, args.quiet, console)?;
    if loaded.draws == 0 && !args.quiet {
        console.show(&[nothing()], &loaded.sources);
    }
    if !outputs.iter().any(|path| Format::of(path) == Some(Format::Exr)) {
        // No other format holds layers.
        loaded.shot.settings.aov.clear();
    }
    for path in outputs.iter().filter(|path| !is_stdout(path)).chain(&args.stats_json).chain(&args.deps) {
        output::check(path, &loaded.inputs)?;
    }
    let rendering = Instant::now();
    let rendered = render(args, &loaded.shot)?;
    let rendering = rendering.elapsed();
    let writing = Instant::now();
    for path in &outputs {
        write(&rendered.film, &loaded.shot.settings, path)?;
    }
    let Loaded { parsing, loading, preparing, scans, inputs, sources, .. } = loaded;
    let files = inputs.len() - sources.files().filter(|f| f.path.is_some()).count();
    let stages = Stages { parsing, loading, preparing, rendering, writing: writing.elapsed() };
    let stats = Stats::new(start.elapsed(), &stages, &rendered, (files, &scans));
    if let Some(path) = &args.stats_json {
        output::write_whole(path, |sink| io::Write::write_all(sink, stats.json().as_bytes()))?;
    }
    if let Some(path) = &args.deps {
        let rule = deps::rule(&outputs, &inputs);
        output::write_whole(path, |sink| io::Write::write_all(sink, rule.as_bytes()))?;
    }
    if args.stats {
        console.note(stats.table().trim_end());
    }
    if args.output.is_empty() && !args.quiet {
        console.note(&format!("wrote {}", outputs[0].display()));
    }
    Ok(())
}

/// The warning that nothing is drawn.
fn nothing() -> Diagnostic {
    let warning = Diagnostic::warning("W0203", "the scene draws nothing: its picture is the background");
    warning.help("draw something: `draw sphere(r: 1)`")
}

fn render(args: &RenderArgs, shot: &Shot) -> Result<Rendered, Failure> {
    let progress = Progress::default();
    let mode = if args.quiet { ProgressMode::None } else { args.progress };
    let render = || pss::render::render(shot, &progress);
    Ok(progress::show(mode, shot.settings.pixels(), &|| progress.done(), render)?)
}

/// The files to write, each once: by default the scene's name with .png, in the working directory.
fn outputs(args: &RenderArgs) -> Result<Vec<PathBuf>, Failure> {
    let usage = |message: &str| Failure::from(Diagnostic::error("E0001", message).fault(Fault::Usage));
    let mut outputs: Vec<PathBuf> = Vec::new();
    for path in &args.output {
        if !outputs.contains(path) {
            outputs.push(path.clone());
        }
    }
    let others: Vec<&PathBuf> = args.stats_json.iter().chain(&args.deps).collect();
    if others.iter().any(|other| outputs.contains(other)) || (others.len() == 2 && others[0] == others[1]) {
        return Err(usage("the picture, its statistics and its dependencies cannot share a file"));
    }
    if args.deps.is_some() && outputs.iter().any(|path| is_stdout(path)) {
        return Err(usage("`--deps` names the picture: give it a file with `-o`"));
    }
    if args.watch && (outputs.iter().any(|path| is_stdout(path)) || load::is_stdin(&args.scene.scene)) {
        return Err(usage("`--watch` wants files: a scene to look at, and a picture to write again"));
    }
    if outputs.iter().any(|path| is_stdout(path)) && io::stdout().is_terminal() {
        return Err(usage("a picture would only confuse the terminal; send standard output elsewhere"));
    }
    if outputs.is_empty() {
        let scene = &args.scene.scene;
        let name = if load::is_stdin(scene) { None } else { scene.file_name() };
        outputs.push(Path::new(name.unwrap_or("scene".as_ref())).with_extension("png"));
    }
    Ok(outputs)
}

fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn write(film: &Film, settings: &Settings, path: &Path) -> Result<(), Failure> {
    if !is_stdout(path) {
        return Ok(output::write(film, settings, path)?);
    }
    let mut bytes = Vec::new();
    output::write_png(film, settings.exposure, settings.tone, &mut bytes)
        .map_err(|source| output::OutputError::Write { path: path.to_owned(), source })?;
    console::print(&bytes).map(drop)
}
