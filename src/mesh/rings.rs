//! Walking round a vertex, and the rings of triangles next to a rim.

use super::connectivity::{DEGENERATE, next, origin, previous};
use super::trimesh::TriMesh;
use std::collections::btree_map::{BTreeMap, Entry};
use std::collections::BTreeSet;

/// How a walk round a vertex came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FanEnd {
    /// At this halfedge, which has no neighbour.
    At(u32),
    /// Back where it began.
    Closed,
}

/// Walks through the triangles round `vertex`, from the triangle of `halfedge` away from the edge of
/// `halfedge`, which must touch `vertex`, and calls `visit` for each triangle.
///
/// Works whatever the orientation of the triangles is. The walk ends at an edge with one triangle or
/// with more than two.
pub(crate) fn walk_fan(
    mesh: &TriMesh,
    vertex: u32,
    halfedge: u32,
    mut visit: impl FnMut(u32),
) -> FanEnd {
    let (triangles, connectivity) = (mesh.triangles(), mesh.connectivity());
    let mut entry = halfedge;
    loop {
        visit(entry / 3);
        let exit = if origin(triangles, entry) == vertex { previous(entry) } else { next(entry) };
        let link = connectivity.twin(exit);
        if link >= DEGENERATE {
            return FanEnd::At(exit);
        }
        if link == halfedge {
            return FanEnd::Closed;
        }
        entry = link;
    }
}

/// Triangles and vertices near a rim, ring by ring, found through shared edges only: another sheet that
/// passes close by in space is not part of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rings {
    /// Triangles with their ring: ring `r` has the triangles that touch a vertex of level `r` and none
    /// of a lower level.
    pub(crate) faces: Vec<(u32, u32)>,
    /// Level of each vertex met: 0 on the rim, else the ring that it was met in, plus one.
    pub(crate) levels: BTreeMap<u32, u32>,
}

/// Collects `count` rings of triangles round the rim given by its boundary halfedges.
///
/// Cost follows the number of triangles collected.
pub(crate) fn collect_rings(mesh: &TriMesh, rim_halfedges: &[u32], count: u32) -> Rings {
    let triangles = mesh.triangles();
    let mut rings = Rings::default();
    let mut seen_faces = BTreeSet::new();
    // A vertex with the halfedge through which it was met, so that the walk stays on its sheet.
    let mut frontier: Vec<(u32, u32)> = Vec::new();
    for &h in rim_halfedges {
        // Each rim vertex is the head of one rim halfedge.
        let head = origin(triangles, next(h));
        rings.levels.insert(head, 0);
        frontier.push((head, h));
    }
    for ring in 0..count {
        let mut next_frontier = Vec::new();
        for (vertex, halfedge) in frontier {
            let mut visit = |face: u32| {
                if !seen_faces.insert(face) {
                    return;
                }
                rings.faces.push((face, ring));
                for k in 0..3 {
                    let h = 3 * face + k;
                    let v = origin(triangles, h);
                    if let Entry::Vacant(slot) = rings.levels.entry(v) {
                        slot.insert(ring + 1);
                        next_frontier.push((v, h));
                    }
                }
            };
            if let FanEnd::At(_) = walk_fan(mesh, vertex, halfedge, &mut visit) {
                // The fan is open: walk the other way round as well.
                let twin = mesh.connectivity().twin(halfedge);
                if twin < DEGENERATE {
                    walk_fan(mesh, vertex, twin, &mut visit);
                }
            }
        }
        frontier = next_frontier;
    }
    rings
}
