//! What do the passes over the whole mesh (connectivity, loops, index) cost per triangle?

mod common;

use common::sheet;
use divan::Bencher;
use divan::counter::ItemsCount;
use holefill::{BoundaryLoops, FillSession, TriMesh};

/// Quads a side: about 10,000, 100,000 and 1,000,000 triangles.
const SIZES: [usize; 3] = [71, 224, 708];

fn main() {
    divan::main();
}

fn triangles(mesh: &TriMesh) -> ItemsCount {
    ItemsCount::new(mesh.triangles().len())
}

#[divan::bench(args = SIZES, sample_count = 5, sample_size = 1)]
fn connectivity(bencher: Bencher, size: usize) {
    let mesh = sheet(size, 20..24);
    let count = triangles(&mesh);
    bencher
        .counter(count)
        .with_inputs(|| (mesh.positions().to_vec(), mesh.triangles().to_vec()))
        .bench_values(|(positions, triangles)| TriMesh::new(positions, triangles));
}

#[divan::bench(args = SIZES, sample_count = 5, sample_size = 1)]
fn loops(bencher: Bencher, size: usize) {
    let mesh = sheet(size, 20..24);
    let count = triangles(&mesh);
    bencher.counter(count).bench(|| BoundaryLoops::find(&mesh));
}

/// The index for the intersection tests. The time includes finding the loops, which costs very little.
#[divan::bench(args = SIZES, sample_count = 5, sample_size = 1)]
fn index(bencher: Bencher, size: usize) {
    let mesh = sheet(size, 20..24);
    let count = triangles(&mesh);
    bencher
        .counter(count)
        .with_inputs(|| FillSession::new(mesh.clone()))
        .bench_refs(|session| session.prepare());
}
