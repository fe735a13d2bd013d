//! Loops, their measures and classes.

use super::boundary_loop::{BoundaryLoop, LoopClass};
use super::loops::BoundaryLoops;
use crate::fixtures::{self, Arrays, fixtures};
use crate::math::Vec3;
use crate::mesh::halfedge::{BOUNDARY, origin, target};
use crate::mesh::trimesh::TriMesh;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

fn mesh_of(arrays: &Arrays) -> TriMesh {
    TriMesh::new(arrays.positions.clone(), arrays.triangles.clone()).unwrap()
}

fn loops_of(arrays: &Arrays) -> Vec<BoundaryLoop> {
    BoundaryLoops::find(&mesh_of(arrays)).loops
}

/// Panics unless what is documented of all loops of any mesh holds.
fn check_loops(mesh: &TriMesh) {
    let boundary = BoundaryLoops::find(mesh);
    let mut covered: Vec<u32> = Vec::new();
    let mut lowest = Vec::new();
    for (id, l) in boundary.loops.iter().enumerate() {
        assert_eq!(l.id, id);
        assert_eq!(l.edge_count(), l.halfedges.len());
        covered.extend(&l.halfedges);
        lowest.push(*l.halfedges.iter().min().unwrap());
        let distinct: BTreeSet<u32> = l.vertices.iter().copied().collect();
        let is_closed = l.class != LoopClass::OpenChain;
        if is_closed {
            assert_eq!(
                distinct.len(),
                l.vertices.len(),
                "a vertex is visited twice"
            );
            assert_eq!(l.vertices.len(), l.edge_count());
            assert_eq!(l.halfedges[0], lowest[id]);
            assert_eq!(l.edge(), [l.vertices[0], l.vertices[1]]);
        } else {
            assert_eq!(l.vertices.len(), l.edge_count() + 1);
        }
        let mut is_oriented = true;
        for (i, &h) in l.halfedges.iter().enumerate() {
            let (a, b) = (origin(mesh.triangles(), h), target(mesh.triangles(), h));
            let (v, w) = (l.vertices[i], l.vertices[(i + 1) % l.vertices.len()]);
            assert!(
                (v, w) == (a, b) || (v, w) == (b, a),
                "edge {i} of loop {id}"
            );
            is_oriented &= (v, w) == (a, b);
            assert_eq!(boundary.with_edge([a, b]).map(|l| l.id), Some(id));
            assert_eq!(boundary.with_edge([b, a]), None);
        }
        match l.class {
            LoopClass::OpenChain => {}
            LoopClass::NotOriented => assert!(!is_oriented),
            _ => assert!(is_oriented),
        }
        assert_eq!(boundary.with_edge(l.edge()).map(|l| l.id), Some(id));
        assert_eq!(l.host.is_some(), l.class == LoopClass::Island);
        assert!(l.perimeter >= 0.0 && l.diameter >= 0.0 && (0.0..0.6).contains(&l.planarity));
    }
    assert!(
        lowest.is_sorted(),
        "loops are ordered by their lowest halfedge"
    );
    covered.sort_unstable();
    let expected: Vec<u32> = (0..3 * mesh.triangles().len() as u32)
        .filter(|&h| mesh.connectivity().twin(h) == BOUNDARY)
        .collect();
    assert_eq!(
        covered, expected,
        "every boundary edge is in exactly one loop"
    );
}

#[test]
fn every_fixture_has_the_loops_and_classes_that_it_was_made_with() {
    for f in fixtures() {
        let mesh = mesh_of(&f.mesh);
        check_loops(&mesh);
        let mut classes: Vec<&str> = BoundaryLoops::find(&mesh)
            .loops
            .iter()
            .map(|l| l.class.name())
            .collect();
        classes.sort_unstable();
        assert_eq!(classes, f.classes, "{}", f.name);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn loops_of_random_triangles_keep_what_is_documented(
        n in 3_u32..14,
        triangles in proptest::collection::vec(proptest::array::uniform3(0..1000_u32), 0..30),
    ) {
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| v % n)).collect();
        let mut noise = fixtures::Noise(u64::from(n));
        let positions = (0..n).map(|_| [0; 3].map(|_: i32| noise.signed())).collect();
        check_loops(&TriMesh::new(positions, triangles).unwrap());
    }

    #[test]
    fn loops_of_sheets_with_random_holes_keep_what_is_documented(seed in 0_u64..1000, share in 2_u32..6) {
        // Quads removed at random give rims that touch themselves and each other everywhere.
        let mut noise = fixtures::Noise(seed);
        let quads: Vec<bool> = (0..144).map(|_| noise.below(share) == 0).collect();
        let sheet = fixtures::sheet_without(12, |i, j| quads[12 * i + j]);
        let mesh = mesh_of(&sheet.shuffled(seed));
        check_loops(&mesh);
        let loops = BoundaryLoops::find(&mesh).loops;
        prop_assert!(loops.iter().all(|l| l.class != LoopClass::OpenChain));
    }

    #[test]
    fn the_order_of_vertices_and_triangles_changes_the_names_only(seed in 0_u64..1000) {
        let arrays = fixtures::tongue().beside(&fixtures::sheet_with_islands(2));
        // A loop by what does not depend on names: its edges as positions, from the lowest one.
        let geometry = |arrays: &Arrays| {
            let bits = |v: u32| arrays.positions[v as usize].map(|c| c as i64);
            let mut loops: Vec<_> = loops_of(arrays)
                .iter()
                .map(|l| {
                    let mut points: Vec<_> = l.vertices.iter().map(|&v| bits(v)).collect();
                    let lowest = (0..points.len()).min_by_key(|&i| points[i]).unwrap();
                    points.rotate_left(lowest);
                    (points, l.class)
                })
                .collect();
            loops.sort();
            loops
        };
        prop_assert_eq!(geometry(&arrays.shuffled(seed)), geometry(&arrays));
    }
}

#[test]
fn a_circle_is_measured_as_one() {
    for (scale, angle, offset) in [
        (1.0, 0.0, [0.0; 3]),
        (1e-4, 1.0, [1.0, -2.0, 3.0]),
        (1e4, 2.0, [1e8, 0.0, 0.0]),
    ] {
        let n = 64;
        let mesh = fixtures::cylinder(n, 4).moved(scale, angle, offset);
        let normal = fixtures::cylinder(4, 2).with_vertex([0.0, 0.0, 1.0]);
        let normal = Vec3::from(*normal.moved(1.0, angle, [0.0; 3]).positions.last().unwrap());
        let loops = loops_of(&mesh);
        assert_eq!(loops.len(), 2);
        let half = PI / n as f64;
        let tolerance = 1e-9 * scale.max(1e-6 * fixtures::norm(offset));
        for (l, side) in loops.iter().zip([1.0, -1.0]) {
            let perimeter = 2.0 * n as f64 * half.sin() * scale;
            assert!((l.perimeter - perimeter).abs() < n as f64 * tolerance);
            let area = n as f64 * half.sin() * half.cos() * scale * scale;
            let found = Vec3::from(l.vector_area);
            assert!(
                (found - side * area * normal).norm() < 10.0 * tolerance * scale,
                "{found}"
            );
            assert!(l.planarity < 1e-6, "{}", l.planarity);
            assert!((2.0 * scale..2.9 * scale).contains(&l.diameter));
            assert_eq!(l.class, LoopClass::Simple);
        }
    }
}

#[test]
fn the_vector_area_follows_the_direction_of_the_loop() {
    let sheet = fixtures::sheet_with_hole().mapped(|p| [p[0], p[1], 0.0]);
    let loops = loops_of(&sheet);
    let area = |class| loops.iter().find(|l| l.class == class).unwrap().vector_area;
    assert_eq!(area(LoopClass::OuterRim), [0.0, 0.0, 144.0]);
    assert_eq!(area(LoopClass::Simple), [0.0, 0.0, -16.0]);
}

#[test]
fn a_rim_that_is_not_flat_has_its_planarity_measured() {
    // A closed curve that goes up and down twice with height 1 at radius 1.
    let rim = fixtures::cylinder(64, 2).mapped(|p| {
        let angle = p[1].atan2(p[0]);
        [p[0], p[1], p[2] + (2.0 * angle).cos()]
    });
    for l in loops_of(&rim) {
        // Mean squares: 1/2 up and 1 in the plane.
        let expected = (0.5_f64 / 1.5).sqrt();
        assert!((l.planarity - expected).abs() < 1e-9, "{}", l.planarity);
    }
}

#[test]
fn a_perimeter_of_coordinates_near_the_largest_number_does_no_harm() {
    for scale in [1e-300, 1e-200, 1e150, 1e200, 1e307] {
        let mesh = mesh_of(&fixtures::sheet_with_hole().mapped(|p| p.map(|c| c * scale)));
        let loops = BoundaryLoops::find(&mesh).loops;
        assert_eq!(loops.len(), 2);
        for l in loops {
            assert!(
                (0.0..0.6).contains(&l.planarity),
                "{scale}: {}",
                l.planarity
            );
        }
    }
}

#[test]
fn two_holes_that_touch_are_two_simple_loops() {
    for size in [1, 3] {
        let loops = loops_of(&fixtures::touching_holes(size));
        let touching: Vec<_> = loops
            .iter()
            .filter(|l| l.class == LoopClass::Touching)
            .collect();
        assert_eq!(touching.len(), 2);
        assert!(touching.iter().all(|l| l.edge_count() == 4 * size));
        let shared = touching[0]
            .vertices
            .iter()
            .filter(|v| touching[1].vertices.contains(v));
        assert_eq!(shared.count(), 1);
    }
}

#[test]
fn an_island_names_the_smallest_hole_round_it() {
    let mesh = fixtures::sheet_with_islands(3);
    let loops = loops_of(&mesh);
    let hole = loops
        .iter()
        .find(|l| l.class == LoopClass::Simple)
        .unwrap()
        .id;
    let hosts: Vec<_> = loops
        .iter()
        .filter(|l| l.class == LoopClass::Island)
        .map(|l| l.host)
        .collect();
    assert_eq!(hosts, [Some(hole); 3]);
    // A sheet far away is no island, nor is one that is larger than the hole.
    for (scale, offset) in [(1.0, [50.0, 0.0, 0.0]), (3.0, [0.0, 0.0, 1.0])] {
        let hole = fixtures::sphere(8)
            .cut(|c| c[2] > 0.6)
            .moved(3.0, 0.0, [0.0; 3]);
        let disc = fixtures::fan(12, true).moved(scale, 0.0, offset);
        let classes: Vec<_> = loops_of(&hole.beside(&disc))
            .iter()
            .map(|l| l.class)
            .collect();
        assert_eq!(classes, [LoopClass::Simple, LoopClass::OuterRim]);
    }
}

#[test]
fn a_large_sheet_is_an_outer_rim_wherever_it_lies() {
    for angle in [0.0, 0.7, 2.0] {
        let sheet = fixtures::sheet(8, fixtures::waves).moved(1e3, angle, [1e5, -1e5, 3.0]);
        assert_eq!(loops_of(&sheet)[0].class, LoopClass::OuterRim);
        // A bowl: half a sphere is judged by what lies along its rim, and counts as a hole.
        let bowl = fixtures::sphere(12)
            .cut(|c| c[2] > 0.0)
            .moved(2.0, angle, [0.0; 3]);
        assert_eq!(loops_of(&bowl)[0].class, LoopClass::Simple);
    }
}

#[test]
fn an_edge_names_its_loop_in_the_direction_of_its_triangle_only() {
    let mesh = mesh_of(&fixtures::sheet_with_hole());
    let boundary = BoundaryLoops::find(&mesh);
    for l in &boundary.loops {
        let [a, b] = l.edge();
        assert_eq!([a, b], [l.vertices[0], l.vertices[1]]);
        assert_eq!(boundary.with_edge([a, b]), Some(l));
        assert_eq!(boundary.with_edge([b, a]), None);
    }
    assert_eq!(boundary.with_edge([0, u32::MAX]), None);
}

#[test]
fn a_vertex_count_of_a_fan_is_its_rim() {
    let loops = loops_of(&fixtures::fan(5000, true));
    assert_eq!(loops.len(), 1);
    assert_eq!(loops[0].edge_count(), 5000);
    let open = loops_of(&fixtures::fan(5000, false));
    assert_eq!(open[0].edge_count(), 5002);
    assert!(TAU - loops[0].perimeter > 0.0);
}
