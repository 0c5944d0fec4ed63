//! The items of a file to the [`Scene`]: definitions in the order they need each other, then cameras, lights,
//! `render` and what is drawn.

use std::collections::HashMap;

use super::ast::{Arg, Args, Item, ItemKind, Word};
use super::defines::{self, Define};
use super::eval::{Machine, later};
use super::value::{Eval, Located, Stop, Val};
use super::{builtins, check, order, parse, sets, span, split, units};
use crate::diag::{Diagnostic, nearest};
use crate::scene::{Call, Catalog, Draw, Group, Kind, Named, Scene};
use crate::source::{FileId, SourceMap, Span};

/// The largest file that is read.
const MAX_BYTES: usize = 256 << 20;

/// What a scene, or the failure to read it, comes to.
pub type Outcome = Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>>;

/// Reads a file. Needs a deep stack: see [`super::read`].
pub fn read(sources: &SourceMap, file: FileId, catalog: &Catalog, defines: &[Define]) -> Outcome {
    let items = parsed(&sources.file(file).text, file)?;
    let mut errors = Vec::new();
    let unit = scene_unit(&items, &mut errors);
    errors.extend(order::redefinitions(items.iter().filter_map(order::defined)));
    errors.extend(order::redefinitions(items.iter().filter_map(|i| label(i, false))));
    errors.extend(order::redefinitions(items.iter().filter_map(|i| label(i, true))));
    let params: Vec<&str> = items
        .iter()
        .filter_map(|i| if let ItemKind::Param(p) = &i.kind { Some(p.name.text.as_str()) } else { None })
        .collect();
    errors.extend(defines::unknown(defines, &params));
    let names = items.iter().filter_map(|i| Some((order::defined(i)?.text.clone(), None)));
    let machine = Machine {
        catalog,
        sources,
        unit,
        names: HashMap::from_iter(names),
        binding: None,
        materials: Vec::new(),
        warnings: Vec::new(),
    };
    let mut reader = Reader {
        machine,
        defines,
        scene: Scene::default(),
        only: Vec::new(),
        errors,
        render: None,
        quiet: None,
    };
    reader.read(&items);
    reader.finish()
}

/// The items, or every mistake in their wording.
fn parsed(text: &str, file: FileId) -> Result<Vec<Item>, Vec<Diagnostic>> {
    if text.len() > MAX_BYTES {
        let told = format!("the scene is larger than {} MB", MAX_BYTES >> 20);
        return Err(vec![
            Diagnostic::error("E0705", told).help("keep points in files of their own: `points(\"a.ply\")`"),
        ]);
    }
    if let Some(at) = text.find('\0') {
        return Err(vec![
            Diagnostic::error("E0103", "the text holds a NUL character")
                .at(span(file, at..at + 1), "not text")
                .help("is this a scene file?"),
        ]);
    }
    let cut = split::cut(text, file);
    let mut errors = cut.errors;
    let mut items = Vec::with_capacity(cut.items.len());
    for range in cut.items {
        match parse::item(text, file, range) {
            Ok(item) => items.push(item),
            Err(error) => errors.push(*error),
        }
    }
    if errors.is_empty() { Ok(items) } else { Err(in_order(errors)) }
}

fn in_order(mut all: Vec<Diagnostic>) -> Vec<Diagnostic> {
    all.sort_by_key(|d| d.labels.first().map(|l| (l.span.file, l.span.start)));
    all
}

/// The label of a camera, or of a light.
fn label(item: &Item, of_light: bool) -> Option<&Word> {
    match &item.kind {
        ItemKind::Camera(name, _) if !of_light => name.as_ref(),
        ItemKind::Light(name, _) if of_light => name.as_ref(),
        _ => None,
    }
}

/// Micrometres in a unit of the scene.
fn scene_unit(items: &[Item], errors: &mut Vec<Diagnostic>) -> f64 {
    let mut first: Option<(f64, Span)> = None;
    for item in items {
        let ItemKind::Units(word) = &item.kind else { continue };
        if let Some((_, at)) = first {
            errors.push(twice("units", item.at, at));
            continue;
        }
        let names = units::LENGTHS.map(|(n, _)| n);
        match units::LENGTHS.iter().find(|(n, _)| *n == word.text) {
            Some((_, um)) => first = Some((*um, item.at)),
            None => {
                let error = Diagnostic::error("E0401", format!("`{}` is not a unit of length", word.text));
                errors.push(error.at(word.at, "unknown unit").help(match nearest(&word.text, names) {
                    Some(near) if near.len() > 1 && word.text.len() > 1 => format!("did you mean `{near}`?"),
                    _ => format!("the units are {}", names.map(|n| format!("`{n}`")).join(" ")),
                }));
            }
        }
    }
    first.map_or(1e3, |(um, _)| um)
}

fn twice(what: &str, at: Span, first: Span) -> Diagnostic {
    Diagnostic::error("E0402", format!("`{what}` is given twice"))
        .at(at, "the second time")
        .at(first, "the first time")
        .help("a scene has one: remove the other")
}

struct Reader<'a> {
    machine: Machine<'a>,
    defines: &'a [Define],
    scene: Scene,
    /// Draws that carry `@only`.
    only: Vec<Draw>,
    errors: Vec<Diagnostic>,
    /// The place of the `render` item.
    render: Option<Span>,
    /// The last item that failed because of another.
    quiet: Option<Span>,
}

impl Reader<'_> {
    fn read(&mut self, items: &[Item]) {
        let catalog = self.machine.catalog;
        let takes_condition = |word: &str| {
            let decl = catalog.find(Group::Primitive, word);
            decl.is_some_and(|d| d.params.iter().any(|p| matches!(p.kind, Kind::HalfSpace | Kind::Condition)))
        };
        let (sorted, cycles) = order::sorted(items, &takes_condition);
        self.errors.extend(cycles);
        for i in sorted {
            let value = self.definition(&items[i]);
            if let (Some(value), Some(name)) = (self.told(value, items[i].at), order::defined(&items[i])) {
                self.hides_builtin(name);
                self.machine.names.insert(name.text.clone(), Some(value));
            }
        }
        for item in items {
            let done = self.item(item);
            self.told(done, item.at);
        }
    }

    fn finish(self) -> Outcome {
        let Reader { machine, mut scene, only, errors, quiet, .. } = self;
        let mut all = errors;
        if let (true, Some(at)) = (all.is_empty(), quiet) {
            let error =
                Diagnostic::error("E0407", "a name is used before it is known").at(at, "in this item");
            all.push(error.help("define what it uses above it"));
        }
        let failed = !all.is_empty();
        all.extend(machine.warnings);
        let all = in_order(all);
        if failed {
            return Err(all);
        }
        scene.materials = machine.materials;
        if !only.is_empty() {
            scene.draws = only;
        }
        Ok((scene, all))
    }

    fn told<T>(&mut self, outcome: Eval<T>, at: Span) -> Option<T> {
        match outcome {
            Ok(value) => return Some(value),
            Err(Stop::Told(error)) => self.errors.push(*error),
            Err(Stop::Quiet) => self.quiet = Some(at),
        }
        None
    }

    fn definition(&mut self, item: &Item) -> Eval<Val> {
        match &item.kind {
            ItemKind::Let(name, expr) => {
                self.machine.binding = Some(name.text.clone());
                let value = self.machine.value(expr);
                self.machine.binding = None;
                value
            }
            ItemKind::Param(param) => defines::value(&mut self.machine, param, self.defines),
            ItemKind::Material(_, args) => self.material(args, item.at),
            _ => Err(Stop::Quiet),
        }
    }

    fn item(&mut self, item: &Item) -> Eval<()> {
        match &item.kind {
            ItemKind::Camera(name, args) => {
                let call = self.scene_call(Group::Camera, "camera", args, item.at)?;
                self.scene.cameras.push(Named { name: name.as_ref().map(|n| n.text.clone()), call });
            }
            ItemKind::Light(name, args) => {
                let call = self.scene_call(Group::Light, "light", args, item.at)?;
                self.scene.lights.push(Named { name: name.as_ref().map(|n| n.text.clone()), call });
            }
            ItemKind::Render(args) => {
                if let Some(first) = self.render {
                    return Err(twice("render", item.at, first).into());
                }
                self.render = Some(item.at);
                self.scene.render = Some(self.scene_call(Group::Render, "render", args, item.at)?);
            }
            ItemKind::Draw(attributes, expr) => {
                let value = self.machine.located(expr)?;
                self.draw(attributes, &value)?;
            }
            // Whoever renders or probes does not ask whether a scene keeps its promises.
            ItemKind::Later("expect") => {}
            ItemKind::Later(what) => {
                let at = Span { end: item.at.start + what.len() as u32, ..item.at };
                return Err(later(what, at).into());
            }
            _ => {}
        }
        Ok(())
    }

    fn scene_call(&mut self, group: Group, word: &str, args: &Args, at: Span) -> Eval<Call> {
        let catalog = self.machine.catalog;
        match catalog.find(group, word) {
            Some(decl) => check::call(&mut self.machine, decl, args, at),
            None => Err(later(word, at).into()),
        }
    }

    /// `material name(kind: ...)`: the kind is the word of the declaration, the first where none is given.
    fn material(&mut self, args: &Args, at: Span) -> Eval<Val> {
        let catalog = self.machine.catalog;
        let is_kind = |a: &&Arg| a.name.as_ref().is_some_and(|n| n.text == "kind");
        let mut kinds = args.list.iter().filter(is_kind);
        let decl = match kinds.next() {
            None => catalog.words(Group::Material).next().and_then(|w| catalog.find(Group::Material, w)),
            Some(kind) => {
                let given = self.machine.located(&kind.value)?;
                let words: Vec<&str> = catalog.words(Group::Material).collect();
                let word = check::choice(&given, "kind", &words)?;
                catalog.find(Group::Material, &word)
            }
        };
        let decl = decl.ok_or_else(|| later("material", at))?;
        if let Some(second) = kinds.next() {
            let error =
                Diagnostic::error("E0405", "`kind` is given twice").at(second.value.at, "the second time");
            return Err(error.help("remove one of them").into());
        }
        let call = check::call_without(&mut self.machine, decl, args, at, "kind")?;
        Ok(self.machine.add_material(call))
    }

    fn draw(&mut self, attributes: &[Word], value: &Located) -> Eval<()> {
        let mut draws: Vec<Draw> = Vec::new();
        for operand in sets::flatten(value, "draw")? {
            draws.push(Draw { shape: operand.shape, at: operand.at });
        }
        if let Val::Shape(_) = value.value {
            draws.iter_mut().for_each(|d| d.at = value.at);
        }
        let mut only = false;
        let mut skip = false;
        for word in attributes {
            match word.text.as_str() {
                "only" => only = true,
                "skip" => skip = true,
                "ghost" => return Err(later("@ghost", word.at).into()),
                other => {
                    let error = Diagnostic::error("E0401", format!("`@{other}` is not known"));
                    return Err(error
                        .at(word.at, "unknown attribute")
                        .help(match nearest(other, ["ghost", "only", "skip"]) {
                            Some(near) => format!("did you mean `@{near}`?"),
                            None => "the attributes are `@ghost` `@only` `@skip`".to_owned(),
                        })
                        .into());
                }
            }
        }
        if only && !skip {
            self.only.extend(draws);
        } else if !skip {
            self.scene.draws.extend(draws);
        }
        Ok(())
    }

    fn hides_builtin(&mut self, name: &Word) {
        let catalog = self.machine.catalog;
        let word = name.text.as_str();
        let hidden = catalog.find(Group::Primitive, word).is_some()
            || catalog.find(Group::Material, word).is_some()
            || builtins::functions().any(|b| b.name == word)
            || builtins::CONSTANTS.iter().any(|(n, _, _)| *n == word);
        if hidden {
            let warning = Diagnostic::warning("W0201", format!("`{word}` hides what the language calls so"));
            self.machine.warnings.push(warning.at(name.at, "defined here").help("take another name"));
        }
    }
}
