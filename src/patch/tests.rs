//! Tests of the patch mesh against [`PatchMesh::validate`] and slow answers.

use super::mesh::PatchMesh;
use crate::error::ErrorKind;
use proptest::prelude::*;

fn fan(n: u32) -> PatchMesh {
    let triangles = (1..n - 1).map(|i| [0, i, i + 1]).collect();
    PatchMesh::new(triangles, n as usize, n as usize).unwrap()
}

fn has_edge_slowly(mesh: &PatchMesh, a: u32, b: u32) -> bool {
    mesh.triangles()
        .iter()
        .any(|t| a != b && t.contains(&a) && t.contains(&b))
}

fn check_edges_against_all_pairs(mesh: &PatchMesh) {
    for a in 0..mesh.vertex_count() as u32 {
        for b in (0..mesh.vertex_count() as u32).filter(|&b| b != a) {
            assert_eq!(
                mesh.has_edge(a, b),
                has_edge_slowly(mesh, a, b),
                "edge {a} {b}"
            );
        }
    }
}

fn kind(triangles: &[[u32; 3]], vertices: usize, rim: usize) -> ErrorKind {
    PatchMesh::new(triangles.to_vec(), vertices, rim)
        .unwrap_err()
        .kind()
}

#[test]
fn broken_patches_are_refused_by_cause() {
    assert_eq!(kind(&[[0, 1, 3]], 3, 3), ErrorKind::InvalidInput);
    assert_eq!(kind(&[[0, 1, 2]], 3, 4), ErrorKind::InvalidInput);
    assert_eq!(kind(&[[0, 1, 1]], 3, 3), ErrorKind::Topology);
    assert_eq!(
        kind(&[[0, 1, 2], [0, 1, 3]], 4, 4),
        ErrorKind::Topology,
        "flipped neighbour"
    );
    assert_eq!(
        kind(&[[0, 1, 2], [1, 0, 2]], 3, 3),
        ErrorKind::Topology,
        "doubled triangle"
    );
    assert_eq!(
        kind(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5, 5),
        ErrorKind::Topology
    );
    assert_eq!(
        kind(&[[0, 1, 2]], 3, 2),
        ErrorKind::Topology,
        "interior vertex on an open edge"
    );
}

#[test]
fn an_empty_patch_and_unused_vertices_are_fine() {
    let mesh = PatchMesh::new(Vec::new(), 4, 4).unwrap();
    assert!(!mesh.has_edge(0, 1));
    mesh.validate();
}

#[test]
fn a_vertex_that_closes_two_fans_is_refused() {
    // Two tetrahedra without bottom, tip to tip at vertex 0.
    let cone = |a, b, c| [[0, a, b], [0, b, c], [0, c, a]];
    let both = [cone(1, 2, 3), cone(4, 5, 6)].concat();
    assert_eq!(kind(&both, 7, 7), ErrorKind::Topology);
    PatchMesh::new(cone(1, 2, 3).to_vec(), 4, 4)
        .unwrap()
        .validate();
}

#[test]
fn edges_at_a_pinched_rim_vertex_are_found_in_all_its_fans() {
    let mesh = PatchMesh::new(
        vec![[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 6], [0, 7, 8]],
        9,
        9,
    )
    .unwrap();
    mesh.validate();
    check_edges_against_all_pairs(&mesh);
}

#[test]
fn an_annulus_keeps_its_euler_characteristic_through_splits() {
    // Outer square 0..4, inner square 4..8, a ring of eight triangles.
    let ring = (0..4u32).flat_map(|i| {
        let j = (i + 1) % 4;
        [[i, j, 4 + i], [j, 4 + j, 4 + i]]
    });
    let mut mesh = PatchMesh::new(ring.collect(), 8, 8).unwrap();
    assert_eq!(mesh.euler(), 0);
    for h in 0..24 {
        if let Some(g) = mesh.opposite(h) {
            mesh.split(h, g);
            mesh.validate();
        }
    }
    assert_eq!(mesh.euler(), 0);
    assert_eq!(mesh.rim_pairs().len(), 8);
}

proptest! {
    #[test]
    fn random_splits_and_flips_keep_every_invariant(
        n in 3u32..12,
        steps in prop::collection::vec((any::<bool>(), any::<u32>()), 0..60),
    ) {
        let mut mesh = fan(n);
        let (rim, euler) = (mesh.rim_pairs(), mesh.euler());
        for (split, pick) in steps {
            let h = pick % mesh.halfedge_count();
            let Some(g) = mesh.opposite(h) else { continue };
            let (a, b, c, d) = (mesh.origin(h), mesh.target(h), mesh.apex(h), mesh.apex(g));
            let outer = if split {
                mesh.split(h, g)
            } else if mesh.has_edge(c, d) {
                continue;
            } else {
                mesh.flip(h, g)
            };
            let mut ends: Vec<_> = outer
                .iter()
                .map(|&h| (mesh.origin(h).min(mesh.target(h)), mesh.origin(h).max(mesh.target(h))))
                .collect();
            let mut expected: Vec<_> =
                [(a, c), (c, b), (b, d), (d, a)].map(|(x, y)| (x.min(y), x.max(y))).to_vec();
            ends.sort_unstable();
            expected.sort_unstable();
            prop_assert_eq!(ends, expected);
            prop_assert_eq!(has_edge_slowly(&mesh, a, b), false);
            mesh.validate();
        }
        check_edges_against_all_pairs(&mesh);
        prop_assert_eq!(mesh.rim_pairs(), rim);
        prop_assert_eq!(mesh.euler(), euler);
    }
}
