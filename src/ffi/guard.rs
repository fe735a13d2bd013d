//! What every exported function runs in.

use super::failure::Failure;
use super::objects::{Handle, Object, free, keep, lock};
use super::status::{HOLEFILL_STATUS_OK, HOLEFILL_STATUS_PANIC, HolefillStatus};
use super::types::HolefillError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// How a call ended that did not fail: nothing is `HOLEFILL_STATUS_OK`.
pub(super) trait Success {
    fn status(self) -> HolefillStatus;
}

impl Success for () {
    fn status(self) -> HolefillStatus {
        HOLEFILL_STATUS_OK
    }
}

impl Success for HolefillStatus {
    fn status(self) -> HolefillStatus {
        self
    }
}

/// Runs the body of an exported function. A failure is described in the error object that `error` holds, or in a new
/// one. Nothing is written there otherwise.
///
/// `error` is null or points to a handle that the caller may write.
pub(super) fn guard<S: Success>(
    error: *mut HolefillError,
    body: impl FnOnce() -> Result<S, Failure>,
) -> HolefillStatus {
    // Whatever the body leaves half done is behind a handle that is poisoned.
    match contained(body) {
        Ok(success) => success.status(),
        Err(failure) => {
            let status = failure.status;
            if !error.is_null() {
                // A failure to describe the failure must not leave the function either.
                let _ = contained(|| describe(error, failure));
            }
            status
        }
    }
}

/// As [`guard`], for functions that return something else. `otherwise` stands for a panic.
pub(super) fn guard_value<R>(otherwise: R, body: impl FnOnce() -> R) -> R {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or(otherwise)
}

/// As [`guard`], with the object of a handle.
pub(super) fn guard_with<H: Handle>(
    handle: H,
    error: *mut HolefillError,
    body: impl FnOnce(&H::Object) -> Result<(), Failure>,
) -> HolefillStatus {
    guard(error, || handle.with(body))
}

/// Frees an object.
pub(super) fn guard_free(handle: impl Handle) -> HolefillStatus {
    guard(std::ptr::null_mut(), || free(handle))
}

fn contained<S>(body: impl FnOnce() -> Result<S, Failure>) -> Result<S, Failure> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied());
        let message = format!("defect in the library: {}", text.unwrap_or("no message"));
        Err(Failure::new(HOLEFILL_STATUS_PANIC, message))
    })
}

fn describe(error: *mut HolefillError, failure: Failure) -> Result<(), Failure> {
    // SAFETY: `error` is not null, and points to a handle of the caller.
    let known = unsafe { error.read_unaligned() };
    let replaced = known.with(|place| {
        *lock(place) = failure.clone();
        Ok(())
    });
    if replaced.is_ok() {
        return Ok(());
    }
    let id = keep(Object::Error(Mutex::new(failure))).unwrap_or(0);
    // SAFETY: as above.
    unsafe { error.write_unaligned(HolefillError { id }) };
    Ok(())
}
