//! What `pss test` does with the goldens beside a scene: compares and tells, or writes.

use std::path::Path;

use pss::diag::{Diagnostic, Fault};
use pss::golden::{self, Differs, GoldenError, Goldens, Kind};
use pss::lang::ast::ItemKind;
use pss::source::{FileId, SourceMap};

use crate::console::{Console, Failure};
use crate::load::Loaded;
use crate::numbers;

/// What there is to say of a scene that is as it was.
#[derive(Default, Debug)]
pub struct Kept {
    /// In words that follow its `ok`.
    pub told: String,
    /// Whether it has no golden at all.
    pub is_bare: bool,
}

/// Compares a scene with what lies beside it; what differs, as errors. A picture of the differences is left beside it, or removed.
pub fn compare(scene: &Path, loaded: &Loaded, console: &Console) -> Result<Kept, Vec<Diagnostic>> {
    let goldens = Goldens::read(scene).map_err(one)?;
    if goldens.is_empty() {
        if others_have_goldens(scene) && pictures_something(&loaded.sources) {
            console.show(&[bare(scene)], &loaded.sources);
        }
        return Ok(Kept { told: ", no golden".to_owned(), is_bare: true });
    }
    let compared = goldens.compare(&loaded.shot).map_err(|e| one(e.into()))?;
    let shown = compared.show_beside(scene).map_err(|e| one(e.into()))?;
    let mut wrong: Vec<Diagnostic> = goldens.missing().map(|kind| missing(scene, kind)).collect();
    if !numbers::are_expected(&loaded.sources) {
        wrong.push(without_number(scene, "has goldens"));
    }
    wrong.extend(compared.differs.iter().map(|differs| error(scene, differs, shown)));
    if wrong.is_empty() { Ok(Kept::default()) } else { Err(wrong) }
}

/// Makes goldens of what a scene is, and says what changed.
pub fn bless(scene: &Path, loaded: &Loaded, console: &Console) -> Result<Kept, Vec<Diagnostic>> {
    let goldens = Goldens::read(scene).map_err(one)?;
    if !numbers::are_expected(&loaded.sources) {
        return Err(vec![without_number(scene, "is not blessed")]);
    }
    let blessed = golden::bless(scene, &goldens, &loaded.shot, &loaded.inputs).map_err(one)?;
    if blessed.is_nothing() {
        return Ok(Kept::default());
    }
    let differs = &blessed.compared.differs;
    for Differs { kind, first, was, is, .. } in differs {
        let file = kind.beside(scene);
        console.note(&format!("{}: {first} was: {was}, is: {is}", file.display()));
    }
    let shown = golden::differences_beside(scene);
    let shown = (!differs.is_empty()).then(|| format!("`{}` shows what changed", shown.display()));
    let changed = differs.iter().map(|d| format!("{} {} of .{}", d.count, d.kind.unit(), d.kind.suffix()));
    let added = blessed.added.iter().map(|kind| format!("new .{}", kind.suffix()));
    let all: Vec<String> = changed.chain(added).chain(shown).collect();
    Ok(Kept { told: format!(", blessed: {}", all.join(", ")), is_bare: false })
}

/// The goldens of a scene that is gone.
pub fn orphans(scene: &Path) -> Diagnostic {
    let files = Kind::ALL.map(|kind| kind.beside(scene)).into_iter().filter(|file| file.exists());
    let files: Vec<String> = files.map(|file| format!("`{}`", file.display())).collect();
    let told = format!("`{}` is gone, and its goldens are here: {}", scene.display(), files.join(", "));
    let error = Diagnostic::error("E0808", told).fault(Fault::Unmet);
    error.help("bring the scene back, or remove its goldens too")
}

/// A golden that is gone while others of its scene are here.
fn missing(scene: &Path, kind: Kind) -> Diagnostic {
    let told = format!("`{}` is gone, and other goldens of the scene are here", kind.beside(scene).display());
    let error = Diagnostic::error("E0808", told).fault(Fault::Unmet);
    error.help("bring it back, or `pss test --bless` makes it of what the scene is now")
}

fn without_number(scene: &Path, what: &str) -> Diagnostic {
    let told = format!("`{}` {what}, and expects no number of a shape", scene.display());
    let error = Diagnostic::error("E0807", told).fault(Fault::Unmet);
    error.help("a wrong golden is seen by what a formula knows: `expect volume(part) ~= 6.43 within 0.1%`")
}

/// The warning of a scene that has no golden beside others that have.
fn bare(scene: &Path) -> Diagnostic {
    let told = format!("`{}` has no golden, and other scenes of its folder have", scene.display());
    let warning = Diagnostic::warning("W0207", told);
    warning.help("bring back what was removed, or `pss test --bless` makes them")
}

/// Whether the folder of a scene that has no golden holds some.
fn others_have_goldens(scene: &Path) -> bool {
    let folder = scene.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).any(|path| path.extension().is_some_and(|e| e == Kind::Spans.suffix()))
}

/// Whether a scene says what is seen: a folder's files of functions do not.
fn pictures_something(sources: &SourceMap) -> bool {
    // The scene's own text is the first.
    let items = pss::lang::items(sources, FileId::default()).unwrap_or_default();
    items.iter().any(|item| matches!(item.kind, ItemKind::Draw(..) | ItemKind::Render(_)))
}

/// What to say of a golden that differs; `shown`: there is a picture of the differences.
fn error(scene: &Path, differs: &Differs, shown: bool) -> Diagnostic {
    let Differs { kind, count, of, first, was, is, ray } = differs;
    let (file, unit) = (kind.beside(scene), kind.unit());
    let told = format!("`{}` differs: {count} of {of} {unit}", file.display());
    let error = Diagnostic::error("E0805", told)
        .fault(Fault::Unmet)
        .note(format!("{first} was: {was}"))
        .note(format!("{first} is:  {is}"));
    let error = match ray {
        Some(ray) => {
            let (o, d) = (ray.origin, ray.dir);
            let ray = format!("{},{},{} {},{},{}", o.x, o.y, o.z, d.x, d.y, d.z);
            error.note(format!("all of that ray: pss probe {} --ray \"{ray}\"", scene.display()))
        }
        None => error,
    };
    let bless = "if it is meant, `pss test --bless` makes it the golden";
    match shown {
        true => {
            let picture = golden::differences_beside(scene);
            error.help(format!("`{}` shows what was, where it differs, what is; {bless}", picture.display()))
        }
        false => error.help(bless),
    }
}

/// Why goldens cannot be compared or written.
fn one(e: GoldenError) -> Vec<Diagnostic> {
    let told = e.to_string();
    match e {
        GoldenError::Broken { .. } => {
            let help = "remove it, and `pss test --bless` writes it anew";
            vec![Diagnostic::error("E0806", told).help(help)]
        }
        GoldenError::InTheWay { .. } => {
            let help = "somebody rendered it: move the file away";
            vec![Diagnostic::error("E0806", told).fault(Fault::Output).help(help)]
        }
        GoldenError::Unseen { .. } => {
            let help = "bring them back, or remove all goldens of the scene to begin anew";
            vec![Diagnostic::error("E0808", told).fault(Fault::Unmet).help(help)]
        }
        GoldenError::Render(e) => Failure::from(e).diagnostics,
        GoldenError::Output(e) => Failure::from(e).diagnostics,
    }
}
