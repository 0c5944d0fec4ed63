//! The items of a file to the [`Scene`]: definitions in the order they need each other, then cameras, lights,
//! `render` and what is drawn.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::ast::{Arg, Args, Import, Item, ItemKind, Word};
use super::budget::Budget;
use super::defines::{self, Define};
use super::eval::{Machine, later};
use super::modules::{self, Module};
use super::salvage::in_order;
use super::scope::Locals;
use super::unknown::words;
use super::value::{Eval, Located, Record, Stop, Val};
use super::{Read, Reading, check, order, print, resolve, sets, units};
use crate::diag::{Diagnostic, is_slip, nearest};
use crate::scene::{Call, Draw, Group, Kind, Named, Scene};
use crate::source::{FileId, SourceMap, Span};

/// The words that may stand before `draw`, with their `@`.
pub const ATTRIBUTES: [&str; 3] = ["ghost", "only", "skip"];

/// What a scene, or the failure to read it, comes to.
pub type Outcome = Result<Read, Vec<Diagnostic>>;

/// Reads a file and what it imports. Needs a deep stack: see [`super::read`].
pub fn read(sources: &mut SourceMap, file: FileId, reading: &Reading, defines: &[Define]) -> Outcome {
    let loaded = modules::load(sources, file, reading);
    let importers = loaded.importers;
    if loaded.modules.is_empty() {
        let mut errors = loaded.errors;
        modules::with_imports(&mut errors, &importers, sources);
        return Err(errors);
    }
    let mut outcome = evaluated(sources, reading, defines, &loaded.modules, loaded.errors);
    match &mut outcome {
        Ok(read) => {
            modules::with_imports(&mut read.warnings, &importers, sources);
            modules::with_imports(&mut read.unmet, &importers, sources);
        }
        Err(errors) => modules::with_imports(errors, &importers, sources),
    }
    outcome
}

fn evaluated(
    sources: &SourceMap,
    reading: &Reading,
    defines: &[Define],
    modules: &[Module],
    mut errors: Vec<Diagnostic>,
) -> Outcome {
    let unit = scene_unit(modules.iter().rev().map(|m| &*m.items), &mut errors);
    let root = modules.last().map_or(&[][..], |m| &m.items);
    errors.extend(order::redefinitions(root.iter().filter_map(|i| label(i, false))));
    errors.extend(order::redefinitions(root.iter().filter_map(|i| label(i, true))));
    let params = root
        .iter()
        .filter_map(|i| if let ItemKind::Param(p) = &i.kind { Some(p.name.text.as_str()) } else { None });
    let broken = modules.last().map_or(&[][..], |m| &m.broken);
    let params: Vec<&str> = params.chain(broken.iter().map(String::as_str)).collect();
    if modules.last().is_some_and(|m| !m.partly) {
        errors.extend(defines::unknown(defines, &params));
    }
    let machine = Machine {
        catalog: reading.catalog,
        sources,
        unit,
        names: modules.iter().map(|_| HashMap::new()).collect(),
        partly: modules.iter().map(|m| m.is_partly_known(modules)).collect(),
        module: 0,
        locals: Locals::default(),
        calls: 0,
        depth: 0,
        budget: Budget::new(reading.memory),
        binding: None,
        words: words(reading.catalog),
        materials: Vec::new(),
        warnings: Vec::new(),
        warned: HashSet::new(),
        geometry: reading.geometry,
        doubts: Default::default(),
    };
    let mut reader = Reader {
        machine,
        defines,
        expects: reading.expects,
        scene: Scene::default(),
        only: Default::default(),
        errors,
        unmet: Vec::new(),
        named: Vec::new(),
        render: None,
        quiet: None,
        spent: false,
    };
    reader.read(modules);
    reader.finish()
}

/// The names that a file defines itself.
fn own_names(items: &[Item]) -> impl Iterator<Item = &Word> {
    items.iter().filter(|item| !matches!(item.kind, ItemKind::Import(_))).filter_map(order::defined)
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
fn scene_unit<'a>(files: impl Iterator<Item = &'a [Item]>, errors: &mut Vec<Diagnostic>) -> f64 {
    let mut first: Option<(f64, Span)> = None;
    for item in files.flatten() {
        let ItemKind::Units(word) = &item.kind else { continue };
        let names = units::LENGTHS.map(|(n, _)| n);
        let known = units::LENGTHS.iter().find(|(n, _)| *n == word.text).map(|(_, um)| *um);
        match (known, first) {
            (_, Some((_, at))) if at.file == item.at.file => errors.push(twice("units", item.at, at)),
            (Some(um), Some((other, at))) if um != other => {
                let error = Diagnostic::error("E0513", "the files of a scene have different units");
                let error = error.at(item.at, "here").at(at, "and here");
                errors.push(error.help("write the lengths of one of them with their units: `12mm`"));
            }
            (Some(_), Some(_)) => {}
            (Some(um), None) => first = Some((um, item.at)),
            (None, _) => {
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

fn imported_twice(at: Span, first: Span) -> Diagnostic {
    Diagnostic::error("E0402", "a file is imported twice")
        .at(at, "the second time")
        .at(first, "the first time")
        .help("remove one of them; a second name for the same is `import \"file.pss\" as name`")
}

fn twice(what: &str, at: Span, first: Span) -> Diagnostic {
    Diagnostic::error("E0402", format!("`{what}` is given twice"))
        .at(at, "the second time")
        .at(first, "the first time")
        .help("a scene has one: remove the other")
}

/// The name space of a file.
fn space_of(names: Vec<(String, Option<Val>)>) -> Record {
    let failed = names.iter().filter(|(_, value)| value.is_none()).map(|(name, _)| name.clone());
    let mut failed: Vec<String> = failed.collect();
    failed.sort_unstable();
    let fields = names.into_iter().filter_map(|(name, value)| Some((name, value?)));
    let mut fields: Vec<(String, Val)> = fields.collect();
    fields.sort_by(|a, b| a.0.cmp(&b.0));
    Record { kind: "an imported file", fields, failed }
}

struct Reader<'a> {
    machine: Machine<'a>,
    defines: &'a [Define],
    /// Whether expectations are evaluated.
    expects: bool,
    scene: Scene,
    /// Draws that carry `@only`, and those of them that are ghosts.
    only: [Vec<Draw>; 2],
    errors: Vec<Diagnostic>,
    /// Expectations that are not met.
    unmet: Vec<Diagnostic>,
    /// Shapes that the scene's own file names.
    named: Vec<Draw>,
    /// The place of the `render` item.
    render: Option<Span>,
    /// The last item that failed because of another.
    quiet: Option<Span>,
    /// Whether no steps or no memory are left: all that follows would fail.
    spent: bool,
}

impl Reader<'_> {
    fn read(&mut self, modules: &[Module]) {
        for (k, module) in modules.iter().enumerate() {
            self.machine.module = k;
            self.names(module, modules);
            let root = k + 1 == modules.len();
            // Of a file that is imported nothing is seen; what it says and promises counts.
            let counts = |item: &&Item| root || matches!(item.kind, ItemKind::Print(_) | ItemKind::Expect(_));
            for item in module.items.iter().filter(counts) {
                if self.spent {
                    return;
                }
                let done = self.item(item);
                self.told(done, item.at);
            }
            if root && self.expects {
                self.named = self.shapes_of(&module.items);
            }
            if self.spent {
                return;
            }
            let more = resolve::unresolved(&mut self.machine, &module.items, &self.errors);
            self.errors.extend(more);
        }
    }

    /// The shapes that `let` items name.
    fn shapes_of(&self, items: &[Item]) -> Vec<Draw> {
        let names = &self.machine.names[self.machine.module];
        let shape = |item: &Item| match (&item.kind, names.get(&order::defined(item)?.text)) {
            (ItemKind::Let(name, _), Some(Some(Val::Shape(shape)))) => {
                Some(Draw { shape: shape.clone(), at: name.at })
            }
            _ => None,
        };
        items.iter().filter_map(shape).collect()
    }

    /// The names of a file: those it imports, then its own.
    fn names(&mut self, module: &Module, modules: &[Module]) {
        let catalog = self.machine.catalog;
        let takes_condition = |word: &str| {
            let decl = catalog.find(Group::Primitive, word);
            decl.is_some_and(|d| d.params.iter().any(|p| matches!(p.kind, Kind::HalfSpace | Kind::Condition)))
        };
        let items = &module.items;
        let mut known: Vec<(&Import, usize)> = Vec::new();
        for (import, from) in module.imported().filter(|(import, _)| import.space.is_none()) {
            match known.iter().find(|(_, same)| *same == from) {
                Some((first, _)) => self.errors.push(imported_twice(import.at, first.at)),
                None => known.push((import, from)),
            }
        }
        let known = known.into_iter().flat_map(|(_, from)| own_names(&modules[from].items));
        let own = items.iter().filter_map(order::defined);
        self.errors.extend(order::redefinitions(known.chain(own.clone())));
        let k = self.machine.module;
        let unknown = own.map(|name| &name.text).chain(&module.broken);
        self.machine.names[k].extend(unknown.map(|name| (name.clone(), None)));
        for (import, from) in module.imported() {
            // What a file imports is its own business.
            let names = own_names(&modules[from].items).map(|name| name.text.clone());
            let names =
                names.map(|name| (name.clone(), self.machine.names[from].get(&name).cloned().flatten()));
            let broken = modules[from].broken.iter().map(|name| (name.clone(), None));
            let names: Vec<(String, Option<Val>)> = names.chain(broken).collect();
            match &import.space {
                Some(space) => {
                    // What may have any name is not known at all.
                    let record = (!modules[from].partly).then(|| Val::Record(Arc::new(space_of(names))));
                    self.machine.names[k].insert(space.text.clone(), record);
                }
                None => self.machine.names[k].extend(names),
            }
        }
        let (sorted, cycles) = order::sorted(items, &takes_condition);
        self.errors.extend(cycles);
        for i in sorted {
            if self.spent {
                return;
            }
            if let ItemKind::Import(_) = items[i].kind {
                continue;
            }
            let value = self.definition(&items[i]);
            if let (Some(value), Some(name)) = (self.told(value, items[i].at), order::defined(&items[i])) {
                self.machine.hides_builtin(name);
                self.machine.names[k].insert(name.text.clone(), Some(value));
            }
        }
    }

    fn finish(self) -> Outcome {
        let Reader { machine, mut scene, only, errors, quiet, unmet, named, .. } = self;
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
        if only.iter().any(|draws| !draws.is_empty()) {
            [scene.draws, scene.ghosts] = only;
        }
        Ok(Read { scene, warnings: all, unmet, named })
    }

    fn told<T>(&mut self, outcome: Eval<T>, at: Span) -> Option<T> {
        match outcome {
            Ok(value) => return Some(value),
            Err(Stop::Told(error)) => {
                self.spent |= matches!(error.code, "E0709" | "E0710");
                self.errors.push(*error);
            }
            Err(Stop::Quiet) => self.quiet = Some(at),
        }
        None
    }

    fn definition(&mut self, item: &Item) -> Eval<Val> {
        match &item.kind {
            ItemKind::Let(name, expr) => self.machine.named(&name.text, expr),
            ItemKind::Function(name, function) => Ok(self.machine.function(function, Some(&name.text))),
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
            ItemKind::Print(expr) => {
                let value = self.machine.value(expr)?;
                self.scene.prints.push(print::text(&value));
            }
            // Whoever renders or probes does not ask whether a scene keeps its promises.
            ItemKind::Expect(expect) if self.expects => {
                let unmet = self.machine.expect(expect)?;
                self.unmet.extend(unmet);
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
                let words: Vec<&str> = catalog.words(Group::Material).collect();
                check::unquoted(&self.machine, &kind.value, "kind", &words)?;
                let given = self.machine.located(&kind.value)?;
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
        for operand in sets::flatten(value, "draw", &self.machine.budget)? {
            draws.push(Draw { shape: operand.shape, at: operand.at });
        }
        if let Val::Shape(_) = value.value {
            draws.iter_mut().for_each(|d| d.at = value.at);
        }
        let [mut only, mut skip, mut ghost] = [false; 3];
        for word in attributes {
            match word.text.as_str() {
                "only" => only = true,
                "skip" => skip = true,
                "ghost" => ghost = true,
                other => {
                    let error = Diagnostic::error("E0401", format!("`@{other}` is not known"));
                    let near = nearest(other, ATTRIBUTES);
                    return Err(error
                        .at(word.at, "unknown attribute")
                        .fix_with(word.at, near.filter(|near| is_slip(other, near)))
                        .help(match near {
                            Some(near) => format!("did you mean `@{near}`?"),
                            None => "the attributes are `@ghost` `@only` `@skip`".to_owned(),
                        })
                        .into());
                }
            }
        }
        let into = match (only, ghost) {
            (true, _) => &mut self.only[usize::from(ghost)],
            (false, true) => &mut self.scene.ghosts,
            (false, false) => &mut self.scene.draws,
        };
        if !skip {
            into.extend(draws);
        }
        Ok(())
    }
}
