//! A language server: what editors show of a scene while it is written. Documents are synchronised whole; diagnostics follow
//! when no message waits. Scenes are read, never prepared: nothing is traced, and no scan is opened.
//!
//! What the language knows comes from the tables of [`crate::lang`]; what a text binds is found by its tokens alone
//! ([`names`]), so that a text that is not complete yet has names as well.

mod actions;
mod answers;
mod completion;
mod context;
mod definition;
mod diagnostics;
mod documents;
mod hover;
mod names;
mod parts;
mod positions;
mod server;
mod symbols;
mod uri;
mod view;
mod wire;

use std::io::{BufRead, Write};
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use lsp_server::Message;

use server::Server;
use wire::Received;

/// How long no message comes before diagnostics are made: a burst of key strokes makes them once.
const SETTLED: Duration = Duration::from_millis(40);

/// What scenes may read.
#[derive(Clone, Debug)]
pub struct Access {
    /// Folders below which files may be read, beside that of the scene.
    pub allow_read: Vec<PathBuf>,
    /// The longest scene, bytes.
    pub limit: u64,
}

/// Serves one client until it says `exit` or goes away; whether it said `shutdown` before.
pub fn serve(
    mut input: impl BufRead + Send + 'static,
    mut output: impl Write,
    access: Access,
) -> std::io::Result<bool> {
    let (sender, receiver) = channel();
    // The thread ends with the process: it may wait for a client that never writes again.
    std::thread::spawn(move || while wire::read(&mut input).is_some_and(|got| sender.send(got).is_ok()) {});
    let mut server = Server::new(access);
    while !server.exits() {
        let received = match server.is_settled() {
            true => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
            false => receiver.recv_timeout(SETTLED),
        };
        match received {
            Ok(Received::Message(message)) => server.take(message),
            Ok(Received::Malformed { id, code, message }) => server.refuse(id, code, message),
            Err(RecvTimeoutError::Timeout) => server.diagnose(),
            Err(RecvTimeoutError::Disconnected) => break,
        }
        for message in server.outbox() {
            wire::write(&mut output, &message)?;
        }
    }
    Ok(server.was_shut_down())
}

/// What is sent to the client.
enum Sent {
    Message(Message),
    /// An answer to what had no id that could be read.
    Unaddressed {
        code: i32,
        message: String,
    },
}
