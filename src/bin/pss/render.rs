//! `pss render`: scene to files.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use pss::diag::{Diagnostic, Fault};
use pss::output::{self, Format, Old, Picture};
use pss::prepare::{Inputs, Options};
use pss::render::{Done, Progress};

use crate::args::{ProgressMode, RenderArgs};
use crate::console::{Console, Failure};
use crate::identity::Identities;
use crate::keeping::Keeping;
use crate::live::Live;
use crate::load::{self, Loaded};
use crate::making::Making;
use crate::progress;
use crate::stats::{Stages, Stats};
use crate::stop::{self, Stoppable};
use crate::{deps, watch};

/// Runs the command.
pub fn run(args: &RenderArgs, console: &Console) -> Result<(), Failure> {
    if args.watch { watch::run(args, console) } else { once(args, &Inputs::default(), console) }
}

/// Makes the picture once. The names of the files that the scene asks for are left in `inputs`, also where it fails.
pub fn once(args: &RenderArgs, inputs: &Inputs, console: &Console) -> Result<(), Failure> {
    let start = Instant::now();
    let outputs = outputs(args)?;
    stop::let_writes_fail();
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
        if args.no_clobber {
            output::check_free(path)?;
        }
    }
    let making = begin(args, &outputs, &loaded, console)?;
    let rendering = Instant::now();
    let (making, done) = render(args, (&outputs, &loaded), making, start, console)?;
    let rendering = rendering.elapsed();
    let writing = Instant::now();
    let old = if args.no_clobber { Old::Kept } else { Old::Replaced };
    making.finish(old, &taken(args, &outputs, &loaded))?;
    let layers = loaded.shot.settings.aov.len();
    let Loaded { parsing, loading, preparing, scans, inputs, sources, .. } = loaded;
    let files = inputs.len() - sources.files().filter(|f| f.path.is_some()).count();
    let stages = Stages { parsing, loading, preparing, rendering, writing: writing.elapsed() };
    let stats = Stats::new(start.elapsed(), &stages, (&done.work, layers), (files, &scans));
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

/// Begins the outputs. Where there is a file among them and the picture is made but once, tiles are kept beside the first.
fn begin(
    args: &RenderArgs,
    outputs: &[PathBuf],
    loaded: &Loaded,
    console: &Console,
) -> Result<Making, Failure> {
    let settings = &loaded.shot.settings;
    let name = outputs.first().map_or("scene".into(), |path| path.to_string_lossy());
    let live = Live::begin(args, &name, settings)?;
    let mut picture = Picture::new(settings);
    let Some(first) = outputs.iter().find(|path| !is_stdout(path)) else {
        return Making::begin(outputs, &picture, None, live);
    };
    let identities = Arc::new(Identities::new(args, settings, &loaded.sources, &loaded.inputs));
    let mut line = output::settings_line(settings);
    if let Some(camera) = &args.scene.camera {
        line += &format!(", camera {camera}");
    }
    picture.about = output::about(&identities.scene(), &line);
    let keeping = match args.watch {
        true => None,
        false => Some(Keeping::new(args, first, settings, &identities, console)?),
    };
    Making::begin(outputs, &picture, keeping, live)
}

/// Renders, as long as nothing stops it.
fn render(
    args: &RenderArgs,
    (outputs, loaded): (&[PathBuf], &Loaded),
    mut making: Making,
    start: Instant,
    console: &Console,
) -> Result<(Making, Done), Failure> {
    let progress = Arc::new(Progress::default());
    let time = args.time_limit.map(|limit| limit.saturating_sub(start.elapsed()));
    let stoppable = Stoppable::new(&progress, making.litter(), time);
    let mode = if args.quiet { ProgressMode::None } else { args.progress };
    let shot = &loaded.shot;
    let render = || pss::render::render_for(shot, &progress, &mut making);
    let done = progress::show(mode, shot.settings.pixels(), &|| progress.done(), render);
    making.live.end(console);
    let trouble = making.keeping.as_ref().and_then(Keeping::trouble);
    if !args.quiet {
        console.show(trouble.as_slice(), &loaded.sources);
    }
    let done = done?;
    match making.failure.take() {
        Some(e) => Err(e.into()),
        None if done.missing == 0 => Ok((making, done)),
        None => Err(stopped(&done, making, stoppable.signal(), &taken(args, outputs, loaded))),
    }
}

/// All files that are something else than what there is of a stopped picture.
fn taken(args: &RenderArgs, outputs: &[PathBuf], loaded: &Loaded) -> Vec<PathBuf> {
    let others = args.stats_json.iter().chain(&args.deps);
    loaded.inputs.iter().chain(outputs).chain(others).cloned().collect()
}

/// Leaves what there is of a picture of which tiles are missing.
fn stopped(done: &Done, mut making: Making, signal: Option<u8>, taken: &[PathBuf]) -> Failure {
    let kept = making.keeping.as_ref().is_some_and(Keeping::is_kept);
    let there = format!("{} of {} tiles are done", done.tiles - done.missing, done.tiles);
    let mut failure = match &done.failed {
        Some(e) => {
            let mut failure = Failure::from(e.clone());
            failure.diagnostics[0].notes.push(there);
            failure
        }
        None => {
            let by = signal
                .map_or("the time limit", |number| if number == 2 { "an interrupt" } else { "a signal" });
            let fault = signal.filter(|_| !kept).map_or(Fault::Stopped, Fault::Signal);
            Failure::from(Diagnostic::error("E0611", format!("stopped by {by}: {there}")).fault(fault))
        }
    };
    let diagnostic = &mut failure.diagnostics[0];
    diagnostic.notes.extend(making.finish_partial(taken));
    if kept && diagnostic.help.is_none() {
        diagnostic.help = Some("the same command with `--resume` goes on".into());
    }
    failure
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
    if args.watch && (args.resume || args.no_clobber || args.time_limit.is_some()) {
        return Err(usage(
            "`--watch` makes the picture anew each time: nothing is resumed, limited or left as it was",
        ));
    }
    if args.preview && outputs.iter().any(|path| is_stdout(path)) {
        return Err(usage("`--preview` draws on standard output, where the picture itself shall go"));
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
