//! What every exported function runs in.

use super::objects::{ERROR, Object, TABLE, keep};
use super::status::{
    self, HOLEFILL_STATUS_CANCELLED, HOLEFILL_STATUS_INVALID_ARGUMENT, HOLEFILL_STATUS_LIMIT,
    HOLEFILL_STATUS_OK, HOLEFILL_STATUS_PANIC, HOLEFILL_STATUS_TOPOLOGY, HolefillStatus,
};
use super::types::HolefillError;
use crate::error::{Error, ErrorKind};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Why a call did not do what it says.
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
        Self::new(status, status::message(status))
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

/// Runs the body of an exported function. A failure is described in the error object that `error` holds, or in a new
/// one; nothing is written there otherwise.
///
/// `error` is null or points to a handle that the caller may write.
pub(super) fn guard(
    error: *mut HolefillError,
    body: impl FnOnce() -> Result<HolefillStatus, Failure>,
) -> HolefillStatus {
    // Whatever the body leaves half done is behind a handle that is poisoned.
    match contained(body) {
        Ok(status) => status,
        Err(failure) => {
            let status = failure.status;
            if !error.is_null() {
                // Describing the failure must not fail in turn.
                let _ = contained(|| describe(error, failure));
            }
            status
        }
    }
}

/// As [`guard`], for functions that free: they have no error object.
pub(super) fn guard_free(body: impl FnOnce() -> Result<(), Failure>) -> HolefillStatus {
    guard(std::ptr::null_mut(), || body().map(|()| HOLEFILL_STATUS_OK))
}

/// As [`guard`], for functions that return something else: `otherwise` stands for a panic.
pub(super) fn guard_value<R>(otherwise: R, body: impl FnOnce() -> R) -> R {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or(otherwise)
}

fn contained(
    body: impl FnOnce() -> Result<HolefillStatus, Failure>,
) -> Result<HolefillStatus, Failure> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied());
        let message = format!(
            "a defect of the library showed itself: {}",
            text.unwrap_or("no message")
        );
        Err(Failure::new(HOLEFILL_STATUS_PANIC, message))
    })
}

fn describe(error: *mut HolefillError, failure: Failure) -> Result<HolefillStatus, Failure> {
    // SAFETY: `error` is not null, and points to a handle of the caller.
    let known = unsafe { error.read_unaligned() };
    if let Some(object) = TABLE.get(ERROR, known.id)
        && let Object::Error(place) = &*object
    {
        *place.lock().unwrap_or_else(|e| e.into_inner()) = failure;
        return Ok(HOLEFILL_STATUS_OK);
    }
    let id = keep(Object::Error(std::sync::Mutex::new(failure))).unwrap_or(0);
    // SAFETY: as above.
    unsafe { error.write_unaligned(HolefillError { id }) };
    Ok(HOLEFILL_STATUS_OK)
}
