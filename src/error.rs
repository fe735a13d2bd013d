//! The one error type that leaves the crate.

use std::fmt;

/// What went wrong, by cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The caller's data or options break a documented precondition.
    InvalidInput,
    /// The connectivity does not allow the operation (non-manifold, not orientable, would duplicate an edge).
    Topology,
    /// The positions do not allow the operation (zero area, coincident or collinear vertices).
    Geometry,
    /// A curve could not be unfolded: it is knotted, linked with another one, or too tangled.
    Knotted,
    /// A linear system could not be factored or its solution is not finite.
    Solver,
    /// A documented size, work or time limit was exceeded.
    Limit,
    /// The caller asked to stop.
    Cancelled,
    /// A file could not be read or written by the operating system.
    Io,
    /// A file was read, but its contents are not what its format prescribes.
    Parse,
}

/// An error with its cause and a message that names the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    kind: ErrorKind,
    message: String,
}

impl Error {
    pub(crate) fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self {
            kind,
            message: message.into(),
        }
    }

    pub(crate) fn invalid(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::InvalidInput, message)
    }

    pub(crate) fn topology(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Topology, message)
    }

    pub(crate) fn geometry(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Geometry, message)
    }

    pub(crate) fn limit(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Limit, message)
    }

    /// The caller asked to stop.
    pub(crate) fn cancelled() -> Self {
        Self::new(ErrorKind::Cancelled, "stopped by the caller")
    }

    /// The cause.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The message, in one line, without a trailing full stop.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// `Result` with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;
