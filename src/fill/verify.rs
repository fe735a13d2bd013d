//! Whether a patch may be used: the checks that every filled hole has passed.

use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::aabb::Aabb;
use crate::math::cross_normal;
use crate::mesh::halfedge::{BOUNDARY, NON_MANIFOLD, origin, target};
use crate::mesh::pairing::pair_halfedges;
use crate::mesh::trimesh::TriMesh;
use crate::patch::PatchSurface;

/// A triangle has no area when its double area is below this share of the squared rim edge length, which
/// is the unit of the hole's coordinates.
const SMALLEST_DOUBLE_AREA: f64 = 2e-10;

/// Checks the patch by itself and against the rim, from whose middle it must not go further than `farthest`
/// diameters of the rim.
///
/// Every rim edge must have one triangle, which runs along it as the polygon does; every other edge two
/// triangles of opposite direction, and no counterpart in the mesh; no triangle may be degenerate or
/// without area; all points must be finite, near the hole and used; the Euler characteristic must be that
/// of a disk, less one for each island.
///
/// Returns the pairs of the triangles' halfedges, which it finds on the way.
///
/// # Errors
/// [`crate::ErrorKind::Topology`] or [`crate::ErrorKind::Geometry`] with the first violation found; `Cancelled` when
/// the job is stopped.
pub(crate) fn check_patch(
    hole: &Hole,
    surface: &PatchSurface,
    farthest: f64,
    job: &Job<'_>,
) -> Result<Vec<u32>> {
    if let Some(v) = surface
        .points
        .iter()
        .position(|p| !p.iter().all(|c| c.is_finite()))
    {
        return Err(Error::geometry(format!("new vertex {v} is not finite")));
    }
    let rim = Aabb::around(hole.rim());
    let limit = farthest * (rim.hi - rim.lo).norm();
    let middle = (rim.hi + rim.lo) / 2.0;
    if surface.points.iter().any(|p| (p - middle).norm() > limit) {
        return Err(Error::geometry(
            "the patch runs away from the hole".to_owned(),
        ));
    }
    let m = hole.polygon.len();
    let mut rim_edges: Vec<(u32, u32)> = (0..m)
        .filter(|&i| !hole.is_bridge[i])
        .map(|i| (hole.polygon[i], hole.polygon[(i + 1) % m]))
        .collect();
    rim_edges.sort_unstable();
    for t in &surface.triangles {
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            return Err(Error::topology(format!(
                "new triangle {t:?} names a vertex twice"
            )));
        }
        let [a, b, c] = t.map(|v| &surface.points[v as usize]);
        if cross_normal(a, b, c).norm() < SMALLEST_DOUBLE_AREA {
            return Err(Error::geometry("a new triangle has no area".to_owned()));
        }
    }
    job.ask()?;
    let twins = pair_halfedges(&surface.triangles, surface.points.len());
    job.ask()?;
    let mut is_used = vec![false; surface.points.len()];
    surface
        .triangles
        .iter()
        .flatten()
        .for_each(|&v| is_used[v as usize] = true);
    if let Some(v) = is_used.iter().position(|used| !used) {
        return Err(Error::topology(format!(
            "vertex {v} of the patch has no triangle"
        )));
    }
    let mut edge_count = 0;
    let mut rim_edges_met = 0;
    for (h, twin) in (0_u32..).zip(&twins) {
        let (a, b) = (origin(&surface.triangles, h), target(&surface.triangles, h));
        let is_rim = |edge| rim_edges.binary_search(&edge).is_ok();
        let is_right = match *twin {
            BOUNDARY => is_rim((a, b)),
            NON_MANIFOLD => false,
            // The other halfedge has been looked at.
            twin if twin < h => continue,
            twin => {
                let joins_rim = a.max(b) < surface.rim_count as u32;
                let is_known = || is_rim((a, b)) || is_rim((b, a)) || hole.is_joined(a, b);
                origin(&surface.triangles, twin) == b && !(joins_rim && is_known())
            }
        };
        if !is_right {
            return Err(Error::topology(format!(
                "the edge between vertices {a} and {b} of the patch would be open, run the wrong way, have more than \
                 two new triangles, or join two vertices twice"
            )));
        }
        rim_edges_met += usize::from(*twin == BOUNDARY);
        edge_count += 1;
    }
    if rim_edges_met != rim_edges.len() {
        return Err(Error::topology(format!(
            "{} of {} rim edges would stay open",
            rim_edges.len() - rim_edges_met,
            rim_edges.len()
        )));
    }
    // One face over the polygon, whose bridges are passed twice.
    let bridges = (m - rim_edges.len()) / 2;
    let expected = (hole.rim().len() + 1) as i64 - (rim_edges.len() + bridges) as i64;
    let found = (surface.points.len() + surface.triangles.len()) as i64 - edge_count;
    if found != expected {
        return Err(Error::topology(format!(
            "the patch has the Euler characteristic {found} instead of {expected}"
        )));
    }
    Ok(twins)
}

/// Checks a patch, given by the edges that it closes and its triangles in the mesh's vertex indices, against the mesh as it
/// is now: other holes may have been filled since the patch was made.
///
/// # Errors
/// [`crate::ErrorKind::Topology`] when the patch would repeat an edge or a triangle, or its rim is not open.
pub(crate) fn check_against_mesh(
    mesh: &TriMesh,
    rim_edges: &[[u32; 2]],
    triangles: &[[u32; 3]],
) -> Result<()> {
    for &[a, b] in rim_edges {
        let known = mesh.connectivity().outgoing(b).find(|o| o.target == a);
        if known.is_none_or(|o| mesh.connectivity().twin(o.halfedge) != BOUNDARY) {
            return Err(Error::topology(format!(
                "the edge between vertices {a} and {b} is not open"
            )));
        }
    }
    let undirected = rim_edges.iter().map(|&[a, b]| (a.min(b), a.max(b)));
    let mut rim_edges: Vec<(u32, u32)> = undirected.collect();
    rim_edges.sort_unstable();
    let is_old = |v: u32| (v as usize) < mesh.positions().len();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if !(is_old(a) && is_old(b)) {
                continue;
            }
            let is_rim = rim_edges.binary_search(&(a.min(b), a.max(b))).is_ok();
            if !is_rim && mesh.connectivity().has_edge(a, b) {
                return Err(Error::topology(format!(
                    "vertices {a} and {b} are joined by an edge already"
                )));
            }
        }
        if t.iter().all(|&v| is_old(v)) && mesh.connectivity().has_face(mesh.triangles(), *t) {
            return Err(Error::topology(format!(
                "the patch would repeat the triangle {t:?}"
            )));
        }
    }
    Ok(())
}
