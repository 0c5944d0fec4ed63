//! The house style changes nothing but the space between words, and what is in it stays as it is.

use pss::lang::{codes, formatted, reference};
use pss::source::SourceMap;

fn styled(text: &str) -> Option<String> {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    formatted(&sources, file).ok()
}

/// A text without its space, and so the words and comments of it in their order.
fn bare(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

/// Scenes, examples and pages of codes; each also with its spaces doubled and its lines ended as on other systems.
fn texts() -> Vec<String> {
    let scenes = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes")).unwrap();
    let scenes =
        scenes.map(|entry| entry.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "pss"));
    let mut all: Vec<String> = scenes.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    all.extend(codes::all().filter(|c| !c.bad.is_empty()).flat_map(|c| [c.bad, c.good]).map(str::to_owned));
    let words = reference::words(&pss::prepare::catalog());
    all.extend(
        words.iter().filter(|word| !word.example.is_empty()).map(|word| format!("draw {}", word.example)),
    );
    all.push("let a = /* one */ 3 // two\n\n\n\n// three\n/* four\n   five */ let b = [ // six\n1, // seven\n\n2\n// eight\n]\n\n".into());
    all.push("/* a */let a=1/* b */+/* c */2//d\nlet b=-a\nlet c=a - -b\nlet d=[a,-b,!(a<b)]".into());
    // Found by fuzzing: a bracket that ends a comment opens nothing.
    // What begins a comment does not end it.
    all.push("draw sphere(r: 1) /*/ a ( b */\n/*/*/ draw box(size: 1)\n".into());
    all.push("let a = 1 // f(\n\n\n// b\nlet b = 2 /* [ */\n\n// c {\n\n".into());
    let doubled: Vec<String> = all.iter().map(|text| text.replace('\n', "\r\n")).collect();
    let spread: Vec<String> =
        all.iter().map(|text| text.replace(", ", " ,\n  ").replace(" = ", "=")).collect();
    all.into_iter().chain(doubled).chain(spread).collect()
}

#[test]
fn what_is_formatted_says_the_same_and_stays_so() {
    let mut seen = 0;
    for text in texts() {
        let Some(once) = styled(&text) else { continue };
        assert_eq!(bare(&once), bare(&text), "{text}\n{once}");
        assert_eq!(styled(&once).as_deref(), Some(once.as_str()), "{text}\n{once}");
        assert!(!once.contains(" \n") && !once.contains("\n\n\n") && !once.contains('\r'), "{once}");
        seen += 1;
    }
    assert!(150 < seen, "{seen}");
}

#[test]
fn comments_between_items_stand_at_the_margin() {
    let text =
        "let a = 3\n// one\n// two\nlet b = [ // three\n    1]\n// four (\n\n/* five */\n// six\nlet c = 1\n";
    assert_eq!(styled(text).as_deref(), Some(text));
}
