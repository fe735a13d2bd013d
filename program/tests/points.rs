//! Meshes from points: the program as users run it.

#[path = "../../tests/common/mod.rs"]
mod common;

use common::edges::{boundary_edges, is_oriented_manifold};
use common::meshes::{self, Arrays};
use holefill::io::{self, MeshData};
use holefill::{AttributeValues, ScalarValues};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use tempfile::TempDir;

struct Run {
    status: i32,
    stdout: String,
    stderr: String,
}

/// A folder that goes away at the end, and runs in it.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn file(&self, name: &str, content: &str) {
        fs::write(self.path(name), content).unwrap();
    }

    /// Runs `holefill points` with the words of `line`, in the folder.
    fn points(&self, line: &str) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_holefill"))
            .arg("points")
            .args(line.split_whitespace())
            .current_dir(self.0.path())
            .output()
            .unwrap();
        let run = Run {
            status: output.status.code().expect("ended by a signal"),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        };
        assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
        run
    }

    fn read(&self, name: &str) -> MeshData {
        io::read(self.path(name)).unwrap()
    }
}

fn xyz(points: &[[f64; 3]]) -> String {
    let mut text = String::new();
    for [x, y, z] in points {
        writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
    }
    text
}

/// A sphere with a round hole of some twenty edges.
fn holed_sphere() -> Arrays {
    meshes::sphere(12).cut(|c| c[2] > 0.85)
}

#[test]
fn text_points_become_a_mesh_with_its_hole() {
    let folder = Folder::new();
    let sphere = holed_sphere();
    folder.file("a.xyz", &xyz(&sphere.positions));
    let run = folder.points("a.xyz -o out.ply --report report.json");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.starts_with("LOOP"), "{}", run.stdout);
    let count = sphere.positions.len();
    let expected = format!("from {count} of {count} points, 1 boundary loop");
    assert!(run.stderr.contains(&expected), "{}", run.stderr);

    let mesh = folder.read("out.ply");
    assert_eq!(mesh.positions, sphere.positions);
    assert!(is_oriented_manifold(&mesh.triangles));
    let report: Value =
        serde_json::from_slice(&fs::read(folder.path("report.json")).unwrap()).unwrap();
    assert_eq!(report["used"], count);
    assert_eq!(report["unused"], 0);
    assert_eq!(report["duplicates"], 0);
    assert_eq!(report["pieces"], 1);
    assert_eq!(report["triangles"], mesh.triangles.len());
    assert_eq!(report["loops"].as_array().unwrap().len(), 1);
    assert_eq!(report["holes"], Value::Null);
    assert!(report["radius"]["median"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_hole_is_filled_if_asked_for() {
    let folder = Folder::new();
    let sphere = holed_sphere();
    folder.file("a.txt", &xyz(&sphere.positions));
    let run = folder.points("a.txt -o out.ply --fill --method membrane --report r.json");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.starts_with("HOLE"), "{}", run.stdout);
    let mesh = folder.read("out.ply");
    assert_eq!(mesh.positions[..sphere.positions.len()], sphere.positions);
    assert_eq!(boundary_edges(&mesh.triangles), 0);
    let report: Value = serde_json::from_slice(&fs::read(folder.path("r.json")).unwrap()).unwrap();
    assert_eq!(report["holes"][0]["status"], "filled");
    assert_eq!(report["holes"][0]["method"], "membrane");

    let run = folder.points("a.txt -o out.ply --fill --keep-largest 1 --quiet");
    assert_eq!(
        (run.status, run.stdout.as_str(), run.stderr.as_str()),
        (0, "", "")
    );
    assert!(boundary_edges(&folder.read("out.ply").triangles) > 0);
}

#[test]
fn properties_stay_and_normals_decide_the_side() {
    let folder = Folder::new();
    let sphere = meshes::sphere(8);
    let count = sphere.positions.len();
    let mut data = MeshData::new(sphere.positions.clone(), Vec::new());
    let mut push = |name: &str, values: ScalarValues| {
        let column = AttributeValues::Scalars(values);
        data.vertex_attributes.push(name, column).unwrap();
    };
    push("label", ScalarValues::I16((0..count as i16).collect()));
    for (axis, name) in ["nx", "ny", "nz"].into_iter().enumerate() {
        let inward = sphere.positions.iter().map(|p| -p[axis] as f32);
        push(name, ScalarValues::F32(inward.collect()));
    }
    for name in ["red", "green", "blue"] {
        push(
            name,
            ScalarValues::U8((0..count).map(|v| (v % 256) as u8).collect()),
        );
    }
    io::write(folder.path("a.ply"), &data).unwrap();

    let volume = |mesh: &MeshData| -> f64 {
        let corners = |t: &[u32; 3]| t.map(|v| mesh.positions[v as usize]);
        let signed = |[a, b, c]: [[f64; 3]; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        mesh.triangles
            .iter()
            .map(|t| signed(corners(t)) / 6.0)
            .sum()
    };
    assert_eq!(folder.points("a.ply -o out.ply").status, 0);
    let mesh = folder.read("out.ply");
    assert_eq!(mesh.vertex_attributes, data.vertex_attributes);
    assert_eq!(mesh.positions, data.positions);
    assert!(volume(&mesh) < -3.5);
    assert_eq!(folder.points("a.ply -o out.ply --ignore-normals").status, 0);
    assert!(volume(&folder.read("out.ply")) > 3.5);
}

#[test]
fn a_mesh_is_taken_for_its_points() {
    let folder = Folder::new();
    let sphere = holed_sphere();
    let data = MeshData::new(sphere.positions.clone(), sphere.triangles);
    for name in ["a.ply", "a.obj", "a.off"] {
        io::write(folder.path(name), &data).unwrap();
        let run = folder.points(&format!("{name} -o out.off"));
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert!(
            run.stderr.contains("only the points are used"),
            "{}",
            run.stderr
        );
        assert_eq!(folder.read("out.off").positions, sphere.positions);
    }
}

#[test]
fn bad_points_are_errors_with_a_reason_and_no_file() {
    let folder = Folder::new();
    for (content, expected) in [
        ("", "there are no points"),
        ("# nothing\n", "there are no points"),
        ("0 0 0\n1 0 0\n0 1 0\n", "3 points are too few"),
        ("0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n", "on one line"),
        ("1 2 3\n1 2 3\n1 2 3\n1 2 3\n", "at 1 different places"),
        ("0 0 0\n1 0 0\n0 1 0\n0 0 nan\n", "point 3 is not finite"),
        ("0 0 0\n1 0\n", "line 2: 2 numbers"),
        ("0 0 0\n1 0 zero\n", "line 2: \"zero\" is no number"),
    ] {
        folder.file("a.xyz", content);
        let run = folder.points("a.xyz -o out.ply");
        assert_eq!(run.status, 1, "{content:?}: {}", run.stderr);
        assert!(run.stderr.contains(expected), "{content:?}: {}", run.stderr);
        assert!(run.stderr.contains("a.xyz"), "{}", run.stderr);
        assert!(!folder.path("out.ply").exists());
    }
    let run = folder.points("missing.xyz -o out.ply");
    assert_eq!(run.status, 1);
    let run = folder.points("a.las -o out.ply");
    assert_eq!(run.status, 1);
    assert!(run.stderr.contains(".xyz"), "{}", run.stderr);
}

#[test]
fn wrong_usage_is_refused() {
    let folder = Folder::new();
    folder.file("a.xyz", &xyz(&holed_sphere().positions));
    for line in [
        "a.xyz",
        "a.xyz -o out.xyz",
        "a.xyz -o out.ply --radius 0",
        "a.xyz -o out.ply --radius nan",
        "a.xyz -o out.ply --neighbours 5",
        "a.xyz -o out.ply --method flat",
        "a.xyz -o out.ply --keep-largest 1",
        "a.xyz -o out.ply --fill --keep 0,0",
        "a.xyz -o out.ply --report out.ply",
    ] {
        let run = folder.points(line);
        assert_eq!(run.status, 2, "{line}: {}", run.stderr);
        assert!(!folder.path("out.ply").exists(), "{line}");
    }
}

#[test]
fn the_result_does_not_depend_on_threads() {
    let folder = Folder::new();
    folder.file(
        "a.xyz",
        &xyz(&meshes::torus(20, 40).jittered(0.02, 4).positions),
    );
    for threads in [1, 3] {
        let line = format!("a.xyz -o {threads}.ply --threads {threads}");
        assert_eq!(folder.points(&line).status, 0);
    }
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_eq!(bytes("1.ply"), bytes("3.ply"));
}
