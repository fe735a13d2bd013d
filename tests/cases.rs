//! Fills the holes of real and published models by every method, where the models are at hand.
//!
//! They are looked for in the folder named by the environment variable `HOLEFILL_CASES`, else in
//! `../shared/data/cases` beside this package. Each case is a folder with `input.ply` and `meta.json`,
//! whose `keep_loops` lists the loops that stay open.

use holefill::io::{self, MeshData};
use holefill::{BoundaryLoops, FillOptions, HoleStatus, Method, Selection, TriMesh, fill_holes};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

const METHODS: [Method; 6] = [
    Method::Flat,
    Method::Membrane,
    Method::FairC1,
    Method::FairC2,
    Method::Hpde,
    Method::Mls,
];

/// Cases in which a method may leave intersections of a patch, of those whose own truth has none.
const CASES_WITH_INTERSECTIONS: usize = 3;

/// No case may take longer, in seconds.
const LONGEST: f64 = 60.0;

struct Case {
    name: String,
    folder: PathBuf,
    keep: Vec<[u32; 2]>,
    /// Intersections of the true surface itself.
    truth: u64,
}

/// What is remembered of one fill.
struct Outcome {
    line: String,
    intersections: usize,
    errors: Vec<String>,
}

fn folder() -> PathBuf {
    match std::env::var_os("HOLEFILL_CASES") {
        Some(folder) => folder.into(),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases"),
    }
}

fn find_cases() -> Vec<Case> {
    let Ok(entries) = fs::read_dir(folder()) else {
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    folders.retain(|f| f.join("input.ply").is_file());
    folders.sort();
    folders.into_iter().map(read_case).collect()
}

fn read_case(folder: PathBuf) -> Case {
    let text = fs::read_to_string(folder.join("meta.json")).unwrap();
    let meta: Value = serde_json::from_str(&text).unwrap();
    let vertex = |v: &Value| u32::try_from(v.as_u64().unwrap()).unwrap();
    let edge = |l: &Value| [vertex(&l["edge"][0]), vertex(&l["edge"][1])];
    let keep = meta["keep_loops"].as_array().unwrap().iter().map(edge);
    let truth = meta["truth_selfint"].as_array();
    Case {
        name: folder.file_name().unwrap().to_string_lossy().into_owned(),
        keep: keep.collect(),
        truth: truth.map_or(0, |pairs| pairs.iter().filter_map(Value::as_u64).sum()),
        folder,
    }
}

fn bits(positions: &[[f64; 3]]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.map(f64::to_bits)).collect()
}

/// Fills one case by one method and checks what must hold.
fn run(case: &Case, data: &MeshData, method: Method) -> Outcome {
    let start = Instant::now();
    let before = TriMesh::with_attributes(
        data.positions.clone(),
        data.triangles.clone(),
        data.vertex_attributes.clone(),
        data.face_attributes.clone(),
    )
    .unwrap();
    let boundary = BoundaryLoops::find(&before);
    let selection = Selection {
        keep: case.keep.clone(),
        ..Selection::default()
    };
    let mut options = FillOptions::default();
    options.method = method;
    options.threads = 1;
    let mut mesh = before.clone();
    let report = fill_holes(&mut mesh, &boundary, &selection, &options, None).unwrap();
    let seconds = start.elapsed().as_secs_f64();

    let mut errors = Vec::new();
    let mut check = |holds: bool, what: &str| {
        if !holds {
            errors.push(format!("{} by {method}: {what}", case.name));
        }
    };
    let (n, f) = (before.positions().len(), before.triangles().len());
    check(
        bits(&mesh.positions()[..n]) == bits(before.positions()),
        "vertices changed",
    );
    check(
        &mesh.triangles()[..f] == before.triangles(),
        "triangles changed",
    );
    check(
        report.count(HoleStatus::Kept) == case.keep.len(),
        "a loop to keep was not kept",
    );
    check(
        report.count(HoleStatus::Cancelled) == 0,
        "a loop was cancelled",
    );
    for hole in &report.holes {
        let is_explained = hole.status != HoleStatus::Failed || !hole.reason.is_empty();
        check(
            is_explained,
            &format!("loop {} failed without a reason", hole.id),
        );
    }
    // Built anew from the arrays: exactly the loops that were not filled are open.
    let (positions, triangles, ..) = mesh.into_parts();
    let rebuilt = TriMesh::new(positions, triangles).unwrap();
    let mut open: Vec<[u32; 2]> = BoundaryLoops::find(&rebuilt)
        .loops
        .iter()
        .map(|l| l.edge())
        .collect();
    let mut expected: Vec<[u32; 2]> = report
        .holes
        .iter()
        .filter(|h| h.status != HoleStatus::Filled)
        .map(|h| h.edge)
        .collect();
    open.sort_unstable();
    expected.sort_unstable();
    check(
        open == expected,
        "other loops are open than the report says",
    );
    check(
        rebuilt.defects() == before.defects(),
        "the filled mesh has new defects",
    );
    check(seconds < LONGEST, &format!("took {seconds:.1} s"));

    let intersections = report.holes.iter().map(|h| h.self_intersections).sum();
    let line = format!(
        "{:24} {method:9} {:4} filled {:3} kept {:3} failed {:7} new triangles {intersections:4} intersections {seconds:6.2} s",
        case.name,
        report.count(HoleStatus::Filled),
        report.count(HoleStatus::Kept),
        report.count(HoleStatus::Failed),
        rebuilt.triangles().len() - f,
    );
    Outcome {
        line,
        intersections,
        errors,
    }
}

/// Says it past the test harness, which shows the output of failed tests only.
fn say(line: &str) {
    let mut out = std::io::stderr();
    writeln!(out, "{line}").unwrap();
}

#[test]
fn every_case_is_filled_by_every_method() {
    let cases = find_cases();
    if cases.is_empty() {
        say("CASES: skipped, no data");
        say(&format!(
            "SKIPPED: the real models: {} has none",
            folder().display()
        ));
        return;
    }
    let next = AtomicUsize::new(0);
    let outcomes: Vec<Mutex<Vec<Outcome>>> = cases.iter().map(|_| Mutex::default()).collect();
    let work = || {
        while let Some(i) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&i| i < cases.len())
        {
            let data = io::read(cases[i].folder.join("input.ply")).unwrap();
            let done = METHODS.iter().map(|&method| run(&cases[i], &data, method));
            *outcomes[i].lock().unwrap() = done.collect();
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let outcomes: Vec<Vec<Outcome>> = outcomes
        .into_iter()
        .map(|o| o.into_inner().unwrap())
        .collect();
    outcomes.iter().flatten().for_each(|o| say(&o.line));
    for (m, method) in METHODS.iter().enumerate() {
        let intersecting: Vec<&str> = cases
            .iter()
            .zip(&outcomes)
            .filter(|(case, of_case)| case.truth == 0 && of_case[m].intersections > 0)
            .map(|(case, _)| case.name.as_str())
            .collect();
        say(&format!(
            "{method}: intersections remain in {intersecting:?}"
        ));
        assert!(
            intersecting.len() <= CASES_WITH_INTERSECTIONS,
            "{method}: {intersecting:?}"
        );
    }
    say(&format!("CASES: ran {}", cases.len()));
    let errors: Vec<&String> = outcomes.iter().flatten().flat_map(|o| &o.errors).collect();
    assert!(errors.is_empty(), "{errors:#?}");
}
