//! The command line program, run as users run it: exit status, streams, files.
#![allow(clippy::print_stderr)] // A skipped test says so.

use serde_json::Value;
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_holefill");

/// How a run of the program ended.
struct Run {
    status: i32,
    stdout: String,
    stderr: String,
}

fn finish(mut command: Command) -> Run {
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let run = Run {
        status: output.status.code().expect("ended by a signal"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    };
    assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
    run
}

fn holefill<S: AsRef<OsStr>>(args: impl IntoIterator<Item = S>) -> Run {
    let mut command = Command::new(PROGRAM);
    command.args(args);
    finish(command)
}

/// A folder that goes away at the end, and runs in it.
struct Folder {
    dir: TempDir,
}

impl Folder {
    fn new() -> Self {
        Self {
            dir: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, content).unwrap();
        path
    }

    /// Runs `holefill` with the words of `line`; those with a dot are files in the folder.
    fn run(&self, line: &str) -> Run {
        let is_file = |word: &str| {
            [".off", ".ply", ".obj", ".stl", ".json", ".png", ".xyz"]
                .iter()
                .any(|extension| word.ends_with(extension))
        };
        holefill(line.split_whitespace().map(|word| {
            if is_file(word) {
                self.path(word).into_os_string()
            } else {
                word.into()
            }
        }))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path(name)).unwrap()).unwrap()
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.dir.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

#[derive(Clone)]
struct Mesh {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    fn off(&self) -> String {
        let mut text = format!("OFF\n{} {} 0\n", self.positions.len(), self.triangles.len());
        for [x, y, z] in &self.positions {
            writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
        }
        for [a, b, c] in &self.triangles {
            writeln!(text, "3 {a} {b} {c}").unwrap();
        }
        text
    }

    fn from_off(text: &str) -> Self {
        let mut words = text.split_whitespace().skip(1);
        let mut next = || words.next().unwrap();
        let [n, m, _]: [usize; 3] = std::array::from_fn(|_| next().parse().unwrap());
        let positions = (0..n)
            .map(|_| std::array::from_fn(|_| next().parse().unwrap()))
            .collect();
        let triangles = (0..m)
            .map(|_| {
                assert_eq!(next(), "3");
                std::array::from_fn(|_| next().parse().unwrap())
            })
            .collect();
        Self {
            positions,
            triangles,
        }
    }

    /// The same without these vertices and the triangles round them.
    fn without(mut self, vertices: &[u32]) -> Self {
        self.triangles
            .retain(|t| !t.iter().any(|v| vertices.contains(v)));
        let before = |v: u32| vertices.iter().filter(|&&w| w < v).count() as u32;
        self.triangles
            .iter_mut()
            .flatten()
            .for_each(|v| *v -= before(*v));
        let mut v = 0..;
        self.positions
            .retain(|_| !v.next().is_some_and(|v| vertices.contains(&v)));
        self
    }
}

const RINGS: u32 = 24;
const PER_RING: u32 = 16;

/// A torus of 24 rings with 16 vertices each; all loops of a damaged one are holes.
fn torus() -> Mesh {
    let vertex = |i: u32, j: u32| (i % RINGS) * PER_RING + j % PER_RING;
    let mut mesh = Mesh {
        positions: Vec::new(),
        triangles: Vec::new(),
    };
    for i in 0..RINGS {
        for j in 0..PER_RING {
            let turn = |k: u32, n: u32| std::f64::consts::TAU * f64::from(k) / f64::from(n);
            let (u, v) = (turn(i, RINGS), turn(j, PER_RING));
            let r = 3.0 + v.cos();
            mesh.positions.push([r * u.cos(), r * u.sin(), v.sin()]);
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// Holes of 6, 8 and 10 edges round one, two and three vertices of a torus.
fn three_holes() -> Mesh {
    torus().without(&[20, 116, 117, 212, 213, 214])
}

fn folder_with(name: &str, mesh: &Mesh) -> Folder {
    let folder = Folder::new();
    folder.file(name, mesh.off());
    folder
}

/// One value of each hole of a report, in order.
fn column<'a>(report: &'a Value, key: &str) -> Vec<&'a str> {
    report["holes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|h| h[key].as_str().unwrap())
        .collect()
}

fn numbers(report: &Value, key: &str) -> Vec<u64> {
    report["holes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|h| h[key].as_u64().unwrap())
        .collect()
}

fn loops_of(folder: &Folder, name: &str) -> Vec<Value> {
    let run = folder.run(&format!("inspect {name} --json"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    found["loops"].as_array().unwrap().clone()
}

fn assert_starts_with(filled: &Mesh, mesh: &Mesh) {
    assert_eq!(filled.positions[..mesh.positions.len()], mesh.positions);
    assert_eq!(filled.triangles[..mesh.triangles.len()], mesh.triangles);
}

fn assert_is_message(run: &Run) {
    assert!(run.stderr.starts_with("holefill: "), "{}", run.stderr);
    assert_eq!(run.stdout, "");
}

// What a fill gives

#[test]
fn every_hole_is_filled_and_nothing_else_is_touched() {
    let mesh = three_holes();
    let folder = folder_with("in.off", &mesh);
    let before = fs::read(folder.path("in.off")).unwrap();
    let run = folder.run("fill in.off -o out.off");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(
        run.stdout.ends_with("3 holes: 3 filled\n"),
        "{}",
        run.stdout
    );
    let filled = Mesh::from_off(&fs::read_to_string(folder.path("out.off")).unwrap());
    assert_starts_with(&filled, &mesh);
    assert!(filled.triangles.len() > mesh.triangles.len());
    assert_eq!(loops_of(&folder, "out.off").len(), 0);
    assert_eq!(fs::read(folder.path("in.off")).unwrap(), before);
    assert_eq!(folder.names(), ["in.off", "out.off"]);
}

#[test]
fn every_method_fills() {
    for method in ["auto", "flat", "membrane", "fair-c1", "fair-c2"] {
        let folder = folder_with("in.off", &three_holes());
        let run = folder.run(&format!(
            "fill in.off -o out.off --method {method} --report r.json"
        ));
        assert_eq!(run.status, 0, "{method}: {}", run.stderr);
        let used = folder.json("r.json");
        assert_eq!(column(&used, "method"), [method; 3]);
        assert_eq!(
            numbers(&used, "new_vertices").iter().all(|&n| n == 0),
            method == "flat"
        );
    }
}

#[test]
fn the_report_says_what_happened_to_each_hole() {
    let mesh = three_holes();
    let folder = folder_with("in.off", &mesh);
    let run =
        folder.run("fill in.off -o out.off --report r.json --threads 2 --seed 7 --max-edges 9");
    assert_eq!(run.status, 0, "{}", run.stderr);
    let report = folder.json("r.json");
    assert_eq!(report["input"]["vertices"], mesh.positions.len());
    assert_eq!(report["input"]["triangles"], mesh.triangles.len());
    assert_eq!(report["threads"], 2);
    assert_eq!(report["seed"], 7);
    for key in ["read", "build", "fill", "write"] {
        assert!(report["seconds"][key].as_f64().unwrap() >= 0.0, "{key}");
    }
    assert_eq!(numbers(&report, "id"), [0, 1, 2]);
    assert_eq!(numbers(&report, "edges"), [6, 8, 10]);
    assert_eq!(column(&report, "status"), ["filled", "filled", "kept"]);
    assert_eq!(column(&report, "class"), ["simple"; 3]);
    for key in ["vertices", "triangles"] {
        let new: u64 = numbers(&report, &format!("new_{key}")).iter().sum();
        let grown =
            report["output"][key].as_u64().unwrap() - report["input"][key].as_u64().unwrap();
        assert_eq!(new, grown, "{key}");
    }
    let hole = &report["holes"][0];
    assert!(hole["perimeter"].as_f64().unwrap() > 0.0);
    assert!(hole["min_angle_deg"].as_f64().unwrap() > 1.0);
    assert!(hole["seconds"].as_f64().unwrap() >= 0.0);
    assert_eq!(hole["tried"], serde_json::json!([]));
    assert_eq!(hole["self_intersections"], 0);
    let edge: Vec<u32> = serde_json::from_value(hole["edge"].clone()).unwrap();
    assert!(
        mesh.triangles
            .iter()
            .any(|t| (0..3).any(|k| [t[k], t[(k + 1) % 3]] == edge[..]))
    );
    let kept = &report["holes"][2];
    assert_eq!(
        (&kept["method"], &kept["min_angle_deg"]),
        (&Value::Null, &Value::Null)
    );
    assert_ne!(kept["reason"], "");
}

#[test]
fn a_closed_mesh_is_written_as_it_is() {
    let folder = folder_with("in.off", &torus());
    let run = folder.run("fill in.off -o out.off --report r.json --preview p.png");
    assert_eq!(
        (run.status, run.stdout.as_str()),
        (0, "no holes\n"),
        "{}",
        run.stderr
    );
    let filled = Mesh::from_off(&fs::read_to_string(folder.path("out.off")).unwrap());
    assert_starts_with(&filled, &torus());
    assert_eq!(folder.json("r.json")["holes"], serde_json::json!([]));
    assert_eq!(folder.names(), ["in.off", "out.off", "p.png", "r.json"]);
}

#[test]
fn quiet_says_nothing_but_errors() {
    let folder = folder_with("in.off", &three_holes());
    let run = folder.run("fill in.off -o out.off --quiet");
    assert_eq!(
        (run.status, run.stdout.as_str(), run.stderr.as_str()),
        (0, "", "")
    );
    let run = folder.run("fill missing.off -o out.off --quiet");
    assert_eq!(run.status, 1);
    assert_is_message(&run);
}

#[test]
fn no_progress_bar_is_drawn_where_nobody_watches() {
    let folder = folder_with("in.off", &three_holes());
    assert_eq!(folder.run("fill in.off -o out.off").stderr, "");
}

#[test]
fn a_fill_in_place_replaces_the_input() {
    let mesh = three_holes();
    let folder = folder_with("in.off", &mesh);
    assert_eq!(folder.run("fill in.off -o in.off").status, 0);
    let filled = Mesh::from_off(&fs::read_to_string(folder.path("in.off")).unwrap());
    assert_starts_with(&filled, &mesh);
    assert_eq!(folder.names(), ["in.off"]);
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads_or_the_run() {
    let folder = folder_with("in.off", &three_holes());
    let outputs: Vec<Vec<u8>> = [1, 1, 2, 7]
        .map(|threads| {
            let run = folder.run(&format!("fill in.off -o out.ply --threads {threads}"));
            assert_eq!(run.status, 0, "{}", run.stderr);
            fs::read(folder.path("out.ply")).unwrap()
        })
        .to_vec();
    assert!(outputs.iter().all(|o| *o == outputs[0]));
}

#[test]
fn doubles_and_extra_properties_survive() {
    let folder = Folder::new();
    let mut text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n\
        property double z\nproperty float heat\nelement face 3\n\
        property list uchar int vertex_indices\nproperty uchar part\nend_header\n"
            .to_owned();
    text.push_str("0.1 0 0 1\n1 0.2 0 2\n0 1 0.30000000000000004 3\n0 0 1 4\n");
    text.push_str("3 0 1 3 7\n3 1 2 3 8\n3 2 0 3 9\n");
    folder.file("in.ply", text);
    let run = folder.run("fill in.ply -o out.ply --method flat");
    assert_eq!(run.status, 0, "{}", run.stderr);
    let bytes = fs::read(folder.path("out.ply")).unwrap();
    let output = String::from_utf8_lossy(&bytes);
    for line in [
        "property double x",
        "property float heat",
        "property uchar part",
        "element face 4",
    ] {
        assert!(output.contains(line), "{line}: {output}");
    }
    assert!(output.contains("0.30000000000000004"), "{output}");
}

// Which holes are filled

#[test]
fn rules_choose_the_holes() {
    let mesh = three_holes();
    let folder = folder_with("in.off", &mesh);
    let loops = loops_of(&folder, "in.off");
    let edge = |id: usize| format!("{},{}", loops[id]["edge"][0], loops[id]["edge"][1]);
    let perimeter = |id: usize| loops[id]["perimeter"].as_f64().unwrap();
    let between = (perimeter(0) + perimeter(1)) / 2.0;
    let largest = (0..3)
        .max_by(|&i, &j| perimeter(i).total_cmp(&perimeter(j)))
        .unwrap();
    assert!(
        perimeter(0) < perimeter(1),
        "the limit below is between them"
    );
    for (rules, filled) in [
        (String::new(), vec![0, 1, 2]),
        (format!("--keep {}", edge(1)), vec![0, 2]),
        (format!("--keep {} --keep {}", edge(1), edge(0)), vec![2]),
        (format!("--loop {}", edge(1)), vec![1]),
        (format!("--loop {} --loop {}", edge(2), edge(1)), vec![1, 2]),
        (format!("--loop {} --keep {}", edge(1), edge(1)), vec![]),
        (format!("--loop {} --max-edges 7", edge(1)), vec![]),
        ("--max-edges 8".to_owned(), vec![0, 1]),
        ("--max-edges 0".to_owned(), vec![]),
        (format!("--max-perimeter {}", perimeter(0)), vec![0]),
        ("--max-perimeter 0".to_owned(), vec![]),
        (
            "--keep-largest 1".to_owned(),
            (0..3).filter(|&i| i != largest).collect(),
        ),
        ("--keep-largest 99".to_owned(), vec![]),
        (format!("--max-perimeter {between} --max-edges 99"), {
            (0..3).filter(|&i| perimeter(i) <= between).collect()
        }),
    ] {
        let run = folder.run(&format!("fill in.off -o out.off --report r.json {rules}"));
        assert_eq!(run.status, 0, "{rules}: {}", run.stderr);
        let report = folder.json("r.json");
        let status = column(&report, "status");
        let is_filled = |i: usize| {
            if filled.contains(&i) {
                "filled"
            } else {
                "kept"
            }
        };
        assert_eq!(status, [0, 1, 2].map(is_filled), "{rules}");
        assert_eq!(
            loops_of(&folder, "out.off").len(),
            3 - filled.len(),
            "{rules}"
        );
    }
}

// Bad usage: status 2, nothing written

#[test]
fn bad_usage_is_told_before_anything_is_read_or_written() {
    let folder = Folder::new();
    for (line, word) in [
        ("", "Usage"),
        ("fill", "required"),
        ("fill in.off", "--output"),
        ("fill in.off -o out.xyz", "extension"),
        ("fill in.off -o out.off --method best", "fair-c2"),
        (
            "fill in.off -o out.off --set refine.densty=1",
            "refine.density",
        ),
        (
            "fill in.off -o out.off --set refine.density=0",
            "from 0.1 to 100",
        ),
        ("fill in.off -o out.off --set refine.density", "KEY=VALUE"),
        ("fill in.off -o out.off --keep 1", "comma"),
        ("fill in.off -o out.off --loop a,b", "comma"),
        ("fill in.off -o out.off --max-edges -1", "--max-edges"),
        ("fill in.off -o out.off --max-perimeter -1", "perimeter"),
        ("fill in.off -o out.off --max-perimeter NaN", "perimeter"),
        ("fill in.off -o out.off --threads many", "--threads"),
        ("fill in.off -o out.off --threads 2000", "1024"),
        ("fill in.off -o out.off --seed -3", "--seed"),
        ("fill in.off -o out.off --unknown", "--unknown"),
        ("fill in.off -o out.off --report in.off", "overwrite"),
        ("fill in.off -o out.off --report out.off", "overwrite"),
        (
            "fill in.off -o out.off --preview a.png --report a.png",
            "overwrite",
        ),
        ("inspect", "required"),
        ("compare a.off", "required"),
        ("mend in.off", "mend"),
    ] {
        let run = folder.run(line);
        assert_eq!(run.status, 2, "{line}: {}", run.stderr);
        assert_eq!(run.stdout, "", "{line}");
        assert!(run.stderr.contains(word), "{line}: {}", run.stderr);
        assert!(
            line.is_empty() || run.stderr.starts_with("holefill: "),
            "{}",
            run.stderr
        );
        assert!(folder.names().is_empty(), "{line}");
    }
}

#[test]
fn an_edge_that_is_on_no_loop_is_bad_usage() {
    let folder = folder_with("in.off", &three_holes());
    let loops = loops_of(&folder, "in.off");
    let (from, to) = (&loops[0]["edge"][0], &loops[0]["edge"][1]);
    for option in ["--keep", "--loop"] {
        for (edge, word) in [
            ("0,1".to_owned(), "no boundary edge"),
            ("4000000000,1".to_owned(), "no boundary edge"),
            (format!("{to},{from}"), "runs from"),
        ] {
            let run = folder.run(&format!("fill in.off -o out.off {option} {edge}"));
            assert_eq!(run.status, 2, "{option} {edge}: {}", run.stderr);
            assert_is_message(&run);
            assert!(run.stderr.contains(word), "{}", run.stderr);
            assert_eq!(folder.names(), ["in.off"]);
        }
    }
}

// Files that cannot be read or written: status 1

const PLY_HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
    property float y\nproperty float z\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n";

#[test]
fn input_that_is_no_mesh_is_refused_and_existing_output_stays() {
    let ply = |body: &str| format!("{PLY_HEADER}{body}").into_bytes();
    let binary = PLY_HEADER.replace("ascii", "binary_little_endian");
    for (name, content) in [
        ("empty.ply", Vec::new()),
        ("empty.off", Vec::new()),
        ("empty.obj", Vec::new()),
        ("empty.stl", Vec::new()),
        ("header.ply", PLY_HEADER.into()),
        ("half-header.ply", PLY_HEADER[..60].into()),
        ("truncated.ply", ply("0 0 0\n1 0 0\n")),
        (
            "truncated-binary.ply",
            [binary.as_bytes(), &[0; 20]].concat(),
        ),
        ("no-number.ply", ply("0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n")),
        ("index.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")),
        ("negative.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")),
        ("nan.ply", ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")),
        ("infinite.ply", ply("0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n")),
        (
            "index.off",
            b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n".into(),
        ),
        ("noise.ply", (0..=255).collect()),
        ("noise.stl", (0..=255).collect()),
        ("image.ply", b"\x89PNG\r\n\x1a\n".into()),
        (
            "huge.ply",
            PLY_HEADER
                .replace("vertex 3", "vertex 99999999999999")
                .into_bytes(),
        ),
    ] {
        let folder = Folder::new();
        folder.file(name, &content);
        folder.file("out.off", "old");
        let run = folder.run(&format!("fill {name} -o out.off --report r.json"));
        assert_eq!(run.status, 1, "{name}: {}", run.stderr);
        assert_is_message(&run);
        assert!(run.stderr.contains(name), "{name}: {}", run.stderr);
        assert_eq!(fs::read(folder.path("out.off")).unwrap(), b"old");
        assert_eq!(fs::read(folder.path(name)).unwrap(), content);
        assert_eq!(folder.names().len(), 2, "{name}");
        let run = folder.run(&format!("inspect {name}"));
        assert_eq!(run.status, 1, "{name}: {}", run.stderr);
        assert_is_message(&run);
    }
}

#[test]
fn input_that_does_not_exist_is_named() {
    let folder = Folder::new();
    for line in [
        "fill gone.ply -o out.ply",
        "inspect gone.ply",
        "compare gone.ply gone.ply",
        "inspect gone.xyz",
    ] {
        let run = folder.run(line);
        assert_eq!(run.status, 1, "{line}: {}", run.stderr);
        assert_is_message(&run);
        assert!(run.stderr.contains("gone"), "{}", run.stderr);
    }
    let run = holefill(["inspect".as_ref(), folder.dir.path().as_os_str()]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(folder.names().is_empty());
}

#[test]
fn a_missing_folder_for_any_output_is_told_before_the_work() {
    let folder = folder_with("in.off", &three_holes());
    for line in [
        "fill in.off -o missing/out.off",
        "fill in.off -o out.off --report missing/r.json",
        "fill in.off -o out.off --preview missing/p.png",
    ] {
        let run = folder.run(line);
        assert_eq!(run.status, 1, "{line}: {}", run.stderr);
        assert_is_message(&run);
        assert!(run.stderr.contains("missing"), "{}", run.stderr);
        assert_eq!(folder.names(), ["in.off"], "{line}");
    }
    let taken = folder.path("taken.off");
    fs::create_dir(&taken).unwrap();
    assert_eq!(folder.run("fill in.off -o taken.off").status, 1);
    assert!(taken.is_dir());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_for_the_report_or_the_picture_is_an_error_and_the_mesh_is_written() {
    for option in ["--report", "--preview"] {
        let folder = folder_with("in.off", &three_holes());
        let run = folder.run(&format!("fill in.off -o out.off {option} /dev/full"));
        assert_eq!(run.status, 1, "{option}: {}", run.stderr);
        assert!(run.stderr.contains("/dev/full"), "{}", run.stderr);
        assert_eq!(folder.names(), ["in.off", "out.off"]);
    }
    use std::os::unix::fs::FileTypeExt;
    assert!(
        fs::metadata("/dev/full")
            .unwrap()
            .file_type()
            .is_char_device()
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let folder = folder_with("in.off", &three_holes());
    let mut command = Command::new(PROGRAM);
    command.arg("inspect").arg(folder.path("in.off"));
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = command.stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .starts_with("holefill: ")
    );
}

/// A file cannot grow past the limit that the shell sets, as if the disk were full.
#[cfg(unix)]
#[test]
fn output_that_does_not_fit_leaves_the_old_file_and_no_remains() {
    let folder = folder_with("in.off", &three_holes());
    folder.file("out.off", "old");
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" fill in.off -o out.off";
    let mut command = Command::new("sh");
    command
        .args(["-c", script, PROGRAM])
        .current_dir(folder.dir.path());
    let run = finish(command);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert_is_message(&run);
    assert!(run.stderr.contains("out.off"), "{}", run.stderr);
    assert_eq!(fs::read(folder.path("out.off")).unwrap(), b"old");
    assert_eq!(folder.names(), ["in.off", "out.off"]);
}

/// The same on a disk that is really full: a small file system in a mount namespace of its own.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_file_and_no_remains() {
    let folder = folder_with("in.off", &three_holes());
    fs::create_dir(folder.path("disk")).unwrap();
    let script = "mount -t tmpfs -o size=8k holefill disk || exit 77
        printf old > disk/out.off
        \"$0\" fill in.off -o disk/out.off
        status=$?
        printf '%s ' disk/* disk/.[!.]* \"$(cat disk/out.off)\"
        exit $status";
    let mut command = Command::new("unshare");
    command.args(["--mount", "--map-root-user", "sh", "-c", script, PROGRAM]);
    command.current_dir(folder.dir.path());
    let Ok(output) = command.output() else {
        eprintln!("SKIPPED: there is no unshare here");
        return;
    };
    let (stdout, stderr) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    if stderr.starts_with("unshare") || output.status.code() == Some(77) {
        eprintln!("SKIPPED: no file system can be mounted here: {stderr}");
        return;
    }
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(
        stderr.starts_with("holefill: ") && stderr.contains("out.off"),
        "{stderr}"
    );
    assert_eq!(stdout.trim(), "disk/out.off disk/.[!.]* old");
}

// Meshes that are hard: no panic, what was there stays, and a truthful status

/// Fills `mesh`; the statuses of its holes, after checking that the exit status agrees with them.
fn fill_hard(name: &str, mesh: &Mesh) -> Vec<String> {
    let folder = folder_with("in.off", mesh);
    let run = folder.run("fill in.off -o out.off --report r.json --preview p.png");
    let report = folder.json("r.json");
    let statuses: Vec<String> = column(&report, "status")
        .iter()
        .map(|&s| s.to_owned())
        .collect();
    let is_complete = statuses.iter().all(|s| s == "filled");
    assert_eq!(
        run.status,
        if is_complete { 0 } else { 3 },
        "{name}: {}",
        run.stderr
    );
    let filled = Mesh::from_off(&fs::read_to_string(folder.path("out.off")).unwrap());
    assert_starts_with(&filled, mesh);
    let mut faces: Vec<[u32; 3]> = filled.triangles[mesh.triangles.len()..].to_vec();
    faces.iter_mut().for_each(|t| t.sort_unstable());
    let is_proper = |t: &[u32; 3]| t[0] < t[1] && t[1] < t[2];
    assert!(
        faces.iter().all(is_proper),
        "{name}: a new triangle names a vertex twice"
    );
    if !is_complete {
        assert!(
            run.stderr.contains("could not be filled"),
            "{name}: {}",
            run.stderr
        );
        let failed = report["holes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|h| h["status"] == "failed");
        assert!(
            failed.clone().count() > 0 && failed.clone().all(|h| h["reason"] != ""),
            "{name}"
        );
    }
    statuses
}

fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh {
        positions: positions.to_vec(),
        triangles: triangles.to_vec(),
    }
}

const CORNERS: [[f64; 3]; 5] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
];

#[test]
fn a_moebius_strip_is_not_filled() {
    let n = 12;
    let mut strip = mesh(&[], &[]);
    for i in 0..n {
        let u = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        for side in [-0.3, 0.3] {
            let r = 1.0 + side * (u / 2.0).cos();
            strip
                .positions
                .push([r * u.cos(), r * u.sin(), side * (u / 2.0).sin()]);
        }
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 < n {
            [2 * i + 2, 2 * i + 3]
        } else {
            [1, 0]
        };
        strip.triangles.extend([[a, c, b], [b, c, d]]);
    }
    let statuses = fill_hard("moebius", &strip);
    assert!(
        !statuses.is_empty() && statuses.iter().all(|s| s == "failed"),
        "{statuses:?}"
    );
}

#[test]
fn a_single_triangle_cannot_be_closed_by_its_own_back() {
    assert_eq!(
        fill_hard("single", &mesh(&CORNERS[..3], &[[0, 1, 2]])),
        ["failed"]
    );
}

#[test]
fn vertices_in_one_place_give_no_surface() {
    let triangles = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 4, 1]];
    let statuses = fill_hard("one place", &mesh(&[[2.5; 3]; 5], &triangles));
    assert_eq!(statuses.len(), 1);
}

#[test]
fn irregular_meshes_are_kept_and_said_to_be_irregular() {
    let damaged = three_holes();
    let with = |extra: &[[u32; 3]]| {
        let mut mesh = damaged.clone();
        mesh.triangles.extend_from_slice(extra);
        mesh
    };
    let [a, b, c] = damaged.triangles[0];
    let mut alone = damaged.clone();
    alone.positions.push([9.0; 3]);
    for (name, mesh, words) in [
        (
            "repeated vertex",
            with(&[[5, 5, 6]]),
            "names a vertex twice",
        ),
        (
            "repeated thrice",
            with(&[[5, 5, 5]]),
            "names a vertex twice",
        ),
        (
            "three triangles at an edge",
            with(&[[a, b, 200]]),
            "more than two triangles",
        ),
        ("duplicate", with(&[[a, b, c]]), "duplicate"),
        ("turned duplicate", with(&[[a, c, b]]), "duplicate"),
        ("a vertex alone", alone, "without a triangle"),
    ] {
        let folder = folder_with("in.off", &mesh);
        let run = folder.run("fill in.off -o out.off");
        let note = run
            .stderr
            .lines()
            .find(|line| line.contains("twice") || line.contains(words));
        assert!(
            note.is_some_and(|n| n.starts_with("holefill: note: ")),
            "{name}: {}",
            run.stderr
        );
        let statuses = fill_hard(name, &mesh);
        assert!(
            statuses.iter().filter(|s| *s == "filled").count() >= 3,
            "{name}: {statuses:?}"
        );
    }
}

#[test]
fn small_and_odd_meshes_do_not_stop_the_program() {
    for (name, mesh) in [
        ("nothing", mesh(&[], &[])),
        ("no triangle", mesh(&CORNERS, &[])),
        ("only degenerate", mesh(&CORNERS, &[[0, 0, 1], [2, 2, 2]])),
        ("pillow", mesh(&CORNERS[..3], &[[0, 1, 2], [0, 2, 1]])),
        (
            "glued along two edges",
            mesh(&CORNERS[..4], &[[0, 1, 2], [2, 1, 3], [2, 3, 1]]),
        ),
        (
            "two edges",
            mesh(&CORNERS[..4], &[[0, 1, 2], [1, 0, 3], [0, 1, 3], [1, 0, 2]]),
        ),
        ("bow tie", mesh(&CORNERS, &[[0, 1, 2], [0, 3, 4]])),
        (
            "opposite neighbours",
            mesh(&CORNERS[..4], &[[0, 1, 2], [0, 1, 3]]),
        ),
        (
            "fan of three",
            mesh(&CORNERS, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]),
        ),
        (
            "needle",
            mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], &[[0, 1, 2]]),
        ),
        (
            "tiny",
            mesh(
                &CORNERS.map(|p| p.map(|x| x * 1e-300)),
                &[[0, 1, 3], [1, 2, 3], [2, 0, 3]],
            ),
        ),
        (
            "vast",
            mesh(
                &CORNERS.map(|p| p.map(|x| x * 1e300)),
                &[[0, 1, 3], [1, 2, 3], [2, 0, 3]],
            ),
        ),
    ] {
        fill_hard(name, &mesh);
        let folder = folder_with("in.off", &mesh);
        for line in ["inspect in.off", "inspect in.off --json"] {
            assert_eq!(folder.run(line).status, 0, "{name}");
        }
        assert!(
            [0, 1].contains(&folder.run("compare in.off in.off").status),
            "{name}"
        );
    }
}

// The other commands

#[test]
fn inspect_lists_the_loops() {
    let mesh = three_holes();
    let folder = folder_with("in.off", &mesh);
    let run = folder.run("inspect in.off");
    assert_eq!(run.status, 0, "{}", run.stderr);
    let rows: Vec<Vec<&str>> = run
        .stdout
        .lines()
        .map(|l| l.split_whitespace().collect())
        .collect();
    let headings = [
        "LOOP",
        "CLASS",
        "EDGES",
        "PERIMETER",
        "AREA",
        "PLANARITY",
        "EDGE",
    ];
    assert_eq!(rows[0], headings);
    assert_eq!(
        rows[1..].iter().map(|r| r[2]).collect::<Vec<_>>(),
        ["6", "8", "10"]
    );

    let run = folder.run("inspect in.off --json");
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(found["vertices"], mesh.positions.len());
    assert_eq!(found["triangles"], mesh.triangles.len());
    assert_eq!(found["defects"]["isolated_vertices"]["count"], 0);
    assert_eq!(found["defects"]["nonmanifold_edges"]["count"], 0);
    for key in ["read", "build", "loops"] {
        assert!(found["seconds"][key].as_f64().unwrap() >= 0.0);
    }
    let first = &found["loops"][0];
    assert_eq!((&first["id"], &first["edges"]), (&0.into(), &6.into()));
    assert_eq!(first["class"], "simple");
    for key in ["perimeter", "area", "planarity"] {
        assert!(first[key].as_f64().unwrap() > 0.0, "{key}");
    }
    assert_eq!(
        format!("{},{}", first["edge"][0], first["edge"][1]),
        rows[1][6]
    );
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = folder_with("in.off", &three_holes());
    for line in [
        "inspect in.off",
        "inspect in.off --json",
        "fill in.off -o out.off",
        "--help",
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = Command::new(PROGRAM);
        command
            .args(line.split_whitespace())
            .current_dir(folder.dir.path());
        command.stdout(writer).stderr(Stdio::piped());
        let output = command.spawn().unwrap().wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {stderr}");
        assert!(!stderr.contains("panicked"), "{line}: {stderr}");
    }
    assert!(folder.path("out.off").exists());
}

#[test]
fn compare_measures_the_distance() {
    let folder = folder_with("a.off", &torus());
    let mut moved = torus();
    moved.positions.iter_mut().for_each(|p| p[2] += 0.25);
    folder.file("b.off", moved.off());
    let json = |line: &str| -> Value { serde_json::from_str(&folder.run(line).stdout).unwrap() };
    let same = json("compare a.off a.off --json");
    assert!(same["hausdorff"].as_f64().unwrap() < 1e-9, "{same}");
    let apart = json("compare a.off b.off --json");
    let hausdorff = apart["hausdorff"].as_f64().unwrap();
    assert!((0.2..=0.25 + 1e-9).contains(&hausdorff), "{apart}");
    for key in ["a_to_b", "b_to_a"] {
        for measure in ["mean", "rms", "max"] {
            assert!(
                apart[key][measure].as_f64().unwrap() > 0.0,
                "{key} {measure}"
            );
        }
    }
    let run = folder.run("compare a.off b.off");
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert!(
        run.stdout.contains("A to B") && run.stdout.contains("B to A"),
        "{}",
        run.stdout
    );
    folder.file("none.off", mesh(&CORNERS, &[]).off());
    assert_eq!(folder.run("compare a.off none.off").status, 1);
}

#[test]
fn the_picture_is_a_png_of_the_documented_size() {
    let folder = folder_with("in.off", &three_holes());
    assert_eq!(
        folder.run("fill in.off -o out.off --preview p.png").status,
        0
    );
    let bytes = fs::read(folder.path("p.png")).unwrap();
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(
        bytes[16..24],
        [1600u32.to_be_bytes(), 800u32.to_be_bytes()].concat()
    );
}

#[test]
fn help_names_every_method_and_parameter_with_its_default() {
    let run = holefill(["fill", "--help"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    for method in holefill::Method::ALL {
        assert!(run.stdout.contains(method.summary()), "{method}");
    }
    let defaults = holefill::FillOptions::default();
    for parameter in holefill::FillOptions::parameters() {
        for text in [
            parameter.name(),
            parameter.help(),
            parameter.allowed(),
            &parameter.value(&defaults),
        ] {
            assert!(run.stdout.contains(text), "{text}");
        }
    }
    for command in ["fill", "inspect", "compare", "demo"] {
        let help = holefill([command, "--help"]).stdout;
        assert!(
            help.contains(&format!("Example: holefill {command}")),
            "{help}"
        );
    }
    let version = holefill(["--version"]).stdout;
    assert_eq!(version, format!("holefill {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn the_demo_writes_a_damaged_and_a_filled_model() {
    let folder = Folder::new();
    let dir = folder.path("new/demo");
    let run = holefill(["demo".as_ref(), dir.as_os_str()]);
    assert_eq!(run.status, 0, "{}\n{}", run.stdout, run.stderr);
    let path = |name: &str| -> PathBuf { Path::new(&dir).join(name) };
    for name in ["damaged.ply", "filled.ply", "preview.png", "report.json"] {
        assert!(path(name).is_file(), "{name}");
        assert!(
            run.stdout.contains(&path(name).display().to_string()),
            "{name}"
        );
    }
    let found = holefill([
        "inspect".as_ref(),
        path("filled.ply").as_os_str(),
        "--json".as_ref(),
    ]);
    let found: Value = serde_json::from_str(&found.stdout).unwrap();
    assert_eq!(found["loops"], serde_json::json!([]));
}
