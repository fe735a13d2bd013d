//! Filling holes, from the outside of the module: what every fill of any mesh must keep.

mod attributes;
mod auto;
mod conflicts;
mod creases;
mod interruption;
mod islands;
mod outcomes;
mod properties;
mod shape;
mod unfold;
mod verify;

use super::report::{FillReport, HoleStatus};
use super::session::at_once::fill_holes;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::fixtures::Arrays;
use crate::job::Job;
use crate::math::Vec3;
use crate::mesh::halfedge::BOUNDARY;
use crate::mesh::pairing::pair_halfedges;
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::options::FillOptions;
use crate::quality::Surface;
use crate::quality::self_intersection::{AppendedPatch, count};
use crate::quality::spatial::FaceIndex;
use crate::quality::topology::{Topology, examine};
use std::collections::BTreeSet;

/// The methods that are not a choice among the others.
const METHODS: [Method; 5] = [
    Method::Flat,
    Method::Membrane,
    Method::FairC1,
    Method::FairC2,
    Method::Hpde,
];

fn mesh_of(arrays: &Arrays) -> TriMesh {
    TriMesh::new(arrays.positions.clone(), arrays.triangles.clone()).unwrap()
}

/// Options for `method` on one thread.
fn with_method(method: Method) -> FillOptions {
    FillOptions {
        method,
        threads: 1,
        ..FillOptions::default()
    }
}

/// Everything but the loop of the largest perimeter.
fn all_but_the_largest() -> Selection {
    Selection {
        keep_largest: 1,
        ..Selection::default()
    }
}

/// A mesh before and after a fill.
struct Filled {
    before: TriMesh,
    boundary: BoundaryLoops,
    after: TriMesh,
    report: FillReport,
}

/// Fills and checks everything that holds for any fill.
fn fill_mesh(before: TriMesh, selection: &Selection, options: &FillOptions) -> Filled {
    let boundary = BoundaryLoops::find(&before);
    let mut after = before.clone();
    let report = fill_holes(&mut after, &boundary, selection, options, None).unwrap();
    let filled = Filled {
        before,
        boundary,
        after,
        report,
    };
    filled.check();
    filled
}

fn fill(arrays: &Arrays, selection: &Selection, options: &FillOptions) -> Filled {
    fill_mesh(mesh_of(arrays), selection, options)
}

fn bits(positions: &[[f64; 3]]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.map(f64::to_bits)).collect()
}

impl Filled {
    fn statuses(&self) -> Vec<HoleStatus> {
        self.report.holes.iter().map(|h| h.status).collect()
    }

    fn new_triangles(&self) -> &[[u32; 3]] {
        &self.after.triangles()[self.before.triangles().len()..]
    }

    fn topology(&self) -> Topology {
        examine(self.after.triangles())
    }

    fn check(&self) {
        self.check_input_kept();
        self.check_report();
        self.check_loops();
        self.check_topology();
        assert_eq!(self.recounted(), self.reported_intersections());
    }

    /// What was there is there, bit for bit, and what was appended is fit to be there.
    fn check_input_kept(&self) {
        let (old, new) = (&self.before, &self.after);
        let (n, f) = (old.positions().len(), old.triangles().len());
        assert_eq!(bits(&new.positions()[..n]), bits(old.positions()));
        assert_eq!(&new.triangles()[..f], old.triangles());
        assert!(new.positions()[n..].iter().flatten().all(|c| c.is_finite()));
        assert_eq!(new.vertex_attributes().len(), new.positions().len());
        assert_eq!(new.face_attributes().len(), new.triangles().len());
        let count = new.positions().len() as u32;
        assert!(self.new_triangles().iter().flatten().all(|&v| v < count));
    }

    /// The ranges of the reports tile what was appended, and each status has what belongs to it.
    fn check_report(&self) {
        assert_eq!(self.report.holes.len(), self.boundary.loops.len());
        let mut vertices = self.before.positions().len() as u32;
        let mut triangles = self.before.triangles().len() as u32;
        for (l, hole) in self.boundary.loops.iter().zip(&self.report.holes) {
            assert_eq!((hole.id, hole.edge), (l.id, l.edge()));
            assert_eq!((hole.edges, hole.class), (l.edge_count(), l.class));
            if hole.method.is_some() {
                assert_eq!(hole.status, HoleStatus::Filled);
                assert_eq!(hole.new_vertices.start, vertices);
                assert_eq!(hole.new_triangles.start, triangles);
                assert!(!hole.new_triangles.is_empty());
                assert!(hole.min_angle.is_some_and(|a| (0.0..=1.05).contains(&a)));
                assert_eq!(hole.reason.is_empty(), hole.self_intersections == 0);
                vertices = hole.new_vertices.end;
                triangles = hole.new_triangles.end;
            } else {
                assert!(hole.new_vertices.is_empty() && hole.new_triangles.is_empty());
                assert!(!hole.reason.is_empty(), "{hole:?}");
                assert_eq!(hole.self_intersections, 0);
            }
        }
        assert_eq!(vertices as usize, self.after.positions().len());
        assert_eq!(triangles as usize, self.after.triangles().len());
    }

    /// Filled loops are closed, the others are open as before, and no other boundary came about.
    fn check_loops(&self) {
        let mut open: Vec<u32> = Vec::new();
        for (l, hole) in self.boundary.loops.iter().zip(&self.report.holes) {
            if hole.status != HoleStatus::Filled {
                open.extend(&l.halfedges);
            }
        }
        open.sort_unstable();
        assert_eq!(self.after.connectivity().boundary_halfedges(), open);
    }

    /// The mesh is as sound as it was, and its connectivity is that of a mesh built from its arrays.
    fn check_topology(&self) {
        let (positions, triangles, ..) = self.after.clone().into_parts();
        let rebuilt = TriMesh::new(positions, triangles).unwrap();
        for h in 0..3 * rebuilt.triangles().len() as u32 {
            assert_eq!(
                rebuilt.connectivity().twin(h),
                self.after.connectivity().twin(h)
            );
        }
        assert_eq!(rebuilt.defects(), self.before.defects());
        let (old, new) = (examine(self.before.triangles()), self.topology());
        let flaws = |t: &Topology| {
            [
                t.nonmanifold_edges,
                t.inconsistent_edges,
                t.degenerate_faces,
                t.duplicate_faces,
            ]
        };
        assert_eq!(flaws(&new), flaws(&old));
        assert!(new.nonmanifold_vertices <= old.nonmanifold_vertices);
        for hole in self.report.holes.iter().filter(|h| h.method.is_some()) {
            let range = hole.new_triangles.start as usize..hole.new_triangles.end as usize;
            let patch = examine(&self.after.triangles()[range]);
            assert_eq!(
                patch.euler_characteristic(),
                self.expected_euler(hole.id),
                "{hole:?}"
            );
            assert_eq!(patch.components, 1);
        }
    }

    /// That of a disk over the loop, joined to each of its islands by a bridge or by a shared vertex.
    fn expected_euler(&self, outer: usize) -> i64 {
        let loops = &self.boundary.loops;
        let mut vertices: BTreeSet<u32> = loops[outer].vertices.iter().copied().collect();
        let mut edges = loops[outer].edge_count();
        for l in loops.iter().filter(|l| l.host == Some(outer)) {
            let report = &self.report.holes[l.id];
            if report.status == HoleStatus::Filled && report.method.is_none() {
                let is_bridged = l.vertices.iter().all(|v| !vertices.contains(v));
                edges += l.edge_count() + usize::from(is_bridged);
                vertices.extend(&l.vertices);
            }
        }
        vertices.len() as i64 - edges as i64 + 1
    }

    fn reported_intersections(&self) -> usize {
        self.report.holes.iter().map(|h| h.self_intersections).sum()
    }

    /// All intersecting pairs with a new triangle, counted at once.
    fn recounted(&self) -> usize {
        let mesh = Surface {
            points: self.before.points(),
            triangles: self.before.triangles(),
        };
        let patch = AppendedPatch {
            points: &self.after.points()[self.before.positions().len()..],
            triangles: self.new_triangles(),
            twins: &pair_halfedges(self.new_triangles(), self.after.positions().len()),
        };
        let faces = FaceIndex::build(mesh, &Job::unlimited()).unwrap();
        count(mesh, &faces, patch, &Job::unlimited())
            .unwrap()
            .total()
    }

    /// The angles in radians between the normals of a new and an old triangle at the edges of the filled loops.
    fn creases_at_the_rims(&self) -> Vec<f64> {
        let normal = |h: u32| {
            let [a, b, c] = self.after.corners(h / 3);
            crate::math::unit(crate::math::cross_normal(&a, &b, &c))
        };
        let rims = self.boundary.loops.iter().flat_map(|l| &l.halfedges);
        let pairs = rims.map(|&h| (h, self.after.connectivity().twin(h)));
        pairs
            .filter(|&(_, twin)| twin != BOUNDARY)
            .map(|(h, twin)| normal(h).angle(&normal(twin)))
            .collect()
    }

    fn largest_crease_at_the_rims(&self) -> f64 {
        self.creases_at_the_rims().into_iter().fold(0.0, f64::max)
    }

    fn new_points(&self) -> &[Vec3] {
        &self.after.points()[self.before.positions().len()..]
    }
}
