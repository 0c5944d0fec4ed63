//! Messages on the wire: a header with the length, and JSON. One that is malformed is told and costs only itself.

use std::io::{self, BufRead, Read, Write};

use lsp_server::{ErrorCode, Message, RequestId};
use serde_json::{Value, json};

use super::Sent;

/// The longest message, bytes; the longest scene fits in it several times.
const MAX_MESSAGE: u64 = 256 << 20;

/// What came.
pub enum Received {
    /// A message.
    Message(Message),
    /// Something else.
    Malformed {
        /// Whom to answer, if it can be read.
        id: Option<RequestId>,
        /// What is wrong.
        code: ErrorCode,
        /// The same in words.
        message: String,
    },
}

/// The next message; `None` at the end of the input.
pub fn read(input: &mut impl BufRead) -> Option<Received> {
    let length = match header(input).ok()?? {
        Ok(length) => length,
        Err(message) => return Some(malformed(None, ErrorCode::ParseError, message)),
    };
    let mut body = Vec::new();
    let took = input.by_ref().take(length.min(MAX_MESSAGE)).read_to_end(&mut body).ok()? as u64;
    if took < length.min(MAX_MESSAGE) {
        return None;
    }
    if MAX_MESSAGE < length {
        io::copy(&mut input.take(length - MAX_MESSAGE), &mut io::sink()).ok()?;
        return Some(malformed(None, ErrorCode::InvalidRequest, "the message is too long".to_owned()));
    }
    Some(parsed(&body))
}

/// The length that a header gives, or what is wrong with it; `None` at the end of the input.
fn header(input: &mut impl BufRead) -> io::Result<Option<Result<u64, String>>> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        if input.by_ref().take(1 << 12).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        match line.split_once(':') {
            _ if line.is_empty() => break,
            Some((name, value)) if name.trim().eq_ignore_ascii_case("content-length") => {
                length = value.trim().parse::<u64>().ok();
            }
            Some(_) => {}
            None => return Ok(Some(Err("a line of the header has no colon".to_owned()))),
        }
    }
    Ok(Some(length.ok_or_else(|| "the header has no Content-Length".to_owned())))
}

fn parsed(body: &[u8]) -> Received {
    let value: Value = match serde_json::from_slice(body) {
        Ok(value) => value,
        Err(e) => return malformed(None, ErrorCode::ParseError, format!("not JSON: {e}")),
    };
    let id = value.get("id").and_then(|id| serde_json::from_value(id.clone()).ok());
    match serde_json::from_value(value) {
        Ok(message) => Received::Message(message),
        Err(_) => malformed(id, ErrorCode::InvalidRequest, "not a message of the protocol".to_owned()),
    }
}

fn malformed(id: Option<RequestId>, code: ErrorCode, message: String) -> Received {
    Received::Malformed { id, code, message }
}

/// Writes a message.
pub fn write(output: &mut impl Write, sent: &Sent) -> io::Result<()> {
    match sent {
        Sent::Message(message) => message.write(output),
        Sent::Unaddressed { code, message } => {
            let error = json!({ "code": code, "message": message });
            let text = json!({ "jsonrpc": "2.0", "id": null, "error": error }).to_string();
            write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
            output.flush()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_malformed_costs_only_itself() {
        let good = r#"{"jsonrpc":"2.0","method":"exit"}"#;
        let framed = |text: &str| format!("Content-Length: {}\r\n\r\n{text}", text.len());
        let text = framed("{")
            + &framed("[1]")
            + &framed(r#"{"id":7,"method":3}"#)
            + "X-Y: z\r\n\r\n"
            + &framed(good);
        let mut input = text.as_bytes();
        let mut told = Vec::new();
        while let Some(got) = read(&mut input) {
            told.push(match got {
                Received::Message(_) => "good".to_owned(),
                Received::Malformed { id, code, .. } => {
                    format!("{:?} {}", id.map(|id| id.to_string()), code as i32)
                }
            });
        }
        let want = ["None -32700", "None -32600", "Some(\"7\") -32600", "None -32700", "good"];
        assert_eq!(told, want);
    }
}
