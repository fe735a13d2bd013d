//! What a failing call said.

use super::guard::guard_silent;
use super::objects::{ERROR, free, with_error};
use super::output::write;
use super::status::HolefillStatus;
use super::text::write_text;
use super::types::HolefillError;
use std::ffi::c_char;

/// The status of the last call that failed with this error object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_error_status(
    error: HolefillError,
    status: *mut HolefillStatus,
) -> HolefillStatus {
    guard_silent(|| {
        // SAFETY: the caller's promise.
        with_error(error.id, |failure| unsafe {
            write(status, failure.status, "status")
        })
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
    guard_silent(|| {
        // SAFETY: the caller's promise.
        with_error(error.id, |failure| unsafe {
            write_text(&failure.message, buffer, capacity, length)
        })
    })
}

/// Frees an error object. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_error_free(error: HolefillError) -> HolefillStatus {
    guard_silent(|| free(ERROR, error.id))
}
