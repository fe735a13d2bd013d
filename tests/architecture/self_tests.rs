//! The checks find what they should, and nothing else.

use super::reader::uses;
use super::{RULES, Root, forbidden_word, is_on_circle, machine_path, name, used_files};

fn example_root() -> Root {
    let modules = RULES
        .iter()
        .map(|(module, _)| name(module)[0].clone())
        .collect();
    let exports = [
        ("Error", "error::Error"),
        ("fill_holes", "fill::session::fill_holes"),
    ];
    Root {
        modules,
        exports: exports
            .map(|(export, place)| (export.to_owned(), name(place)))
            .into(),
    }
}

#[test]
fn what_is_forbidden_is_found_in_every_form() {
    let root = example_root();
    let cases = [
        (
            "math",
            "use crate::mesh::trimesh::TriMesh;",
            "mesh::trimesh::TriMesh",
        ),
        ("mesh::trimesh", "use crate::boundary;", "boundary"),
        (
            "quality::shape",
            "fn f() -> crate::fair::X { todo() }",
            "fair::X",
        ),
        (
            "fair::kharmonic",
            "use crate::{math::{Vec3, plane::*}, refine::{self}};",
            "refine",
        ),
        (
            "refine",
            "use crate::quality::{spatial::{Aabb as B}};",
            "quality::spatial::Aabb",
        ),
        (
            "triangulate",
            "pub(crate) use crate::fill::options as o;",
            "fill::options",
        ),
        (
            "triangulate::a",
            "fn f() { super::super::predict::run(); }",
            "predict::run",
        ),
        (
            "triangulate",
            "mod x { use super::super::fair::Y; }",
            "fair::Y",
        ),
        ("triangulate", "mod x {} use super::refine::Z;", "refine::Z"),
        (
            "methods::mls",
            "use crate::fill::session::FillSession;",
            "fill::session::FillSession",
        ),
        ("patch", "use crate::*;", "*"),
        ("patch", "use super::*;", "*"),
        ("patch", "use crate as c;", "the root"),
        ("patch", "use crate::{self as c};", "the root"),
        (
            "io::ply",
            "use crate::mesh::trimesh::TriMesh;",
            "mesh::trimesh",
        ),
        ("io", "use crate::mesh;", "mesh"),
        ("ffi::mesh", "let a = |x| crate::io::read(x);", "io::read"),
        ("mesh::connectivity", "use crate::math::Vec3;", "math::Vec3"),
        (
            "mesh::connectivity",
            "use super::trimesh::TriMesh;",
            "mesh::trimesh",
        ),
        (
            "boundary",
            "macro_rules! m { () => { $crate::fill::f() } }",
            "fill::f",
        ),
        (
            "boundary",
            "let s = r#\"\" \"#; let c = '\"'; use crate::fill::f;",
            "fill::f",
        ),
        (
            "boundary",
            "fn f<'a>(x: &'a str) { /* a /* b */ */ crate::fill::f(x) }",
            "fill::f",
        ),
        (
            "boundary",
            "fn f() -> impl Fn() + use<'_> { crate::fill::f }",
            "fill::f",
        ),
        (
            "boundary",
            "#[cfg(not(test))] use crate::fill::f;",
            "fill::f",
        ),
        (
            "boundary",
            "#[cfg(test)] mod tests { use a::b; } use crate::fill::f;",
            "fill::f",
        ),
        (
            "boundary",
            "#[cfg(test)] mod tests; use crate::fill::f;",
            "fill::f",
        ),
        (
            "boundary",
            "#[cfg(test)] fn f(a: [u8; 2]) {} use crate::fill::f;",
            "fill::f",
        ),
        (
            "boundary",
            "fn g() { #[cfg(test)] crate::fill::f(); }",
            "fill::f",
        ),
        ("boundary", "use crate::fill_holes;", "fill::session"),
        ("boundary", "use crate::Nonsense;", "not known"),
        ("novelty", "use crate::error::Error;", "no rule"),
    ];
    for (module, source, expected) in cases {
        let found = root.objections(module, source);
        let fits = |o: &String| o.contains(expected);
        assert!(
            found.len() == 1 && fits(&found[0]),
            "{module}: {source}: {found:?}"
        );
    }
}

#[test]
fn what_is_allowed_is_not_objected_to() {
    let root = example_root();
    let cases = [
        (
            "fill::cut",
            "use crate::{fair::laplacian::X, boundary::*, quality::{self, Surface}};",
        ),
        ("methods::mls", "use crate::triangulate::triangulate;"),
        (
            "io::ply::body",
            "use super::super::text::Lines; use crate::mesh::attributes::{A, B};",
        ),
        ("io::ply::write", "pub(in super::super) fn f() {}"),
        (
            "fair",
            "mod a { use super::b::C; use super::super::math::Vec3; }",
        ),
        (
            "fair",
            "use kharmonic::fair; use std::fmt; use rayon::prelude::*;",
        ),
        ("patch", "use crate::{Error, math::Vec3};"),
        (
            "patch",
            "/// See [`crate::fill::f`].\n// crate::fill::f\n/* crate::fill */ fn f() {}",
        ),
        (
            "patch",
            "const A: &str = \"crate::fill::f\"; const B: &[u8] = br#\"crate::fill\"\"#;",
        ),
        (
            "patch",
            "#[cfg(test)] mod tests { use crate::fill::f; mod a { use crate::io; } }",
        ),
        (
            "patch",
            "#[cfg(test)] #[allow(x)] pub(crate) fn f(a: [u8; 2]) { crate::fill::f(); }",
        ),
        ("patch", "fn f(self) { self.a::<u8>(); }"),
    ];
    for (module, source) in cases {
        assert_eq!(
            root.objections(module, source),
            [""; 0],
            "{module}: {source}"
        );
    }
}

#[test]
fn modules_of_tests_in_other_files_are_known() {
    let found = uses(
        &name("refine"),
        "mod a; #[cfg(test)] mod b; #[cfg(test)] pub(crate) mod c;",
    );
    assert_eq!(found.test_modules, [name("refine::b"), name("refine::c")]);
    assert!(
        uses(&name("refine"), "#[cfg(not(test))] mod b;")
            .test_modules
            .is_empty()
    );
}

#[test]
fn the_root_is_read_with_its_exports() {
    let root = Root::read(
        "mod a; pub mod b; #[cfg(test)] #[path = \"c.rs\"] mod c;\npub use a::{c::{D, E}, G};\npub use b::h;",
    );
    assert_eq!(root.modules, ["a", "b"]);
    let place = |export: &str| root.exports[export].join("::");
    assert_eq!(
        ["D", "E", "G", "h"].map(place),
        ["a::c::D", "a::c::E", "a::G", "b::h"]
    );
}

#[test]
fn forbidden_words_and_places_are_found_and_others_are_not() {
    let fair = Some(name("fair"));
    let ffi = Some(name("ffi::mesh"));
    assert_eq!(
        forbidden_word(fair.as_ref(), "unsafe { f() }"),
        Some("unsafe")
    );
    assert_eq!(forbidden_word(None, "unsafe { f() }"), Some("unsafe"));
    assert_eq!(forbidden_word(ffi.as_ref(), "unsafe { f() }"), None);
    assert_eq!(
        forbidden_word(ffi.as_ref(), "use std::collections::HashMap;"),
        Some("HashMap")
    );
    assert_eq!(
        forbidden_word(
            fair.as_ref(),
            "// unsafe\nlet s = \"HashSet\"; a.unsafe_b()"
        ),
        None
    );

    let at = |folder: &str| format!("see \"/{folder}/x.ply\" there");
    for folder in ["home", "root", "tmp", "Users", "work"] {
        let text = at(folder);
        let expected = &text["see \"".len()..];
        assert_eq!(machine_path(&text), Some(expected));
    }
    for text in [
        "https://a.example/home/b",
        "${TMPDIR}/tmp/a",
        "a/work/b",
        "/usr/share",
    ] {
        assert_eq!(machine_path(text), None, "{text}");
    }
}

#[test]
fn circles_of_files_are_found_through_children_and_parents() {
    let sources = [
        ("a", "mod b; pub use b::f; use crate::d::g;"),
        ("a::b", "use super::c::h;"),
        ("a::c", "fn h() { crate::a::S }"),
        ("d", "use crate::a::c::inner::X;"),
        ("e", "mod f; mod a { pub use super::f::x; } use a::y;"),
        ("e::f", "#[cfg(test)] use super::z;"),
    ];
    let files: Vec<_> = sources.iter().map(|(file, _)| name(file)).collect();
    let read: Vec<_> = sources
        .iter()
        .map(|(file, source)| uses(&name(file), source))
        .collect();
    let used = used_files(&files, &read);
    assert_eq!(
        used,
        [vec![1, 3], vec![2], vec![0], vec![2], vec![5], vec![]]
    );
    let circles: Vec<_> = (0..files.len())
        .filter(|&file| is_on_circle(file, &used))
        .collect();
    assert_eq!(circles, [0, 1, 2, 3]);
}
