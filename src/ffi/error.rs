//! What a failing call said.

use super::guard::{Failure, guard, guard_free};
use super::memory::{write, write_text};
use super::objects::{ERROR, Object, find, free, invalid_handle};
use super::status::{HOLEFILL_STATUS_OK, HolefillStatus};
use super::types::HolefillError;
use std::ffi::c_char;

fn failure(error: HolefillError) -> Result<Failure, Failure> {
    match &*find(ERROR, error.id)? {
        Object::Error(place) => Ok(place.lock().unwrap_or_else(|e| e.into_inner()).clone()),
        _ => Err(invalid_handle(ERROR)),
    }
}

/// The status of the last call that failed with this error object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_error_status(
    error: HolefillError,
    status: *mut HolefillStatus,
) -> HolefillStatus {
    guard(std::ptr::null_mut(), || {
        let failure = failure(error)?;
        // SAFETY: the caller's promise.
        unsafe { write(status, failure.status, "status")? };
        Ok(HOLEFILL_STATUS_OK)
    })
}

/// The message of the last call that failed with this error object: one line, UTF-8, ended by a zero byte.
///
/// `length` gets its length without the zero byte, also when the text does not fit. With `buffer` null and `capacity` 0
/// only the length is written.
///
/// Statuses: `BUFFER_TOO_SMALL`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_error_message(
    error: HolefillError,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
) -> HolefillStatus {
    guard(std::ptr::null_mut(), || {
        let failure = failure(error)?;
        // SAFETY: the caller's promise.
        unsafe { write_text(&failure.message, buffer, capacity, length)? };
        Ok(HOLEFILL_STATUS_OK)
    })
}

/// Frees an error object. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_error_free(error: HolefillError) -> HolefillStatus {
    guard_free(|| free(ERROR, error.id))
}
