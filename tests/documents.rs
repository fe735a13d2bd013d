//! The documents agree with the code: examples, methods, parameters, links.

use holefill::{BoundaryLoops, FillOptions, Method, Selection, TriMesh, fill_holes};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The lines between the first line that is `start` and the next that is `end`.
fn block(text: &str, start: &str, end: &str) -> String {
    let lines = text.lines().skip_while(|line| *line != start).skip(1);
    lines
        .take_while(|line| *line != end)
        .map(|line| format!("{line}\n"))
        .collect()
}

#[test]
fn the_readme_shows_the_example_that_is_tested() {
    let documentation: String = read("src/lib.rs")
        .lines()
        .filter_map(|line| line.strip_prefix("//!"))
        .map(|line| format!("{}\n", line.strip_prefix(' ').unwrap_or(line)))
        .collect();
    let tested: String = block(&documentation, "```", "```")
        .lines()
        .filter(|line| !line.starts_with("# "))
        .map(|line| format!("{line}\n"))
        .collect();
    let shown = block(&read("README.md"), "```rust", "```");
    assert!(!shown.is_empty());
    assert_eq!(shown, tested);
}

#[test]
fn the_readme_lists_every_method() {
    let readme = read("README.md");
    for method in Method::ALL {
        let row = format!("| `{}` |", method.name());
        assert!(readme.contains(&row), "{row}");
    }
}

#[test]
fn the_page_on_adding_a_method_shows_a_method_that_runs() {
    let shown = block(&read("docs/methods/adding.md"), "```rust", "```");
    assert_eq!(shown, read("src/methods/centroid.rs"));
    let method = Method::ALL.into_iter().find(|m| m.name() == "centroid");
    let options = FillOptions::default()
        .method(method.expect("it is in the list"))
        .fallback(false);
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut mesh = TriMesh::new(positions, vec![[0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
    let boundary = BoundaryLoops::find(&mesh);
    fill_holes(&mut mesh, &boundary, &Selection::default(), &options, None).unwrap();
    assert_eq!(mesh.triangles().len(), 6);
    assert!(BoundaryLoops::find(&mesh).loops.is_empty());
}

#[test]
fn every_parameter_is_documented_with_its_default() {
    let pages: String = files(&root().join("docs/methods"))
        .iter()
        .map(|page| fs::read_to_string(page).unwrap())
        .collect();
    for parameter in FillOptions::parameters() {
        let default = parameter.value(&FillOptions::default());
        let row = format!("| `{}` | `{default}` |", parameter.name());
        assert!(pages.contains(&row), "{row}");
    }
}

#[test]
fn documented_constants_have_their_values() {
    let page = read("docs/methods/staircase.md");
    let rows = page
        .lines()
        .skip_while(|line| *line != "## Constants")
        .skip(1)
        .take_while(|line| !line.starts_with("## "))
        .filter(|line| line.starts_with("| `"));
    let mut count = 0;
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(|c| c.trim_matches([' ', '`'])).collect();
        let [_, name, value, file, _] = cells[..] else {
            panic!("{row}");
        };
        let source = read(&format!("src/{file}"));
        let is_defined = source.lines().any(|line| {
            line == format!("            {name}: {value},")
                || (line.starts_with(&format!("const {name}: "))
                    && line.ends_with(&format!(" = {value};")))
        });
        assert!(is_defined, "{file} does not say that {name} is {value}");
        count += 1;
    }
    assert!(count > 10, "only {count} constants were found");
}

/// All Markdown files in `folder` and below.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|e| e == "md") {
            found.push(path);
        }
    }
    found
}

/// The targets of links and pictures that are files.
fn links(text: &str) -> Vec<&str> {
    text.split("](")
        .skip(1)
        .filter_map(|rest| rest.split_once(')'))
        .map(|(target, _)| target)
        .filter(|target| !target.contains("://") && !target.starts_with('#'))
        .collect()
}

/// The headings of a page as links name them.
fn headings(text: &str) -> Vec<String> {
    let heading = |line: &str| {
        let words = line.trim_start_matches('#').trim().to_lowercase();
        let kept = words
            .chars()
            .filter(|&c| c.is_alphanumeric() || " -_".contains(c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    text.lines()
        .filter(|line| line.starts_with('#'))
        .map(heading)
        .collect()
}

#[test]
fn links_lead_to_files() {
    let mut pages = files(&root().join("docs"));
    for page in [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "compare/README.md",
        "meshlab_plugin/README.md",
    ] {
        pages.push(root().join(page));
    }
    let mut count = 0;
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for link in links(&text) {
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = page.parent().unwrap().join(file);
            assert!(target.exists(), "{}: {link}", page.display());
            if !place.is_empty() {
                let places = headings(&fs::read_to_string(&target).unwrap());
                assert!(
                    places.iter().any(|p| p == place),
                    "{}: {link}",
                    page.display()
                );
            }
            count += 1;
        }
    }
    assert!(count > 10, "only {count} links were found");
}

#[test]
fn links_are_found() {
    let text = "[a](b/c.md) ![d](e.png) [f](https://g.example/) [h](#i)";
    assert_eq!(links(text), ["b/c.md", "e.png"]);
}
