//! The C header is what the sources say.

use std::fs;
use std::path::{Path, PathBuf};

/// The parts of the interface, in the order in which the header has them.
const PARTS: [&str; 11] = [
    "version",
    "status",
    "types",
    "error",
    "mesh",
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
