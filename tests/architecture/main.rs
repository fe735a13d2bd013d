//! The sources keep the architecture: who may use whom, how long a file may be, what must not occur.
//!
//! The sources are read as tokens, so comments and texts do not count. Paths that begin with `crate`,
//! `self` or `super` are followed wherever they stand, in `use` trees and in expressions; names that
//! `lib.rs` re-exports count as the module that they come from. Code under `#[cfg(test)]` may use more.

mod reader;
mod self_tests;

use reader::{Uses, tokens, uses};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// A module, or a part of one, and what it may use besides itself.
///
/// The rule of the longest name that fits holds. A module without a rule is an error: a new one must
/// find its place here first.
const RULES: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("job", &["error"]),
    ("math", &["error", "job"]),
    // Who is whose neighbor: no coordinates.
    ("mesh::halfedge", &[]),
    ("mesh::connectivity", &CONNECTIVITY),
    ("mesh::linking", &CONNECTIVITY),
    ("mesh::pairing", &CONNECTIVITY),
    ("mesh::rim_table", &CONNECTIVITY),
    ("mesh::survey", &CONNECTIVITY),
    ("mesh::defects", &["error"]),
    ("mesh", &["error", "job", "math"]),
    ("boundary", &["error", "job", "math", "mesh"]),
    ("quality", &["error", "job", "math", "mesh"]),
    // What a method is given, in coordinates and indices of its own.
    ("surroundings", &["error", "job", "math"]),
    ("hole", &["math", "surroundings"]),
    ("patch", &["error", "job", "math", "mesh", "hole"]),
    // The triangulation of a patch: no coordinates.
    ("patch::mesh", &["error", "mesh", "patch::edit"]),
    ("patch::edit", &["patch::mesh"]),
    // What makes a patch knows nothing of loops, of the pipeline, of its judges or of each other.
    ("triangulate", &["error", "job", "math", "mesh", "patch"]),
    ("refine", &["error", "job", "math", "mesh", "patch"]),
    (
        "fair",
        &["error", "job", "math", "mesh", "patch", "surroundings"],
    ),
    // What users choose: plain values, and the machinery that gives them names.
    ("options::entry", &["error"]),
    ("options", &["error", "methods::method"]),
    // The methods see neither loops nor the pipeline.
    (
        "methods",
        &[
            "error",
            "job",
            "math",
            "mesh",
            "quality",
            "patch",
            "hole",
            "surroundings",
            "options",
            "triangulate",
            "refine",
            "fair",
        ],
    ),
    (
        "fill",
        &[
            "error",
            "job",
            "math",
            "mesh",
            "boundary",
            "quality",
            "patch",
            "hole",
            "surroundings",
            "options",
            "methods",
            "fair",
        ],
    ),
    // What a caller is told, and how it stops the work.
    ("fill::progress", &["error", "job"]),
    // From points to a mesh: before there are loops to fill.
    (
        "reconstruct",
        &["error", "job", "math", "mesh", "fill::progress"],
    ),
    // Plain arrays in and out.
    ("io", &["error", "math", "mesh::attributes"]),
    (
        "ffi",
        &[
            "error",
            "job",
            "math",
            "mesh",
            "boundary",
            "quality",
            "patch",
            "options",
            "methods",
            "fill",
            "reconstruct",
        ],
    ),
];

/// What connectivity consists of.
const CONNECTIVITY: [&str; 8] = [
    "error",
    "mesh::connectivity",
    "mesh::defects",
    "mesh::halfedge",
    "mesh::linking",
    "mesh::pairing",
    "mesh::rim_table",
    "mesh::survey",
];

const MOST_LINES: usize = 900;

/// The only module with `unsafe`.
const UNSAFE: &str = "ffi";

type Name = Vec<String>;

fn name(path: &str) -> Name {
    path.split("::").map(str::to_owned).collect()
}

// Judging

/// What the crate's root declares.
struct Root {
    modules: Vec<String>,
    /// Names that `lib.rs` re-exports, and their places.
    exports: BTreeMap<String, Name>,
}

impl Root {
    fn read(source: &str) -> Self {
        let tokens = tokens(source);
        let is_mod = |w: &&[&str]| w[0] == "mod" && [";", "{"].contains(&w[2]);
        // Paths in the root begin with a module's name: `self::` before them makes the reader take them.
        let read = uses(&[], &source.replace("pub use ", "pub use self::"));
        let modules = tokens
            .windows(3)
            .filter(is_mod)
            .map(|w| w[1].to_owned())
            .filter(|module| !read.test_modules.contains(&vec![module.clone()]));
        let mut root = Self {
            modules: modules.collect(),
            exports: BTreeMap::new(),
        };
        for (_, path) in read.paths {
            if let Some(last) = path.last() {
                root.exports.insert(last.clone(), path.clone());
            }
        }
        root
    }

    /// Why `user` must not use `path`.
    fn objection(&self, user: &[String], path: &[String]) -> Option<String> {
        let place = match path.first() {
            None => return Some("the root of the crate".to_owned()),
            Some(first) if self.modules.contains(first) => path,
            Some(first) => match self.exports.get(first) {
                Some(place) => place,
                None => return Some(format!("{}, which is not known", path.join("::"))),
            },
        };
        let rule = RULES
            .iter()
            .filter(|(module, _)| user.starts_with(&name(module)))
            .max_by_key(|(module, _)| name(module).len());
        let Some((module, allowed)) = rule else {
            return Some(format!("{}, but has no rule", place.join("::")));
        };
        let is_allowed = std::iter::once(module)
            .chain(*allowed)
            .any(|prefix| place.starts_with(&name(prefix)));
        (!is_allowed).then(|| place.join("::"))
    }

    /// The paths in `source` that `module` must not use.
    fn objections(&self, module: &str, source: &str) -> Vec<String> {
        uses(&name(module), source)
            .paths
            .iter()
            .filter_map(|(user, path)| self.objection(user, path))
            .collect()
    }
}

// The sources

struct SourceFile {
    /// From the root of the repository.
    path: PathBuf,
    text: String,
}

/// Folders that programs make and version control ignores.
const BUILT: [&str; 3] = ["compare/build", "compare/inputs", "compare/out"];

/// All files under the repository's folder `folder` whose names end in one of `extensions`, in order.
fn files(folder: &str, extensions: &[&str]) -> Vec<SourceFile> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let mut folders = vec![root.join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                if !BUILT.iter().any(|folder| path.ends_with(folder)) {
                    folders.push(path);
                }
            } else if extensions
                .iter()
                .any(|e| path.extension().is_some_and(|x| x == *e))
            {
                found.push(SourceFile {
                    text: fs::read_to_string(&path).unwrap(),
                    path: path.strip_prefix(root).unwrap().to_owned(),
                });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// The sources of the library and of the program.
fn sources() -> Vec<SourceFile> {
    let mut sources = files("src", &["rs"]);
    let program = files("program/src", &["rs"]);
    assert!(!program.is_empty(), "there is no program/src");
    sources.extend(program);
    sources
}

/// The module of a file under `src`; `None` for the program's.
fn module_of(path: &Path) -> Option<Name> {
    let path = path.strip_prefix("src").ok()?.with_extension("");
    let mut module: Name = path
        .iter()
        .map(|part| part.to_str().unwrap().to_owned())
        .collect();
    if ["mod", "lib"].contains(&module[module.len() - 1].as_str()) {
        module.pop();
    }
    Some(module)
}

fn library() -> (Root, Vec<(Name, SourceFile)>) {
    let sources = files("src", &["rs"]);
    let library: Vec<_> = sources
        .into_iter()
        .filter_map(|file| Some((module_of(&file.path)?, file)))
        .collect();
    let root = library.iter().find(|(module, _)| module.is_empty());
    let root = Root::read(&root.expect("there is no src/lib.rs").1.text);
    (root, library)
}

/// For each file of the library the others that it uses; `files` are their modules, and paths into what is no file
/// count for the file above it.
fn used_files(files: &[Name], uses: &[Uses]) -> Vec<Vec<usize>> {
    let file_of = |path: &[String]| {
        let above = (1..=path.len()).rev().map(|length| &path[..length]);
        above
            .into_iter()
            .find_map(|module| files.iter().position(|file| file == module))
    };
    let used = uses.iter().enumerate().map(|(user, uses)| {
        let paths = uses.paths.iter();
        paths
            .filter_map(|(_, path)| file_of(path).filter(|&file| file != user))
            .collect()
    });
    used.collect()
}

/// Whether `file` uses itself through others.
fn is_on_circle(file: usize, used: &[Vec<usize>]) -> bool {
    let mut reached = used[file].clone();
    let mut at = 0;
    while at < reached.len() {
        for &other in &used[reached[at]] {
            if !reached.contains(&other) {
                reached.push(other);
            }
        }
        at += 1;
    }
    reached.contains(&file)
}

fn assert_none(complaints: &str) {
    assert!(complaints.is_empty(), "\n{complaints}");
}

#[test]
fn modules_use_only_what_lies_below_them() {
    let (root, library) = library();
    let read: Vec<(&SourceFile, Uses)> = library
        .iter()
        .filter(|(module, _)| !module.is_empty())
        .map(|(module, file)| (file, uses(module, &file.text)))
        .collect();
    let is_for_tests = |module: &Name| {
        read.iter()
            .flat_map(|(_, uses)| &uses.test_modules)
            .any(|tests| module.starts_with(tests))
    };
    let mut complaints = String::new();
    let mut count = 0;
    for (file, uses) in &read {
        for (user, path) in uses.paths.iter().filter(|(user, _)| !is_for_tests(user)) {
            count += 1;
            if let Some(objection) = root.objection(user, path) {
                let (path, user) = (file.path.display(), user.join("::"));
                let _ = writeln!(complaints, "{path}: {user} must not use {objection}");
            }
        }
    }
    assert_none(&complaints);
    assert!(
        count > 100,
        "only {count} paths were found: they are not read"
    );
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let (root, library) = library();
    let (files, mut read): (Vec<Name>, Vec<Uses>) = library
        .iter()
        .filter(|(module, _)| !module.is_empty())
        .map(|(module, file)| (module.clone(), uses(module, &file.text)))
        .unzip();
    let tests: Vec<Name> = read.iter().flat_map(|u| u.test_modules.clone()).collect();
    for (file, uses) in files.iter().zip(&mut read) {
        if tests.iter().any(|module| file.starts_with(module)) {
            uses.paths.clear();
        }
        for (_, path) in &mut uses.paths {
            if let Some(place) = path.first().and_then(|first| root.exports.get(first)) {
                path.clone_from(place);
            }
        }
    }
    let used = used_files(&files, &read);
    let circles: Vec<usize> = (0..files.len())
        .filter(|&file| is_on_circle(file, &used))
        .collect();
    let mut complaints = String::new();
    for &file in &circles {
        let others = used[file].iter().filter(|other| circles.contains(other));
        let others: BTreeSet<String> = others.map(|&other| files[other].join("::")).collect();
        let _ = writeln!(complaints, "{} uses {others:?}", files[file].join("::"));
    }
    assert_none(&complaints);
}

#[test]
fn every_module_has_a_place() {
    let (root, _) = library();
    for module in &root.modules {
        assert!(
            RULES.iter().any(|(name, _)| name == module),
            "{module} has no rule"
        );
    }
}

#[test]
fn the_root_has_no_logic() {
    let (_, library) = library();
    let (_, root) = library
        .iter()
        .find(|(module, _)| module.is_empty())
        .unwrap();
    let tokens = tokens(&root.text);
    for keyword in ["fn", "impl", "struct", "enum", "trait", "macro_rules"] {
        assert!(!tokens.contains(&keyword), "lib.rs has a {keyword}");
    }
}

#[test]
fn files_are_short_enough_to_be_read() {
    let mut complaints = String::new();
    for file in sources() {
        let lines = file.text.lines().count();
        if lines > MOST_LINES {
            let _ = writeln!(complaints, "{}: {lines} lines", file.path.display());
        }
    }
    assert_none(&complaints);
}

/// The first of the words that must not stand in `module`.
fn forbidden_word(module: Option<&Name>, source: &str) -> Option<&'static str> {
    let is_unsafe_allowed = module.is_some_and(|m| m.first().is_some_and(|m| m == UNSAFE));
    let words = tokens(source);
    let is_forbidden = |word: &str| words.contains(&word);
    ["HashMap", "HashSet", "RandomState", "DefaultHasher"]
        .into_iter()
        .find(|word| is_forbidden(word))
        .or_else(|| Some("unsafe").filter(|word| !is_unsafe_allowed && is_forbidden(word)))
}

#[test]
fn no_unsafe_outside_ffi_and_no_hash_order() {
    let mut complaints = String::new();
    for file in sources() {
        if let Some(word) = forbidden_word(module_of(&file.path).as_ref(), &file.text) {
            let _ = writeln!(complaints, "{}: {word}", file.path.display());
        }
    }
    assert_none(&complaints);
}

/// The first path in `text` that leads to a place on somebody's machine.
fn machine_path(text: &str) -> Option<&str> {
    let roots = ["home", "root", "tmp", "work", "Users", "mnt"].map(|folder| format!("/{folder}/"));
    roots.iter().find_map(|root| {
        text.match_indices(root.as_str()).find_map(|(at, _)| {
            // Inside a longer path or address it is something else.
            let is_start =
                !text[..at].ends_with(|c: char| c.is_alphanumeric() || "._-}".contains(c));
            is_start.then(|| &text[at..text[at..].find('\n').map_or(text.len(), |end| at + end)])
        })
    })
}

#[test]
fn no_place_on_a_machine_is_named() {
    const KINDS: [&str; 8] = ["rs", "md", "toml", "cpp", "txt", "sh", "json", "yml"];
    let mut complaints = String::new();
    for folder in [
        "src", "program", "tests", "compare", "docs", "benches", "examples",
    ] {
        for file in files(folder, &KINDS) {
            if let Some(path) = machine_path(&file.text) {
                let _ = writeln!(complaints, "{}: {path}", file.path.display());
            }
        }
    }
    assert_none(&complaints);
}
