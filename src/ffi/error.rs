//! What a failing call said.

use super::guard::{guard_free, guard_with};
use super::objects::lock;
use super::output::write;
use super::status::HolefillStatus;
use super::text::write_text;
use super::types::HolefillError;
use std::ffi::c_char;
use std::ptr;

/// The status of the last call that failed with this error object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_error_status(
    error: HolefillError,
    status: *mut HolefillStatus,
) -> HolefillStatus {
    guard_with(error, ptr::null_mut(), |failure| {
        // SAFETY: the caller's promise.
        unsafe { write(status, lock(failure).status, "status") }
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
    guard_with(error, ptr::null_mut(), |failure| {
        // SAFETY: the caller's promise.
        unsafe { write_text(&lock(failure).message, buffer, capacity, length) }
    })
}

/// Frees an error object. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_error_free(error: HolefillError) -> HolefillStatus {
    guard_free(error)
}
