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
        "flipped neighbor"
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

/// A strip of `2 n` triangles between two circles: a rim and an island, or both sides of a slit.
fn annulus(n: u32) -> PatchMesh {
    let quads = (0..n).flat_map(|i| {
        let j = (i + 1) % n;
        [[i, j, n + i], [j, n + j, n + i]]
    });
    PatchMesh::new(quads.collect(), 2 * n as usize, 2 * n as usize).unwrap()
}

/// The same, joined by a bridge to a second strip: vertex 0 is passed twice.
fn pinched(n: u32) -> PatchMesh {
    let shifted = |v: u32| if v == 0 { 0 } else { v + 2 * n - 1 };
    let first = annulus(n).triangles().to_vec();
    let second = first.iter().map(|t| t.map(shifted));
    let all = first.iter().copied().chain(second).collect();
    let count = 4 * n as usize - 1;
    PatchMesh::new(all, count, count).unwrap()
}

/// Everything that a refused change must leave alone.
type Contents = (Vec<[u32; 3]>, Vec<Option<u32>>, Vec<Vec<u32>>);

fn contents(mesh: &PatchMesh) -> Contents {
    let opposites = (0..mesh.halfedge_count()).map(|h| mesh.opposite(h));
    let rounds = (0..mesh.vertex_count() as u32).map(|v| mesh.corners(v).collect());
    (
        mesh.triangles().to_vec(),
        opposites.collect(),
        rounds.collect(),
    )
}

/// Whether the edge of `h` may be collapsed, from the definition: the triangles that would be left, put together anew,
/// are a patch with the same rim.
fn collapses_slowly(mesh: &PatchMesh, h: u32) -> bool {
    let (gone, kept) = (mesh.origin(h), mesh.target(h));
    let moved = mesh
        .living()
        .map(|t| t.map(|v| if v == gone { kept } else { v }));
    let left: Vec<[u32; 3]> = moved
        .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
        .collect();
    let count = left.len();
    gone as usize >= mesh.rim_count()
        && count + 2 == mesh.living().count()
        && PatchMesh::new(left, mesh.vertex_count(), mesh.rim_count()).is_ok_and(|new| {
            let is_thin = |v: u32| new.closed_start(v).is_some() && new.corners(v).count() < 3;
            new.rim_pairs() == mesh.rim_pairs() && !(0..mesh.vertex_count() as u32).any(is_thin)
        })
}

proptest! {
    #[test]
    fn random_changes_keep_every_promise_and_refusals_change_nothing(
        start in 0..4,
        n in 3u32..7,
        steps in prop::collection::vec((0..6, any::<u32>(), any::<u32>()), 0..150),
    ) {
        let mut mesh = match start {
            0 => fan(3),
            1 => fan(n + 3),
            2 => annulus(n),
            _ => pinched(n),
        };
        let (rim, euler) = (mesh.rim_pairs(), mesh.euler());
        for (change, pick, other) in steps {
            let h = pick % mesh.halfedge_count();
            let is_gone = mesh.living().count() != mesh.triangles().len()
                && !mesh.living().any(|t| t == mesh.triangles()[h as usize / 3]);
            let before = contents(&mesh);
            let triangles: Vec<_> = mesh.living().collect();
            match (change, mesh.opposite(h)) {
                (0 | 1, Some(g)) => {
                    mesh.split(h, g);
                }
                (0 | 1, None) if !is_gone => {
                    // An edge of the rim cannot be collapsed.
                    prop_assert!(!mesh.collapse(h));
                    prop_assert_eq!(contents(&mesh), before);
                }
                (2, Some(g)) if !mesh.has_edge(mesh.apex(h), mesh.apex(g)) => {
                    let ends = [mesh.origin(h), mesh.target(h)];
                    mesh.flip(h, g);
                    prop_assert!(!mesh.has_edge(ends[0], ends[1]));
                }
                (3 | 4, _) if !is_gone => {
                    let (gone, is_allowed) = (mesh.origin(h), collapses_slowly(&mesh, h));
                    let is_done = mesh.collapse(h);
                    prop_assert_eq!(is_done, is_allowed);
                    if is_done {
                        prop_assert_eq!(mesh.corners(gone).count(), 0);
                        prop_assert_eq!(mesh.living().count() + 2, triangles.len());
                    } else {
                        prop_assert_eq!(contents(&mesh), before);
                    }
                }
                (5, _) if !is_gone => {
                    let t = other % mesh.triangles().len() as u32;
                    if triangles.contains(&mesh.triangles()[t as usize]) {
                        let corners = [mesh.origin(h), mesh.target(h), mesh.apex(h)];
                        mesh.place(h, t);
                        prop_assert_eq!(mesh.triangles()[t as usize], corners);
                        prop_assert_eq!(mesh.living().count(), triangles.len());
                    }
                }
                _ => {}
            }
            mesh.validate();
            prop_assert_eq!(mesh.rim_pairs(), rim.clone());
            prop_assert_eq!(mesh.euler(), euler);
        }
    }
}
