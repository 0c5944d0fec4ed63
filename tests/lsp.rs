//! `pss lsp`, spoken to over its pipes as an editor does.

mod cli_common;

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use cli_common::Folder;
use serde_json::{Value, json};

/// A client and the server it started.
struct Client {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    asked: i64,
    /// Notifications that nobody waited for.
    heard: Vec<Value>,
}

impl Client {
    /// A server that knows nothing yet.
    fn start(folder: &Folder) -> Client {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pss"))
            .args(["lsp", "--stdio"])
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().unwrap());
        Client { child, input, output, asked: 0, heard: Vec::new() }
    }

    /// A server that is initialized, with what the client says of itself.
    fn initialized(folder: &Folder, capabilities: Value) -> (Client, Value) {
        let mut client = Client::start(folder);
        let said = json!({ "processId": null, "rootUri": null, "capabilities": capabilities });
        let result = client.ask("initialize", said)["result"].clone();
        client.tell("initialized", json!({}));
        (client, result)
    }

    fn raw(&mut self, text: &str) {
        self.input.as_mut().unwrap().write_all(text.as_bytes()).unwrap();
    }

    fn write(&mut self, message: &Value) {
        let text = message.to_string();
        self.raw(&format!("Content-Length: {}\r\n\r\n{text}", text.len()));
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "the server went away");
            match line.trim().split_once(": ") {
                Some(("Content-Length", value)) => length = value.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.write(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// The whole answer to a request.
    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        let id = self.asked;
        self.write(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        self.answer(&json!(id))
    }

    fn answer(&mut self, id: &Value) -> Value {
        loop {
            let message = self.read();
            if message.get("method").is_some() {
                self.heard.push(message);
            } else if message["id"] == *id {
                return message;
            }
        }
    }

    fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "pss", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    fn change(&mut self, uri: &str, version: i32, text: &str) {
        let document = json!({ "uri": uri, "version": version });
        let changes = json!([{ "text": text }]);
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    /// The next diagnostics of a document that are as wanted.
    fn diagnostics(&mut self, uri: &str, wanted: impl Fn(&[Value]) -> bool) -> Vec<Value> {
        let mut waiting = std::mem::take(&mut self.heard).into_iter();
        loop {
            let message = waiting.next().unwrap_or_else(|| self.read());
            let of = &message["params"];
            if of["uri"] != uri {
                self.heard.push(message);
                continue;
            }
            let list = of["diagnostics"].as_array().unwrap();
            if wanted(list) {
                self.heard.extend(waiting);
                return list.clone();
            }
        }
    }

    /// What a request about a place says.
    fn at(&mut self, method: &str, uri: &str, [line, character]: [usize; 2]) -> Value {
        let position = json!({ "line": line, "character": character });
        let params = json!({ "textDocument": { "uri": uri }, "position": position });
        let answer = self.ask(&format!("textDocument/{method}"), params);
        assert!(answer.get("error").is_none(), "{answer}");
        answer["result"].clone()
    }

    fn hover(&mut self, uri: &str, at: [usize; 2]) -> String {
        self.at("hover", uri, at)["contents"]["value"].as_str().unwrap_or_default().to_owned()
    }

    fn labels(&mut self, uri: &str, at: [usize; 2]) -> Vec<String> {
        let items = self.at("completion", uri, at);
        items.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// The exit code once the client has said `exit`, or gone away.
    fn left(mut self, says_exit: bool) -> i32 {
        if says_exit {
            self.tell("exit", Value::Null);
        }
        drop(self.input.take());
        self.child.wait().unwrap().code().unwrap()
    }

    fn shut_down(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null)["result"], Value::Null);
        assert_eq!(self.left(true), 0);
    }
}

fn uri(folder: &Folder, name: &str) -> String {
    format!("file://{}", folder.path().canonicalize().unwrap().join(name).to_str().unwrap())
}

fn some(list: &[Value]) -> bool {
    !list.is_empty()
}

/// The range of a diagnostic: line and column of both ends.
fn range(diagnostic: &Value) -> [u64; 4] {
    let range = &diagnostic["range"];
    [&range["start"], &range["end"]]
        .map(|p| [p["line"].as_u64().unwrap(), p["character"].as_u64().unwrap()])
        .concat()
        .try_into()
        .unwrap()
}

fn codes(list: &[Value]) -> Vec<&str> {
    list.iter().map(|d| d["code"].as_str().unwrap()).collect()
}

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
