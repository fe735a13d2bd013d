//! What `auto` makes of real models does not depend on where they lie, how large they are, and how their vertices
//! and triangles are numbered.
//!
//! The models are those of `cases`, the smaller ones; without them the test says that it was left out.

mod common;

use common::meshes::{Arrays, Point, norm, sub};
use holefill::{BoundaryLoops, Candidate, FillOptions, FillReport, Selection, TriMesh, fill_holes};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Models with more triangles than this, or more rim edges, are left to the other tests.
const MOST_TRIANGLES: usize = 150_000;
const MOST_RIM_EDGES: usize = 200;

/// Longest distance of a new vertex from where it was, over the diameter of the rims.
const SAME: f64 = 1e-6;

/// A model is one of those that do not change if none of these does it.
const MOVES: [(&str, f64, f64, f64); 5] = [
    // Scale, angle, offset in diameters.
    ("turned", 1.0, 1.0, 0.0),
    ("small", 1e-4, 0.0, 0.0),
    ("large", 1e4, 0.0, 0.0),
    ("far away", 1.0, 0.0, 1e4),
    ("all of it", 1e-4, 2.5, 1e4),
];
const SHUFFLES: u64 = 2;

/// So many models, at least, must be the same in every way.
const FEWEST: usize = 25;

struct Model {
    name: String,
    arrays: Arrays,
    /// Ends of an edge of each loop that stays open.
    keep: Vec<[Point; 2]>,
}

fn folder() -> PathBuf {
    match std::env::var_os("HOLEFILL_CASES") {
        Some(folder) => folder.into(),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases"),
    }
}

fn models() -> Vec<Model> {
    let Ok(entries) = fs::read_dir(folder()) else {
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    folders.retain(|f| f.join("input.ply").is_file());
    folders.sort();
    folders.iter().filter_map(|f| read(f)).collect()
}

fn read(folder: &Path) -> Option<Model> {
    let text = fs::read_to_string(folder.join("meta.json")).unwrap();
    let meta: Value = serde_json::from_str(&text).unwrap();
    let data = holefill::io::read(folder.join("input.ply")).unwrap();
    let list = |key: &str| meta[key].as_array().unwrap().clone();
    let edges = list("fill_loops")
        .iter()
        .map(|l| l["n_edges"].as_u64().unwrap())
        .sum::<u64>();
    if data.triangles.len() > MOST_TRIANGLES || edges as usize > MOST_RIM_EDGES {
        return None;
    }
    let end = |v: &Value| data.positions[v.as_u64().unwrap() as usize];
    let keep = list("keep_loops")
        .iter()
        .map(|l| [end(&l["edge"][0]), end(&l["edge"][1])])
        .collect();
    Some(Model {
        name: folder.file_name().unwrap().to_string_lossy().into_owned(),
        arrays: Arrays::new(data.positions.clone(), data.triangles.clone()),
        keep,
    })
}

/// New vertices, and the surface chosen for each hole in the order of these.
struct Filled {
    points: Vec<Point>,
    chosen: Vec<Option<Candidate>>,
}

fn fill(arrays: &Arrays, keep: &[[Point; 2]]) -> Filled {
    let mut mesh = TriMesh::new(arrays.positions.clone(), arrays.triangles.clone()).unwrap();
    let boundary = BoundaryLoops::find(&mesh);
    let number = |p: &Point| arrays.positions.iter().position(|q| q == p).unwrap() as u32;
    let selection = Selection {
        keep: keep
            .iter()
            .map(|edge| [number(&edge[0]), number(&edge[1])])
            .collect(),
        ..Selection::default()
    };
    let options = FillOptions::default();
    let report: FillReport = fill_holes(&mut mesh, &boundary, &selection, &options, None).unwrap();
    let mut chosen: Vec<(String, Option<Candidate>)> = report
        .holes
        .iter()
        .map(|h| h.prediction.as_ref().map(|p| p.chosen))
        .map(|c| (c.map_or(String::new(), |c| c.name().to_owned()), c))
        .collect();
    // The order of the loops follows the numbers of the vertices.
    chosen.sort_by(|a, b| a.0.cmp(&b.0));
    Filled {
        points: mesh.positions()[arrays.positions.len()..].to_vec(),
        chosen: chosen.into_iter().map(|c| c.1).collect(),
    }
}

fn extent(points: &[Point]) -> f64 {
    let span = |k: usize| {
        let values = points.iter().map(|p| p[k]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    norm([span(0), span(1), span(2)])
}

/// The farthest of `points` from its nearest among `others`.
fn farthest(points: &[Point], others: &[Point]) -> f64 {
    let nearest = |p: &Point| {
        others
            .iter()
            .map(|q| norm(sub(*p, *q)))
            .fold(f64::INFINITY, f64::min)
    };
    points.iter().map(nearest).fold(0.0, f64::max)
}

/// What changes a model, if anything does.
fn changes(model: &Model) -> Vec<String> {
    let original = fill(&model.arrays, &model.keep);
    let rims = extent(&original.points);
    let mut found = Vec::new();
    let mut compare =
        |what: &str, arrays: &Arrays, keep: &[[Point; 2]], expected: &[Point], scale: f64| {
            let filled = fill(arrays, keep);
            if filled.chosen != original.chosen {
                found.push(format!("{what}: another surface"));
            }
            let off = farthest(&filled.points, expected).max(farthest(expected, &filled.points));
            let off = off / (scale * rims);
            if off > SAME {
                found.push(format!("{what}: {off:.1e}"));
            }
        };
    for (what, scale, angle, diameters) in MOVES {
        let at = diameters * scale * extent(&model.arrays.positions);
        let offset = [at, -0.7 * at, 0.4 * at];
        let moved = |points: Vec<Point>| {
            Arrays::new(points, Vec::new())
                .moved(scale, angle, offset)
                .positions
        };
        let arrays = model.arrays.moved(scale, angle, offset);
        let keep: Vec<[Point; 2]> = model
            .keep
            .iter()
            .map(|edge| {
                let ends = moved(edge.to_vec());
                [ends[0], ends[1]]
            })
            .collect();
        compare(what, &arrays, &keep, &moved(original.points.clone()), scale);
    }
    for seed in 0..SHUFFLES {
        let arrays = model.arrays.shuffled(seed);
        compare("renumbered", &arrays, &model.keep, &original.points, 1.0);
    }
    found
}

#[test]
fn place_size_and_numbers_change_no_patch() {
    let models = models();
    if models.is_empty() {
        println!(
            "SKIPPED: invariance on real models: there are none in {}",
            folder().display()
        );
        return;
    }
    let mut same = 0;
    for model in &models {
        let found = changes(model);
        same += usize::from(found.is_empty());
        println!(
            "{}: {}",
            model.name,
            if found.is_empty() {
                "same".into()
            } else {
                found.join(", ")
            }
        );
    }
    println!("INVARIANCE: {same} of {} models", models.len());
    assert!(same >= FEWEST, "only {same} of {} models", models.len());
}
