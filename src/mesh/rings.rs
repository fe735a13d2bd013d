//! Walking round a vertex, and the rings of triangles next to a rim.

use super::halfedge::{DEGENERATE, next, origin, previous};
use super::trimesh::TriMesh;
use crate::error::Result;
use crate::job::Job;
use crate::math::segments::Segments;

/// How far the rings round a rim go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach {
    /// Rings of triangles that are collected whole.
    pub(crate) rings: u32,
    /// Further rings have the triangles that touch a vertex nearer to the rim than this, in units of the mesh.
    pub(crate) distance: f64,
}

impl Reach {
    /// So many rings, and no more.
    pub(crate) fn rings(rings: u32) -> Self {
        Self {
            rings,
            distance: 0.0,
        }
    }
}

/// How a walk round a vertex came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FanEnd {
    /// At this halfedge, which has no neighbor.
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

/// Triangles and vertices near a rim, ring by ring, found through shared edges only: another sheet that
/// passes close by in space is not part of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rings {
    /// Triangles with their ring: ring `r` has the triangles that touch a vertex of level `r` and none
    /// of a lower level. Ordered by ring, then by triangle.
    pub(crate) faces: Vec<(u32, u32)>,
    /// Vertices with their level: 0 on the rim, else the ring that the vertex was met in, plus one.
    /// Ordered by vertex.
    pub(crate) levels: Vec<(u32, u32)>,
}

/// Collects rings of triangles round the rim given by its boundary halfedges, as far as `reach` says.
///
/// Cost follows the number of triangles collected, but for sorting them and, where the distance counts, a
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
    // A vertex with the halfedge through which it was met, so that the walk stays on its sheet. Each rim
    // vertex is the head of one rim halfedge.
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
                // The fan is open: walk the other way round as well.
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
