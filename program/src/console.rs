//! Standard output and standard error, without a panic if they are closed.

use crate::Failure;
use std::io::{self, ErrorKind, Write};

/// Writes `text` to standard output. A closed pipe, as in `holefill inspect x | head`, is not an error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::file(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes one message to standard error. Errors are ignored, because they cannot be reported.
pub(crate) fn message(text: &str) {
    let _ = writeln!(io::stderr(), "holefill: {text}");
}

/// Writes each line as a note to standard error.
pub(crate) fn notes(lines: &[String]) {
    for line in lines {
        message(&format!("note: {line}"));
    }
}
