//! Messages and standard output. Writes that fail because the reader has gone are no errors, and nothing here
//! panics when standard error is closed.

use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;

use pss::diag::{Diagnostic, Fault};
use pss::output::OutputError;
use pss::output::state::ClaimError;
use pss::render::RenderError;
use pss::report;
use pss::source::SourceMap;

use crate::args::MessageFormat;

/// Why a command failed.
#[derive(Debug)]
pub struct Failure {
    /// What to say; the first decides the exit code.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts they point into.
    pub sources: SourceMap,
}

impl Failure {
    /// A failure that points into texts.
    pub fn new(diagnostics: Vec<Diagnostic>, sources: SourceMap) -> Failure {
        Failure { diagnostics, sources }
    }

    /// The program is wrong.
    pub fn internal(message: String) -> Failure {
        Failure::from(Diagnostic::error("E0900", message).fault(Fault::Internal))
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Failure {
        Failure::new(vec![diagnostic], SourceMap::default())
    }
}

impl From<OutputError> for Failure {
    fn from(e: OutputError) -> Failure {
        let fault = match e {
            OutputError::Suffix { .. } => Fault::Usage,
            OutputError::Create { .. } => Fault::Output,
            OutputError::Write { .. } => Fault::Io,
        };
        Failure::from(Diagnostic::error("E0608", e.to_string()).fault(fault))
    }
}

impl From<ClaimError> for Failure {
    fn from(e: ClaimError) -> Failure {
        let (code, fault) = match &e {
            ClaimError::Taken { .. } => ("E0612", Fault::Output),
            ClaimError::Io { .. } => ("E0608", Fault::Output),
            ClaimError::Other { .. } => ("E0610", Fault::Input),
        };
        let diagnostic = Diagnostic::error(code, e.to_string()).fault(fault);
        Failure::from(match &e {
            ClaimError::Other { parts, .. } => {
                let words: Vec<&str> = parts.iter().map(|part| part.word()).collect();
                let differ = diagnostic.note(format!("not the same: {}", words.join(", ")));
                differ.help("leave out `--resume` to begin anew")
            }
            _ => diagnostic,
        })
    }
}

impl From<RenderError> for Failure {
    fn from(e: RenderError) -> Failure {
        match e {
            RenderError::NoRoom(_) => {
                let diagnostic = Diagnostic::error("E0707", e.to_string()).fault(Fault::Memory);
                Failure::from(
                    diagnostic.help("make the picture smaller, or render it in parts with `--crop`"),
                )
            }
            RenderError::Panicked { .. } => Failure::internal(e.to_string()),
        }
    }
}

/// Where messages go.
#[derive(Debug)]
pub struct Console {
    format: MessageFormat,
    color: bool,
    silent: bool,
}

impl Console {
    /// Messages in a format; in colour on a terminal, unless `NO_COLOR` is set.
    pub fn new(format: MessageFormat) -> Console {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        Console { format, color: !refused && io::stderr().is_terminal(), silent: false }
    }

    /// One that says nothing.
    pub fn silent() -> Console {
        Console { format: MessageFormat::Text, color: false, silent: true }
    }

    /// Shows errors and warnings.
    pub fn show(&self, diagnostics: &[Diagnostic], sources: &SourceMap) {
        if diagnostics.is_empty() {
            return;
        }
        match self.format {
            MessageFormat::Text => self.say(report::text(diagnostics, sources, self.color).trim_end()),
            MessageFormat::Json => {
                diagnostics.iter().for_each(|d| self.say(report::json_line(d, sources).trim_end()));
            }
        }
    }

    /// Shows why a command failed and gives its exit code.
    pub fn fail(&self, failure: &Failure) -> u8 {
        let mut diagnostics = failure.diagnostics.clone();
        if let Some(place) = take_panic() {
            let internal = diagnostics.iter_mut().find(|d| d.fault == Fault::Internal);
            if let Some(d) = internal {
                d.notes.push(place);
                d.help = Some("this is a fault of pss, not of the scene; please report it".into());
            }
        }
        self.show(&diagnostics, &failure.sources);
        let first = diagnostics.iter().find(|d| d.is_error());
        first.map_or(Fault::Internal, |d| d.fault).exit_code()
    }

    /// A line for people on standard error; nothing where messages are JSON.
    pub fn note(&self, line: &str) {
        if self.format == MessageFormat::Text {
            self.say(line);
        }
    }

    /// What a scene prints.
    pub fn printed(&self, line: &str) {
        match self.format {
            MessageFormat::Text => self.say(&report::printable(line)),
            MessageFormat::Json => {
                self.say(&serde_json::json!({ "severity": "print", "message": line }).to_string())
            }
        }
    }

    fn say(&self, line: &str) {
        if !self.silent {
            // Whoever closed standard error does not want to hear of it.
            let _ = writeln!(io::stderr(), "{line}");
        }
    }
}

/// Writes to standard output; `Ok(false)` where its reader has gone.
pub fn print(bytes: &[u8]) -> Result<bool, Failure> {
    print_with(|out| out.write_all(bytes))
}

/// The same of what is made while it is written.
pub fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<bool, Failure> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Ok(()) => Ok(true),
        Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        Err(e) => {
            let message = format!("cannot write to standard output: {e}");
            Err(Failure::from(Diagnostic::error("E0608", message).fault(Fault::Io)))
        }
    }
}

/// What the first panic said of itself.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Panics are caught and reported as diagnostics: the hook only remembers where the first one was.
pub fn keep_panics_quiet() {
    std::panic::set_hook(Box::new(|info| {
        let mut first = PANIC.lock().unwrap_or_else(|e| e.into_inner());
        if first.is_none() {
            *first = Some(info.to_string());
        }
    }));
}

fn take_panic() -> Option<String> {
    PANIC.lock().unwrap_or_else(|e| e.into_inner()).take()
}
