//! Meshes from the points of real models, where they are at hand.
#![allow(clippy::print_stderr)] // A skipped test says so.

mod common;

use common::edges::is_oriented_manifold;
use common::meshes::{self, Arrays};
use holefill::io::{self, MeshData};
use holefill::{
    BoundaryLoops, FillOptions, HoleStatus, PointCloud, PointOptions, Selection, TriMesh,
    fill_holes, mesh_from_points,
};
use std::path::{Path, PathBuf};

fn cases() -> PathBuf {
    match std::env::var_os("HOLEFILL_CASES") {
        Some(folder) => folder.into(),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases"),
    }
}

/// Reconstructs the points of a case, moved by up to `noise` times the spacing, and fills all holes but the
/// `keep` largest.
fn reconstruct_and_fill(data: &MeshData, noise: f64, keep: usize) -> (TriMesh, usize) {
    let spacing = |t: &[u32; 3]| {
        let [a, b] = [t[0], t[1]].map(|v| data.positions[v as usize]);
        meshes::norm(meshes::sub(a, b))
    };
    let mean = data.triangles.iter().map(spacing).sum::<f64>() / data.triangles.len() as f64;
    let arrays = Arrays::new(data.positions.clone(), Vec::new()).jittered(noise * mean, 1);
    let cloud = PointCloud::new(arrays.positions);
    let (mut mesh, report) = mesh_from_points(cloud, &PointOptions::default(), None).unwrap();
    assert!(is_oriented_manifold(mesh.triangles()));
    assert!(report.used * 100 >= report.points * 99, "{report:?}");
    assert_eq!(report.pieces, 1);
    let boundary = BoundaryLoops::find(&mesh);
    let selection = Selection {
        keep_largest: keep,
        ..Selection::default()
    };
    let options = FillOptions::default();
    let filled = fill_holes(&mut mesh, &boundary, &selection, &options, None).unwrap();
    assert_eq!(filled.count(HoleStatus::Failed), 0);
    assert!(is_oriented_manifold(mesh.triangles()));
    (mesh, boundary.loops.len())
}

#[test]
fn the_points_of_real_models_are_reconstructed_and_filled() {
    // Loops to keep open, and how many loops there may be.
    for (name, keep, loops) in [
        ("bunny_natural", 0, 5..=9),
        ("mls_cap30", 0, 1..=1),
        ("cylinder_side", 2, 3..=3),
    ] {
        let input = cases().join(name).join("input.ply");
        if !input.is_file() {
            eprintln!("SKIPPED: the points of {name}, which are not at hand");
            continue;
        }
        let data = io::read(input).unwrap();
        for noise in [0.0, 0.01] {
            let (mesh, found) = reconstruct_and_fill(&data, noise, keep);
            assert!(loops.contains(&found), "{name} has {found} loops");
            let open = BoundaryLoops::find(&mesh).loops.len();
            assert_eq!(open, keep, "{name}");
        }
    }
}
