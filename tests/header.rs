//! The C header is what the sources say.

use holefill::ffi::*;
use std::fmt::Write as _;
use std::fs;
use std::mem::offset_of;
use std::path::{Path, PathBuf};

/// The parts of the interface, in the order in which the header has them.
const PARTS: [&str; 12] = [
    "version",
    "status",
    "types",
    "error",
    "mesh",
    "points",
    "attributes",
    "loops",
    "options",
    "fill",
    "plan",
    "report",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn generated() -> String {
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).unwrap();
    let sources: Vec<PathBuf> = PARTS
        .iter()
        .map(|part| root().join(format!("src/ffi/{part}.rs")))
        .collect();
    let builder = cbindgen::Builder::new().with_config(config);
    let builder = sources.iter().fold(builder, |b, source| b.with_src(source));
    let mut header = Vec::new();
    builder.generate().unwrap().write(&mut header);
    String::from_utf8(header).unwrap()
}

#[test]
fn the_header_is_generated_from_the_sources() {
    let path = root().join("include/holefill.h");
    let expected = generated();
    if std::env::var_os("HOLEFILL_UPDATE").is_some() {
        fs::write(&path, &expected).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let first = committed
        .lines()
        .zip(expected.lines())
        .position(|(a, b)| a != b);
    assert!(
        committed == expected,
        "include/holefill.h differs from the sources from line {} on: run \
         `HOLEFILL_UPDATE=1 cargo test --test header` and look at what changes",
        first.unwrap_or(committed.lines().count()) + 1
    );
}

// Golden lists

/// Compares `found` with the file `name` beside this one, or writes it.
fn compare(name: &str, found: &str, advice: &str) {
    let path = root().join("tests/golden").join(name);
    if std::env::var_os("HOLEFILL_UPDATE").is_some() {
        fs::create_dir_all(root().join("tests/golden")).unwrap();
        fs::write(&path, found).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    if expected == found {
        return;
    }
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (old, new) = (lines(&expected), lines(found));
    let gone: Vec<_> = old.iter().filter(|l| !new.contains(l)).collect();
    let come: Vec<_> = new.iter().filter(|l| !old.contains(l)).collect();
    panic!("tests/golden/{name}: gone {gone:#?}, come {come:#?}.\n{advice}");
}

/// The functions that the header declares.
fn declared() -> Vec<String> {
    let header = generated();
    let code: String = header
        .lines()
        .filter(|line| !line.trim_start().starts_with(['*', '/']))
        .map(|line| format!("{line}\n"))
        .collect();
    let mut names: Vec<String> = code
        .match_indices("holefill_")
        .filter_map(|(start, _)| {
            let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let rest = &code[start..];
            let end = rest.find(|c| !is_word(c))?;
            rest[end..].starts_with('(').then(|| rest[..end].to_owned())
        })
        .collect();
    names.sort();
    names.dedup();
    names
}

#[test]
fn the_list_of_functions_changes_only_on_purpose() {
    let names: String = declared().iter().map(|name| format!("{name}\n")).collect();
    compare(
        "functions.txt",
        &names,
        "A function that is gone or has other arguments breaks every caller: raise HOLEFILL_ABI_VERSION in \
         src/ffi/version.rs, which the SONAME follows, and the major version. One that has come needs the minor \
         version in Cargo.toml. Then run `HOLEFILL_UPDATE=1 cargo test --test header`.",
    );
}

/// Size of each struct and place of each field.
fn layout() -> String {
    let mut text = String::new();
    macro_rules! describe {
        ($($name:ident { $($field:ident),* $(,)? })*) => {
            $(
                writeln!(text, "{} {} bytes, aligned to {}", stringify!($name), size_of::<$name>(), align_of::<$name>())
                    .unwrap();
                $(writeln!(text, "    {} {}", offset_of!($name, $field), stringify!($field)).unwrap();)*
            )*
        };
    }
    describe! {
        HolefillMesh { id }
        HolefillPlan { id }
        HolefillReport { id }
        HolefillParameters { id }
        HolefillError { id }
        HolefillInput { data, count, stride, scalar_type, reserved }
        HolefillOutput { data, count, stride, scalar_type, reserved }
        HolefillMeshInfo {
            struct_size, version, vertex_count, triangle_count, input_vertex_count, input_triangle_count, undo_count,
            is_polyline, reserved
        }
        HolefillDefects {
            struct_size, version, nonmanifold_edges, inconsistent_edges, degenerate_triangles, duplicate_triangles,
            isolated_vertices
        }
        HolefillAttributeInfo { struct_size, version, scalar_type, components, count }
        HolefillLoopInfo {
            struct_size, version, loop_id, edge_count, vertex_count, edge, perimeter, vector_area, diameter, planarity,
            loop_class, is_open
        }
        HolefillSelection { struct_size, version, only, keep, max_edges, max_perimeter, keep_largest }
        HolefillTarget { struct_size, version, kind, reserved, loop_id, edge, ids, selection }
        HolefillProgress { struct_size, version, holes_done, holes_total, seconds }
        HolefillFillOptions {
            struct_size, version, method, parameters, seed, time_budget, density, max_new_vertices, threads, log_level,
            progress, progress_data, log, log_data
        }
        HolefillPointOptions {
            struct_size, version, radius, neighbours, threads, time_budget, progress, progress_data
        }
        HolefillPointSummary {
            struct_size, version, used, duplicates, unused, triangle_count, piece_count, estimated_normals, radius
        }
        HolefillPatchInfo { struct_size, version, first_vertex, vertex_count, triangle_count }
        HolefillHole {
            struct_size, version, loop_id, edge_count, edge, perimeter, loop_class, status, cause, tried_count, method,
            first_vertex, vertex_count, first_triangle, triangle_count, self_intersections, min_angle, seconds
        }
        HolefillPrediction {
            struct_size, version, chosen, noise, score_count, crease_count, crease_surface_count, is_tip, is_flat
        }
        HolefillSummary {
            struct_size, version, hole_count, filled, kept, failed, cancelled, new_vertices, new_triangles,
            index_seconds, fill_seconds
        }
    }
    text
}

/// The structs of the header with their fields, in the form of `layout` without the numbers.
fn declared_structs() -> Vec<String> {
    let header = generated();
    let mut lines = Vec::new();
    let mut is_inside = false;
    for line in header.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix("typedef struct ") {
            lines.push(rest.trim_end_matches(" {").to_owned());
            is_inside = true;
        } else if line.starts_with('}') {
            is_inside = false;
        } else if is_inside && line.ends_with(';') {
            let field = line.trim_end_matches(';').split('[').next().unwrap();
            let name = field.rsplit([' ', '*']).next().unwrap();
            lines.push(name.to_owned());
        }
    }
    lines.sort();
    lines
}

#[test]
#[cfg(target_pointer_width = "64")]
fn the_layout_of_the_structs_changes_only_on_purpose() {
    let layout = layout();
    let mut known: Vec<String> = layout
        .lines()
        .map(|line| match line.strip_prefix("    ") {
            Some(field) => field.split(' ').nth(1).unwrap().to_owned(),
            None => line.split(' ').next().unwrap().to_owned(),
        })
        .collect();
    known.sort();
    assert_eq!(
        known,
        declared_structs(),
        "a struct or a field is not in the list of this test"
    );
    compare(
        "layout.txt",
        &layout,
        "A field that moved or is gone breaks every caller: raise HOLEFILL_ABI_VERSION in src/ffi/version.rs, which \
         the SONAME follows, and the major version. A field that was added at the end of a struct with struct_size \
         needs the minor version in Cargo.toml, and a new meaning of an old field the ..._VERSION of its struct in \
         src/ffi/types.rs. Then run `HOLEFILL_UPDATE=1 cargo test --test header`.",
    );
}

/// The shared library that was built with this test program, if it is there.
fn shared_library() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?;
    let path = program.parent()?.join("libholefill.so");
    path.exists().then_some(path)
}

#[test]
fn the_shared_library_exports_what_the_header_declares() {
    let Some(library) = shared_library() else {
        println!("SKIPPED: the symbols of the shared library, which is not there");
        return;
    };
    let output = std::process::Command::new("nm")
        .args(["-D", "--defined-only"])
        .arg(&library)
        .output();
    let Ok(output) = output else {
        println!("SKIPPED: the symbols of the shared library: no nm");
        return;
    };
    let text = String::from_utf8(output.stdout).unwrap();
    let mut exported: Vec<&str> = text.lines().filter_map(|l| l.split(' ').nth(2)).collect();
    exported.sort_unstable();
    assert_eq!(exported, declared());
}

/// Functions that cannot fail: they return a constant.
const UNGUARDED: [&str; 4] = [
    "holefill_abi_version",
    "holefill_version",
    "holefill_status_name",
    "holefill_status_message",
];

/// What runs the bodies of the others, and a function that calls such a one.
const GUARDS: [&str; 4] = ["guard(", "guard_", " text(&", "{ holefill_mesh_fill("];

#[test]
fn every_exported_function_is_guarded() {
    let mut count = 0;
    for part in PARTS {
        let source = fs::read_to_string(root().join(format!("src/ffi/{part}.rs"))).unwrap();
        for function in source.split("#[unsafe(no_mangle)]").skip(1) {
            let name = function
                .split("fn ")
                .nth(1)
                .unwrap()
                .split('(')
                .next()
                .unwrap();
            let body = function.split("\n}\n").next().unwrap();
            let is_guarded = GUARDS.iter().any(|call| body.contains(call));
            assert!(is_guarded || UNGUARDED.contains(&name), "{name}");
            count += 1;
        }
    }
    assert_eq!(count, declared().len());
}
