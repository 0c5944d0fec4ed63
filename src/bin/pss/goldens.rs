//! What `pss test` does with the goldens beside a scene: compares and tells, or writes.

use std::path::Path;

use pss::diag::{Diagnostic, Fault};
use pss::golden::{self, Differs, GoldenError, Goldens};
use pss::lang::ast::{Expect, ExprKind, ItemKind};
use pss::source::{FileId, SourceMap};

use crate::console::{Console, Failure};
use crate::load::Loaded;

/// What there is to say of a scene that is as it was.
#[derive(Default, Debug)]
pub struct Kept {
    /// In words that follow its `ok`.
    pub told: String,
    /// Whether it has no golden at all.
    pub is_bare: bool,
}

/// Compares a scene with what lies beside it; what differs, as errors. A picture of the differences is left beside it, or removed.
pub fn compare(scene: &Path, loaded: &Loaded) -> Result<Kept, Vec<Diagnostic>> {
    let goldens = Goldens::read(scene).map_err(one)?;
    if goldens.is_empty() {
        return Ok(Kept { told: ", no golden".to_owned(), is_bare: true });
    }
    let compared = goldens.compare(&loaded.shot).map_err(|e| one(e.into()))?;
    let shown = compared.show_beside(scene).map_err(|e| one(e.into()))?;
    if compared.differs.is_empty() {
        let missing: Vec<String> = goldens.missing().map(|kind| format!(", no .{}", kind.suffix())).collect();
        return Ok(Kept { told: missing.concat(), is_bare: false });
    }
    Err(compared.differs.iter().map(|differs| error(scene, differs, shown)).collect())
}

/// Makes goldens of what a scene is, and says what changed.
pub fn bless(scene: &Path, loaded: &Loaded, console: &Console) -> Result<Kept, Vec<Diagnostic>> {
    let goldens = Goldens::read(scene).map_err(one)?;
    let blessed = golden::bless(scene, &goldens, &loaded.shot, &loaded.inputs).map_err(one)?;
    blessed.compared.show_beside(scene).map_err(|e| one(e.into()))?;
    if blessed.is_nothing() {
        return Ok(Kept::default());
    }
    if !compares_a_number(&loaded.sources) {
        let message = format!("`{}` is blessed, and expects no number", scene.display());
        let help =
            "a wrong golden is seen by what a formula knows: `expect volume(part) ~= 6.43 within 0.1%`";
        console.show(&[Diagnostic::warning("W0206", message).help(help)], &loaded.sources);
    }
    let changed = blessed
        .compared
        .differs
        .iter()
        .map(|d| format!("{} {} of .{}", d.count, d.kind.unit(), d.kind.suffix()));
    let added = blessed.added.iter().map(|kind| format!("new .{}", kind.suffix()));
    let all: Vec<String> = changed.chain(added).collect();
    Ok(Kept { told: format!(", blessed: {}", all.join(", ")), is_bare: false })
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
            let help = "goldens begin with a `.spans`, and there is none: move the file away";
            vec![Diagnostic::error("E0806", told).fault(Fault::Output).help(help)]
        }
        GoldenError::Render(e) => Failure::from(e).diagnostics,
        GoldenError::Output(e) => Failure::from(e).diagnostics,
    }
}

/// Whether a scene says of a number what it shall be.
fn compares_a_number(sources: &SourceMap) -> bool {
    // The scene's own text is the first.
    let items = pss::lang::items(sources, FileId::default()).unwrap_or_default();
    items.iter().any(|item| match &item.kind {
        ItemKind::Expect(expect) => is_of_a_number(expect),
        _ => false,
    })
}

fn is_of_a_number(Expect { left, right, .. }: &Expect) -> bool {
    match right {
        Some((nearly, right)) => *nearly || matches!(right.kind, ExprKind::Number(..)),
        None => match &left.kind {
            ExprKind::Infix(_, list) => list.iter().any(|(op, _, _)| op.compares()),
            _ => false,
        },
    }
}
