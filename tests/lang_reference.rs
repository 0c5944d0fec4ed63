//! The reference page is what the tables say; every word has a page, and every example is a scene.

mod cli_common;

use cli_common::Folder;
use pss::lang::{codes, reference};

#[test]
fn the_reference_page_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/reference.md");
    let page = reference::page(&pss::prepare::catalog());
    if std::env::var_os("PSS_BLESS").is_some() {
        std::fs::write(path, &page).unwrap();
    }
    let known = std::fs::read_to_string(path).unwrap_or_default();
    assert!(known == page, "run `PSS_BLESS=1 cargo test --test lang_reference`");
}

#[test]
fn every_word_has_a_page_and_a_chapter() {
    let words = reference::words(&pss::prepare::catalog());
    for word in &words {
        assert!(!word.doc.is_empty(), "{word:?}");
        assert!(word.page().contains(word.doc) && word.page().contains(&word.call));
    }
    for name in [
        "let", "fn", "for", "and", "deg", "|", "box", "points", "move", "close", "union", "volume", "rand",
        "pi", "matte", "camera", "render",
    ] {
        assert!(words.iter().any(|word| word.is(name)), "{name}");
    }
}

/// Every code that the program tells has a page, no page is of a code that is not told, and the scenes show what they say.
#[test]
fn every_code_has_a_page_whose_scenes_show_it() {
    let mut told = std::collections::BTreeSet::new();
    let mut open = vec![std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"))];
    while let Some(next) = open.pop() {
        if next.is_dir() {
            open.extend(std::fs::read_dir(next).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        if next.ends_with("lang/codes.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&next).unwrap();
        for (at, _) in text.match_indices(['E', 'W']) {
            let code: String = text[at..].chars().take(6).collect();
            let is_code =
                code.len() == 6 && code.ends_with('"') && code[1..5].chars().all(|c| c.is_ascii_digit());
            if is_code && text[..at].ends_with('"') {
                told.insert(code[..5].to_owned());
            }
        }
    }
    let pages: Vec<&str> = codes::all().map(|c| c.code).collect();
    assert_eq!(told.iter().map(String::as_str).collect::<Vec<_>>(), pages);
    let mut wrong = Vec::new();
    for code in codes::all().filter(|code| !code.bad.is_empty()) {
        let (bad, good) = (said(code.bad), said(code.good));
        // What cannot be told by reading and preparing alone is told by a command.
        let told = bad.contains(&code.code.to_owned()) && good.is_empty();
        let (bad, good) = if told { (bad, good) } else { (commanded(code.bad), commanded(code.good)) };
        if !bad.contains(&code.code.to_owned()) || !good.is_empty() {
            wrong.push(format!("{}: {bad:?} {good:?}", code.code));
        }
        assert!(code.page().contains(code.told));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The codes told of a scene: by reading it, or by preparing it.
fn said(text: &str) -> Vec<String> {
    let mut sources = pss::source::SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    let told = |all: Vec<pss::diag::Diagnostic>| all.iter().map(|d| d.code.to_owned()).collect::<Vec<_>>();
    match pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]) {
        Ok((scene, warnings)) => {
            let mut all = told(warnings);
            all.extend(
                pss::prepare::prepare(&scene, &Default::default()).err().map(told).unwrap_or_default(),
            );
            all
        }
        Err(errors) => told(errors),
    }
}

/// The codes told by the command of an example, in a folder that holds its files.
fn commanded(example: &str) -> Vec<String> {
    let folder = Folder::new();
    let mut commands: Vec<&str> = example.lines().map_while(|line| line.strip_prefix("$ pss ")).collect();
    let text = example.lines().skip(commands.len());
    if commands.is_empty() {
        commands.push("check scene.pss");
    }
    let mut name = "scene.pss".to_owned();
    let mut files = std::collections::BTreeMap::new();
    for line in text {
        if let Some(next) = line.strip_prefix("--- ") {
            next.clone_into(&mut name);
        }
        let file: &mut String = files.entry(name.clone()).or_default();
        if !line.starts_with("--- ") {
            *file += line;
            *file += "\n";
        }
    }
    for (name, text) in &files {
        folder.write(name, text);
    }
    let mut told = String::new();
    for command in commands {
        told = folder.run(&command.split(' ').collect::<Vec<_>>()).stderr;
    }
    let codes = told.lines().filter_map(|line| {
        let (severity, rest) = line.split_once('[')?;
        let is_told = ["error", "warning", "note"].contains(&severity);
        is_told.then(|| rest.split(']').next().unwrap().to_owned())
    });
    codes.collect()
}

/// Those that no scene shows: they take a full disk, gigabytes, or a fault.
#[test]
fn few_codes_are_without_a_scene_that_shows_them() {
    let without: Vec<&str> = codes::all().filter(|c| c.bad.is_empty()).map(|c| c.code).collect();
    let wanted = ["E0602", "E0606", "E0612", "E0702", "E0704", "E0705", "E0707", "E0708", "E0710", "E0900"];
    assert_eq!(without, wanted);
    for code in codes::all().filter(|c| c.bad.is_empty()) {
        assert!(code.page().contains("No scene on a page is told so: "), "{}", code.page());
        assert!(code.good.len() > 20, "{}", code.code);
    }
}

/// The words that editors colour are those of the grammar.
#[test]
fn the_editors_grammar_knows_every_keyword_and_unit() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/");
    let read = |name: &str| std::fs::read_to_string(format!("{root}{name}")).unwrap();
    let editors: serde_json::Value = serde_json::from_str(&read("pss.tmLanguage.json")).unwrap();
    let text = editors.to_string();
    let pest = read("pss.pest");
    let keywords: Vec<&str> = pest
        .lines()
        .filter_map(|line| {
            line.split_once("_kw").filter(|(word, rest)| !word.contains(' ') && rest.contains("!letter"))
        })
        .map(|(word, _)| word)
        .collect();
    assert!(20 < keywords.len(), "{keywords:?}");
    for word in keywords
        .into_iter()
        .chain(["um", "mm", "cm", "km", "ft", "deg", "rad", "turn", "ghost", "only", "skip"])
    {
        let known = text.split(|c: char| !c.is_ascii_alphanumeric()).any(|known| known == word);
        assert!(known, "{word}");
    }
}
