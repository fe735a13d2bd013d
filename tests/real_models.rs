//! Real and made-up models with known holes, if they are there: every folder in `../shared/data/cases`.
//!
//! Each holds `input.ply` and `meta.json`, whose `keep_loops` stay open and whose `fill_loops` are to be
//! closed. What is judged here needs no original surface; `compare/` measures against that.

use holefill::{
    BoundaryLoops, FillOptions, HoleStatus, Method, Selection, TriMesh, fill_holes, io,
};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The folders of the cases, in order; `None` when there are none on this machine.
fn cases() -> Option<Vec<PathBuf>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases");
    let mut found: Vec<PathBuf> = fs::read_dir(folder)
        .ok()?
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("input.ply").is_file())
        .collect();
    found.sort();
    Some(found)
}

fn edges(meta: &Value, key: &str) -> Vec<[u32; 2]> {
    let loops = meta[key].as_array().expect("a list of loops");
    loops
        .iter()
        .map(|l| {
            let vertex = |k: usize| u32::try_from(l["edge"][k].as_u64().unwrap()).unwrap();
            [vertex(0), vertex(1)]
        })
        .collect()
}

fn bits(positions: &[[f64; 3]]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.map(f64::to_bits)).collect()
}

/// Fills the case and says what happened.
fn run(case: &Path) -> String {
    let name = case.file_name().unwrap().to_string_lossy();
    let meta: Value = serde_json::from_slice(&fs::read(case.join("meta.json")).unwrap()).unwrap();
    let file = io::read(case.join("input.ply")).unwrap();
    let mut mesh = TriMesh::with_attributes(
        file.positions.clone(),
        file.triangles.clone(),
        file.vertex_attributes,
        file.face_attributes,
    )
    .unwrap();
    let boundary = BoundaryLoops::find(&mesh);
    let (keep, fill) = (edges(&meta, "keep_loops"), edges(&meta, "fill_loops"));
    let selection = Selection {
        keep: keep.clone(),
        ..Selection::default()
    };
    let mut options = FillOptions::default();
    options.method = Method::FairC1;
    let start = Instant::now();
    let report = fill_holes(&mut mesh, &boundary, &selection, &options, None).unwrap();
    let seconds = start.elapsed().as_secs_f64();

    let (vertices, triangles) = (file.positions.len(), file.triangles.len());
    assert_eq!(
        bits(&mesh.positions()[..vertices]),
        bits(&file.positions),
        "{name}"
    );
    assert_eq!(mesh.triangles()[..triangles], file.triangles, "{name}");
    let left = BoundaryLoops::find(&mesh);
    for edge in keep {
        assert!(
            left.with_edge(edge).is_some(),
            "{name}: {edge:?} was to stay open"
        );
    }
    for edge in fill {
        let id = boundary.with_edge(edge).expect("a boundary edge").id;
        let is_filled = report.holes[id].status == HoleStatus::Filled;
        assert_eq!(
            left.with_edge(edge).is_none(),
            is_filled,
            "{name}: {edge:?}"
        );
        if !is_filled {
            assert!(!report.holes[id].reason.is_empty(), "{name}: {edge:?}");
        }
    }
    let [filled, kept, failed] = [HoleStatus::Filled, HoleStatus::Kept, HoleStatus::Failed]
        .map(|status| report.count(status));
    assert_eq!(filled + kept + failed, report.holes.len(), "{name}");
    let intersections: usize = report.holes.iter().map(|h| h.self_intersections).sum();
    format!(
        "real model {name}: {filled} holes filled, {kept} kept, {failed} failed, \
         {intersections} intersections reported, {seconds:.2} s"
    )
}

#[test]
fn real_models_keep_what_they_have_and_get_what_is_reported() {
    let Some(cases) = cases() else {
        eprintln!("SKIPPED: the real models: there is no ../shared/data/cases");
        return;
    };
    assert!(!cases.is_empty(), "../shared/data/cases has no case in it");
    for case in &cases {
        println!("{}", run(case));
    }
    println!("real models that ran: {}", cases.len());
}
