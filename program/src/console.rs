//! Standard output and standard error, without panics when nobody listens.

use crate::Failure;
use std::io::{self, ErrorKind, Write};

/// Writes `text` to standard output. A reader that has gone away, as in `holefill inspect x | head`,
/// is no error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::file(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes one message to standard error. There is nowhere to report that this failed.
pub(crate) fn message(text: &str) {
    let _ = writeln!(io::stderr(), "holefill: {text}");
}

/// Writes a remark on standard error for each line.
pub(crate) fn notes(lines: &[String]) {
    for line in lines {
        message(&format!("note: {line}"));
    }
}
