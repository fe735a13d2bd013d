//! Walks round a vertex, and collects the rings of triangles round a rim.

use super::halfedge::{DEGENERATE, next, origin, previous};
use super::trimesh::TriMesh;
use crate::error::Result;
use crate::job::Job;
use crate::math::segments::Segments;

/// The extent of the rings round a rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach {
    /// Number of complete rings of triangles.
    pub(crate) rings: u32,
    /// In addition, triangles with a vertex nearer to the rim than this, in units of the mesh.
    pub(crate) distance: f64,
}

impl Reach {
    /// The given number of rings, and no more.
    pub(crate) fn rings(rings: u32) -> Self {
        Self {
            rings,
            distance: 0.0,
        }
    }
}

/// The end of a walk round a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FanEnd {
    /// The walk ended at this halfedge, which has no neighbor.
    At(u32),
    /// The walk came back to its start.
    Closed,
}

/// Walks through the triangles round `vertex` and calls `visit` for each. The walk starts in the triangle of `halfedge`
/// and leads away from its edge, which must have `vertex` as an end.
///
/// Triangles may be oriented inconsistently. The walk ends at an edge with one triangle or with more than two.
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
        let exit = if origin(triangles, entry) == vertex {
            previous(entry)
        } else {
            next(entry)
        };
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

/// Triangles and vertices near a rim, ring by ring. They are found through shared edges only, so a different sheet
/// that is near in space is not included.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rings {
    /// Triangles with their rings, sorted by ring, then by triangle. The ring of a triangle is the lowest level of its
    /// vertices.
    pub(crate) faces: Vec<(u32, u32)>,
    /// Vertices with their levels, sorted by vertex. The level is 0 on the rim; elsewhere it is the ring in which the
    /// vertex was found, plus one.
    pub(crate) levels: Vec<(u32, u32)>,
}

/// Collects the rings of triangles round a rim within `reach`. The rim is given by its boundary halfedges.
///
/// The cost is proportional to the number of collected triangles, plus sorting them and, if `reach` has a distance, a
/// search among the rim's edges for each vertex.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(crate) fn collect_rings(
    mesh: &TriMesh,
    rim_halfedges: &[u32],
    reach: Reach,
    job: &Job<'_>,
) -> Result<Rings> {
    let triangles = mesh.triangles();
    // Vertices with the halfedges through which they were found, so that the walk stays on its sheet. Each rim vertex
    // is the head of one rim halfedge.
    let mut frontier: Vec<(u32, u32)> = rim_halfedges
        .iter()
        .map(|&h| (origin(triangles, next(h)), h))
        .collect();
    let mut levels: Vec<(u32, u32)> = frontier.iter().map(|&(v, _)| (v, 0)).collect();
    levels.sort_unstable();
    levels.dedup();
    let mut faces: Vec<(u32, u32)> = Vec::new();
    let mut known_faces: Vec<u32> = Vec::new();
    let mut rim_edges: Option<Segments> = None;
    for ring in 0.. {
        job.ask()?;
        if ring >= reach.rings && reach.distance > 0.0 {
            let rim_edges = match &rim_edges {
                Some(known) => known,
                None => rim_edges.insert(edges(mesh, rim_halfedges, job)?),
            };
            let limit = reach.distance * reach.distance;
            job.ask()?;
            let mut near = Vec::with_capacity(frontier.len());
            for &(v, h) in &frontier {
                job.tick(30)?;
                if rim_edges.distance_sq(&mesh.point(v)) < limit {
                    near.push((v, h));
                }
            }
            frontier = near;
        } else if ring >= reach.rings {
            break;
        }
        if frontier.is_empty() {
            break;
        }
        let mut met = Vec::new();
        for &(vertex, halfedge) in &frontier {
            if let FanEnd::At(_) = walk_fan(mesh, vertex, halfedge, |face| met.push(face)) {
                // The fan is open, so the walk is done in the other direction, too.
                let twin = mesh.connectivity().twin(halfedge);
                if twin < DEGENERATE {
                    walk_fan(mesh, vertex, twin, |face| met.push(face));
                }
            }
        }
        met.sort_unstable();
        met.dedup();
        met.retain(|face| known_faces.binary_search(face).is_err());
        faces.extend(met.iter().map(|&face| (face, ring)));
        frontier = met
            .iter()
            .flat_map(|&face| 3 * face..3 * face + 3)
            .map(|h| (origin(triangles, h), h))
            .filter(|&(v, _)| {
                levels
                    .binary_search_by_key(&v, |&(known, _)| known)
                    .is_err()
            })
            .collect();
        frontier.sort_unstable();
        frontier.dedup_by_key(|&mut (v, _)| v);
        levels.extend(frontier.iter().map(|&(v, _)| (v, ring + 1)));
        levels.sort_unstable();
        known_faces.append(&mut met);
        known_faces.sort_unstable();
    }
    Ok(Rings { faces, levels })
}

fn edges(mesh: &TriMesh, halfedges: &[u32], job: &Job<'_>) -> Result<Segments> {
    let triangles = mesh.triangles();
    let ends = halfedges
        .iter()
        .map(|&h| [origin(triangles, h), origin(triangles, next(h))].map(|v| mesh.point(v)));
    Segments::new(ends.collect(), job)
}
