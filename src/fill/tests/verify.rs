//! A patch that is wrong in any way is caught.

use super::{mesh_of, with_method};
use crate::boundary::loops::BoundaryLoops;
use crate::error::{ErrorKind, Result};
use crate::fill::cut::{MeshPlace, cut_out};
use crate::fill::verify::{check_against_mesh, check_patch};
use crate::fixtures::{self, Arrays};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::mesh::pairing::pair_halfedges;
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::methods::spec::HoleReach;
use crate::methods::task::Task;
use crate::patch::PatchSurface;

/// The hole of a mesh with one loop.
fn cut(mesh: &TriMesh, rings: u32) -> (Hole, MeshPlace) {
    let boundary = BoundaryLoops::find(mesh);
    let rims = [&boundary.loops[0]];
    cut_out(mesh, &rims, HoleReach::rings(rings), &Job::unlimited()).unwrap()
}

/// What is wrong with triangles that are to be appended to the mesh over the hole.
fn against(mesh: &TriMesh, hole: &(Hole, MeshPlace), triangles: &[[u32; 3]]) -> Option<ErrorKind> {
    let rim_edges = hole.1.rim_edges(&hole.0.polygon);
    kind(check_against_mesh(mesh, &rim_edges, triangles))
}

/// The hole of a mesh with one loop, and its patch.
fn hole_and_patch(arrays: &Arrays, method: Method) -> (TriMesh, (Hole, MeshPlace), PatchSurface) {
    let mesh = mesh_of(arrays);
    let hole = cut(&mesh, 2);
    let options = with_method(method);
    let job = Job::unlimited();
    let surface = (method.spec().make)(&Task::new(&hole.0, &options, &job)).unwrap();
    (mesh, hole, surface)
}

fn sphere_cap() -> (TriMesh, (Hole, MeshPlace), PatchSurface) {
    hole_and_patch(
        &fixtures::sphere(10).jittered(0.01, 3).cut(|c| c[2] > 0.6),
        Method::FairC1,
    )
}

fn kind<T>(result: Result<T>) -> Option<ErrorKind> {
    result.err().map(|e| e.kind())
}

/// Panics unless the change to a valid patch is caught as `expected`.
fn assert_caught(expected: ErrorKind, what: &str, change: impl Fn(&mut PatchSurface)) {
    let (_, hole, mut surface) = sphere_cap();
    assert_eq!(
        kind(check_patch(
            &hole.0,
            &surface,
            Method::FairC1.spec().farthest,
            &Job::unlimited()
        )),
        None
    );
    change(&mut surface);
    assert_eq!(
        kind(check_patch(
            &hole.0,
            &surface,
            Method::FairC1.spec().farthest,
            &Job::unlimited()
        )),
        Some(expected),
        "{what}"
    );
}

#[test]
fn a_patch_as_it_is_made_is_accepted() {
    for method in super::METHODS {
        let (mesh, hole, surface) =
            hole_and_patch(&fixtures::sphere(9).cut(|c| c[0] > 0.5), method);
        assert_eq!(
            kind(check_patch(
                &hole.0,
                &surface,
                Method::FairC1.spec().farthest,
                &Job::unlimited()
            )),
            None
        );
        let global = |v: u32| match (v as usize).checked_sub(surface.rim_count) {
            Some(new) => (mesh.positions().len() + new) as u32,
            None => hole.1.rim[v as usize],
        };
        let triangles: Vec<_> = surface.triangles.iter().map(|t| t.map(global)).collect();
        assert_eq!(against(&mesh, &hole, &triangles), None);
    }
}

#[test]
fn each_single_triangle_that_is_missing_turned_or_doubled_is_caught() {
    let count = sphere_cap().2.triangles.len();
    assert!(count > 40);
    for f in 0..count {
        let (what, topology) = (format!("triangle {f}"), ErrorKind::Topology);
        assert_caught(topology, &what, |s| {
            s.triangles.remove(f);
        });
        assert_caught(topology, &what, |s| s.triangles[f].swap(0, 1));
        assert_caught(topology, &what, |s| s.triangles.push(s.triangles[f]));
        assert_caught(topology, &what, |s| s.triangles[f][1] = s.triangles[f][0]);
    }
}

#[test]
fn a_patch_turned_as_a_whole_or_empty_is_caught() {
    assert_caught(ErrorKind::Topology, "turned", |s| {
        s.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    });
    assert_caught(ErrorKind::Topology, "empty", |s| s.triangles.clear());
    assert_caught(ErrorKind::Topology, "unused", |s| {
        s.points.push(s.points[0])
    });
}

#[test]
fn a_piece_that_hangs_loose_is_caught() {
    let add_tetrahedron = |s: &mut PatchSurface, corner: Option<u32>| {
        let v = s.points.len() as u32;
        let near = s.points[s.rim_count];
        let count = if corner.is_some() { 3 } else { 4 };
        for k in 0..count {
            let mut p = near;
            p[k % 3] += 0.1 + 0.05 * k as f64;
            s.points.push(p);
        }
        let c = corner.unwrap_or(v + 3);
        s.triangles.extend([
            [v, v + 2, v + 1],
            [v, v + 1, c],
            [v + 1, v + 2, c],
            [v + 2, v, c],
        ]);
    };
    assert_caught(ErrorKind::Topology, "floating", |s| {
        add_tetrahedron(s, None)
    });
    assert_caught(ErrorKind::Topology, "on a vertex", |s| {
        add_tetrahedron(s, Some(s.rim_count as u32));
    });
}

#[test]
fn positions_that_cannot_be_are_caught() {
    let geometry = ErrorKind::Geometry;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e3] {
        assert_caught(geometry, &bad.to_string(), |s| {
            s.points[s.rim_count].y = bad
        });
    }
    assert_caught(geometry, "no area", |s| {
        let [a, b, c] = *s.triangles.last().unwrap();
        let inner = [a, b, c].into_iter().max().unwrap() as usize;
        let other = [a, b, c].into_iter().min().unwrap() as usize;
        s.points[inner] = s.points[other];
    });
}

#[test]
fn an_edge_that_the_mesh_has_already_is_caught() {
    // The rim of two triangles: its diagonal 1-2 is taken, 0-3 is free.
    let mesh = mesh_of(&fixtures::two_triangles());
    let hole = cut(&mesh, 1);
    let at = |v: u32| hole.1.rim.iter().position(|&r| r == v).unwrap() as u32;
    let patch = |triangles: [[u32; 3]; 2]| PatchSurface {
        rim_count: 4,
        points: hole.0.rim().to_vec(),
        triangles: triangles.map(|t| t.map(at)).to_vec(),
    };
    let free = patch([[0, 2, 3], [0, 3, 1]]);
    assert_eq!(
        kind(check_patch(
            &hole.0,
            &free,
            Method::FairC1.spec().farthest,
            &Job::unlimited()
        )),
        None
    );
    let taken = patch([[0, 2, 1], [1, 2, 3]]);
    assert_eq!(
        kind(check_patch(
            &hole.0,
            &taken,
            Method::FairC1.spec().farthest,
            &Job::unlimited()
        )),
        Some(ErrorKind::Topology)
    );
    let caught = |triangles: &[[u32; 3]]| against(&mesh, &hole, triangles);
    assert_eq!(caught(&[[0, 2, 3], [0, 3, 1]]), None);
    assert_eq!(caught(&[[0, 2, 1], [1, 2, 3]]), Some(ErrorKind::Topology));
}

#[test]
fn a_rim_that_was_closed_in_the_meantime_is_caught() {
    let mut mesh = mesh_of(&fixtures::triangle().with_vertex([0.0, 0.0, 1.0]));
    let hole = cut(&mesh, 1);
    let tent = [[1, 0, 3], [2, 1, 3], [0, 2, 3]];
    assert_eq!(against(&mesh, &hole, &tent), None);
    let lid = [[0, 2, 1]];
    assert_eq!(against(&mesh, &hole, &lid), Some(ErrorKind::Topology));
    let twins = pair_halfedges(&tent, 4);
    mesh.append(&[], &tent, &twins, |_, faces| faces.append_copies(&[0; 3]))
        .unwrap();
    assert_eq!(against(&mesh, &hole, &lid), Some(ErrorKind::Topology));
}

#[test]
fn the_coordinates_of_a_hole_are_those_of_the_mesh_moved_and_scaled() {
    let arrays = fixtures::sphere(10)
        .cut(|c| c[2] > 0.6)
        .moved(1e3, 1.0, [1e6, 0.0, -1e6]);
    let mesh = mesh_of(&arrays);
    let (hole, place) = cut(&mesh, 2);
    let n = hole.rim().len();
    assert!(hole.rim().iter().sum::<Vec3>().norm() < 1e-6);
    let perimeter: f64 = (0..n)
        .map(|i| (hole.rim()[(i + 1) % n] - hole.rim()[i]).norm())
        .sum();
    assert!((perimeter / n as f64 - 1.0).abs() < 1e-9);
    for (p, &v) in hole.rim().iter().zip(&place.rim) {
        assert!((place.to_mesh(p) - mesh.point(v)).norm() < 1e-8);
    }
    // The polygon runs against the loop.
    let boundary = BoundaryLoops::find(&mesh);
    let l = &boundary.loops[0].vertices;
    let at: Vec<u32> = hole
        .polygon
        .iter()
        .map(|&i| place.rim[i as usize])
        .collect();
    let first = l.iter().position(|&v| v == at[0]).unwrap();
    let expected: Vec<u32> = (0..n).map(|i| l[(first + n - i) % n]).collect();
    assert_eq!(at, expected);
}
