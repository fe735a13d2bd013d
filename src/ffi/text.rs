//! Texts: in, out, and those that stay.

use super::failure::{Failure, invalid, null};
use super::output::write_list;
use std::ffi::{CStr, CString, c_char};

/// A text of the caller; `None` when the pointer is null.
///
/// # Safety
/// `text` is null or ends with a zero byte; it must not change as long as the result lives.
pub(super) unsafe fn read_optional_text<'a>(
    text: *const c_char,
    what: &str,
) -> Result<Option<&'a str>, Failure> {
    if text.is_null() {
        return Ok(None);
    }
    // SAFETY: not null, and the caller's promise.
    match unsafe { CStr::from_ptr(text) }.to_str() {
        Ok(text) => Ok(Some(text)),
        Err(_) => Err(invalid(format!("{what} is not UTF-8"))),
    }
}

/// As [`read_optional_text`]; null is refused.
///
/// # Safety
/// As [`read_optional_text`].
pub(super) unsafe fn read_text<'a>(text: *const c_char, what: &str) -> Result<&'a str, Failure> {
    // SAFETY: the caller's promise.
    unsafe { read_optional_text(text, what)? }.ok_or_else(|| null(what))
}

/// Writes a text and its length without the zero byte that ends it.
///
/// # Safety
/// `buffer` is null or points to `capacity` bytes, `length` is null or points to a number.
pub(super) unsafe fn write_text(
    text: &str,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
) -> Result<(), Failure> {
    let buffer = (buffer.cast::<u8>(), capacity, "buffer");
    // SAFETY: the caller's promise.
    unsafe { write_list(text.as_bytes(), &[0], buffer, (length, "length")) }
}

/// A copy of a text that ends with a zero byte. None of the library's texts has a zero byte inside.
pub(super) fn owned(text: &str) -> CString {
    CString::new(text).unwrap_or_default()
}
