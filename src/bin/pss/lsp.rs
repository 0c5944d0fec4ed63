//! `pss lsp`: the language server on standard input and output.

use std::io::{self, BufReader};

use pss::diag::{Diagnostic, Fault};
use pss::lsp::Access;

use crate::args::LspArgs;
use crate::console::Failure;
use crate::load::MAX_SCENE;

/// Serves until the client leaves; the exit code is 1 where it did not say `shutdown` before.
pub fn run(args: &LspArgs) -> Result<u8, Failure> {
    let access = Access { allow_read: args.allow_read.clone(), limit: MAX_SCENE };
    let served = pss::lsp::serve(BufReader::new(io::stdin()), io::stdout().lock(), access);
    match served {
        Ok(shut_down) => Ok(u8::from(!shut_down)),
        Err(e) => {
            let message = format!("cannot write to the client: {e}");
            Err(Failure::from(Diagnostic::error("E0608", message).fault(Fault::Io)))
        }
    }
}
