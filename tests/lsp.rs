//! `pss lsp`, spoken to over its pipes as an editor does.

mod cli_common;
mod lsp_support;

use cli_common::Folder;
use lsp_support::{Client, codes, range, some, uri};
use serde_json::{Value, json};

#[test]
fn diagnostics_come_stand_at_their_place_and_go() {
    let folder = Folder::new();
    let (mut client, result) = Client::initialized(&folder, json!({}));
    assert_eq!(result["capabilities"]["positionEncoding"], "utf-16");
    assert_eq!(result["capabilities"]["textDocumentSync"]["change"], 1);
    let a = uri(&folder, "a.pss");
    client.open(&a, "draw sphere(r: 1)\r\ndraw shpere(r: 2)\r\nlet box = 1\r\n");
    let list = client.diagnostics(&a, some);
    let error = list.iter().find(|d| d["severity"] == 1).unwrap();
    assert_eq!((range(error), &error["source"]), ([1, 5, 1, 11], &json!("pss")), "{error}");
    assert!(error["message"].as_str().unwrap().contains("help: did you mean `sphere`?"), "{error}");
    assert!(list.iter().any(|d| d["severity"] == 2 && d["code"] == "W0201"), "{list:?}");
    client.change(&a, 2, "draw sphere(r: 1)\n");
    client.diagnostics(&a, <[Value]>::is_empty);
    // Several mistakes, several diagnostics; closing takes them away.
    client.change(&a, 3, "draw sphere(r: )\nlet b = [1, 2\nlet c = 5mn\n");
    let list = client.diagnostics(&a, some);
    assert_eq!(codes(&list), ["E0101", "E0102", "E0105"], "{list:?}");
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": a } }));
    client.diagnostics(&a, <[Value]>::is_empty);
    client.shut_down();
}

#[test]
fn columns_count_what_was_agreed_on() {
    let folder = Folder::new();
    let a = uri(&folder, "a.pss");
    let text = "/* ä😀 */ draw shpere(r: 1)\r\n";
    for (offered, chosen, column) in [
        (json!({}), "utf-16", 15),
        (json!({ "general": { "positionEncodings": ["utf-32", "utf-8", "utf-16"] } }), "utf-8", 18),
        (json!({ "general": { "positionEncodings": ["utf-16", "utf-8"] } }), "utf-16", 15),
    ] {
        let (mut client, result) = Client::initialized(&folder, offered);
        assert_eq!(result["capabilities"]["positionEncoding"], chosen);
        client.open(&a, text);
        assert_eq!(range(&client.diagnostics(&a, some)[0]), [0, column, 0, column + 6]);
        client.change(&a, 2, &text.replace("shpere", "sphere"));
        let hover = client.at("hover", &a, [0, column as usize + 1]);
        assert_eq!(range(&hover), [0, column, 0, column + 6]);
        client.shut_down();
    }
}

#[test]
fn an_imported_file_is_read_as_it_is_open_and_its_errors_are_its_own() {
    let folder = Folder::new();
    folder.write("lib.pss", "fn part(r) = sphere(r: r)\nlet size = bounds(part(2)).size\n");
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let (a, lib) = (uri(&folder, "a.pss"), uri(&folder, "lib.pss"));
    client.open(&a, "import \"lib.pss\" as lib\ndraw lib.part(1).move(lib.size)\ndraw lib.prt(1)\n");
    // What is not measured is no error, nor is what depends on it.
    let list = client.diagnostics(&a, some);
    assert_eq!((codes(&list), range(&list[0])), (vec!["E0408"], [2, 9, 2, 12]), "{list:?}");
    client.open(&lib, "fn prt(r) = sphere(r: r)\nlet size = [0, 0, 1]\nfn part(r) = prt(r)\n");
    client.diagnostics(&a, <[Value]>::is_empty);
    client.change(&lib, 2, "fn prt(r) = sphere(r: r\n");
    let list = client.diagnostics(&lib, some);
    assert_eq!(codes(&list), ["E0102"]);
    // Once, though both documents read it; closed, the file counts again.
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": lib } }));
    client.diagnostics(&lib, <[Value]>::is_empty);
    assert_eq!(codes(&client.diagnostics(&a, some)), ["E0408"]);
    client.shut_down();
}

#[test]
fn measured_scenes_get_no_false_errors() {
    let folder = Folder::new();
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let a = uri(&folder, "a.pss");
    let text = "let s = points(\"far.ply\")\nlet v = volume(s)\nlet w = v + 1\ndraw s.move([0, 0, w])\nexpect w ~= 3 within 1%\nexpect s == s\n";
    client.open(&a, &format!("{text}draw bix(1)\n"));
    let list = client.diagnostics(&a, some);
    assert_eq!(range(&list[0])[0], 6, "{list:?}");
    assert_eq!(list.len(), 1, "{list:?}");
    client.change(&a, 2, text);
    client.diagnostics(&a, <[Value]>::is_empty);
    client.change(&a, 3, "expect 1 + 1 is 3\n");
    assert_eq!(codes(&client.diagnostics(&a, some)), ["E0801"]);
    client.shut_down();
}

/// A quick fix is the edit of the message, at its place in UTF-16 units, also after a character that has two.
#[test]
fn diagnostics_bring_their_edits_as_quick_fixes() {
    let folder = Folder::new();
    let (mut client, capabilities) = Client::initialized(&folder, json!({}));
    assert_eq!(capabilities["capabilities"]["codeActionProvider"], true);
    let uri = uri(&folder, "a.pss");
    client.open(&uri, "print \"\u{1f980}\" draw spere(r: 1)\nlet a = y_unknown\n");
    let told = client.diagnostics(&uri, |list| list.len() == 2);
    let asked = json!({
        "textDocument": { "uri": uri },
        "range": told[0]["range"],
        "context": { "diagnostics": told },
    });
    let actions = client.ask("textDocument/codeAction", asked)["result"].clone();
    assert_eq!(actions.as_array().map(Vec::len), Some(1), "{actions}");
    assert_eq!(actions[0]["title"], "Write `sphere`");
    let edit = &actions[0]["edit"]["changes"][&uri][0];
    assert_eq!(edit["newText"], "sphere");
    assert_eq!(
        edit["range"],
        json!({ "start": { "line": 0, "character": 16 }, "end": { "line": 0, "character": 21 } })
    );
    // A client that keeps no diagnostics is told of what the server found at the cursor.
    let at = |line: u32, character: u32| {
        let cursor = json!({ "line": line, "character": character });
        json!({
            "textDocument": { "uri": uri },
            "range": { "start": cursor, "end": cursor },
            "context": { "diagnostics": [] },
        })
    };
    let found = client.ask("textDocument/codeAction", at(0, 18))["result"].clone();
    assert_eq!(found[0]["edit"], actions[0]["edit"], "{found}");
    let elsewhere = client.ask("textDocument/codeAction", at(1, 2))["result"].clone();
    assert_eq!(elsewhere, json!([]));
}

#[test]
fn hovering_shows_pages_and_definitions() {
    let folder = Folder::new();
    folder.write("lib.pss", "fn wheel(r, h = 2) = cylinder(r: r, h: h)\n");
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let a = uri(&folder, "a.pss");
    client.open(
        &a,
        "import \"lib.pss\" as lib\nparam bore: length = 4 in 1..8 \"radius of the drain\"\nlet c = sphere(r: bore).move([0, 0, pi])\ndraw lib.wheel(r: 2) // sphere\nfn f(x) = x\n",
    );
    let page = client.hover(&a, [2, 10]);
    assert!(
        page.contains("sphere(r:, at:)") && page.contains("- `r`: ") && page.contains("ellipsoid"),
        "{page}"
    );
    assert!(client.hover(&a, [2, 15]).contains("`r`: a length"));
    assert!(client.hover(&a, [2, 26]).contains(".move("));
    assert!(client.hover(&a, [2, 36]).contains("half the circumference"));
    assert!(client.hover(&a, [3, 1]).contains("draw shape"));
    let page = client.hover(&a, [2, 19]);
    for part in ["param bore: length = 4", "type: length", "allowed: `1..8`", "- radius of the drain"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    assert_eq!(client.hover(&a, [1, 14]), "", "a type, not the function");
    assert!(client.hover(&a, [3, 12]).contains("fn wheel(r, h = 2)"));
    assert!(client.hover(&a, [4, 10]).contains("fn f(x) = x"));
    assert_eq!(client.hover(&a, [3, 26]), "");
    client.shut_down();
}

#[test]
fn documents_are_formatted_as_fmt_does() {
    let folder = Folder::new();
    let messy = "// a\r\n\r\n\r\nlet   r=3 // ä😀\r\n draw sphere( r:r )-box( [0,0,-1],[ 1,1,1 ] )";
    folder.write("b.pss", messy);
    assert_eq!(folder.run(&["fmt", "b.pss"]).code, 0);
    let neat = String::from_utf8(folder.read("b.pss")).unwrap();
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let a = uri(&folder, "a.pss");
    let ask = json!({ "textDocument": { "uri": a }, "options": { "tabSize": 4, "insertSpaces": true } });
    client.open(&a, messy);
    let answer = client.ask("textDocument/formatting", ask.clone());
    let edit = &answer["result"][0];
    assert_eq!(edit["newText"], neat.as_str());
    assert_eq!(range(edit), [0, 0, 4, messy.rsplit('\n').next().unwrap().len() as u64]);
    client.change(&a, 2, &neat);
    assert_eq!(client.ask("textDocument/formatting", ask.clone())["result"], json!([]));
    client.change(&a, 3, "draw sphere(");
    assert_eq!(client.ask("textDocument/formatting", ask)["result"], Value::Null);
    client.shut_down();
}

#[test]
fn definitions_and_symbols_are_found() {
    let folder = Folder::new();
    folder.write("lib.pss", "// ä\nfn wheel(r) = sphere(r: r)\n");
    folder.write("more.pss", "let extra = 2\n");
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let (a, lib, more) = (uri(&folder, "a.pss"), uri(&folder, "lib.pss"), uri(&folder, "more.pss"));
    let text = "import \"lib.pss\" as lib\nimport \"more.pss\"\nlet a = 1\nfn f(a) = a + extra\ndraw lib.wheel(r: a)\nlight sun(direction: [0, 0, -1])\n";
    client.open(&a, text);
    let mut found = |at: [usize; 2]| {
        let place = client.at("definition", &a, at);
        (!place.is_null()).then(|| (place["uri"].as_str().unwrap().to_owned(), range(&place)))
    };
    assert_eq!(found([4, 18]), Some((a.clone(), [2, 4, 2, 5])));
    assert_eq!(found([3, 10]), Some((a.clone(), [3, 5, 3, 6])));
    assert_eq!(found([3, 15]), Some((more, [0, 4, 0, 9])));
    assert_eq!(found([4, 10]), Some((lib.clone(), [1, 3, 1, 8])));
    assert_eq!(found([4, 15]), Some((lib.clone(), [1, 9, 1, 10])));
    assert_eq!(found([4, 6]), Some((a.clone(), [0, 20, 0, 23])));
    assert_eq!(found([0, 10]), Some((lib, [0, 0, 0, 0])));
    assert_eq!(found([4, 1]), None);
    let answer = client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": a } }));
    let names: Vec<&str> =
        answer["result"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["lib", "a", "f", "sun"]);
    client.shut_down();
}

#[test]
fn wrong_requests_are_answered_and_harm_nothing() {
    let folder = Folder::new();
    let mut client = Client::start(&folder);
    let a = uri(&folder, "a.pss");
    let code = |answer: Value| answer["error"]["code"].as_i64();
    assert_eq!(code(client.ask("textDocument/hover", json!({}))), Some(-32002));
    client.ask("initialize", json!({ "capabilities": {} }));
    assert_eq!(code(client.ask("initialize", json!({ "capabilities": {} }))), Some(-32600));
    assert_eq!(code(client.ask("textDocument/rename", json!({}))), Some(-32601));
    assert_eq!(code(client.ask("$/strange", json!({}))), Some(-32601));
    for params in [json!({}), json!([1]), json!({ "textDocument": { "uri": "%%" } }), Value::Null] {
        assert_eq!(code(client.ask("textDocument/hover", params)), Some(-32602));
    }
    let place = json!({ "textDocument": { "uri": a }, "position": { "line": 0, "character": 0 } });
    assert_eq!(code(client.ask("textDocument/hover", place)), Some(-32602), "not open");
    let far = json!({ "textDocument": { "uri": a }, "position": { "line": -1, "character": 0 } });
    assert_eq!(code(client.ask("textDocument/hover", far)), Some(-32602));
    client.tell("textDocument/didOpen", json!({ "textDocument": 3 }));
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": a } }));
    client.tell("$/cancelRequest", json!({ "id": 1 }));
    // No JSON, no message, no id that can be: each is answered, and the next message is understood.
    for (text, id, wanted) in [
        ("{\"id\"", Value::Null, -32700),
        ("[]", Value::Null, -32600),
        ("{\"jsonrpc\":\"2.0\",\"id\":77,\"method\":5}", json!(77), -32600),
    ] {
        client.raw(&format!("Content-Length: {}\r\nX-Other: 1\r\n\r\n{text}", text.len()));
        assert_eq!(code(client.answer(&id)), Some(wanted), "{text}");
    }
    // Places past every end, in texts of all sorts.
    for text in [
        "",
        "let",
        "draw a.",
        "\u{feff}let x = (",
        "param p: = in \"",
        "import \"",
        "fn f(",
        "@ . ( : )",
        "\"😀",
        "let x = /",
    ] {
        client.open(&a, text);
        for at in [[0, 0], [0, 1], [0, 2], [0, 5], [0, 99], [99, 99]] {
            for method in ["hover", "completion", "definition"] {
                client.at(method, &a, at);
            }
        }
        let answer = client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": a } }));
        assert!(answer["result"].is_array(), "{text}");
    }
    client.open("untitled:Untitled-1", "draw bix(1)");
    assert_eq!(client.diagnostics("untitled:Untitled-1", some).len(), 1);
    client.shut_down();
}

#[test]
fn every_place_of_a_scene_can_be_asked_about() {
    let folder = Folder::new();
    let (mut client, _) = Client::initialized(&folder, json!({}));
    let text = include_str!("../scenes/rook.pss");
    let a = uri(&folder, "a.pss");
    client.open(&a, text);
    for (i, line) in text.lines().enumerate() {
        for column in (0..line.len() + 1).step_by(3) {
            for method in ["hover", "completion", "definition"] {
                client.at(method, &a, [i, column]);
            }
        }
    }
    client.diagnostics(&a, <[Value]>::is_empty);
    client.shut_down();
}

#[test]
fn the_exit_code_says_whether_the_server_was_shut_down() {
    let folder = Folder::new();
    assert_eq!(Client::start(&folder).left(true), 1);
    assert_eq!(Client::initialized(&folder, json!({})).0.left(true), 1);
    assert_eq!(Client::initialized(&folder, json!({})).0.left(false), 1);
    let (mut client, _) = Client::initialized(&folder, json!({}));
    client.ask("shutdown", Value::Null);
    assert_eq!(client.ask("textDocument/hover", json!({}))["error"]["code"], -32600);
    assert_eq!(client.left(true), 0);
}
