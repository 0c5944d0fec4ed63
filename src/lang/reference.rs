//! The reference of the language, from the tables that the evaluator reads: `pss explain` and the page in `grammar` print it.

use std::fmt::Write;

use super::args::{self, Formal};
use super::builtins::{self, Builtin};
use super::keywords::KEYWORDS;
use super::signs::SIGNS;
use crate::scene::{Catalog, Group, Kind};

/// A word of the language.
#[derive(Clone, Debug)]
pub struct Word {
    /// The word itself; words that belong together have blanks between them.
    pub name: String,
    /// Where it belongs.
    pub chapter: Chapter,
    /// How it is written.
    pub call: String,
    /// One sentence.
    pub doc: &'static str,
    /// Its arguments: the name, what it must be, what it is.
    pub args: Vec<[String; 3]>,
    /// The names of all its arguments.
    pub names: Vec<String>,
    /// Arguments that are words in quotes: their names, and the words.
    pub choices: Vec<(&'static str, Vec<&'static str>)>,
    /// A call that works; empty where there is none.
    pub example: &'static str,
}

/// Where a word belongs, in the order of the page.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Chapter {
    /// What begins an item and has arguments.
    Items,
    /// Words that cannot be names.
    Keywords,
    /// Signs, units and attributes.
    Signs,
    /// What makes a shape.
    Solids,
    /// What changes a shape.
    Methods,
    /// What makes other values.
    Functions,
    /// Names of numbers.
    Constants,
    /// What makes a material.
    Materials,
}

impl Chapter {
    /// All, in order.
    pub const ALL: [Chapter; 8] = [
        Chapter::Items,
        Chapter::Keywords,
        Chapter::Signs,
        Chapter::Solids,
        Chapter::Methods,
        Chapter::Functions,
        Chapter::Constants,
        Chapter::Materials,
    ];

    /// Its heading.
    pub fn title(self) -> &'static str {
        match self {
            Chapter::Items => "Items",
            Chapter::Keywords => "Keywords",
            Chapter::Signs => "Signs and units",
            Chapter::Solids => "Solids and sheets",
            Chapter::Methods => "Methods",
            Chapter::Functions => "Functions",
            Chapter::Constants => "Constants",
            Chapter::Materials => "Materials",
        }
    }
}

/// All words, chapter by chapter.
pub fn words(catalog: &Catalog) -> Vec<Word> {
    let declared = catalog.decls.iter().map(|decl| {
        let formals = args::formals(decl);
        let arg = |p: &crate::scene::Param| [p.name.to_owned(), args::wanted(p.kind), p.doc.to_owned()];
        Word {
            name: decl.word.to_owned(),
            chapter: match decl.group {
                Group::Primitive => Chapter::Solids,
                Group::Material => Chapter::Materials,
                Group::Camera | Group::Light | Group::Render => Chapter::Items,
            },
            call: args::signature(decl.word, &formals),
            doc: decl.doc,
            args: decl.params.iter().map(arg).collect(),
            names: names(&formals),
            choices: decl.params.iter().filter_map(|p| Some((p.name, choices(p.kind)?.to_vec()))).collect(),
            example: decl.example,
        }
    });
    let methods = builtins::METHODS.iter().map(|b| builtin(b, Chapter::Methods, "."));
    let functions = builtins::functions().map(|b| builtin(b, Chapter::Functions, ""));
    let constants =
        builtins::CONSTANTS.iter().map(|(name, _, doc)| bare(name, Chapter::Constants, name, doc));
    // The arguments of `camera`, `light` and `render` are declared.
    let undeclared = KEYWORDS.iter().filter(|k| !catalog.decls.iter().any(|d| d.word == k.word));
    let keywords = undeclared.map(|k| bare(k.word, Chapter::Keywords, k.usage, k.doc));
    let signs = SIGNS.iter().map(|sign| Word {
        example: sign.example,
        ..bare(&sign.names.join(" "), Chapter::Signs, sign.usage, sign.doc)
    });
    let mut all: Vec<Word> =
        declared.chain(methods).chain(functions).chain(constants).chain(keywords).chain(signs).collect();
    all.sort_by_key(|word| word.chapter);
    all
}

fn names(formals: &[Formal]) -> Vec<String> {
    formals.iter().map(|f| f.name.to_owned()).collect()
}

/// A word without arguments.
fn bare(name: &str, chapter: Chapter, call: &str, doc: &'static str) -> Word {
    let (name, call) = (name.to_owned(), call.to_owned());
    Word { name, chapter, call, doc, args: Vec::new(), names: Vec::new(), choices: Vec::new(), example: "" }
}

/// The words of which an argument is one, or a list.
fn choices(kind: Kind) -> Option<&'static [&'static str]> {
    match kind {
        Kind::Choice(words) | Kind::Choices(words) | Kind::LengthOr(words) => Some(words),
        _ => None,
    }
}

fn builtin(b: &Builtin, chapter: Chapter, before: &str) -> Word {
    let arg = |f: &Formal| {
        let free = match (f.required, f.doc) {
            (true, doc) => doc.to_owned(),
            (false, "") => "may be left out".to_owned(),
            (false, doc) => format!("{doc}; may be left out"),
        };
        [f.name.to_owned(), free, String::new()]
    };
    Word {
        name: b.name.to_owned(),
        chapter,
        call: format!("{before}{}", args::signature(b.name, b.formals)),
        doc: b.doc,
        args: b.formals.iter().filter(|f| !f.required || !f.doc.is_empty()).map(arg).collect(),
        names: names(b.formals),
        choices: Vec::new(),
        example: "",
    }
}

/// What to write instead of a word of another language, wherever it stands there.
pub fn instead(word: &str) -> Vec<&'static str> {
    use super::habits::{Place, instead};
    let places = [Place::Item, Place::Name, Place::Method, Place::Argument];
    let mut found: Vec<&str> = places.iter().filter_map(|place| instead(word, *place)).collect();
    found.dedup();
    found
}

impl Word {
    /// What stands below its call, in Markdown: the sentence, the arguments, the example.
    pub fn markdown(&self) -> String {
        let mut out = format!("{}\n\n", self.doc);
        for [name, kind, doc] in &self.args {
            let sign = if doc.is_empty() { "" } else { ": " };
            let _ = writeln!(out, "- `{name}`: {kind}{sign}{doc}");
        }
        if !self.example.is_empty() {
            let _ = writeln!(out, "\n```pss\n{}\n```", self.example);
        }
        out
    }

    /// Whether it is this word, or has it among those that belong together.
    pub fn is(&self, name: &str) -> bool {
        self.name.split(' ').any(|own| own == name)
    }

    /// All that is known of it, as text.
    pub fn page(&self) -> String {
        let mut out = format!("{}\n\n    {}\n", self.call, self.doc);
        let width = self.args.iter().map(|a| a[0].len()).max().unwrap_or(0);
        if !self.args.is_empty() {
            out.push('\n');
        }
        for [name, kind, doc] in &self.args {
            let sign = if doc.is_empty() { "" } else { ": " };
            let _ = writeln!(out, "    {name:width$}  {kind}{sign}{doc}");
        }
        if !self.example.is_empty() {
            let _ = writeln!(out, "\n    {}", self.example.replace('\n', "\n    "));
        }
        out
    }
}

/// The page of all words, in Markdown.
pub fn page(catalog: &Catalog) -> String {
    let mut out = String::from(
        "# Words of the language\n\nWritten by `PSS_BLESS=1 cargo test --test lang_reference` from the tables that scenes are read with; `pss explain WORD` prints one.\nArguments without a colon may be given by place, all by name.\n",
    );
    let words = words(catalog);
    for chapter in Chapter::ALL {
        let _ = writeln!(out, "\n## {}\n", chapter.title());
        for word in words.iter().filter(|word| word.chapter == chapter) {
            let _ = write!(out, "### `{}`\n\n{}", word.call, word.markdown());
            if !word.args.is_empty() || !word.example.is_empty() {
                out.push('\n');
            }
        }
    }
    format!("{}\n", out.trim_end())
}
