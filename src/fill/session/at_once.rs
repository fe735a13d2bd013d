//! Fills the chosen holes of a mesh in one call.

use super::{FillSession, Target};
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::boundary_loop::LoopClass;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::error::{Error, Result};
use crate::fill::progress::{ProgressCallback, Watch};
use crate::fill::report::FillReport;
use crate::mesh::halfedge::{BOUNDARY, origin, target};
use crate::mesh::trimesh::TriMesh;
use crate::options::FillOptions;
use std::time::Instant;

/// Fills the holes of `mesh` that `selection` chooses among the loops in `boundary`.
///
/// New vertices and triangles are appended in the order of the loops; everything that was in the mesh
/// stays bit for bit and keeps its index. New triangles are oriented like those round their hole. A hole
/// that cannot be filled is left as it was, with the reason in its report, and the others are still filled.
/// Every patch is checked: manifold, oriented, without degenerate or duplicate triangles, and tested for
/// intersections with itself, with the mesh and with the other patches; if it fails, simpler methods are
/// tried in turn (see [`FillOptions::fallback`]).
///
/// `boundary` must be [`BoundaryLoops::find`] of this mesh as it is; afterwards it describes the mesh
/// before the fill.
///
/// Not guaranteed: that a patch has no intersections at all. When every method's patch has some, the one with
/// the fewest is used and [`self_intersections`](crate::HoleReport::self_intersections) says how many remain.
///
/// # Errors
/// [`crate::ErrorKind::InvalidInput`] when the selection names an edge that is on no loop, when `boundary` is not that
/// of `mesh`, when an option is out of its range or names an attribute that `mesh` lacks, or when the thread pool cannot be made. The mesh is then
/// unchanged. What goes wrong with a single hole is not an error of the call.
///
/// # Complexity
/// One pass over the mesh for the index of the intersection tests, then each hole by itself: about
/// `k^1.5` for `k` new vertices.
pub fn fill_holes(
    mesh: &mut TriMesh,
    boundary: &BoundaryLoops,
    selection: &Selection,
    options: &FillOptions,
    progress: Option<ProgressCallback<'_>>,
) -> Result<FillReport> {
    check_boundary(mesh, boundary)?;
    let mut lent = Lent::new(mesh, boundary.clone());
    let mut watch = Watch::new(0, options.time_budget, progress);
    let target = Target::Selected(selection);
    let plan = lent.session.plan_watched(target, options, &mut watch)?;
    let mut report = lent.session.stitch(plan, &watch);
    // Giving back the memory of a large index takes longer than filling a small hole.
    let start = Instant::now();
    drop(lent);
    report.index_seconds += start.elapsed().as_secs_f64();
    Ok(report)
}

/// A session with the mesh of somebody else, who gets it back whatever happens.
struct Lent<'a> {
    owner: &'a mut TriMesh,
    session: FillSession,
}

impl<'a> Lent<'a> {
    fn new(owner: &'a mut TriMesh, boundary: BoundaryLoops) -> Self {
        let session = FillSession::with_boundary(std::mem::take(owner), boundary);
        Self { owner, session }
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        *self.owner = std::mem::take(&mut self.session.mesh);
    }
}

/// Fails when a loop does not run along open edges of the mesh.
fn check_boundary(mesh: &TriMesh, boundary: &BoundaryLoops) -> Result<()> {
    let (triangles, connectivity) = (mesh.triangles(), mesh.connectivity());
    let is_edge = |l: &BoundaryLoop, i: usize| {
        let h = l.halfedges[i];
        (h as usize) < connectivity.halfedge_count()
            && connectivity.twin(h) == BOUNDARY
            && l.directed_edge(i) == [origin(triangles, h), target(triangles, h)]
    };
    let is_sound = |id: usize, l: &BoundaryLoop| {
        let open_end = usize::from(l.class == LoopClass::OpenChain);
        l.id == id
            && l.vertices.len() == l.edge_count() + open_end
            && (0..l.edge_count()).all(|i| is_edge(l, i))
            && (l.reversed.is_empty() || l.class.unfillable_reason().is_some())
            && l.host.is_none_or(|host| host < boundary.loops.len())
    };
    match (0..boundary.loops.len()).find(|&id| !is_sound(id, &boundary.loops[id])) {
        Some(id) => Err(Error::invalid(format!(
            "loop {id} is not on the boundary of this mesh"
        ))),
        None => Ok(()),
    }
}
