//! Options, parameters by name, and the list of methods.

use super::callbacks::Callbacks;
use super::failure::{Failure, invalid, not_found};
use super::guard::{guard, guard_free, guard_value, guard_with};
use super::objects::{Handle as _, Object, lock};
use super::output::hand_out;
use super::status::{HOLEFILL_STATUS_LIMIT, HolefillStatus};
use super::structs::read_struct;
use super::text::{owned, read_optional_text, read_text, write_text};
use super::types::{HolefillError, HolefillFillOptions, HolefillParameters};
use crate::methods::method::Method;
use crate::options::{FillOptions, Parameter};
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
    let given = unsafe { read_struct(options, "options")? }.unwrap_or_default();
    let mut read = match given.parameters.id {
        0 => FillOptions::default(),
        _ => given.parameters.with(|options| Ok(lock(options).clone()))?,
    };
    // SAFETY: the caller's promise.
    if let Some(method) = unsafe { read_optional_text(given.method, "method")? } {
        read.method = method.parse()?;
    }
    read.seed = given.seed;
    read.threads = check_threads(given.threads)?;
    // The ranges of the parameters hold for the fields too.
    let (seconds, density, most) = (given.time_budget, given.density, given.max_new_vertices);
    for (is_given, name, value) in [
        (seconds != 0.0, "fill.time-budget", seconds.to_string()),
        (density != 0.0, "refine.density", density.to_string()),
        (most != 0, "refine.max-vertices", most.to_string()),
    ] {
        if is_given {
            read.set(name, &value)?;
        }
    }
    // SAFETY: the caller's promise is that both can be called during the call.
    Ok((read, unsafe { Callbacks::new(given) }))
}

fn check_threads(threads: u32) -> Result<usize, Failure> {
    match threads > MOST_THREADS {
        true => Err(Failure::new(
            HOLEFILL_STATUS_LIMIT,
            format!("at most {MOST_THREADS} threads, not {threads}"),
        )),
        false => Ok(threads as usize),
    }
}

/// Makes a set of parameters with their defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_parameters_new(
    parameters: *mut HolefillParameters,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        let made = Object::Parameters(Mutex::new(FillOptions::default()));
        // SAFETY: the caller's promise.
        unsafe { hand_out(made, parameters, "parameters") }
    })
}

/// Frees a set of parameters. The handle 0 is allowed. Calls that were given it have read it already.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameters_free(parameters: HolefillParameters) -> HolefillStatus {
    guard_free(parameters)
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
        let (name, value) = unsafe { (read_text(name, "name")?, read_text(value, "value")?) };
        parameters.with(|options| {
            lock(options)
                .set(name, value)
                .map_err(|e| match find(name) {
                    Some(_) => invalid(e.to_string()),
                    None => not_found(e.to_string()),
                })
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
    guard_with(parameters, error, |options| {
        // SAFETY: the caller's promise.
        let name = unsafe { read_text(name, "name")? };
        let unknown = || not_found(format!("there is no parameter '{name}'"));
        let value = find(name).ok_or_else(unknown)?.value(&lock(options));
        // SAFETY: the caller's promise.
        unsafe { write_text(&value, buffer, capacity, length) }
    })
}

fn find(name: &str) -> Option<&'static Parameter> {
    FillOptions::parameters().find(|p| p.name() == name)
}

/// Name and summary of each method.
static METHODS: LazyLock<Vec<[CString; 2]>> = LazyLock::new(|| {
    let texts = |m: Method| [m.name(), m.summary()].map(owned);
    Method::ALL.into_iter().map(texts).collect()
});

/// Name, help, allowed values and default of each parameter.
static PARAMETER_TEXTS: LazyLock<Vec<[CString; 4]>> = LazyLock::new(|| {
    let defaults = FillOptions::default();
    let texts = |p: &Parameter| [p.name(), p.help(), p.allowed(), &p.value(&defaults)].map(owned);
    FillOptions::parameters().map(texts).collect()
});

/// The name of a method as static text.
pub(super) fn method_text(method: Method) -> *const c_char {
    let place = Method::ALL.iter().position(|&m| m == method);
    place.map_or(ptr::null(), |i| METHODS[i][0].as_ptr())
}

/// Text `field` of entry `index` of a list; null when there is none.
fn text<const N: usize>(
    list: &'static LazyLock<Vec<[CString; N]>>,
    index: u64,
    field: usize,
) -> *const c_char {
    guard_value(ptr::null(), || {
        let entry = usize::try_from(index).ok().and_then(|i| list.get(i));
        entry.map_or(ptr::null(), |texts| texts[field].as_ptr())
    })
}

/// Number of methods of this version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_method_count() -> u64 {
    guard_value(0, || METHODS.len() as u64)
}

/// The name of method `index`, as options take it; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_method_name(index: u64) -> *const c_char {
    text(&METHODS, index, 0)
}

/// What method `index` does, in one line; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_method_summary(index: u64) -> *const c_char {
    text(&METHODS, index, 1)
}

/// Number of parameters that can be set by name in this version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_count() -> u64 {
    guard_value(0, || PARAMETER_TEXTS.len() as u64)
}

/// The name of parameter `index`, such as `refine.density`; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_name(index: u64) -> *const c_char {
    text(&PARAMETER_TEXTS, index, 0)
}

/// What parameter `index` does, with its unit; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_help(index: u64) -> *const c_char {
    text(&PARAMETER_TEXTS, index, 1)
}

/// The values that parameter `index` takes, in words; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_allowed(index: u64) -> *const c_char {
    text(&PARAMETER_TEXTS, index, 2)
}

/// The default of parameter `index` in text; null when there is none. Static, never freed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_parameter_default(index: u64) -> *const c_char {
    text(&PARAMETER_TEXTS, index, 3)
}
