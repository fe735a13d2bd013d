//! Options, parameters by name, and the list of methods.

use super::callbacks::Callbacks;
use super::guard::{Failure, guard, guard_free, guard_value};
use super::memory::{init_struct, invalid, null, read_struct, read_text, write, write_text};
use super::objects::{Object, PARAMETERS, free, keep, with_parameters};
use super::status::{
    HOLEFILL_STATUS_LIMIT, HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_OK, HolefillStatus,
};
use super::types::{HolefillError, HolefillFillOptions, HolefillParameters};
use crate::fill::method::Method;
use crate::fill::options::{FillOptions, Parameter};
use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::{LazyLock, Mutex};

/// Most threads that a caller may ask for.
const MOST_THREADS: u32 = 1024;

/// Reads options; null is the defaults.
///
/// # Safety
/// `options` is null or points to a struct as its first fields say, whose pointers are the caller's.
pub(super) unsafe fn read_options(
    options: *const HolefillFillOptions,
) -> Result<(FillOptions, Callbacks), Failure> {
    // SAFETY: the caller's promise.
    let Some(given) = (unsafe { read_struct(options, "options")? }) else {
        return Ok((FillOptions::default(), Callbacks::none()));
    };
    let mut read = match given.parameters.id {
        0 => FillOptions::default(),
        id => with_parameters(id, |parameters| Ok(parameters.clone()))?,
    };
    // SAFETY: the caller's promise.
    if let Some(method) = unsafe { read_text(given.method, "method")? } {
        read.method = method.parse()?;
    }
    read.seed = given.seed;
    read.threads = check_threads(given.threads)?;
    // The parameters' own ranges hold for the fields too.
    for (name, value, is_given) in [
        (
            "fill.time-budget",
            given.time_budget.to_string(),
            given.time_budget != 0.0,
        ),
        (
            "refine.density",
            given.density.to_string(),
            given.density != 0.0,
        ),
        (
            "refine.max-vertices",
            given.max_new_vertices.to_string(),
            given.max_new_vertices != 0,
        ),
    ] {
        if is_given {
            read.set(name, &value)?;
        }
    }
    // SAFETY: the caller's promise is that both can be called during the call.
    Ok((read, unsafe { Callbacks::new(&given) }))
}

/// How many threads a caller asks for.
pub(super) fn check_threads(threads: u32) -> Result<usize, Failure> {
    if threads > MOST_THREADS {
        return Err(Failure::new(
            HOLEFILL_STATUS_LIMIT,
            format!("at most {MOST_THREADS} threads, not {threads}"),
        ));
    }
    Ok(threads as usize)
}

/// Makes `options` the defaults. `struct_size` is `sizeof(HolefillFillOptions)` of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_fill_options_init(
    options: *mut HolefillFillOptions,
    struct_size: u32,
) -> HolefillStatus {
    guard(ptr::null_mut(), || {
        if options.is_null() {
            return Err(null("options"));
        }
        // SAFETY: not null, and the caller's promise.
        unsafe { init_struct(options, struct_size, "options")? };
        Ok(HOLEFILL_STATUS_OK)
    })
}

/// Makes a set of parameters with their defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_parameters_new(
    parameters: *mut HolefillParameters,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        if parameters.is_null() {
            return Err(null("parameters"));
        }
        let id = keep(Object::Parameters(Mutex::new(FillOptions::default())))?;
        // SAFETY: not null, and the caller's promise.
        unsafe { write(parameters, HolefillParameters { id }, "parameters")? };
        Ok(HOLEFILL_STATUS_OK)
    })
}

/// Frees a set of parameters. The handle 0 is allowed. Calls that were given it have read it already.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameters_free(parameters: HolefillParameters) -> HolefillStatus {
    guard_free(|| free(PARAMETERS, parameters.id))
}

/// Sets a parameter by its name to a value in text, as `holefill_parameter_allowed` describes it.
///
/// Statuses: `NOT_FOUND` for an unknown name (the message lists the known ones), `INVALID_ARGUMENT` for a value that is not
/// allowed (the message says which are).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_parameters_set(
    parameters: HolefillParameters,
    name: *const c_char,
    value: *const c_char,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        // SAFETY: the caller's promise.
        let name = unsafe { read_text(name, "name")? }.ok_or_else(|| null("name"))?;
        // SAFETY: the caller's promise.
        let value = unsafe { read_text(value, "value")? }.ok_or_else(|| null("value"))?;
        with_parameters(parameters.id, |options| {
            options.set(name, value).map_err(|e| match find(name) {
                Some(_) => invalid(e.to_string()),
                None => Failure::new(HOLEFILL_STATUS_NOT_FOUND, e.to_string()),
            })?;
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// The value of a parameter in text; `buffer`, `capacity` and `length` as in `holefill_error_message`.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_parameters_get(
    parameters: HolefillParameters,
    name: *const c_char,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        // SAFETY: the caller's promise.
        let name = unsafe { read_text(name, "name")? }.ok_or_else(|| null("name"))?;
        with_parameters(parameters.id, |options| {
            let parameter = find(name).ok_or_else(|| {
                let message = format!("there is no parameter '{name}'");
                Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
            })?;
            // SAFETY: the caller's promise.
            unsafe { write_text(&parameter.value(options), buffer, capacity, length)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

fn find(name: &str) -> Option<&'static Parameter> {
    FillOptions::parameters().find(|p| p.name == name)
}

/// The texts about a method or a parameter, ended by zero bytes.
struct Texts {
    name: CString,
    help: CString,
    allowed: CString,
    default: CString,
}

/// None of these texts has a zero byte.
fn text(text: &str) -> CString {
    CString::new(text).unwrap_or_default()
}

static METHODS: LazyLock<Vec<Texts>> = LazyLock::new(|| {
    let texts = |m: Method| Texts {
        name: text(m.name()),
        help: text(m.summary()),
        allowed: CString::default(),
        default: CString::default(),
    };
    Method::ALL.into_iter().map(texts).collect()
});

static PARAMETER_TEXTS: LazyLock<Vec<Texts>> = LazyLock::new(|| {
    let defaults = FillOptions::default();
    let texts = |p: &Parameter| Texts {
        name: text(p.name),
        help: text(p.help),
        allowed: text(p.allowed),
        default: text(&p.value(&defaults)),
    };
    FillOptions::parameters().map(texts).collect()
});

/// The name of a method as static text.
pub(super) fn method_text(method: Method) -> *const c_char {
    let place = Method::ALL.iter().position(|&m| m == method);
    place.map_or(ptr::null(), |i| METHODS[i].name.as_ptr())
}

fn entry(
    list: &'static [Texts],
    index: u64,
    field: impl Fn(&'static Texts) -> &'static CString,
) -> *const c_char {
    let texts = usize::try_from(index).ok().and_then(|i| list.get(i));
    texts.map_or(ptr::null(), |t| field(t).as_ptr())
}

/// Number of methods of this version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_method_count() -> u64 {
    guard_value(0, || METHODS.len() as u64)
}

/// The name of method `index`, as options take it; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_method_name(index: u64) -> *const c_char {
    guard_value(ptr::null(), || entry(&METHODS, index, |t| &t.name))
}

/// What method `index` does, in one line; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_method_summary(index: u64) -> *const c_char {
    guard_value(ptr::null(), || entry(&METHODS, index, |t| &t.help))
}

/// Number of parameters that can be set by name in this version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_count() -> u64 {
    guard_value(0, || PARAMETER_TEXTS.len() as u64)
}

/// The name of parameter `index`, such as `refine.density`; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_name(index: u64) -> *const c_char {
    guard_value(ptr::null(), || entry(&PARAMETER_TEXTS, index, |t| &t.name))
}

/// What parameter `index` does, with its unit; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_help(index: u64) -> *const c_char {
    guard_value(ptr::null(), || entry(&PARAMETER_TEXTS, index, |t| &t.help))
}

/// The values that parameter `index` takes, in words; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_allowed(index: u64) -> *const c_char {
    guard_value(ptr::null(), || {
        entry(&PARAMETER_TEXTS, index, |t| &t.allowed)
    })
}

/// The default of parameter `index` in text; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_default(index: u64) -> *const c_char {
    guard_value(ptr::null(), || {
        entry(&PARAMETER_TEXTS, index, |t| &t.default)
    })
}
