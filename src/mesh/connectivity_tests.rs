//! Tests: compares the connectivity with a search through all pairs of halfedges.

use super::connectivity::Connectivity;
use super::defects::MeshDefects;
use super::halfedge::{BOUNDARY, DEGENERATE, NON_MANIFOLD, next, origin, previous, target};
use super::pairing::pair_halfedges;
use super::trimesh::TriMesh;
use crate::error::ErrorKind;
use crate::fixtures::{self, Noise, fixtures};
use crate::mesh::attributes::Attributes;
use proptest::prelude::*;

fn is_sound(t: &[u32; 3]) -> bool {
    t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
}

/// The links of all halfedges and the counts of defects, pair by pair.
fn by_all_pairs(vertex_count: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, [usize; 5]) {
    let count = 3 * triangles.len() as u32;
    let edge = |h: u32| {
        let (a, b) = (origin(triangles, h), target(triangles, h));
        (a.min(b), a.max(b))
    };
    let is_linked = |h: u32| is_sound(&triangles[h as usize / 3]);
    let mut links = Vec::new();
    let mut defects = [0; 5];
    for h in 0..count {
        if !is_linked(h) {
            links.push(DEGENERATE);
            continue;
        }
        let others: Vec<u32> = (0..count)
            .filter(|&o| o != h && is_linked(o) && edge(o) == edge(h))
            .collect();
        links.push(match others[..] {
            [] => BOUNDARY,
            [other] => {
                let is_parallel = origin(triangles, other) == origin(triangles, h);
                defects[1] += usize::from(is_parallel && h < other);
                other
            }
            _ => {
                defects[0] += usize::from(others.iter().all(|&o| h < o));
                NON_MANIFOLD
            }
        });
    }
    defects[2] = triangles.iter().filter(|t| !is_sound(t)).count();
    let key = |t: &[u32; 3]| {
        let mut key = *t;
        key.sort_unstable();
        key
    };
    defects[3] = (0..triangles.len())
        .filter(|&f| is_sound(&triangles[f]))
        .filter(|&f| triangles[..f].iter().any(|t| key(t) == key(&triangles[f])))
        .count();
    defects[4] = (0..vertex_count as u32)
        .filter(|v| !triangles.iter().any(|t| t.contains(v)))
        .count();
    (links, defects)
}

fn counts(defects: &MeshDefects) -> [usize; 5] {
    [
        defects.nonmanifold_edges.count,
        defects.inconsistent_edges.count,
        defects.degenerate_faces.count,
        defects.duplicate_faces.count,
        defects.isolated_vertices.count,
    ]
}

fn links(connectivity: &Connectivity) -> Vec<u32> {
    (0..connectivity.halfedge_count() as u32)
        .map(|h| connectivity.twin(h))
        .collect()
}

fn check(vertex_count: usize, triangles: &[[u32; 3]]) {
    let (connectivity, defects) = Connectivity::build(vertex_count, triangles).unwrap();
    let (expected, expected_counts) = by_all_pairs(vertex_count, triangles);
    assert_eq!(links(&connectivity), expected, "{triangles:?}");
    assert_eq!(counts(&defects), expected_counts, "{triangles:?}");
    let boundary: Vec<u32> = (0..expected.len() as u32)
        .filter(|&h| expected[h as usize] == BOUNDARY)
        .collect();
    assert_eq!(connectivity.boundary_halfedges(), boundary);
    let mut rim = vec![false; vertex_count];
    for &h in &boundary {
        rim[origin(triangles, h) as usize] = true;
        rim[target(triangles, h) as usize] = true;
    }
    let is_edge = |a: u32, b: u32| {
        let has = |t: &[u32; 3]| a != b && t.contains(&a) && t.contains(&b);
        triangles.iter().any(|t| is_sound(t) && has(t))
    };
    // What leaves a vertex is known on the boundary.
    for a in (0..vertex_count as u32).filter(|&a| rim[a as usize]) {
        let is_sound_here =
            |h: &u32| origin(triangles, *h) == a && is_sound(&triangles[*h as usize / 3]);
        let expected: Vec<u32> = (0..expected.len() as u32).filter(is_sound_here).collect();
        let outgoing = connectivity.outgoing(a).filter(|o| o.target != u32::MAX);
        let found: Vec<u32> = outgoing.map(|o| o.halfedge).collect();
        assert_eq!(found, expected, "vertex {a}");
        for b in (0..vertex_count as u32).filter(|&b| rim[b as usize]) {
            assert_eq!(connectivity.has_edge(a, b), is_edge(a, b), "{a} {b}");
        }
    }
}

/// Few vertices, so that every irregularity occurs.
fn soup() -> impl Strategy<Value = (usize, Vec<[u32; 3]>)> {
    (1_usize..12).prop_flat_map(|n| {
        let triangle = proptest::array::uniform3(0..n as u32);
        (Just(n), proptest::collection::vec(triangle, 0..24))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn random_triangles_are_linked_as_by_all_pairs((n, triangles) in soup()) {
        check(n, &triangles);
    }

    #[test]
    fn a_mesh_closed_patch_by_patch_is_linked_as_if_built_at_once(seed in 0_u64..1000, parts in 2_usize..6) {
        // Any split of a manifold into parts keeps the requirement of `append`.
        let whole = fixtures::sphere(3).shuffled(seed);
        let mut noise = Noise(seed);
        let mut cuts: Vec<usize> = (1..parts)
            .map(|_| noise.below(whole.triangles.len() as u32) as usize)
            .collect();
        cuts.push(whole.triangles.len());
        cuts.sort_unstable();
        let count = whole.positions.len();
        let (mut grown, _) = Connectivity::build(count, &whole.triangles[..cuts[0]]).unwrap();
        for pair in cuts.windows(2) {
            let twins = pair_halfedges(&whole.triangles[pair[0]..pair[1]], count);
            grown.append(&whole.triangles[..pair[1]], pair[0], &twins);
        }
        let (built, _) = Connectivity::build(count, &whole.triangles).unwrap();
        prop_assert_eq!(links(&grown), links(&built));
        prop_assert_eq!(grown.boundary_halfedges(), built.boundary_halfedges());
        let first = &whole.triangles[..cuts[0]];
        let (start, _) = Connectivity::build(count, first).unwrap();
        for h in start.boundary_halfedges() {
            let v = origin(first, h);
            let expected = (0..3 * whole.triangles.len() as u32).filter(|&h| origin(&whole.triangles, h) == v);
            prop_assert!(grown.outgoing(v).map(|o| o.halfedge).eq(expected));
        }
    }
}

#[test]
fn every_fixture_is_linked_as_by_all_pairs() {
    for f in fixtures() {
        if f.mesh.triangles.len() < 1000 {
            check(f.mesh.positions.len(), &f.mesh.triangles);
        }
    }
}

#[test]
fn vertices_of_very_high_valence_are_linked_like_others() {
    for is_closed in [true, false] {
        let fan = fixtures::fan(5000, is_closed);
        let (connectivity, defects) =
            Connectivity::build(fan.positions.len(), &fan.triangles).unwrap();
        assert_eq!(defects, MeshDefects::default());
        let rim = if is_closed { 5000 } else { 5002 };
        assert_eq!(connectivity.boundary_halfedges().len(), rim);
        for h in 0..connectivity.halfedge_count() as u32 {
            let twin = connectivity.twin(h);
            if twin != BOUNDARY {
                assert_eq!(connectivity.twin(twin), h);
                assert_eq!(origin(&fan.triangles, twin), target(&fan.triangles, h));
            }
        }
    }
}

#[test]
fn thirty_triangles_at_each_of_two_edges_of_high_valence_vertices_are_one_defect_each() {
    // The book of triangles over the edge 0-1 has buckets that are sorted, and every page is bad.
    let pages = 200_u32;
    let mut triangles: Vec<_> = (2..2 + pages).map(|tip| [0, 1, tip]).collect();
    triangles.push([0, 0, 1]);
    let (connectivity, defects) = Connectivity::build(pages as usize + 2, &triangles).unwrap();
    assert_eq!(counts(&defects), [1, 0, 1, 0, 0]);
    assert_eq!(defects.nonmanifold_edges.examples, [[0, 1]]);
    assert_eq!(connectivity.boundary_halfedges().len(), 2 * pages as usize);
}

#[test]
fn the_steps_within_a_triangle_are_cyclic() {
    for h in 0..12 {
        assert_eq!(previous(next(h)), h);
        assert_eq!(next(next(next(h))), h);
        assert_eq!(next(h) / 3, h / 3);
    }
}

#[test]
fn a_face_is_found_whatever_its_orientation() {
    let mesh = fixtures::two_triangles();
    let (connectivity, _) = Connectivity::build(4, &mesh.triangles).unwrap();
    for t in [[0, 1, 2], [2, 1, 0], [1, 3, 2], [3, 1, 2]] {
        assert!(connectivity.has_face(&mesh.triangles, t), "{t:?}");
    }
    for t in [[0, 1, 3], [3, 2, 0]] {
        assert!(!connectivity.has_face(&mesh.triangles, t), "{t:?}");
    }
}

#[test]
fn defects_are_said_in_one_line_each_with_the_first_places() {
    let triangles = vec![[0, 1, 2], [0, 1, 2], [0, 1, 3], [4, 4, 5]];
    let positions = vec![[0.0; 3]; 12];
    let mesh = TriMesh::new(positions, triangles).unwrap();
    assert_eq!(
        mesh.defects().summary(),
        [
            "1 edges with more than two triangles (0-1)",
            "2 edges between triangles of opposite orientation (1-2, 2-0)",
            "1 triangles that name a vertex twice (3)",
            "1 duplicate triangles (1)",
            "6 vertices without a triangle (6, 7, 8, 9, ...)",
        ]
    );
    assert!(!mesh.defects().is_empty());
    let sound = fixtures::tetrahedron();
    let sound = TriMesh::new(sound.positions, sound.triangles).unwrap();
    assert!(sound.defects().is_empty() && sound.defects().summary().is_empty());
}

#[test]
fn what_no_mesh_can_be_made_of_is_named() {
    let points = || vec![[0.0; 3]; 3];
    let message = |result: crate::Result<TriMesh>| {
        let error = result.expect_err("invalid input");
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        error.message().to_owned()
    };
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut positions = points();
        positions[1][2] = bad;
        let said = message(TriMesh::new(positions, vec![]));
        assert!(said.starts_with("vertex 1 is not finite"), "{said}");
    }
    let said = message(TriMesh::new(points(), vec![[0, 1, 2], [0, 3, 1]]));
    assert!(
        said.contains("triangle 1") && said.contains("only 3"),
        "{said}"
    );
    let said = message(TriMesh::new(points(), vec![[0, 1, u32::MAX]]));
    assert!(said.contains("triangle 0"), "{said}");
    for (of_vertices, of_faces) in [(2, 1), (3, 0)] {
        let said = message(TriMesh::with_attributes(
            points(),
            vec![[0, 1, 2]],
            Attributes::new(of_vertices),
            Attributes::new(of_faces),
        ));
        assert!(said.contains("attributes"), "{said}");
    }
}

#[test]
fn a_mesh_gives_its_arrays_back() {
    let arrays = fixtures::sheet_with_hole();
    let mesh = TriMesh::new(arrays.positions.clone(), arrays.triangles.clone()).unwrap();
    let (positions, triangles, of_vertices, of_faces) = mesh.into_parts();
    assert_eq!(
        (&positions, &triangles),
        (&arrays.positions, &arrays.triangles)
    );
    assert_eq!(
        (of_vertices.len(), of_faces.len()),
        (positions.len(), triangles.len())
    );
}
