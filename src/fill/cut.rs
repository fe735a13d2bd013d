//! Cuts one opening out of the mesh: its rim, the polygon to triangulate, and the triangles round it.

use crate::boundary::boundary_loop::BoundaryLoop;
use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use crate::mesh::halfedge::target;
use crate::mesh::rings::{Reach, collect_rings};
use crate::mesh::trimesh::TriMesh;
use crate::methods::spec::HoleReach;
use crate::surroundings::Surroundings;

/// Where a hole lies in its mesh: what its own coordinates and indices mean there.
pub(crate) struct MeshPlace {
    /// Rim vertices in the mesh; rim vertex `i` of a patch is `rim[i]`.
    pub(crate) rim: Vec<u32>,
    /// Triangle of the mesh at each edge of the hole's polygon; `None` where there is none.
    pub(crate) outside_faces: Vec<Option<u32>>,
    /// The boundary halfedges of the rim.
    halfedges: Vec<u32>,
    rim_index: LocalIndex,
    center: Vec3,
    scale: f64,
}

/// Cuts out the opening that `rims` bound, with the triangles round it as far as `reach` says. The first rim is the outer
/// one; the others are joined to it by bridges.
///
/// # Errors
/// [`InvalidInput`](crate::ErrorKind::InvalidInput) when the first rim has fewer than three edges,
/// [`Geometry`](crate::ErrorKind::Geometry) when all vertices of the rims coincide, `Cancelled`.
pub(crate) fn cut_out(
    mesh: &TriMesh,
    rims: &[&BoundaryLoop],
    reach: HoleReach,
    job: &Job<'_>,
) -> Result<(Hole, MeshPlace)> {
    let (outer, islands) = rims
        .split_first()
        .ok_or_else(|| Error::invalid("an opening without a rim"))?;
    if outer.edge_count() < 3 {
        return Err(Error::invalid(format!(
            "a loop of {} edges encloses no area",
            outer.edge_count()
        )));
    }
    let mut polygon = Polygon::of_loop(mesh, outer);
    for island in islands {
        polygon.join(mesh, Polygon::of_loop(mesh, island));
    }
    job.ask()?;
    let rim = distinct(polygon.0.iter().map(|e| e.0));
    let rim_index = LocalIndex::new(rim.iter().zip(0..).map(|(&v, i)| (v, i)).collect());
    let count = rim.len() as f64;
    let perimeter = outer.perimeter + islands.iter().map(|l| l.perimeter).sum::<f64>();
    let place = MeshPlace {
        center: rim.iter().map(|&v| mesh.point(v)).sum::<Vec3>() / count,
        scale: perimeter / count,
        outside_faces: polygon.0.iter().map(|e| e.1.map(|h| h / 3)).collect(),
        halfedges: rims.iter().flat_map(|l| &l.halfedges).copied().collect(),
        rim_index,
        rim,
    };
    place.check_scale()?;
    let outside_normal = |face: &Option<u32>| {
        let [a, b, c] = mesh.triangles()[(*face)? as usize].map(|v| place.to_local(mesh, v));
        let normal = unit(cross_normal(&a, &b, &c));
        (normal != Vec3::zeros()).then_some(normal)
    };
    let outside_normals = place.outside_faces.iter().map(outside_normal).collect();
    job.ask()?;
    let joined = joined_rim_vertices(mesh, &place.rim, &place.rim_index);
    job.ask()?;
    let (mut surroundings, _) = place.surroundings(mesh, Reach::rings(reach.rings.max(1)), job)?;
    job.ask()?;
    if reach.steps > 0.0 {
        let reach = place.reach(reach, surroundings.sampling_step());
        (surroundings, _) = place.surroundings(mesh, reach, job)?;
    }
    job.ask()?;
    let local = |e: &(u32, _)| place.rim_index.get(e.0);
    let hole = Hole {
        edge_lengths: surroundings.edge_lengths(),
        surroundings,
        polygon: polygon.0.iter().filter_map(local).collect(),
        is_bridge: polygon.0.iter().map(|e| e.1.is_none()).collect(),
        outside_normals,
        joined,
    };
    Ok((hole, place))
}

impl MeshPlace {
    /// That of a hole whose rim vertices are the first `count` of a mesh without triangles.
    pub(super) fn of_points(count: usize, center: Vec3, scale: f64) -> Self {
        let rim: Vec<u32> = (0..count as u32).collect();
        Self {
            rim_index: LocalIndex::new(rim.iter().map(|&i| (i, i)).collect()),
            rim,
            outside_faces: vec![None; count],
            halfedges: Vec::new(),
            center,
            scale,
        }
    }

    fn check_scale(&self) -> Result<()> {
        if !self.scale.is_finite() {
            return Err(Error::geometry("the rim is too long for double precision"));
        }
        if self.scale == 0.0 {
            return Err(Error::geometry(format!(
                "the {} vertices of the rim coincide at one point",
                self.rim.len()
            )));
        }
        Ok(())
    }

    /// The reach in units of the mesh, for a hole with this [sampling step](Surroundings::sampling_step).
    pub(crate) fn reach(&self, reach: HoleReach, sampling_step: f64) -> Reach {
        Reach {
            rings: reach.rings,
            distance: reach.steps * sampling_step * self.scale,
        }
    }

    /// The triangles of `mesh` round the hole as far as `reach` says, and the vertices of the mesh that theirs are.
    ///
    /// # Errors
    /// `Cancelled` when the job is stopped.
    pub(crate) fn surroundings(
        &self,
        mesh: &TriMesh,
        reach: Reach,
        job: &Job<'_>,
    ) -> Result<(Surroundings, Vec<u32>)> {
        let rings = collect_rings(mesh, &self.halfedges, reach, job)?;
        job.ask()?;
        let mut vertices = self.rim.clone();
        let mut levels = vec![0; vertices.len()];
        let mut local = Vec::with_capacity(rings.levels.len());
        for &(v, level) in &rings.levels {
            job.tick(4)?;
            local.push(match self.rim_index.get(v) {
                Some(i) => (v, i),
                None => {
                    vertices.push(v);
                    levels.push(level);
                    (v, vertices.len() as u32 - 1)
                }
            });
        }
        job.ask()?;
        let local = LocalIndex::new(local);
        let mut triangles = Vec::with_capacity(rings.faces.len());
        for &(f, _) in &rings.faces {
            job.tick(4)?;
            let corners = mesh.triangles()[f as usize];
            triangles.push(corners.map(|v| local.get(v).unwrap_or(0)));
        }
        let points = vertices.iter().map(|&v| self.to_local(mesh, v)).collect();
        let around = Surroundings::new(self.rim.len(), points, levels, triangles);
        Ok((around, vertices))
    }

    fn to_local(&self, mesh: &TriMesh, vertex: u32) -> Vec3 {
        (mesh.point(vertex) - self.center) / self.scale
    }

    /// The position in the mesh of a point in the hole's coordinates.
    pub(crate) fn to_mesh(&self, p: &Vec3) -> Vec3 {
        p * self.scale + self.center
    }

    /// The edges of the polygon that lie along triangles, in the mesh's vertices and as the patch runs along them.
    pub(super) fn rim_edges(&self, polygon: &[u32]) -> Vec<[u32; 2]> {
        let m = polygon.len();
        (0..m)
            .filter(|&i| self.outside_faces[i].is_some())
            .map(|i| [polygon[i], polygon[(i + 1) % m]].map(|v| self.rim[v as usize]))
            .collect()
    }
}

/// Vertices of the mesh in the patch's orientation, each with the boundary halfedge along the edge that starts there.
struct Polygon(Vec<(u32, Option<u32>)>);

impl Polygon {
    /// The loop run backwards: the triangles of the patch lie on the other side of it. It begins where the loop is
    /// farthest from its middle, wherever it began in the mesh.
    fn of_loop(mesh: &TriMesh, l: &BoundaryLoop) -> Self {
        let n = l.vertices.len();
        let middle = l.vertices.iter().map(|&v| mesh.point(v)).sum::<Vec3>() / n as f64;
        let distance = |i: usize| (mesh.point(l.vertices[i]) - middle).norm_squared();
        let (mut first, mut farthest) = (0, 0.0);
        for i in 0..n {
            if distance(i) > farthest {
                (first, farthest) = (i, distance(i));
            }
        }
        let edge = |i: usize| {
            let halfedge = l.halfedges[(first + n - 1 - i) % n];
            (l.vertices[(first + n - i) % n], Some(halfedge))
        };
        Self((0..n).map(edge).collect())
    }

    /// Joins `inner` along a bridge between the two vertices that are closest to each other; where the
    /// polygons share a vertex there is no bridge.
    fn join(&mut self, mesh: &TriMesh, Self(mut inner): Self) {
        let (mut at, mut inner_at, mut shortest) = (0, 0, f64::INFINITY);
        for (i, &(v, _)) in self.0.iter().enumerate() {
            let p = mesh.point(v);
            for (j, &(w, _)) in inner.iter().enumerate() {
                let distance = if v == w {
                    -1.0
                } else {
                    (mesh.point(w) - p).norm_squared()
                };
                if distance < shortest {
                    (at, inner_at, shortest) = (i, j, distance);
                }
            }
        }
        inner.rotate_left(inner_at);
        let (from, to) = (self.0[at].0, inner[0].0);
        // ... from -> to .. inner .. to -> from ...: the bridge is passed both ways.
        if from != to {
            inner.insert(0, (from, None));
            inner.push((to, None));
        }
        self.0.splice(at..at, inner);
    }
}

fn joined_rim_vertices(mesh: &TriMesh, rim: &[u32], rim_index: &LocalIndex) -> Vec<(u32, u32)> {
    let mut joined = Vec::new();
    for (i, &v) in (0..).zip(rim) {
        for o in mesh.connectivity().outgoing(v) {
            if let Some(j) = rim_index.get(target(mesh.triangles(), o.halfedge)) {
                joined.push((j.min(i), j.max(i)));
            }
        }
    }
    joined.sort_unstable();
    joined.dedup();
    joined
}

/// The values in the order of their first occurrence.
fn distinct(values: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut places: Vec<(u32, usize)> = values.zip(0..).collect();
    places.sort_unstable();
    places.dedup_by_key(|&mut (value, _)| value);
    places.sort_unstable_by_key(|&(_, place)| place);
    places.into_iter().map(|(value, _)| value).collect()
}

/// Local numbers of mesh vertices.
struct LocalIndex(Vec<(u32, u32)>);

impl LocalIndex {
    fn new(mut pairs: Vec<(u32, u32)>) -> Self {
        pairs.sort_unstable();
        Self(pairs)
    }

    fn get(&self, vertex: u32) -> Option<u32> {
        let at = self.0.binary_search_by_key(&vertex, |&(v, _)| v).ok()?;
        Some(self.0[at].1)
    }
}
