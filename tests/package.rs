//! What the published library brings along: its dependencies and its files.

use std::fs;
use std::path::Path;
use std::process::Command;

/// The lines that `cargo` prints for `arguments`.
fn cargo(arguments: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments.split_whitespace())
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo {arguments}: {error}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Which of the dependencies that only the program and the file formats need are among those of `package`.
fn extra_dependencies(package: &str) -> Vec<&'static str> {
    const EXTRA: [&str; 4] = ["clap", "indicatif", "png", "tempfile"];
    let tree = cargo(&format!(
        "tree --package {package} --edges normal --locked --offline --prefix none --format {{lib}}"
    ));
    assert!(tree.iter().any(|name| name == "faer"), "{tree:?}");
    EXTRA
        .into_iter()
        .filter(|extra| tree.iter().any(|name| name == extra))
        .collect()
}

#[test]
fn the_library_has_no_dependencies_of_the_program_or_the_file_formats() {
    assert_eq!(extra_dependencies("holefill"), [""; 0]);
    assert_eq!(extra_dependencies("holefill --features io"), ["tempfile"]);
    assert_eq!(
        extra_dependencies("holefill-cli"),
        ["clap", "indicatif", "png", "tempfile"]
    );
}

/// The files of the published library.
fn packaged() -> Vec<String> {
    cargo("package --package holefill --list --allow-dirty --locked --offline")
}

fn read(file: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap_or_default()
}

#[test]
fn the_package_has_the_pictures_of_the_readme() {
    let files = packaged();
    let readme = String::from_utf8(read("README.md")).unwrap();
    let pictures: Vec<&str> = readme
        .split("](")
        .filter_map(|rest| rest.split_once(')'))
        .map(|(target, _)| target)
        .filter(|target| target.ends_with(".png"))
        .collect();
    assert!(!pictures.is_empty());
    for picture in pictures {
        assert!(files.iter().any(|file| file == picture), "{picture}");
    }
}

#[test]
fn the_package_has_no_file_under_the_gpl() {
    // In two parts, so that this file has no such mark.
    let mark = concat!("SPDX-License-Identifier: ", "GPL").as_bytes();
    let is_marked = |file: &str| read(file).windows(mark.len()).any(|bytes| bytes == mark);
    let files = packaged();
    assert!(files.iter().any(|file| file == "src/lib.rs"));
    for file in &files {
        let folders = ["meshlab_plugin/", "cpp_tests/judge/", "compare/"];
        let is_gpl = folders.iter().any(|folder| file.starts_with(folder)) || is_marked(file);
        assert!(!is_gpl, "{file}");
    }
}
