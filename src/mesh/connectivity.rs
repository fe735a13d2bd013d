//! The connectivity of a mesh, without coordinates: the triangle on the other side of each edge.
//!
//! Halfedge `3 * f + k` runs from corner `k` of triangle `f` to corner `(k + 1) % 3`. Each halfedge has a link, made by
//! [`super::linking`]: the other halfedge of its edge, or a mark. The halfedges that leave a vertex are stored for
//! boundary vertices only, because patches are joined to these.

use super::defects::MeshDefects;
use super::halfedge::{BOUNDARY, NON_MANIFOLD, Outgoing, origin, target};
use super::linking::link_halfedges;
use super::rim_table::RimTable;
use super::survey::survey;
use crate::error::Result;
use std::collections::BTreeMap;

/// The arrays of a new mesh have free space for one `ROOM`th more entries. So the first patches do not move the arrays,
/// which would cost more than filling a small hole.
pub(super) const ROOM: usize = 16;

/// Halfedge links, and the outgoing halfedges of the vertices on the boundary.
#[derive(Clone, Debug, Default)]
pub(crate) struct Connectivity {
    twin: Vec<u32>,
    /// Boundary halfedges of the mesh as it was built, ascending.
    boundary: Vec<u32>,
    /// Number of halfedges of the mesh as it was built.
    built: usize,
    rim: RimTable,
    /// Outgoing halfedges of triangles that were appended after the mesh was built. They are stored for the vertices on
    /// the rims of the appended patches.
    appended: BTreeMap<u32, Vec<Outgoing>>,
}

impl Connectivity {
    /// Matches the halfedges of `triangles`.
    ///
    /// Runs on the current thread pool with the same result for any number of threads.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`](crate::ErrorKind::InvalidInput) when a triangle names a vertex that is
    /// not below `vertex_count`.
    ///
    /// # Complexity
    /// Linear time and memory; O(n log n) in the edges of vertices of very high valence, and in the
    /// triangles of edges with more than two.
    pub(crate) fn build(
        vertex_count: usize,
        triangles: &[[u32; 3]],
    ) -> Result<(Self, MeshDefects)> {
        let mut defects = MeshDefects::default();
        let chunks = survey(vertex_count, triangles, &mut defects)?;
        let links = link_halfedges(vertex_count, triangles, &chunks, &mut defects);
        let (rim, boundary) =
            RimTable::build(vertex_count, triangles, &links.twin, &links.boundary);
        let mut twin = links.twin;
        twin.reserve_exact(twin.len() / ROOM);
        let connectivity = Self {
            built: twin.len(),
            twin,
            boundary,
            rim,
            appended: BTreeMap::new(),
        };
        Ok((connectivity, defects))
    }

    /// All halfedges that start at `vertex`, in ascending order.
    ///
    /// Halfedges are known only at boundary vertices: of the mesh as it was built, and of each set of triangles that
    /// were appended together. At other vertices they are left out.
    pub(crate) fn outgoing(&self, vertex: u32) -> impl Iterator<Item = Outgoing> + '_ {
        let appended = self.appended.get(&vertex).map_or(&[][..], Vec::as_slice);
        self.rim.outgoing(vertex).iter().chain(appended).copied()
    }

    /// The link of `halfedge`: the other halfedge of its edge, or [`BOUNDARY`], [`NON_MANIFOLD`],
    /// [`DEGENERATE`].
    ///
    /// The linked halfedge has the opposite direction, unless the two triangles are oriented inconsistently.
    pub(crate) fn twin(&self, halfedge: u32) -> u32 {
        self.twin[halfedge as usize]
    }

    /// Number of halfedges.
    pub(crate) fn halfedge_count(&self) -> usize {
        self.twin.len()
    }

    /// All boundary halfedges in ascending order.
    ///
    /// Linear in the number of boundary halfedges of the mesh as it was built and of appended triangles.
    pub(crate) fn boundary_halfedges(&self) -> Vec<u32> {
        let appended = self.built as u32..self.twin.len() as u32;
        let is_open = |&h: &u32| self.twin(h) == BOUNDARY;
        self.boundary
            .iter()
            .copied()
            .chain(appended)
            .filter(is_open)
            .collect()
    }

    /// Whether some triangle has the edge `{a, b}`.
    ///
    /// As [`outgoing`](Self::outgoing), this knows only triangles at boundary vertices.
    pub(crate) fn has_edge(&self, a: u32, b: u32) -> bool {
        self.outgoing(a).any(|o| o.target == b) || self.outgoing(b).any(|o| o.target == a)
    }

    /// Whether some triangle has exactly these three vertices, of which the first must be one that
    /// [`outgoing`](Self::outgoing) knows.
    pub(crate) fn has_face(&self, triangles: &[[u32; 3]], t: [u32; 3]) -> bool {
        self.outgoing(t[0]).any(|o| {
            let other = &triangles[o.halfedge as usize / 3];
            t.iter().all(|v| other.contains(v))
        })
    }

    /// Links the triangles from `first_face` on, which were appended to `triangles`. `twins` pairs their halfedges with
    /// each other, from [`pair_halfedges`](super::pairing::pair_halfedges) of these triangles alone. Their other
    /// halfedges are linked with the boundary. The cost is proportional to the number of appended triangles.
    ///
    /// Their other halfedges must be opposite to boundary halfedges, and they must share no other edge with the mesh.
    /// The pipeline verifies that before it appends.
    pub(crate) fn append(&mut self, triangles: &[[u32; 3]], first_face: usize, twins: &[u32]) {
        let halfedges = 3 * first_face as u32..3 * triangles.len() as u32;
        debug_assert_eq!(halfedges.len(), twins.len());
        let ends = |h: u32| (origin(triangles, h), target(triangles, h));
        self.twin.resize(3 * triangles.len(), BOUNDARY);
        let first_halfedge = halfedges.start;
        let mut rim = Vec::new();
        for (h, twin) in halfedges.clone().zip(twins) {
            match *twin {
                BOUNDARY | NON_MANIFOLD => rim.push(h),
                twin => self.twin[h as usize] = first_halfedge + twin,
            }
        }
        for &h in &rim {
            let (a, b) = ends(h);
            let known = self.outgoing(b).find(|o| o.target == a);
            if let Some(Outgoing { halfedge, .. }) = known {
                self.link(h, halfedge);
            }
        }
        let mut rim_vertices: Vec<u32> = rim
            .iter()
            .flat_map(|&h| <[u32; 2]>::from(ends(h)))
            .collect();
        rim_vertices.sort_unstable();
        rim_vertices.dedup();
        // New vertices, which are the most, have higher numbers than those of the rim.
        let last = rim_vertices.last().copied().unwrap_or(0);
        for halfedge in halfedges {
            let (start, target) = ends(halfedge);
            if start <= last && rim_vertices.binary_search(&start).is_ok() {
                let outgoing = Outgoing { target, halfedge };
                self.appended.entry(start).or_default().push(outgoing);
            }
        }
    }

    fn link(&mut self, g: u32, h: u32) {
        self.twin[g as usize] = h;
        self.twin[h as usize] = g;
    }

    /// Reverts [`append`](Self::append) for the triangles from `first_face` on, which must still be in `triangles`. The
    /// cost is proportional to their number.
    pub(crate) fn truncate(&mut self, triangles: &[[u32; 3]], first_face: usize) {
        let first_halfedge = 3 * first_face as u32;
        for h in first_halfedge..self.twin.len() as u32 {
            let opposite = self.twin[h as usize];
            if opposite < first_halfedge {
                self.twin[opposite as usize] = BOUNDARY;
            }
            let start = origin(triangles, h);
            if let Some(outgoing) = self.appended.get_mut(&start) {
                outgoing.retain(|o| o.halfedge < first_halfedge);
                if outgoing.is_empty() {
                    self.appended.remove(&start);
                }
            }
        }
        self.twin.truncate(first_halfedge as usize);
    }
}
