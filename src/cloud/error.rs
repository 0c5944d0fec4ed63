//! What can be wrong with a cloud, said in one sentence and a hint. How it is shown is left to the caller.

use std::fmt;

/// Which kind of failure it is: it chooses the exit code.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CloudFault {
    /// The file is not there, cannot be opened, or is no regular file.
    Missing,
    /// The data are wrong.
    Bad,
    /// Reading failed on the way.
    Io,
}

/// Why there is no cloud.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CloudError {
    /// The kind of failure.
    pub kind: CloudFault,
    /// One sentence, no final stop.
    pub message: String,
    /// The way out, where one is known.
    pub help: Option<String>,
    /// Line of the file, from 1, where the matter has one.
    pub line: Option<usize>,
}

impl CloudError {
    /// Wrong data.
    pub fn bad(message: impl Into<String>) -> CloudError {
        CloudError { kind: CloudFault::Bad, message: message.into(), help: None, line: None }
    }

    /// A failure of the file system while opening.
    pub fn missing(message: impl Into<String>) -> CloudError {
        CloudError { kind: CloudFault::Missing, ..CloudError::bad(message) }
    }

    /// A failure while reading.
    pub fn io(message: impl Into<String>) -> CloudError {
        CloudError { kind: CloudFault::Io, ..CloudError::bad(message) }
    }

    /// Adds the way out.
    pub fn help(mut self, help: impl Into<String>) -> CloudError {
        self.help = Some(help.into());
        self
    }

    /// Adds the line, from 1.
    pub fn at_line(mut self, line: usize) -> CloudError {
        self.line = Some(line);
        self
    }
}

impl From<std::io::Error> for CloudError {
    fn from(error: std::io::Error) -> CloudError {
        CloudError::io(format!("reading failed: {error}"))
    }
}

impl fmt::Display for CloudError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for CloudError {}
