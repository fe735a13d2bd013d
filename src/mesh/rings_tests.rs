//! Tests: compares the rings of triangles round a rim with a breadth-first search over the whole mesh.

use super::halfedge::DEGENERATE;
use super::rings::{FanEnd, Reach, Rings, collect_rings, walk_fan};
use super::trimesh::TriMesh;
use crate::boundary::loops::BoundaryLoops;
use crate::fixtures::{self, Arrays};
use crate::job::Job;
use std::collections::BTreeSet;

fn mesh_of(arrays: &Arrays) -> TriMesh {
    TriMesh::new(arrays.positions.clone(), arrays.triangles.clone()).unwrap()
}

fn collected(mesh: &TriMesh, rim_halfedges: &[u32], reach: Reach) -> Rings {
    collect_rings(mesh, rim_halfedges, reach, &Job::unlimited()).unwrap()
}

/// Levels of all vertices: edges between them and the nearest one of `rim`.
fn distances(mesh: &TriMesh, rim: &[u32]) -> Vec<u32> {
    let mut level = vec![u32::MAX; mesh.positions().len()];
    rim.iter().for_each(|&v| level[v as usize] = 0);
    loop {
        let mut changed = false;
        for t in mesh.triangles() {
            let lowest = t.iter().map(|&v| level[v as usize]).min().unwrap();
            for &v in t {
                if lowest != u32::MAX && level[v as usize] > lowest + 1 {
                    level[v as usize] = lowest + 1;
                    changed = true;
                }
            }
        }
        if !changed {
            return level;
        }
    }
}

#[test]
fn rings_are_those_of_a_breadth_first_search() {
    for (arrays, count) in [
        (fixtures::sheet_with_hole(), 2),
        (fixtures::sheet_with_hole(), 4),
        (fixtures::sphere(10).cut(|c| c[2] > 0.6), 3),
        (fixtures::cylinder(20, 5), 3),
        (fixtures::torus(16, 30).cut(|c| c[0] > 2.5), 2),
    ] {
        let mesh = mesh_of(&arrays);
        for l in &BoundaryLoops::find(&mesh).loops {
            let level = distances(&mesh, &l.vertices);
            let rings = collected(&mesh, &l.halfedges, Reach::rings(count));
            let expected: Vec<(u32, u32)> = (0..mesh.triangles().len())
                .map(|f| (f as u32, mesh.triangles()[f].map(|v| level[v as usize])))
                .map(|(f, levels)| (f, levels.into_iter().min().unwrap()))
                .filter(|&(_, ring)| ring < count)
                .collect();
            let mut found = rings.faces.clone();
            found.sort_unstable();
            assert_eq!(found, expected);
            for &(v, found) in &rings.levels {
                assert_eq!(found, level[v as usize], "vertex {v}");
            }
            let used: BTreeSet<u32> = found
                .iter()
                .flat_map(|&(f, _)| mesh.triangles()[f as usize])
                .collect();
            assert!(used.iter().eq(rings.levels.iter().map(|(v, _)| v)));
            assert!(rings.faces.is_sorted_by_key(|&(f, ring)| (ring, f)));
        }
    }
}

#[test]
fn a_sheet_that_only_touches_or_passes_close_by_is_not_collected() {
    let lower = fixtures::sheet_with_hole();
    let upper = lower.mapped(|p| [p[0], p[1], p[2] + 1e-9]);
    let mesh = mesh_of(&lower.beside(&upper));
    let count = lower.triangles.len() as u32;
    for l in &BoundaryLoops::find(&mesh).loops {
        let is_lower = l.halfedges[0] / 3 < count;
        let rings = collected(&mesh, &l.halfedges, Reach::rings(3));
        assert!(rings.faces.iter().all(|&(f, _)| (f < count) == is_lower));
    }
    // The tongue shares one vertex with the rim, and its triangles are not round the hole.
    let mesh = mesh_of(&fixtures::tongue());
    let boundary = BoundaryLoops::find(&mesh);
    for l in &boundary.loops {
        let rings = collected(&mesh, &l.halfedges, Reach::rings(1));
        let is_tongue = |f: u32| {
            let c = mesh.corners(f).iter().sum::<crate::math::Vec3>() / 3.0;
            (2.0..4.0).contains(&c.x) && (2.0..4.0).contains(&c.y)
        };
        let of_tongue = is_tongue(l.halfedges[0] / 3);
        assert!(rings.faces.iter().all(|&(f, _)| is_tongue(f) == of_tongue));
    }
}

#[test]
fn a_walk_round_a_vertex_visits_each_triangle_of_its_fan_once() {
    for f in fixtures::fixtures() {
        let mesh = mesh_of(&f.mesh);
        if mesh.triangles().len() > 1000 {
            continue;
        }
        for h in 0..mesh.connectivity().halfedge_count() as u32 {
            let (face, k) = (h as usize / 3, h as usize % 3);
            let vertex = mesh.triangles()[face][k];
            let mut visited = Vec::new();
            let end = walk_fan(&mesh, vertex, h, |f| visited.push(f));
            assert!(
                visited
                    .iter()
                    .all(|&f| mesh.triangles()[f as usize].contains(&vertex))
            );
            let distinct: BTreeSet<u32> = visited.iter().copied().collect();
            assert_eq!(distinct.len(), visited.len(), "{}", f.name);
            if let FanEnd::At(edge) = end {
                assert!(mesh.connectivity().twin(edge) >= DEGENERATE);
                assert_eq!(edge / 3, *visited.last().unwrap());
            }
        }
    }
}

#[test]
fn a_distance_collects_what_touches_a_vertex_nearer_than_it() {
    // A grid of unit squares: the columns count the distance from the edge x = 0.
    let mesh = mesh_of(&fixtures::sheet_with_hole());
    for l in &BoundaryLoops::find(&mesh).loops {
        let segments = (0..l.vertices.len()).map(|i| l.directed_edge(i).map(|v| mesh.point(v)));
        let segments =
            crate::math::segments::Segments::new(segments.collect(), &Job::unlimited()).unwrap();
        let distance = 2.5 * l.perimeter / l.vertices.len() as f64;
        for rings in [0, 1, 6] {
            let reach = Reach { rings, distance };
            let found = collected(&mesh, &l.halfedges, reach);
            let whole = collected(&mesh, &l.halfedges, Reach::rings(rings));
            let mut expected: Vec<u32> = (0..mesh.triangles().len() as u32)
                .filter(|&f| {
                    let near = |p| segments.distance_sq(p) < distance * distance;
                    mesh.corners(f).iter().any(near)
                })
                .chain(whole.faces.iter().map(|&(f, _)| f))
                .collect();
            expected.sort_unstable();
            expected.dedup();
            let mut found: Vec<u32> = found.faces.iter().map(|&(f, _)| f).collect();
            found.sort_unstable();
            assert_eq!(found, expected);
        }
    }
}
