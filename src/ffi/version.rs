//! Versions, and what is alive.

use super::guard::guard_value;
use super::objects::TABLE;
use std::ffi::{CStr, c_char};

/// The version of the interface that this header declares. It changes when a function or a struct is changed so that
/// callers must be compiled anew; functions, statuses and fields at the end of structs come without a change.
pub const HOLEFILL_ABI_VERSION: u32 = 0;

const VERSION: &CStr =
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };

/// The `HOLEFILL_ABI_VERSION` of the library: compare it with that of the header.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_abi_version() -> u32 {
    HOLEFILL_ABI_VERSION
}

/// The version of the library as text, such as `0.1.0`. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_version() -> *const c_char {
    VERSION.as_ptr()
}

/// Number of handles in the process that were not freed: for tests of callers.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_handle_count() -> u64 {
    guard_value(0, || TABLE.len() as u64)
}
