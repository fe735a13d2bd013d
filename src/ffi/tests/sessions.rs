//! Polylines, and the Rust session below the C interface where C does not reach.

use super::*;
use crate::boundary::select::Selection;
use crate::fill::progress::Progress;
use crate::fill::session::{FillSession, Target};
use crate::mesh::trimesh::TriMesh;
use crate::options::FillOptions;
use std::f64::consts::TAU;
use std::ops::ControlFlow;

const EDGES: usize = 48;
/// The polar angle of the circle on the unit sphere.
const OPENING: f64 = 0.8;

fn circle() -> Vec<[f64; 3]> {
    (0..EDGES)
        .map(|i| {
            let (sin, cos) = (TAU * i as f64 / EDGES as f64).sin_cos();
            let (radius, height) = OPENING.sin_cos();
            [radius * cos, radius * sin, height]
        })
        .collect()
}

fn polyline(normals: Option<&[[f64; 3]]>) -> Owned<HolefillMesh> {
    let points = circle();
    let points = rows(&points);
    let normals = normals.map(rows);
    let normals = normals.as_ref().map_or(ptr::null(), ptr::from_ref);
    let mut mesh = Owned(HolefillMesh::default());
    ok!(holefill_mesh_from_polyline: &points, normals, &mut mesh.0);
    mesh
}

/// Largest distance of the new vertices from the unit sphere.
fn deviation(mesh: HolefillMesh) -> f64 {
    let new = &positions(mesh)[EDGES..];
    assert!(!new.is_empty());
    new.iter()
        .map(|p| (fixtures::norm(*p) - 1.0).abs())
        .fold(0.0, f64::max)
}

#[test]
fn a_circle_with_the_normals_of_the_sphere_gives_its_cap_and_without_them_a_disk() {
    let normals = circle();
    for method in [c"fair-c1", c"fair-c2"] {
        let curved = polyline(Some(&normals));
        assert_eq!(loop_count(curved.0), 1);
        assert_eq!(fill_loop(curved.0, 0, &with_method(method)), OK);
        let height = 1.0 - OPENING.cos();
        let found = deviation(curved.0);
        assert!(found < 0.25 * height, "{method:?}: {found}");
        // It runs along the polyline, and its normals point as those that were given.
        let faces = triangles(curved.0);
        let runs = |t: &[u32; 3]| (0..3).any(|k| (t[k], t[(k + 1) % 3]) == (0, 1));
        assert!(faces.iter().any(runs));
        let flat = polyline(None);
        assert_eq!(fill_loop(flat.0, 0, &with_method(method)), OK);
        let plane = OPENING.cos();
        assert!(
            positions(flat.0)
                .iter()
                .all(|p| (p[2] - plane).abs() < 1e-6)
        );
    }
}

#[test]
fn a_polyline_is_used_as_a_mesh_is() {
    let mesh = polyline(None);
    let before = digest(mesh.0);
    let size = info(mesh.0);
    assert_eq!((size.is_polyline, size.triangle_count), (1, 0));
    let l = loop_info(mesh.0, 0);
    assert_eq!(
        (l.edge_count, l.is_open, l.loop_class),
        (EDGES as u64, 1, HOLEFILL_CLASS_SIMPLE)
    );
    assert_eq!(
        loop_vertices(mesh.0, 0),
        (0..EDGES as u64).collect::<Vec<_>>()
    );
    let labels = vec![3_u8; EDGES];
    let values = rows(&labels);
    let empty = rows(&labels[..0]);
    let name = c"label".as_ptr();
    ok!(holefill_mesh_add_attribute: mesh.0, 1, name, 1, &values);
    ok!(holefill_mesh_add_attribute: mesh.0, 2, name, 1, &empty);
    assert_eq!(found(mesh.0, &at_edge([47, 0])), Ok(vec![0]));
    assert_eq!(found(mesh.0, &at_edge([3, 5])), Err(NOT_FOUND));
    let methods = [c"flat", c"membrane", c"fair-c1", c"fair-c2", c"auto"];
    for method in methods {
        let plan = plan_loop(mesh.0, 0, &with_method(method));
        let (points, faces) = patch(&plan, 0);
        assert_eq!(faces.len(), EDGES - 2 + 2 * points.len(), "a disk");
        assert_eq!(apply(&plan, mesh.0), OK);
        assert_eq!(triangles(mesh.0), faces);
        assert_eq!(loop_info(mesh.0, 0).is_open, 0);
        assert_eq!(fill_loop(mesh.0, 0, &options()), INVALID);
        assert_eq!(apply(&plan, mesh.0), STALE_PLAN);
        assert_eq!(undo(mesh.0), OK);
    }
    assert_ne!(digest(mesh.0), before, "there are attributes now");
}

#[test]
fn polylines_that_cannot_be_are_refused() {
    let points = circle();
    let make = |points: &[[f64; 3]], normals: Option<&[[f64; 3]]>| {
        let session = FillSession::from_polyline(points.to_vec(), normals);
        session.map(|_| ()).map_err(|e| e.kind())
    };
    let invalid = Err(crate::ErrorKind::InvalidInput);
    assert_eq!(make(&points[..2], None), invalid);
    assert_eq!(make(&points, Some(&points[1..])), invalid);
    let mut bad = points.clone();
    bad[7][1] = f64::NAN;
    assert_eq!(make(&bad, None), invalid);
    assert_eq!(make(&points, Some(&bad)), invalid);
    // One point many times is a polyline that cannot be filled.
    let mut session = FillSession::from_polyline(vec![[1.0, 2.0, 3.0]; 5], None).unwrap();
    let report = session
        .fill(Target::Loops(&[0]), &FillOptions::default(), None)
        .unwrap();
    assert_eq!(report.holes[0].status, crate::HoleStatus::Failed);
    assert!(!report.holes[0].reason.is_empty());
    assert_eq!(session.undo_count(), 0);
}

/// Holes filled one by one, in any order, are checked against what was filled before; undone in between, the result is
/// the same.
#[test]
fn holes_filled_one_by_one_are_checked_against_each_other() {
    let sphere = fixtures::sphere(18).cut(|c| {
        let pits = [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [-0.6, 0.6, -0.5],
        ];
        pits.iter()
            .any(|p| fixtures::norm(fixtures::sub(*p, c)) < 0.35)
    });
    let mesh = TriMesh::new(sphere.positions, sphere.triangles).unwrap();
    let options = FillOptions {
        threads: 1,
        ..FillOptions::default()
    };
    let selection = Selection::default();
    let mut at_once = FillSession::new(mesh.clone());
    at_once
        .fill(Target::Selected(&selection), &options, None)
        .unwrap();
    let mut singly = FillSession::new(mesh.clone());
    for id in 0..singly.boundary().loops.len() {
        for _ in 0..2 {
            let report = singly.fill(Target::Loops(&[id]), &options, None).unwrap();
            assert_eq!(report.holes[0].self_intersections, 0);
            assert!(singly.undo());
        }
        singly.fill(Target::Loops(&[id]), &options, None).unwrap();
    }
    assert_eq!(singly.mesh().positions(), at_once.mesh().positions());
    assert_eq!(singly.mesh().triangles(), at_once.mesh().triangles());
    // Plans made together and applied apart.
    let mut planned = FillSession::new(mesh);
    let plans: Vec<_> = (0..planned.boundary().loops.len())
        .map(|id| planned.plan(Target::Loops(&[id]), &options, None).unwrap())
        .collect();
    for plan in &plans {
        planned.apply(plan, None).unwrap();
    }
    assert_eq!(planned.mesh().triangles(), at_once.mesh().triangles());
}

/// Two spheres whose caps would intersect: the second patch meets the first.
#[test]
fn a_patch_that_was_appended_after_planning_is_seen_when_the_plan_is_applied() {
    let lower = fixtures::sphere(12).jittered(0.002, 1).cut(|c| c[2] > 0.5);
    let upper = fixtures::sphere(12)
        .jittered(0.002, 2)
        .cut(|c| c[2] < -0.5)
        .moved(1.0, 0.0, [0.0, 0.0, 1.6]);
    let both = lower.beside(&upper);
    let mesh = TriMesh::new(both.positions, both.triangles).unwrap();
    let options = FillOptions {
        method: crate::Method::FairC1,
        fallback: false,
        threads: 1,
        ..FillOptions::default()
    };
    let mut session = FillSession::new(mesh);
    let alone = session.plan(Target::Loops(&[1]), &options, None).unwrap();
    assert_eq!(alone.report().holes[0].self_intersections, 0);
    session.fill(Target::Loops(&[0]), &options, None).unwrap();
    let applied = session.apply(&alone, None).unwrap();
    assert!(session.undo());
    let filled = session.fill(Target::Loops(&[1]), &options, None).unwrap();
    assert_eq!(
        applied.holes[0].self_intersections,
        filled.holes[0].self_intersections
    );
    assert!(applied.holes[0].self_intersections > 0);
}

#[test]
fn a_fill_that_is_cancelled_late_changes_nothing() {
    let sphere = holed();
    let mesh = TriMesh::new(sphere.positions, sphere.triangles).unwrap();
    let mut session = FillSession::new(mesh);
    let before = session.mesh().triangles().len();
    let stop = |p: Progress| match p.holes_done {
        2 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let selection = Selection::default();
    let outcome = session.fill(
        Target::Selected(&selection),
        &FillOptions::default(),
        Some(&stop),
    );
    assert_eq!(outcome.unwrap_err().kind(), crate::ErrorKind::Cancelled);
    assert_eq!(session.mesh().triangles().len(), before);
    assert!(session.is_open(0) && session.is_open(1));
}
