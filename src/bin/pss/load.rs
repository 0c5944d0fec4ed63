//! From a scene's name to a prepared shot.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use pss::diag::{Diagnostic, Fault};
use pss::lang::{Read as SceneRead, Reading};
use pss::measure::Measuring;
use pss::prepare::{self, Imports, Options, Outline, ScanReport};
use pss::shot::Shot;
use pss::source::{FileId, SourceMap};

use crate::args::{ReadArgs, cut};
use crate::console::{Console, Failure};

/// The longest scene, bytes: parsing takes some seventy times as much memory.
pub const MAX_SCENE: u64 = 16 << 20;

/// A scene ready to trace.
#[derive(Debug)]
pub struct Loaded {
    /// What is rendered.
    pub shot: Shot,
    /// All files read, the scene among them.
    pub inputs: Vec<PathBuf>,
    /// What was found about each scan.
    pub scans: Vec<ScanReport>,
    /// Reading and understanding the text.
    pub parsing: Duration,
    /// Building what it says.
    pub preparing: Duration,
    /// Time spent on reading the files that the scene names, while it is prepared.
    pub loading: Duration,
    /// Where its solids were written.
    pub outline: Outline,
    /// All texts read.
    pub sources: SourceMap,
    /// How many things it draws.
    pub draws: usize,
    /// How many warnings there were.
    pub warnings: usize,
    /// Expectations that are not met, if they were to be evaluated.
    pub unmet: Vec<Diagnostic>,
    /// What is wrong with shapes that are named and not drawn, if that was asked.
    pub idle: Vec<Diagnostic>,
}

/// A scene that was read and understood.
#[derive(Debug)]
pub struct Understood {
    /// What it says, what it warns of, and what does not hold.
    pub read: SceneRead,
    /// All texts read.
    pub sources: SourceMap,
    /// The scene's own.
    pub file: FileId,
    /// What it was read with.
    pub options: Options,
}

/// Reads and prepares a scene. `options` holds what the command has to say; what all commands share is filled
/// in here.
pub fn load(
    scene: &Path,
    args: &ReadArgs,
    options: Options,
    quiet: bool,
    console: &Console,
) -> Result<Loaded, Failure> {
    load_with(scene, args, options, Asks { quiet, ..Asks::default() }, console)
}

/// What a command wants to know of a scene.
#[derive(Clone, Copy, Default, Debug)]
pub struct Asks {
    /// Nothing of warnings.
    pub quiet: bool,
    /// Whether it keeps its expectations.
    pub expects: bool,
    /// What is wrong with shapes that it names and does not draw.
    pub idle: bool,
}

/// The same, with more that is asked.
pub fn load_with(
    scene: &Path,
    args: &ReadArgs,
    options: Options,
    Asks { quiet, expects, idle }: Asks,
    console: &Console,
) -> Result<Loaded, Failure> {
    let start = Instant::now();
    let Understood { read, sources, options, .. } =
        understand(scene, args, options, [quiet, expects], console)?;
    let parsing = start.elapsed();
    let start = Instant::now();
    let prepared = match prepare::prepare(&read.scene, &options) {
        Ok(prepared) => prepared,
        Err(errors) => return Err(Failure::new(errors, sources)),
    };
    if !quiet {
        console.show(&prepared.warnings, &sources);
    }
    let mut inputs: Vec<PathBuf> = sources.files().filter_map(|f| f.path.clone()).collect();
    let others = options.inputs.list();
    inputs.extend(others.into_iter().filter(|path| !inputs.contains(path)).collect::<Vec<_>>());
    let idle = if idle { prepare::prepare(&read.scene.of_idle(&read.named), &options).err() } else { None };
    Ok(Loaded {
        shot: prepared.shot,
        idle: idle.unwrap_or_default(),
        inputs,
        scans: prepared.scans,
        parsing,
        preparing: start.elapsed().saturating_sub(prepared.loading),
        loading: prepared.loading,
        outline: prepared.outline,
        warnings: read.warnings.len() + prepared.warnings.len(),
        draws: read.scene.draws.len() + read.scene.ghosts.len(),
        unmet: read.unmet,
        sources,
    })
}

/// Reads a scene, shows its warnings and what it prints.
pub fn understand(
    scene: &Path,
    args: &ReadArgs,
    options: Options,
    [quiet, expects]: [bool; 2],
    console: &Console,
) -> Result<Understood, Failure> {
    let (mut sources, file) = source(scene)?;
    let options = Options {
        scene_dir: if is_stdin(scene) { PathBuf::from(".") } else { folder(scene) },
        allow_read: args.allow_read.clone(),
        cut: cut(args.lenient),
        ..options
    };
    let catalog = prepare::catalog();
    let imports = Imports {
        scene_dir: &options.scene_dir,
        allow_read: &options.allow_read,
        limit: MAX_SCENE,
        inputs: options.inputs.clone(),
    };
    let measuring = Measuring::new(&options);
    let reading = Reading {
        catalog: &catalog,
        defines: &args.define,
        files: Some(&imports),
        geometry: Some(&measuring),
        expects,
        memory: pss::lang::MEMORY,
    };
    match pss::lang::read_with(&mut sources, file, &reading) {
        Ok(read) => {
            if !quiet {
                console.show(&read.warnings, &sources);
            }
            read.scene.prints.iter().for_each(|line| console.printed(line));
            Ok(Understood { read, sources, file, options })
        }
        Err(errors) => Err(Failure::new(errors, sources)),
    }
}

/// The text of a scene, with its name.
pub fn source(scene: &Path) -> Result<(SourceMap, FileId), Failure> {
    let text = read_scene(scene)?;
    let mut sources = SourceMap::default();
    let file = match is_stdin(scene) {
        true => sources.add("<stdin>".to_owned(), None, text),
        false => sources.add(scene.display().to_string(), Some(scene.to_owned()), text),
    };
    Ok((sources, file))
}

/// Whether the scene comes from standard input.
pub fn is_stdin(scene: &Path) -> bool {
    scene.as_os_str() == "-"
}

/// The folder of a scene.
fn folder(scene: &Path) -> PathBuf {
    let parent = scene.parent().filter(|p| !p.as_os_str().is_empty());
    parent.unwrap_or(Path::new(".")).to_owned()
}

/// The text of a scene.
fn read_scene(path: &Path) -> Result<String, Failure> {
    let bytes =
        if is_stdin(path) { read_limited(io::stdin().lock(), MAX_SCENE) } else { read_file(path, MAX_SCENE) };
    let missing = |e: io::Error| {
        let message = format!("cannot read `{}`: {}", path.display(), reason(&e));
        Failure::from(Diagnostic::error("E0601", message).fault(Fault::Missing))
    };
    let bytes = bytes.map_err(missing)?;
    if MAX_SCENE < bytes.len() as u64 {
        let message = format!("`{}` is longer than {} MiB", path.display(), MAX_SCENE >> 20);
        return Err(Failure::from(Diagnostic::error("E0701", message)));
    }
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let message = format!("`{}` is not UTF-8 text: byte {at} is wrong", path.display());
        Failure::from(Diagnostic::error("E0101", message))
    })
}

/// Reads a regular file, up to one byte past a limit: opening anything else may wait for ever.
pub fn read_file(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let meta = fs::metadata(path)?;
    if !meta.is_file() {
        let kind = if meta.is_dir() { "it is a folder" } else { "it is not a regular file" };
        return Err(io::Error::other(kind));
    }
    read_limited(File::open(path)?, limit)
}

/// Reads up to one byte past the limit, so that the caller can tell.
fn read_limited(from: impl Read, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(limit + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The system's reason, in words where they are known.
pub fn reason(e: &io::Error) -> String {
    match e.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "its permissions do not allow it".to_owned(),
        _ => e.to_string(),
    }
}
