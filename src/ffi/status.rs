//! How a call ended.

use std::ffi::{CStr, c_char};

/// How a call ended: one of the `HOLEFILL_STATUS_` constants. A number once given is never used for anything
/// else; later versions may return new ones.
pub type HolefillStatus = i32;

/// The call did what it says; outputs are written.
pub const HOLEFILL_STATUS_OK: HolefillStatus = 0;
/// A fill or plan did its work and its outputs are written, but some of the holes that were asked for stay open:
/// the report says which and why.
pub const HOLEFILL_STATUS_INCOMPLETE: HolefillStatus = 1;
/// A pointer that must not be null is null.
pub const HOLEFILL_STATUS_NULL_POINTER: HolefillStatus = 2;
/// A handle that was freed, never given out, of another kind, or of another process or copy of the library.
pub const HOLEFILL_STATUS_INVALID_HANDLE: HolefillStatus = 3;
/// A value that the function does not take; nothing was changed.
pub const HOLEFILL_STATUS_INVALID_ARGUMENT: HolefillStatus = 4;
/// A struct whose `struct_size` or `version` this library does not know, or that has something other than zero in
/// fields that this library does not know.
pub const HOLEFILL_STATUS_INVALID_STRUCT: HolefillStatus = 5;
/// The text or the list does not fit; the length that is needed was written, nothing else.
pub const HOLEFILL_STATUS_BUFFER_TOO_SMALL: HolefillStatus = 6;
/// Another thread, or the call from whose callback this one comes, uses the mesh in a way that excludes this call.
/// Nothing was changed: try again later.
pub const HOLEFILL_STATUS_BUSY: HolefillStatus = 7;
/// The progress callback asked to stop. Nothing was changed.
pub const HOLEFILL_STATUS_CANCELLED: HolefillStatus = 8;
/// There is no loop, edge, attribute, parameter or entry of this number or name.
pub const HOLEFILL_STATUS_NOT_FOUND: HolefillStatus = 9;
/// A coordinate is infinite or not a number.
pub const HOLEFILL_STATUS_NOT_FINITE: HolefillStatus = 10;
/// An index names a vertex that does not exist.
pub const HOLEFILL_STATUS_INDEX_OUT_OF_RANGE: HolefillStatus = 11;
/// A count times a stride is more than the address space.
pub const HOLEFILL_STATUS_OVERFLOW: HolefillStatus = 12;
/// The loop is of a kind that cannot be filled.
pub const HOLEFILL_STATUS_TOPOLOGY: HolefillStatus = 13;
/// A documented limit was exceeded, such as the number of handles or of threads.
pub const HOLEFILL_STATUS_LIMIT: HolefillStatus = 14;
/// There is not enough memory for a copy of the input.
pub const HOLEFILL_STATUS_OUT_OF_MEMORY: HolefillStatus = 15;
/// The plan does not fit the mesh any more, or is of another mesh: plan again.
pub const HOLEFILL_STATUS_STALE_PLAN: HolefillStatus = 16;
/// There is no fill to undo.
pub const HOLEFILL_STATUS_NOTHING_TO_UNDO: HolefillStatus = 17;
/// An earlier call on this mesh ended in `HOLEFILL_STATUS_PANIC`: it can only be freed.
pub const HOLEFILL_STATUS_POISONED: HolefillStatus = 18;
/// A defect of the library showed itself, and was contained. The mesh that was being used is poisoned.
pub const HOLEFILL_STATUS_PANIC: HolefillStatus = 19;

/// Declares the table of all statuses: number, name, message.
macro_rules! statuses {
    ($($status:ident $name:literal $message:literal)*) => {
        pub(super) const STATUSES: &[(HolefillStatus, &CStr, &CStr)] = &[$(($status, $name, $message)),*];
    };
}
statuses! {
    HOLEFILL_STATUS_OK c"OK" c"done"
    HOLEFILL_STATUS_INCOMPLETE c"INCOMPLETE" c"some of the holes could not be filled"
    HOLEFILL_STATUS_NULL_POINTER c"NULL_POINTER" c"a pointer is null that must not be"
    HOLEFILL_STATUS_INVALID_HANDLE c"INVALID_HANDLE" c"the handle is of no living object of this kind"
    HOLEFILL_STATUS_INVALID_ARGUMENT c"INVALID_ARGUMENT" c"an argument is not allowed"
    HOLEFILL_STATUS_INVALID_STRUCT c"INVALID_STRUCT" c"a struct has an unknown size, version or field"
    HOLEFILL_STATUS_BUFFER_TOO_SMALL c"BUFFER_TOO_SMALL" c"the buffer is too small"
    HOLEFILL_STATUS_BUSY c"BUSY" c"the mesh is in use by another call"
    HOLEFILL_STATUS_CANCELLED c"CANCELLED" c"stopped by the caller"
    HOLEFILL_STATUS_NOT_FOUND c"NOT_FOUND" c"there is nothing of this number or name"
    HOLEFILL_STATUS_NOT_FINITE c"NOT_FINITE" c"a coordinate is infinite or not a number"
    HOLEFILL_STATUS_INDEX_OUT_OF_RANGE c"INDEX_OUT_OF_RANGE" c"an index names a vertex that does not exist"
    HOLEFILL_STATUS_OVERFLOW c"OVERFLOW" c"a count times a stride is more than the address space"
    HOLEFILL_STATUS_TOPOLOGY c"TOPOLOGY" c"the loop is of a kind that cannot be filled"
    HOLEFILL_STATUS_LIMIT c"LIMIT" c"a limit was exceeded"
    HOLEFILL_STATUS_OUT_OF_MEMORY c"OUT_OF_MEMORY" c"there is not enough memory"
    HOLEFILL_STATUS_STALE_PLAN c"STALE_PLAN" c"the plan does not fit the mesh"
    HOLEFILL_STATUS_NOTHING_TO_UNDO c"NOTHING_TO_UNDO" c"there is no fill to undo"
    HOLEFILL_STATUS_POISONED c"POISONED" c"an earlier call failed inside the library; the mesh can only be freed"
    HOLEFILL_STATUS_PANIC c"PANIC" c"a defect of the library showed itself"
}

/// The name of a status without its prefix, such as `INVALID_HANDLE`; `UNKNOWN` for a number that is none. The text
/// is static: it is never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_status_name(status: HolefillStatus) -> *const c_char {
    texts(status).0.as_ptr()
}

/// What a status means, in a few words. The text is static: it is never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_status_message(status: HolefillStatus) -> *const c_char {
    message(status).as_ptr()
}

/// The words for a status.
pub(super) fn message(status: HolefillStatus) -> &'static CStr {
    texts(status).1
}

/// Name and message of a status.
fn texts(status: HolefillStatus) -> (&'static CStr, &'static CStr) {
    let entry = STATUSES.iter().find(|&&(s, ..)| s == status);
    entry.map_or((c"UNKNOWN", c"an unknown status"), |e| (e.1, e.2))
}
