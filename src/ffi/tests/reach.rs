//! Whatever the Rust interface can do with a hole can be asked for through C: every method, every parameter.

use super::*;
use crate::methods::method::Method;
use crate::options::FillOptions;
use std::collections::BTreeSet;

/// A name as the library hands it out.
fn name(text: *const c_char) -> &'static str {
    static_text(text).expect("there is an entry")
}

fn text_of(text: &str) -> CString {
    CString::new(text).expect("no zero byte")
}

#[test]
fn every_method_is_reached() {
    let count = holefill_method_count();
    let names: Vec<&str> = (0..count).map(|i| name(holefill_method_name(i))).collect();
    let known: Vec<&str> = Method::ALL.iter().map(|m| m.name()).collect();
    assert_eq!(names, known);
    assert!(holefill_method_name(count).is_null() && holefill_method_name(u64::MAX).is_null());
    assert!((0..count).all(|i| static_text(holefill_method_summary(i)).is_some()));
    for method in names {
        let mesh = holed_mesh();
        let asked = text_of(method);
        let options = HolefillFillOptions {
            method: asked.as_ptr(),
            ..options()
        };
        let (status, report) = report_of(mesh.0, &at_loop(0), &options);
        assert_eq!(status, OK, "{method}");
        let hole = hole(&report, 0);
        let mut used: Vec<&str> = static_text(hole.method).into_iter().collect();
        for attempt in 0..hole.tried_count {
            let (mut tried, mut length, no) = (ptr::null(), 0, ptr::null_mut());
            ok!(holefill_report_tried: report.0, 0, attempt, &mut tried, no, 0, &mut length);
            used.push(name(tried));
        }
        // `auto` is none of its own: it chooses among the others.
        assert!(
            method == "auto" || used.contains(&method),
            "{method}: {used:?}"
        );
    }
}

/// Sets a parameter through C; whether it was taken.
fn set(parameters: HolefillParameters, name: &str, value: &str) -> bool {
    let (name, value) = (text_of(name), text_of(value));
    let (status, text) = said!(holefill_parameters_set: parameters, name.as_ptr(), value.as_ptr());
    if status != OK {
        assert_eq!(status, INVALID);
        assert!(text.contains(name.to_str().unwrap()));
    }
    status == OK
}

fn get(parameters: HolefillParameters, name: &str) -> String {
    let name = text_of(name);
    told!(holefill_parameters_get: parameters, name.as_ptr())
}

/// Values that a parameter may take: the words of its description, also with an ending that is named there, and some
/// numbers.
fn candidates(allowed: &str) -> BTreeSet<String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || "-._/".contains(c);
    let words: Vec<&str> = allowed
        .split(|c| !is_word(c))
        .map(|w| w.trim_matches('.'))
        .filter(|w| !w.is_empty())
        .collect();
    let endings = words.iter().filter(|w| w.starts_with('/'));
    let ended = endings.flat_map(|ending| words.iter().map(move |w| format!("{w}{ending}")));
    let numbers = [
        "0", "1", "2", "3", "7", "10", "15", "50", "0.01", "0.125", "0.5", "1.5",
    ];
    let plain = words.iter().chain(&numbers).map(|&w| w.to_owned());
    plain.chain(ended).collect()
}

#[test]
fn every_parameter_is_reached() {
    let count = holefill_parameter_count();
    let known: Vec<_> = FillOptions::parameters().collect();
    assert_eq!(count as usize, known.len());
    assert!(holefill_parameter_name(count).is_null());
    let mut owned = Owned(HolefillParameters::default());
    call!(holefill_parameters_new: &mut owned.0);
    let parameters = owned.0;
    let mut asked = Vec::new();
    for (i, parameter) in (0..count).zip(&known) {
        let name = name(holefill_parameter_name(i));
        assert_eq!(name, parameter.name());
        assert_eq!(
            static_text(holefill_parameter_help(i)),
            Some(parameter.help())
        );
        assert_eq!(
            static_text(holefill_parameter_allowed(i)),
            Some(parameter.allowed())
        );
        let default = static_text(holefill_parameter_default(i)).unwrap_or_default();
        assert_eq!(get(parameters, name), default, "{name}");
        assert!(set(parameters, name, default), "{name} takes its default");
        assert!(!set(parameters, name, "no such value,,"), "{name}");
        let changed = candidates(parameter.allowed())
            .into_iter()
            .any(|value| set(parameters, name, &value) && get(parameters, name) != default);
        assert!(changed, "{name} never changes: {}", parameter.allowed());
        asked.push(get(parameters, name));
    }
    let no = c"no".as_ptr();
    let (status, text) = said!(holefill_parameters_set: parameters, no, no);
    assert_eq!(status, NOT_FOUND);
    assert!(text.contains("refine.density"));
    // And a fill that is given them gets them.
    let given = HolefillFillOptions {
        parameters,
        ..Default::default()
    };
    // SAFETY: the pointer is to a living value.
    let (read, _) = unsafe { super::super::options::read_options(&given) }.expect("allowed");
    for (parameter, asked) in known.iter().zip(asked) {
        assert_eq!(parameter.value(&read), asked, "{}", parameter.name());
    }
}
