//! The JSON forms of the tables.

use crate::table::area;
use holefill::{BoundaryLoop, FillReport, MeshDefects};
use serde_json::{Value, json};

/// Facts about a fill, without those about its holes.
pub(crate) struct FillFacts {
    /// Vertices and triangles of the input.
    pub(crate) input: [usize; 2],
    /// Vertices and triangles of the output.
    pub(crate) output: [usize; 2],
    /// Seconds to read the file.
    pub(crate) read_seconds: f64,
    /// Seconds to build the connectivity, the loops and the index.
    pub(crate) build_seconds: f64,
    /// Seconds to write the output.
    pub(crate) write_seconds: f64,
    /// Number of threads.
    pub(crate) threads: usize,
    /// The seed from the command line.
    pub(crate) seed: u64,
}

/// The report of `holefill fill --report`.
pub(crate) fn fill(facts: &FillFacts, report: &FillReport) -> String {
    let counts =
        |[vertices, triangles]: [usize; 2]| json!({"vertices": vertices, "triangles": triangles});
    pretty(&json!({
        "input": counts(facts.input),
        "output": counts(facts.output),
        "seconds": {
            "read": facts.read_seconds,
            "build": facts.build_seconds,
            "fill": report.fill_seconds,
            "write": facts.write_seconds,
        },
        "threads": facts.threads,
        "seed": facts.seed,
        "holes": report.holes,
    }))
}

/// A boundary loop as `holefill inspect --json` lists it.
pub(crate) fn boundary_loop(l: &BoundaryLoop) -> Value {
    json!({
        "id": l.id,
        "class": l.class.name(),
        "edges": l.edge_count(),
        "perimeter": l.perimeter,
        "area": area(l),
        "planarity": l.planarity,
        "edge": l.edge(),
    })
}

/// The number of defects of each kind, with the first examples.
pub(crate) fn defects(defects: &MeshDefects) -> Value {
    json!({
        "nonmanifold_edges": kind(defects.nonmanifold_edges.count, &defects.nonmanifold_edges.examples),
        "inconsistent_edges": kind(defects.inconsistent_edges.count, &defects.inconsistent_edges.examples),
        "degenerate_faces": kind(defects.degenerate_faces.count, &defects.degenerate_faces.examples),
        "duplicate_faces": kind(defects.duplicate_faces.count, &defects.duplicate_faces.examples),
        "isolated_vertices": kind(defects.isolated_vertices.count, &defects.isolated_vertices.examples),
    })
}

fn kind<T: Copy + Into<Value>>(count: usize, examples: &[T]) -> Value {
    let examples: Vec<Value> = examples.iter().map(|&place| place.into()).collect();
    json!({"count": count, "examples": examples})
}

/// JSON text that ends with a line break.
pub(crate) fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
