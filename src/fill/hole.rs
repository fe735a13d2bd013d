//! One hole cut out of the mesh: its rim, the polygon to triangulate, and the triangles round it.

use crate::boundary::boundary_loop::BoundaryLoop;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use crate::mesh::halfedge::target;
use crate::mesh::rings::{Reach, collect_rings};
use crate::mesh::trimesh::TriMesh;
use crate::methods::spec::HoleReach;
use crate::patch::{HoleShape, Surroundings};

/// Known triangles round a hole, and which vertices of the mesh theirs are.
#[derive(Clone, Debug, Default)]
pub(crate) struct BandInMesh {
    /// Where they are, in the hole's coordinates.
    pub(crate) surroundings: Surroundings,
    /// The vertex of the mesh behind each of the points.
    pub(crate) vertices: Vec<u32>,
}

/// A hole, its place in the mesh, and its shape in coordinates of its own.
#[derive(Clone)]
pub(crate) struct Hole {
    /// Rim vertices in the mesh; rim vertex `i` of a patch is `rim[i]`.
    pub(crate) rim: Vec<u32>,
    /// Triangle of the mesh at each edge of the shape's polygon; `None` along the bridges to islands.
    pub(crate) outside_faces: Vec<Option<u32>>,
    /// The boundary halfedges of the rim.
    pub(super) halfedges: Vec<u32>,
    pub(super) rim_index: LocalIndex,
    /// What the methods see.
    pub(crate) shape: HoleShape,
    pub(super) center: Vec3,
    pub(super) scale: f64,
    /// False for a polyline: there are no triangles along its rim.
    pub(super) is_in_mesh: bool,
}

impl Hole {
    /// Cuts out the hole that `outer` bounds, together with the loose sheets that `islands` bound and the
    /// triangles round it as far as `reach` says.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for fewer than three edges, [`ErrorKind::Geometry`] when all vertices of
    /// the rim coincide, [`ErrorKind::Cancelled`].
    pub(crate) fn new(
        mesh: &TriMesh,
        outer: &BoundaryLoop,
        islands: &[&BoundaryLoop],
        reach: HoleReach,
        job: &Job<'_>,
    ) -> Result<Self> {
        if outer.edge_count() < 3 {
            return Err(Error::new(
                ErrorKind::InvalidInput,
                format!("a loop of {} edges encloses no area", outer.edge_count()),
            ));
        }
        let mut polygon = Polygon::of_loop(mesh, outer);
        for island in islands {
            polygon.join(mesh, Polygon::of_loop(mesh, island));
        }
        job.ask()?;
        let rim = distinct(&polygon.vertices);
        let rim_index = LocalIndex::new(rim.iter().zip(0..).map(|(&v, i)| (v, i)).collect());
        let polygon_indices: Vec<u32> = polygon
            .vertices
            .iter()
            .filter_map(|&v| rim_index.get(v))
            .collect();

        let count = rim.len() as f64;
        let center = rim.iter().map(|&v| mesh.point(v)).sum::<Vec3>() / count;
        let scale = (outer.perimeter + islands.iter().map(|l| l.perimeter).sum::<f64>()) / count;
        if !scale.is_finite() {
            let message = "the rim is too long for double precision";
            return Err(Error::new(ErrorKind::Geometry, message));
        }
        if scale == 0.0 {
            return Err(Error::new(
                ErrorKind::Geometry,
                format!(
                    "the {} vertices of the rim coincide at one point",
                    rim.len()
                ),
            ));
        }
        let to_local = |v: u32| (mesh.point(v) - center) / scale;
        let outside_faces: Vec<Option<u32>> =
            polygon.halfedges.iter().map(|h| h.map(|h| h / 3)).collect();
        let outside_normals = outside_faces
            .iter()
            .map(|face| {
                let [a, b, c] = mesh.triangles()[(*face)? as usize].map(to_local);
                let normal = unit(cross_normal(&a, &b, &c));
                (normal != Vec3::zeros()).then_some(normal)
            })
            .collect();

        let halfedges: Vec<u32> = [outer]
            .iter()
            .chain(islands)
            .flat_map(|l| l.halfedges.iter().copied())
            .collect();
        let points: Vec<Vec3> = rim.iter().map(|&v| to_local(v)).collect();
        job.ask()?;
        let joined = joined_rim_vertices(mesh, &rim, &rim_index);
        job.ask()?;
        let mut hole = Self {
            rim,
            outside_faces,
            halfedges,
            rim_index,
            shape: HoleShape {
                points,
                polygon: polygon_indices,
                outside_normals,
                joined,
                ..HoleShape::default()
            },
            center,
            scale,
            is_in_mesh: true,
        };
        hole.shape.surroundings = hole
            .band(mesh, Reach::rings(reach.rings.max(1)), job)?
            .surroundings;
        job.ask()?;
        if reach.steps > 0.0 {
            hole.shape.surroundings = hole.band(mesh, hole.in_mesh(reach), job)?.surroundings;
        }
        job.ask()?;
        hole.shape.edge_lengths = mean_edge_lengths(&hole.shape.points, &hole.shape.surroundings);
        Ok(hole)
    }

    /// The reach in units of the mesh.
    pub(crate) fn in_mesh(&self, reach: HoleReach) -> Reach {
        Reach {
            rings: reach.rings,
            distance: reach.steps * self.shape.sampling_step() * self.scale,
        }
    }

    /// The triangles of `mesh` round the hole as far as `reach` says.
    ///
    /// # Errors
    /// [`ErrorKind::Cancelled`] when the job is stopped.
    pub(crate) fn band(&self, mesh: &TriMesh, reach: Reach, job: &Job<'_>) -> Result<BandInMesh> {
        let rings = collect_rings(mesh, &self.halfedges, reach, job)?;
        job.ask()?;
        let mut band = BandInMesh::default();
        let mut local = Vec::with_capacity(rings.levels.len());
        for &(v, level) in &rings.levels {
            job.tick(4)?;
            local.push(match self.rim_index.get(v) {
                Some(i) => (v, i),
                None => {
                    let point = (mesh.point(v) - self.center) / self.scale;
                    band.surroundings.points.push(point);
                    band.surroundings.levels.push(level);
                    band.vertices.push(v);
                    (v, (self.rim.len() + band.vertices.len() - 1) as u32)
                }
            });
        }
        job.ask()?;
        let local = LocalIndex::new(local);
        for &(f, _) in &rings.faces {
            job.tick(4)?;
            let corners = mesh.triangles()[f as usize];
            let triangle = corners.map(|v| local.get(v).unwrap_or(0));
            band.surroundings.triangles.push(triangle);
        }
        Ok(band)
    }

    /// The position in the mesh of a point in the hole's coordinates.
    pub(crate) fn to_mesh(&self, p: &Vec3) -> [f64; 3] {
        (p * self.scale + self.center).into()
    }
}

/// Vertices of the mesh in the patch's orientation, with the boundary halfedge along each edge.
struct Polygon {
    vertices: Vec<u32>,
    halfedges: Vec<Option<u32>>,
}

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
        let vertices = (0..n).map(|i| l.vertices[(first + n - i) % n]).collect();
        let halfedges = (0..n)
            .map(|i| Some(l.halfedges[(first + n - 1 - i) % n]))
            .collect();
        Self {
            vertices,
            halfedges,
        }
    }

    /// Joins `inner` along a bridge between the two vertices that are closest to each other; where the
    /// polygons share a vertex there is no bridge.
    fn join(&mut self, mesh: &TriMesh, mut inner: Self) {
        let (mut at, mut inner_at, mut shortest) = (0, 0, f64::INFINITY);
        for (i, &v) in self.vertices.iter().enumerate() {
            let p = mesh.point(v);
            for (j, &w) in inner.vertices.iter().enumerate() {
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
        inner.vertices.rotate_left(inner_at);
        inner.halfedges.rotate_left(inner_at);
        let is_shared = self.vertices[at] == inner.vertices[0];
        let (tail, tail_halfedges) = (self.vertices.split_off(at), self.halfedges.split_off(at));
        if is_shared {
            // ... at | inner | at ...: the shared vertex begins both parts.
            self.vertices.append(&mut inner.vertices);
            self.halfedges.append(&mut inner.halfedges);
        } else {
            // ... at -> inner .. inner start -> at ...: the bridge is passed both ways.
            let start = inner.vertices[0];
            self.vertices.push(tail[0]);
            self.halfedges.push(None);
            self.vertices.append(&mut inner.vertices);
            self.vertices.push(start);
            self.halfedges.append(&mut inner.halfedges);
            self.halfedges.push(None);
        }
        self.vertices.extend(tail);
        self.halfedges.extend(tail_halfedges);
    }
}

fn mean_edge_lengths(rim: &[Vec3], surroundings: &Surroundings) -> Vec<f64> {
    let point = |v: u32| {
        let v = v as usize;
        if v < rim.len() {
            rim[v]
        } else {
            surroundings.points[v - rim.len()]
        }
    };
    let mut sums = vec![(0.0, 0.0); rim.len()];
    for t in &surroundings.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let length = (point(b) - point(a)).norm();
            for v in [a, b] {
                if let Some((sum, count)) = sums.get_mut(v as usize) {
                    *sum += length;
                    *count += 1.0;
                }
            }
        }
    }
    sums.iter()
        .map(|&(sum, count)| if count > 0.0 { sum / count } else { 1.0 })
        .collect()
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
fn distinct(values: &[u32]) -> Vec<u32> {
    let mut places: Vec<(u32, usize)> = values.iter().copied().zip(0..).collect();
    places.sort_unstable();
    places.dedup_by_key(|&mut (value, _)| value);
    places.sort_unstable_by_key(|&(_, place)| place);
    places.into_iter().map(|(value, _)| value).collect()
}

/// Local numbers of mesh vertices.
#[derive(Clone)]
pub(super) struct LocalIndex(Vec<(u32, u32)>);

impl LocalIndex {
    pub(super) fn new(mut pairs: Vec<(u32, u32)>) -> Self {
        pairs.sort_unstable();
        Self(pairs)
    }

    fn get(&self, vertex: u32) -> Option<u32> {
        let at = self.0.binary_search_by_key(&vertex, |&(v, _)| v).ok()?;
        Some(self.0[at].1)
    }
}
