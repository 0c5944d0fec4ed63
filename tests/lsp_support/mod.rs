//! A client of `pss lsp`, over its pipes as an editor speaks.
#![allow(dead_code)]

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

use crate::cli_common::Folder;

/// A client and the server it started.
pub struct Client {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    asked: i64,
    /// Notifications that nobody waited for.
    heard: Vec<Value>,
}

impl Client {
    /// A server that knows nothing yet.
    pub fn start(folder: &Folder) -> Client {
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
    pub fn initialized(folder: &Folder, capabilities: Value) -> (Client, Value) {
        let mut client = Client::start(folder);
        let said = json!({ "processId": null, "rootUri": null, "capabilities": capabilities });
        let result = client.ask("initialize", said)["result"].clone();
        client.tell("initialized", json!({}));
        (client, result)
    }

    pub fn raw(&mut self, text: &str) {
        self.input.as_mut().unwrap().write_all(text.as_bytes()).unwrap();
    }

    pub fn write(&mut self, message: &Value) {
        let text = message.to_string();
        self.raw(&format!("Content-Length: {}\r\n\r\n{text}", text.len()));
    }

    pub fn read(&mut self) -> Value {
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

    pub fn tell(&mut self, method: &str, params: Value) {
        self.write(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// The whole answer to a request.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        let id = self.asked;
        self.write(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        self.answer(&json!(id))
    }

    pub fn answer(&mut self, id: &Value) -> Value {
        loop {
            let message = self.read();
            if message.get("method").is_some() {
                self.heard.push(message);
            } else if message["id"] == *id {
                return message;
            }
        }
    }

    pub fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "pss", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub fn change(&mut self, uri: &str, version: i32, text: &str) {
        let document = json!({ "uri": uri, "version": version });
        let changes = json!([{ "text": text }]);
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    /// The next diagnostics of a document that are as wanted.
    pub fn diagnostics(&mut self, uri: &str, wanted: impl Fn(&[Value]) -> bool) -> Vec<Value> {
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
    pub fn at(&mut self, method: &str, uri: &str, [line, character]: [usize; 2]) -> Value {
        let position = json!({ "line": line, "character": character });
        let params = json!({ "textDocument": { "uri": uri }, "position": position });
        let answer = self.ask(&format!("textDocument/{method}"), params);
        assert!(answer.get("error").is_none(), "{answer}");
        answer["result"].clone()
    }

    pub fn hover(&mut self, uri: &str, at: [usize; 2]) -> String {
        self.at("hover", uri, at)["contents"]["value"].as_str().unwrap_or_default().to_owned()
    }

    pub fn labels(&mut self, uri: &str, at: [usize; 2]) -> Vec<String> {
        let items = self.at("completion", uri, at);
        items.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// The exit code once the client has said `exit`, or gone away.
    pub fn left(mut self, says_exit: bool) -> i32 {
        if says_exit {
            self.tell("exit", Value::Null);
        }
        drop(self.input.take());
        self.child.wait().unwrap().code().unwrap()
    }

    pub fn shut_down(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null)["result"], Value::Null);
        assert_eq!(self.left(true), 0);
    }
}

pub fn uri(folder: &Folder, name: &str) -> String {
    format!("file://{}", folder.path().canonicalize().unwrap().join(name).to_str().unwrap())
}

pub fn some(list: &[Value]) -> bool {
    !list.is_empty()
}

/// The range of a diagnostic: line and column of both ends.
pub fn range(diagnostic: &Value) -> [u64; 4] {
    let range = &diagnostic["range"];
    [&range["start"], &range["end"]]
        .map(|p| [p["line"].as_u64().unwrap(), p["character"].as_u64().unwrap()])
        .concat()
        .try_into()
        .unwrap()
}

pub fn codes(list: &[Value]) -> Vec<&str> {
    list.iter().map(|d| d["code"].as_str().unwrap()).collect()
}
