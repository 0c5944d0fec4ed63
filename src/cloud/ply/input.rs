//! Bytes, lines and scalars of a stream whose length is known beforehand, each counted.

use std::io::{BufRead, ErrorKind};

use super::header::{Encoding, Scalar};
use crate::cloud::CloudError;

/// No line of a PLY is longer: 64 KiB hold some four thousand numbers.
const LINE_LIMIT: usize = 1 << 16;

/// A stream, with what was read of it.
pub struct Input<R> {
    stream: R,
    length: u64,
    read: u64,
    /// Lines begun so far; the number of the last line read.
    pub line: usize,
    /// Whether the last row had its line's end.
    pub line_ended: bool,
    text: Vec<u8>,
}

/// Why there are no more bytes.
pub enum Short {
    /// The file ends here.
    End,
    /// Something else.
    Error(CloudError),
}

impl<R: BufRead> Input<R> {
    /// A stream of `length` bytes.
    pub fn new(stream: R, length: u64) -> Input<R> {
        Input { stream, length, read: 0, line: 0, line_ended: true, text: Vec::new() }
    }

    /// Bytes from here to the end of the file.
    pub fn left(&self) -> u64 {
        self.length.saturating_sub(self.read)
    }

    /// Bytes before here.
    pub fn position(&self) -> u64 {
        self.read
    }

    /// The bytes that come next, as many as the stream has ready.
    pub fn peek(&mut self) -> Result<&[u8], CloudError> {
        loop {
            match self.stream.fill_buf() {
                Ok(_) => break,
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => return Err(e.into()),
            }
        }
        Ok(self.stream.fill_buf()?)
    }

    /// One byte, if there is one.
    pub fn byte(&mut self) -> Result<Option<u8>, CloudError> {
        let byte = self.peek()?.first().copied();
        if byte.is_some() {
            self.stream.consume(1);
            self.read += 1;
        }
        Ok(byte)
    }

    /// The next byte is eaten where it is `byte`.
    pub fn eat(&mut self, byte: u8) -> Result<bool, CloudError> {
        let next = self.peek()?.first() == Some(&byte);
        if next {
            self.byte()?;
        }
        Ok(next)
    }

    /// The next line of ASCII data that is not blank, without its end (LF, CRLF or CR); `None` at the end.
    pub fn row(&mut self) -> Result<Option<&str>, CloudError> {
        loop {
            if self.peek()?.is_empty() {
                return Ok(None);
            }
            self.line += 1;
            self.line_into()?;
            if !self.text.trim_ascii().is_empty() {
                break;
            }
        }
        let line = self.line;
        std::str::from_utf8(&self.text)
            .map(Some)
            .map_err(|_| CloudError::bad("this line is no text").at_line(line).help(BINARY_HINT))
    }

    fn line_into(&mut self) -> Result<(), CloudError> {
        self.text.clear();
        self.line_ended = false;
        loop {
            let ready = self.peek()?;
            if ready.is_empty() {
                return Ok(());
            }
            let end = ready.iter().position(|&b| b == b'\n' || b == b'\r');
            let (taken, stop) = (end.unwrap_or(ready.len()), end.map(|at| ready[at]));
            if self.text.len() + taken > LINE_LIMIT {
                let message = format!("a line is longer than {LINE_LIMIT} bytes");
                return Err(CloudError::bad(message).at_line(self.line).help(BINARY_HINT));
            }
            let ready = self.stream.fill_buf()?;
            self.text.extend_from_slice(&ready[..taken]);
            self.stream.consume(taken + usize::from(stop.is_some()));
            self.read += (taken + usize::from(stop.is_some())) as u64;
            if stop == Some(b'\r') {
                self.eat(b'\n')?;
            }
            if stop.is_some() {
                self.line_ended = true;
                return Ok(());
            }
        }
    }

    /// Passes over `count` bytes.
    pub fn skip(&mut self, mut count: u64) -> Result<(), Short> {
        if self.left() < count {
            return Err(Short::End);
        }
        while 0 < count {
            let ready = self.peek().map_err(Short::Error)?.len() as u64;
            if ready == 0 {
                return Err(Short::Error(CloudError::io(CHANGED)));
            }
            let step = ready.min(count);
            self.stream.consume(step as usize);
            self.read += step;
            count -= step;
        }
        Ok(())
    }

    /// One binary number.
    pub fn scalar(&mut self, scalar: Scalar, encoding: Encoding) -> Result<f64, Short> {
        let mut bytes = [0u8; 8];
        let bytes = &mut bytes[..scalar.size()];
        if self.left() < bytes.len() as u64 {
            return Err(Short::End);
        }
        self.stream.read_exact(bytes).map_err(|e| Short::Error(changed_or(e)))?;
        self.read += bytes.len() as u64;
        if encoding == Encoding::Big {
            bytes.reverse();
        }
        Ok(scalar.decode(bytes))
    }

    /// The error for a file that ends before it should: a fault of the reading where the file system promised
    /// more bytes than came.
    pub fn truncated(&self, message: String, at_end: bool) -> CloudError {
        let shrank = at_end && 0 < self.left();
        let error = if shrank { CloudError::io(message) } else { CloudError::bad(message) };
        error.help(if shrank { CHANGED } else { "the file is cut short: copy or export it again" })
    }
}

/// A file that ends before its length.
const CHANGED: &str = "the file changed while it was read";

/// Fewer bytes than the file had when it was opened, or what the system says.
fn changed_or(e: std::io::Error) -> CloudError {
    if e.kind() == ErrorKind::UnexpectedEof { CloudError::io(CHANGED) } else { e.into() }
}

/// Given where text is expected and there is none.
const BINARY_HINT: &str = "a binary file that is declared `ascii`?";
