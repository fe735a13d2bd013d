//! Tests: compares the connectivity of arbitrary triangles with a slow, simple implementation of its definition.

use super::connectivity::Connectivity;
use super::defects::{Defect, MeshDefects};
use super::halfedge::{
    BOUNDARY, DEGENERATE, NON_MANIFOLD, Outgoing, is_degenerate, origin, target,
};
use super::pairing::pair_halfedges;
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

type Triangles = Vec<[u32; 3]>;

fn defect<T>(places: impl IntoIterator<Item = T>) -> Defect<T> {
    let mut defect = Defect::default();
    places.into_iter().for_each(|place| defect.record(place));
    defect
}

/// What [`Connectivity`] should say.
struct Expected {
    twin: Vec<u32>,
    boundary: Vec<u32>,
    rim_vertices: BTreeSet<u32>,
    defects: MeshDefects,
}

fn expected(vertex_count: u32, triangles: &[[u32; 3]]) -> Expected {
    let degenerate = |f: u32| is_degenerate(&triangles[f as usize]);
    let ends = |h: u32| [origin(triangles, h), target(triangles, h)];
    let mut edges: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    let mut faces: BTreeMap<[u32; 3], Vec<u32>> = BTreeMap::new();
    for (f, t) in (0..).zip(triangles).filter(|&(f, _)| !degenerate(f)) {
        let mut key = *t;
        key.sort_unstable();
        faces.entry(key).or_default().push(f);
        for h in 3 * f..3 * f + 3 {
            let mut key = ends(h);
            key.sort_unstable();
            edges.entry(key).or_default().push(h);
        }
    }
    let mut twin = vec![DEGENERATE; 3 * triangles.len()];
    for halfedges in edges.values() {
        for &h in halfedges {
            twin[h as usize] = match halfedges[..] {
                [_] => BOUNDARY,
                [a, b] => a ^ b ^ h,
                _ => NON_MANIFOLD,
            };
        }
    }
    // Defects are listed by the lowest halfedge of the edge.
    let mut by_lowest: Vec<&Vec<u32>> = edges.values().collect();
    by_lowest.sort();
    let edges_where = |wanted: &dyn Fn(&[u32]) -> bool| {
        let chosen = by_lowest.iter().filter(|halfedges| wanted(halfedges));
        defect(chosen.map(|halfedges| ends(halfedges[0])))
    };
    let mut duplicates: Vec<u32> = faces
        .values()
        .flat_map(|same| &same[1..])
        .copied()
        .collect();
    duplicates.sort_unstable();
    let used: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let is_open = |&h: &u32| twin[h as usize] == BOUNDARY;
    let boundary: Vec<u32> = (0..twin.len() as u32).filter(is_open).collect();
    Expected {
        rim_vertices: boundary.iter().flat_map(|&h| ends(h)).collect(),
        defects: MeshDefects {
            nonmanifold_edges: edges_where(&|halfedges| halfedges.len() > 2),
            inconsistent_edges: edges_where(
                &|halfedges| matches!(*halfedges, [a, b] if ends(a) == ends(b)),
            ),
            degenerate_faces: defect((0..triangles.len() as u32).filter(|&f| degenerate(f))),
            duplicate_faces: defect(duplicates),
            isolated_vertices: defect((0..vertex_count).filter(|v| !used.contains(v))),
        },
        twin,
        boundary,
    }
}

fn links(connectivity: &Connectivity) -> Vec<u32> {
    (0..connectivity.halfedge_count() as u32)
        .map(|h| connectivity.twin(h))
        .collect()
}

fn check(vertex_count: u32, triangles: &[[u32; 3]], threads: usize) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("pool");
    let (connectivity, defects) = pool
        .install(|| Connectivity::build(vertex_count as usize, triangles))
        .expect("valid indices");
    let expected = expected(vertex_count, triangles);
    assert_eq!(links(&connectivity), expected.twin);
    assert_eq!(connectivity.boundary_halfedges(), expected.boundary);
    assert_eq!(defects, expected.defects);

    let mut outgoing: BTreeMap<u32, Vec<Outgoing>> = BTreeMap::new();
    for h in 0..3 * triangles.len() as u32 {
        let target = match is_degenerate(&triangles[h as usize / 3]) {
            true => u32::MAX,
            false => target(triangles, h),
        };
        let leaving = Outgoing {
            target,
            halfedge: h,
        };
        outgoing
            .entry(origin(triangles, h))
            .or_default()
            .push(leaving);
    }
    for v in 0..vertex_count {
        let is_on_rim = expected.rim_vertices.contains(&v);
        let known: Vec<Outgoing> = connectivity.outgoing(v).collect();
        let all = outgoing.remove(&v).filter(|_| is_on_rim);
        assert_eq!(known, all.unwrap_or_default(), "vertex {v}");
    }
}

fn soup(vertex_count: u32, faces: usize) -> impl Strategy<Value = (u32, Triangles)> {
    (1..=vertex_count).prop_flat_map(move |n| {
        let triangle = [0..n, 0..n, 0..n];
        (Just(n), proptest::collection::vec(triangle, 0..faces))
    })
}

/// Triangles of which most share a few vertices, so that these have long lists.
fn crowded_soup() -> impl Strategy<Value = (u32, Triangles)> {
    let hub = prop_oneof![Just(0_u32), Just(1), Just(150), Just(299)];
    let triangle = (hub, 0..300_u32, 0..300_u32, 0..6_usize);
    proptest::collection::vec(triangle, 0..600).prop_map(|raw| {
        let turned = |&(a, b, c, turn): &(u32, u32, u32, usize)| {
            let mut t = if turn < 3 { [a, b, c] } else { [a, c, b] };
            t.rotate_left(turn % 3);
            t
        };
        (300, raw.iter().map(turned).collect())
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_soup_is_linked_as_defined((n, triangles) in soup(9, 40), threads in 1..4_usize) {
        check(n, &triangles, threads);
    }

    #[test]
    fn a_sparse_soup_is_linked_as_defined((n, triangles) in soup(60, 60), threads in 1..4_usize) {
        check(n, &triangles, threads);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn vertices_of_high_valence_are_linked_as_defined(
        (n, triangles) in crowded_soup(), threads in 1..4_usize,
    ) {
        check(n, &triangles, threads);
    }

    #[test]
    fn removed_triangles_appended_again_are_linked_as_before(
        removed in proptest::collection::vec(any::<bool>(), 2 * 8 * 6),
    ) {
        let (vertex_count, torus) = torus(8, 6);
        let is_removed = |i: &usize| removed[*i];
        let (gone, mut triangles): (Vec<usize>, Vec<usize>) =
            (0..torus.len()).partition(is_removed);
        let kept = triangles.len();
        triangles.extend(gone);
        let triangles: Triangles = triangles.iter().map(|&i| torus[i]).collect();
        let (mut connectivity, _) =
            Connectivity::build(vertex_count as usize, &triangles[..kept]).expect("valid indices");
        let was_open = connectivity.boundary_halfedges().len();
        let twins = pair_halfedges(&triangles[kept..], vertex_count as usize);
        connectivity.append(&triangles, kept, &twins);
        let (whole, _) =
            Connectivity::build(vertex_count as usize, &triangles).expect("valid indices");
        prop_assert_eq!(links(&connectivity), links(&whole));
        prop_assert_eq!(connectivity.boundary_halfedges(), Vec::<u32>::new());
        prop_assert_eq!(was_open == 0, kept == torus.len() || kept == 0);
        // Vertices amid what was appended are not known.
        let is_on_rim = |v: u32| triangles[..kept].iter().flatten().any(|&w| w == v);
        for (f, &t) in (0..).zip(&triangles).skip(kept) {
            if is_on_rim(t[0]) {
                prop_assert!(connectivity.has_face(&triangles, t), "triangle {}", f);
                prop_assert!(connectivity.has_edge(t[0], t[1]) && connectivity.has_edge(t[1], t[0]));
            }
        }
    }
}

/// A closed grid of `2 * m * n` triangles.
fn torus(m: u32, n: u32) -> (u32, Triangles) {
    let at = |i: u32, j: u32| (j % n) * m + i % m;
    let cell = |(i, j): (u32, u32)| {
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        [[a, b, d], [a, d, c]]
    };
    let cells = (0..n).flat_map(|j| (0..m).map(move |i| (i, j)));
    (m * n, cells.flat_map(cell).collect())
}

#[test]
fn a_mesh_of_many_chunks_in_any_order_is_linked_as_defined() {
    let (vertex_count, mut triangles) = torus(200, 120);
    triangles.retain(|t| t[0] % 97 != 5);
    triangles[20_000] = triangles[7];
    triangles[30_000] = [3, 3, 900];
    check(vertex_count, &triangles, 2);
    let stride = |i: usize, n: usize| (i * 7919) % n;
    let count = triangles.len();
    let mixed: Triangles = (0..count)
        .map(|i| triangles[stride(i, count)].map(|v| stride(v as usize, 24_000) as u32))
        .collect();
    for threads in [1, 2, 5] {
        check(vertex_count, &mixed, threads);
    }
}

#[test]
fn a_fan_of_any_size_costs_no_square() {
    const SPOKES: u32 = 300_000;
    for hub in [0, SPOKES] {
        let rim = |i: u32| i % SPOKES + u32::from(hub == 0);
        let fan: Triangles = (0..SPOKES).map(|i| [hub, rim(i), rim(i + 1)]).collect();
        let (connectivity, defects) =
            Connectivity::build(SPOKES as usize + 1, &fan).expect("valid indices");
        assert!(defects.is_empty());
        assert_eq!(connectivity.boundary_halfedges().len(), SPOKES as usize);
    }
    // All triangles at one edge.
    let book: Triangles = (2..SPOKES).map(|v| [0, 1, v]).collect();
    let (connectivity, defects) =
        Connectivity::build(SPOKES as usize, &book).expect("valid indices");
    assert_eq!(defects.nonmanifold_edges.examples, [[0, 1]]);
    assert_eq!(connectivity.twin(0), NON_MANIFOLD);
}

#[test]
fn an_index_out_of_range_is_an_error_that_names_the_first_triangle() {
    let mut triangles = vec![[0, 1, 2]; 40_000];
    triangles[17_000] = [0, 3, 1];
    triangles[39_000] = [7, 0, 1];
    let error = Connectivity::build(3, &triangles).expect_err("out of range");
    assert!(error.to_string().contains("triangle 17000"), "{error}");
}
