//! What `pss lsp` offers while one types.

mod cli_common;
mod lsp_support;

use cli_common::Folder;
use lsp_support::{Client, uri};
use serde_json::json;

#[test]
fn completion_knows_what_may_stand_where() {
    let folder = Folder::new();
    folder.write("lib.pss", "fn wheel(r) = sphere(r: r)\nlet axle = 1\n");
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let a = uri(&folder, "a.pss");
    let mut at = |text: &str| {
        let text = format!("import \"lib.pss\" as lib\nfn part(width, tall) = box(size: width)\n{text}");
        let last = text.rsplit('\n').next().unwrap();
        client.open(&a, &text);
        client.labels(&a, [text.matches('\n').count(), last.encode_utf16().count()])
    };
    let has = |list: &[String], word: &str| list.iter().any(|label| label == word);
    let methods = at("draw sphere(r: 1).");
    assert!(has(&methods, "move") && has(&methods, "with") && !has(&methods, "sphere"), "{methods:?}");
    assert_eq!(at("draw lib.w"), ["wheel", "axle"]);
    // After a point stands what may follow it: parts of a vector or of bounds, methods of a shape, nothing of a number.
    for vector in ["let v = [1, 2, 3]\nlet w = v\nprint w.", "print [1, 2].", "print bounds(part(1)).min."] {
        assert_eq!(at(vector), ["x", "y", "z"], "{vector}");
    }
    for bounds in ["print bounds(sphere(r: 1)).", "let b = bounds(sphere(r: 1))\nprint b."] {
        assert_eq!(at(bounds), ["min", "max", "size", "center"], "{bounds}");
    }
    assert_eq!(
        at("print raycast(s, from: [0, 0, 0], dir: [0, 0, 1])[0]."),
        ["t", "point", "normal", "entering"]
    );
    assert!(at("let n = 3\nprint n.").is_empty() && at("print volume(part(1)).").is_empty());
    assert!(
        has(&at("let s = sphere(r: 1).move([1, 0, 0])\ndraw s."), "move") && has(&at("fn f(s) = s."), "move")
    );
    let args = at("draw sphere(");
    assert!(args.starts_with(&["r:".to_owned(), "at:".to_owned()]) && has(&args, "pi"), "{args:?}");
    let args = at("draw sphere(r: 1, ");
    assert!(!has(&args, "r:") && has(&args, "at:"), "{args:?}");
    assert!(!has(&at("draw sphere(r: "), "at:"));
    let args = at("draw part(");
    assert!(has(&args, "width:") && has(&args, "tall:"), "{args:?}");
    assert!(has(&at("material m("), "kind:") && has(&at("light l("), "direction:"));
    let values = at("let q = 3\ndraw so");
    for word in ["solid", "part", "lib", "q", "sphere", "union", "if"] {
        assert!(has(&values, word), "{word}");
    }
    assert!(!has(&values, "draw") && !has(&values, "move"));
    assert!(has(&at("let q = 3\nd"), "draw") && !has(&at("let q = 3\nd"), "sphere"));
    assert_eq!(at("param p: ").len(), 8);
    assert_eq!(at("@"), ["ghost", "only", "skip"]);
    assert!(at("// sph").is_empty() && at("let s = \"sph").is_empty() && at("let ").is_empty());
    client.shut_down();
}

#[test]
fn words_that_stand_in_quotes_are_offered_there() {
    let folder = Folder::new();
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let a = uri(&folder, "a.pss");
    let mut at = |text: &str| {
        client.open(&a, text);
        client.labels(&a, [0, text.len()])
    };
    assert_eq!(at("render(integrator: \"")[..2], ["direct", "path"]);
    let layers = at("render(aov: [\"depth\", \"n");
    assert!(
        layers.iter().any(|word| word == "normal") && layers.iter().any(|word| word == "wall"),
        "{layers:?}"
    );
    let kinds = at("material m(kind: \"");
    assert!(
        kinds.iter().any(|word| word == "glass") && kinds.iter().any(|word| word == "points"),
        "{kinds:?}"
    );
    assert!(at("camera(kind: \"o").iter().any(|word| word == "orthographic"));
    // Files, and words of nothing.
    assert!(
        at("draw points(\"").is_empty()
            && at("print \"d").is_empty()
            && at("render(tone: \"agx\"").len() != 1
    );
    client.shut_down();
}
