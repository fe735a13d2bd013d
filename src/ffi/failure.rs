//! Why a call did not do what it says.

use super::status::{self, *};
use crate::error::{Error, ErrorKind};

/// A status other than success, and what is to be said of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Failure {
    pub(super) status: HolefillStatus,
    pub(super) message: String,
}

impl Failure {
    pub(super) fn new(status: HolefillStatus, message: impl Into<String>) -> Self {
        Self {
            status,
            message: message.into(),
        }
    }

    /// With the general message of the status.
    pub(super) fn of(status: HolefillStatus) -> Self {
        Self::new(status, status::message(status).to_string_lossy())
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let status = match error.kind() {
            ErrorKind::Topology => HOLEFILL_STATUS_TOPOLOGY,
            ErrorKind::Limit => HOLEFILL_STATUS_LIMIT,
            ErrorKind::Cancelled => HOLEFILL_STATUS_CANCELLED,
            _ => HOLEFILL_STATUS_INVALID_ARGUMENT,
        };
        Self::new(status, error.to_string())
    }
}

pub(super) fn null(what: &str) -> Failure {
    Failure::new(HOLEFILL_STATUS_NULL_POINTER, format!("{what} is null"))
}

/// Refuses a null pointer.
pub(super) fn not_null<T>(pointer: *const T, what: &str) -> Result<(), Failure> {
    match pointer.is_null() {
        true => Err(null(what)),
        false => Ok(()),
    }
}

pub(super) fn invalid(message: impl Into<String>) -> Failure {
    Failure::new(HOLEFILL_STATUS_INVALID_ARGUMENT, message)
}

pub(super) fn invalid_struct(message: impl Into<String>) -> Failure {
    Failure::new(HOLEFILL_STATUS_INVALID_STRUCT, message)
}

pub(super) fn not_found(message: impl Into<String>) -> Failure {
    Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
}

/// Element `index` of a list of things that are called `what`.
pub(super) fn nth<'a, T>(list: &'a [T], index: u64, what: &str) -> Result<&'a T, Failure> {
    let found = usize::try_from(index).ok().and_then(|i| list.get(i));
    found.ok_or_else(|| not_found(format!("there is no {what} {index} among {}", list.len())))
}
