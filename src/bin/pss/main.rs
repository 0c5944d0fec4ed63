//! The command line: arguments, progress, messages and exit codes. The only place with a clock, standard
//! output and process state; everything else is the library's.

mod args;
mod check;
mod cloud;
mod compare;
mod console;
mod deps;
mod dump;
mod explain;
mod fix;
mod fmt;
mod goldens;
mod identity;
mod junit;
mod keeping;
mod live;
mod load;
mod lsp;
mod making;
mod numbers;
mod probe;
mod progress;
mod render;
mod stats;
mod stop;
mod system;
mod test;
mod watch;

use std::process::ExitCode;

use clap::Parser;
use pss::diag::{Diagnostic, Fault};

use args::{Args, Command, MessageFormat};
use console::{Console, Failure};

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(e) => return ExitCode::from(misused(&e)),
    };
    let args::CloudArgs { threads, format, .. } = args.command.common();
    let console = Console::new(format);
    console::keep_panics_quiet();
    let done = std::panic::catch_unwind(|| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        pool.map_err(|e| Failure::internal(format!("cannot start {threads} threads: {e}")))?;
        // What is not parallel stays on this thread: memory that others take grows by many small calls to the system.
        match &args.command {
            Command::Render(args) => render::run(args, &console).map(|()| 0),
            Command::Probe(args) => probe::run(args, &console).map(|()| 0),
            Command::Check(args) => Ok(check::run(args, &console)),
            Command::Fmt(args) => fmt::run(args, &console),
            Command::Dump(args) => dump::run(args, &console).map(|()| 0),
            Command::Test(args) => test::run(args, &console),
            Command::Compare(args) => compare::run(args, &console),
            Command::Explain(args) => explain::run(args).map(|()| 0),
            Command::Lsp(args) => lsp::run(args),
            Command::Cloud(command) => cloud::run(command, &console).map(|()| 0),
        }
    });
    let done = done.unwrap_or_else(|_| Err(Failure::internal("the program went wrong".to_owned())));
    match done {
        Ok(code) => ExitCode::from(code),
        Err(failure) => ExitCode::from(console.fail(&failure)),
    }
}

/// Shows help, or what is wrong with the arguments, and gives the exit code.
fn misused(e: &clap::Error) -> u8 {
    if e.use_stderr() && args::asks_for_json(std::env::args_os()) {
        let text = e.to_string();
        let (message, help) = text.split_once("\n").unwrap_or((&text, ""));
        let message = message.strip_prefix("error: ").unwrap_or(message);
        let diagnostic = Diagnostic::error("E0001", message).help(help.trim()).fault(Fault::Usage);
        return Console::new(MessageFormat::Json).fail(&Failure::from(diagnostic));
    }
    // Printing fails where the pipe is closed; the exit code says all that is left to say.
    let _ = e.print();
    if e.use_stderr() { Fault::Usage.exit_code() } else { 0 }
}
